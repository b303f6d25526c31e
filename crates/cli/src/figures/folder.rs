//! The folder of a set of figures: refused where it holds other things, every file in it whole or not there.

use crate::failure::Failure;
use output::{Claim, write_whole};
use report::{FinishedRun, Report};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use studies::PROGRAM;

/// The file that says whose folder it is, and what is in it.
const MARK: &str = "claims.json";
/// Version of that file.
const FORMAT: u32 = 1;

/// A folder that is being filled.
pub(super) struct Folder {
    path: PathBuf,
    files: Vec<String>,
    _claim: Claim,
}

impl Folder {
    /// Makes the folder; with `force`, removes an earlier set of figures from it, and nothing else.
    pub(super) fn create(path: &Path, force: bool) -> Result<Self, Failure> {
        let earlier = |folder: &Path| ours(&fs::read_to_string(folder.join(MARK)).ok()?);
        let claim = Claim::new(path, "figures", force, earlier)?;
        let folder = Self { path: path.to_owned(), files: vec![], _claim: claim };
        folder.close("running", None)?;
        Ok(folder)
    }

    /// Writes a file.
    pub(super) fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        write_whole(&self.path.join(name), bytes)?;
        self.files.push(name.to_owned());
        Ok(())
    }

    /// A place for a file that writes itself.
    pub(super) fn place(&mut self, name: &str) -> PathBuf {
        self.files.push(name.to_owned());
        self.path.join(name)
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes down how it ended, what is in the folder, and what came out.
    pub(super) fn close(&self, status: &str, came: Option<(&Report, &[FinishedRun])>) -> Result<(), Failure> {
        // A place that was kept for a film which was never finished is no file.
        let there: Vec<&String> = self.files.iter().filter(|name| self.path.join(name).exists()).collect();
        let mut value = json!({
            "format": FORMAT,
            "program": PROGRAM,
            "commit": studies::COMMIT,
            "status": status,
            "files": there,
        });
        if let (Some((report, runs)), Some(all)) = (came, value.as_object_mut()) {
            all.extend(found(report, runs));
        }
        Ok(write_whole(&self.path.join(MARK), format!("{value:#}\n").as_bytes())?)
    }
}

/// Claims, runs, what was left out.
pub(super) fn found(report: &Report, runs: &[FinishedRun]) -> serde_json::Map<String, Value> {
    let claims: Vec<_> = report.claims().collect();
    let run = |ran: &FinishedRun| {
        let trace = &ran.trace;
        json!({
            "name": trace.name,
            "title": trace.fleet.title,
            "seed": trace.scene.seed,
            "digest": trace.digest,
            "settled_from": trace.late_from(),
            "metrics": trace.metrics,
            "efforts": trace.efforts,
        })
    };
    let all = [
        ("title", json!(report.title)),
        ("versions", json!(report.versions)),
        ("holding", json!(claims.iter().filter(|claim| claim.holds).count())),
        ("claims", json!(claims)),
        ("left_out", json!(report.left_out)),
        ("runs", runs.iter().map(run).collect()),
    ];
    all.map(|(key, value)| (key.to_owned(), value)).into_iter().collect()
}

/// The files that an earlier set has left, if it is one; names that lead elsewhere are none of its.
fn ours(text: &str) -> Option<Vec<String>> {
    let value: Value = serde_json::from_str(text).ok()?;
    value.get("program")?.as_str()?;
    let names = value.get("files")?.as_array()?.iter().filter_map(Value::as_str);
    let plain = |name: &&str| Path::new(name).file_name().is_some_and(|file| file == *name);
    Some(names.filter(plain).map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_earlier_set_is_replaced() {
        let root = tempfile::tempdir().expect("a folder");
        let path = root.path().join("figures");
        let mut folder = Folder::create(&path, false).expect("new");
        folder.write("old.svg", b"old").expect("written");
        folder.close("complete", None).expect("closed");
        // A place that was kept for a film which was never finished is not listed.
        assert!(!folder.place("film.mp4").exists());
        folder.close("interrupted", None).expect("closed");
        let listed = fs::read_to_string(path.join(MARK)).expect("a list");
        assert!(listed.contains("old.svg") && !listed.contains("film.mp4"), "{listed}");
        drop(folder);
        fs::write(path.join("notes.txt"), "mine").expect("written");
        let told = |force| match Folder::create(&path, force) {
            Err(Failure::Usage(text)) => text,
            _ => String::new(),
        };
        assert!(told(false).contains("--force"));
        drop(Folder::create(&path, true).expect("replaced"));
        assert!(path.join("notes.txt").exists() && !path.join("old.svg").exists());
        fs::remove_file(path.join(MARK)).expect("removed");
        assert!(told(true).contains("other files"));
    }

    #[test]
    fn names_that_lead_elsewhere_are_left_alone() {
        let text =
            "{\"program\": \"echelon\", \"files\": [\"a.svg\", \"../b\", \"/etc/c\", \"..\", \"d/e\", 7]}";
        assert_eq!(ours(text).expect("a list"), ["a.svg"]);
        assert!(ours("{\"files\": []}").is_none() && ours("not JSON").is_none());
    }
}
