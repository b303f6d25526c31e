//! The folder of a study: what has been run, so that whoever comes next goes on from there.
//!
//! ```text
//! study.toml      the study, with what its command line said
//! scene.toml      the scene as it was
//! study.json      which study this is, how far it is
//! parts/          rows as they came, each file complete
//! runs.parquet    all rows by index, once they are there
//! ```

use crate::error::Error;
use crate::experiment::Experiment;
use crate::index_set::IndexSet;
use crate::row::RunRow;
use crate::row_table::RowTable;
use output::{Claim, write_whole};
use recording::{ParquetWriter, append_bytes, append_columns, parquet_bytes, read_mark};
use scene::Study;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use studies::{COMMIT, PROGRAM};

/// `study.json`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StudyManifest {
    /// Name and version of the program.
    pub program: String,
    /// The commit that the program is built from, where it is known.
    pub commit: Option<String>,
    /// Which study this is: see [`Experiment::fingerprint`].
    pub fingerprint: String,
    /// Runs of the whole study.
    pub runs: u64,
    /// First run of this folder, and the first that is none of its.
    pub range: [u64; 2],
    /// Whether all of these have been made, or all that the search for an edge asked for.
    pub complete: bool,
}

impl StudyManifest {
    /// The program, as exactly as it is known.
    fn version(&self) -> String {
        let Self { program, commit, .. } = self;
        commit.as_ref().map_or(program.clone(), |commit| format!("{program} ({commit})"))
    }
}

/// Where the rows of a study go.
#[derive(Debug)]
pub struct StudyFolder {
    folder: PathBuf,
    manifest: StudyManifest,
    done: IndexSet,
    /// Rows that are not on the disk yet.
    rows: BTreeMap<u64, RunRow>,
    /// Without rows.
    table: RowTable,
    next_part: u64,
    _claim: Claim,
}

const MANIFEST: &str = "study.json";
const STUDY: &str = "study.toml";
const SCENE: &str = "scene.toml";
const PARTS: &str = "parts";
const RUNS: &str = "runs.parquet";
/// Rows that are in memory before they are written.
const ROWS_PER_PART: usize = 4096;

impl StudyFolder {
    /// Opens `folder` for the runs `range` of an experiment. What it holds of them counts; with `force` it is removed.
    ///
    /// # Errors
    /// [`Error::Usage`] where the folder holds another study, or another range of this one; others where it cannot be written.
    pub fn open(
        folder: &Path,
        experiment: &Experiment,
        range: Range<u64>,
        force: bool,
    ) -> Result<Self, Error> {
        let manifest = StudyManifest {
            program: PROGRAM.to_owned(),
            commit: COMMIT.map(str::to_owned),
            fingerprint: experiment.fingerprint().to_owned(),
            runs: experiment.study().runs(),
            range: [range.start, range.end],
            complete: false,
        };
        let earlier = Self::manifest_of(folder);
        let goes_on = !force && earlier.is_ok();
        let claim = if goes_on {
            Claim::again(folder)?
        } else {
            Claim::new(folder, "a study", force, |folder| folder.join(MANIFEST).exists().then(ours))?
        };
        let mut study = Self {
            folder: folder.to_owned(),
            manifest,
            done: IndexSet::default(),
            rows: BTreeMap::new(),
            table: RowTable::new(experiment.design()),
            next_part: 0,
            _claim: claim,
        };
        if let (true, Ok(earlier)) = (goes_on, earlier) {
            study.fits(&earlier)?;
            study.recall()?;
        }
        fs::create_dir_all(study.folder.join(PARTS)).map_err(output::Error::io("create", &study.folder))?;
        // Before all else: without it nobody knows whose the folder is.
        study.write_manifest()?;
        if !folder.join(STUDY).exists() || !folder.join(SCENE).exists() {
            // Whoever reads it later may stand in another folder.
            let scene = std::path::absolute(&experiment.study().scene).ok().filter(|path| path.is_file());
            let scene =
                scene.map_or_else(|| experiment.study().scene.clone(), |path| path.display().to_string());
            study.write(STUDY, &Study { scene, ..experiment.study().clone() }.to_toml())?;
            study.write(SCENE, experiment.scene_text())?;
        }
        Ok(study)
    }

    /// The manifest of the study in `folder`.
    ///
    /// # Errors
    /// [`Error::Manifest`] where there is none, or it cannot be read.
    pub fn manifest_of(folder: &Path) -> Result<StudyManifest, Error> {
        let path = folder.join(MANIFEST);
        let wrong = |message: String| Error::Manifest { path: path.display().to_string(), message };
        let text = fs::read_to_string(&path)
            .map_err(|error| wrong(format!("{error}: a folder that `echelon sweep` wrote has this file")))?;
        serde_json::from_str(&text).map_err(|error| wrong(format!("is no manifest of a study: {error}")))
    }

    /// The study that is in `folder`, with its scene as it was.
    pub fn study_file(folder: &Path) -> PathBuf {
        folder.join(STUDY)
    }

    /// Runs that have been made.
    pub fn done(&self) -> &IndexSet {
        &self.done
    }

    fn write(&self, name: &str, text: &str) -> Result<(), Error> {
        Ok(write_whole(&self.folder.join(name), text.as_bytes())?)
    }

    fn write_manifest(&self) -> Result<(), Error> {
        let text = serde_json::to_string_pretty(&self.manifest).unwrap_or_default();
        self.write(MANIFEST, &(text + "\n"))
    }

    fn fits(&self, earlier: &StudyManifest) -> Result<(), Error> {
        let folder = self.folder.display();
        if earlier.version() != self.manifest.version() {
            return Err(Error::Usage(format!(
                "{folder} holds a study by {}, and this is {}: rows of two versions do not mix; choose another folder, or give \
                 --force to begin anew",
                earlier.version(),
                self.manifest.version()
            )));
        }
        if earlier.fingerprint != self.manifest.fingerprint {
            return Err(Error::Usage(format!(
                "{folder} holds another study, or this one of a scene that has changed since (compare its {STUDY} and {SCENE}): \
                 choose another folder, or give --force to begin anew"
            )));
        }
        if earlier.range != self.manifest.range {
            let [from, to] = earlier.range;
            return Err(Error::Usage(format!(
                "{folder} holds the runs {from}..{to} of this study: choose another folder"
            )));
        }
        Ok(())
    }

    /// Learns which runs have been made.
    fn recall(&mut self) -> Result<(), Error> {
        self.done = IndexSet::default();
        let whole = self.folder.join(RUNS);
        for path in row_files(&self.folder)? {
            let indices = indices(&path)?;
            if path != whole && !indices.is_empty() && indices.iter().all(|index| self.done.contains(*index))
            {
                // It was joined with the others, and the program ended before it was removed.
                fs::remove_file(&path).map_err(output::Error::io("remove", &path))?;
                continue;
            }
            for index in indices {
                if !self.done.insert(index) {
                    return Err(twice(index, &path));
                }
            }
            let number = path.file_stem().and_then(|stem| stem.to_str()?.parse::<u64>().ok());
            self.next_part = self.next_part.max(number.map_or(0, |number| number + 1));
        }
        Ok(())
    }

    /// Takes a row. It is on the disk after the next [`StudyFolder::flush`].
    ///
    /// # Errors
    /// [`Error`] where the disk does not take it.
    pub fn push(&mut self, row: RunRow) -> Result<(), Error> {
        self.rows.insert(row.point.index, row);
        if self.rows.len() >= ROWS_PER_PART { self.flush() } else { Ok(()) }
    }

    /// Puts rows on the disk.
    ///
    /// # Errors
    /// [`Error`] where the disk does not take them; they are kept then.
    pub fn flush(&mut self) -> Result<(), Error> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let path = self.folder.join(PARTS).join(format!("{:06}.parquet", self.next_part));
        write_rows(&path, &self.table, self.rows.values(), &self.manifest.fingerprint)?;
        self.next_part += 1;
        for index in std::mem::take(&mut self.rows).into_keys() {
            self.done.insert(index);
        }
        Ok(())
    }

    /// Makes one file of all rows: those that are there are all that are wanted.
    ///
    /// # Errors
    /// [`Error`] where the disk does not take it.
    pub fn finish(&mut self) -> Result<(), Error> {
        self.flush()?;
        let (whole, files) = (self.folder.join(RUNS), row_files(&self.folder)?);
        if files != [whole.clone()] {
            join(&files, &whole, &self.table, &self.manifest.fingerprint)?;
        }
        let parts = self.folder.join(PARTS);
        fs::remove_dir_all(&parts).map_err(output::Error::io("remove", &parts))?;
        self.manifest.complete = true;
        self.write_manifest()
    }
}

/// What a study leaves in its folder.
fn ours() -> Vec<String> {
    let more = ["summary.csv", "report.html", "figures", "films"];
    [MANIFEST, STUDY, SCENE, PARTS, RUNS].into_iter().chain(more).map(str::to_owned).collect()
}

/// The files with the rows of the study in `folder`: those that were joined first, then parts in the order of their names.
///
/// # Errors
/// Where the folder cannot be read.
pub fn row_files(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let whole = Some(folder.join(RUNS)).filter(|whole| whole.exists());
    let parts = folder.join(PARTS);
    let mut files: Vec<PathBuf> = match fs::read_dir(&parts) {
        Ok(entries) => entries.flatten().map(|entry| entry.path()).collect(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => vec![],
        Err(error) => return Err(output::Error::io("read", &parts)(error).into()),
    };
    files.retain(|path| path.extension().is_some_and(|ending| ending == "parquet"));
    files.sort();
    Ok(whole.into_iter().chain(files).collect())
}

/// Writes rows as a file of their own, which carries the fingerprint of their study; `empty` is a table of it without rows.
///
/// # Errors
/// [`Error`] where the disk does not take them.
pub fn write_rows<'a>(
    path: &Path,
    empty: &RowTable,
    rows: impl Iterator<Item = &'a RunRow>,
    fingerprint: &str,
) -> Result<(), Error> {
    let mut table = empty.clone();
    rows.for_each(|row| table.push(row));
    let mut file = ParquetWriter::marked(path, table.columns(), fingerprint)?;
    file.write(table.columns_mut())?;
    file.close()?;
    Ok(())
}

/// Rows as the bytes of a file, which carries the fingerprint of their study.
///
/// # Errors
/// [`Error`] where they cannot be encoded.
pub fn part_bytes(experiment: &Experiment, rows: &[RunRow]) -> Result<Vec<u8>, Error> {
    let mut table = RowTable::new(experiment.design());
    for row in rows {
        table.push(row);
    }
    Ok(parquet_bytes(table.columns_mut(), experiment.fingerprint())?)
}

/// The rows of files in memory, by index.
///
/// # Errors
/// [`Error::Usage`] where one is of another study or of another version, or a run is there twice.
pub fn joined(experiment: &Experiment, parts: &[Vec<u8>]) -> Result<RowTable, Error> {
    let mut rows = BTreeMap::new();
    for part in parts {
        let mut table = RowTable::new(experiment.design());
        let mark = append_bytes(part.clone(), table.columns_mut())?;
        if mark.as_deref() != Some(experiment.fingerprint()) {
            return Err(Error::Usage(format!("a part {OTHERS}")));
        }
        for row in table.rows() {
            let index = row.point.index;
            if rows.insert(index, row).is_some() {
                return Err(Error::Usage(format!("run {index} is there twice")));
            }
        }
    }
    let mut table = RowTable::new(experiment.design());
    for row in rows.values() {
        table.push(row);
    }
    Ok(table)
}

/// Why rows do not go together.
const OTHERS: &str = "has rows of another study, of another scene, or by another version of the program";

/// The indices of the rows of a file.
fn indices(path: &Path) -> Result<Vec<u64>, Error> {
    let whole = recording::read_whole(path, "index")?;
    Ok(whole.into_iter().filter_map(|index| u64::try_from(index).ok()).collect())
}

fn twice(index: u64, path: &Path) -> Error {
    Error::Usage(format!("run {index} is there twice; the second is in {}", path.display()))
}

/// Joins files of rows into one, by index; those that are in memory at once are of files that overlap. `empty` is a
/// table without rows.
fn join(files: &[PathBuf], whole: &Path, empty: &RowTable, fingerprint: &str) -> Result<(), Error> {
    let mut ordered = vec![];
    for path in files {
        if let Some(first) = indices(path)?.first().copied() {
            ordered.push(FirstOf { first, path });
        }
    }
    ordered.sort_by_key(|file| file.first);
    let mut out = ParquetWriter::marked(whole, empty.columns(), fingerprint)?;
    let mut waiting = BTreeMap::new();
    for (number, file) in ordered.iter().enumerate() {
        let mut read = empty.clone();
        append_columns(file.path, read.columns_mut())?;
        for row in read.rows() {
            let index = row.point.index;
            if waiting.insert(index, row).is_some() {
                return Err(twice(index, file.path));
            }
        }
        // What is to come begins there.
        let sure = ordered.get(number + 1).map_or(u64::MAX, |next| next.first);
        let later = waiting.split_off(&sure);
        let mut table = empty.clone();
        for row in waiting.values() {
            table.push(row);
        }
        if !table.is_empty() {
            out.write(table.columns_mut())?;
        }
        waiting = later;
    }
    out.close()?;
    Ok(())
}

/// A file of rows with the first index in it.
struct FirstOf<'a> {
    first: u64,
    path: &'a PathBuf,
}

/// Joins the rows of studies in folders, and of files of rows, in a folder that holds the whole study then. Returns the runs
/// that are missing; where there are any, nothing is written.
///
/// # Errors
/// [`Error::Usage`] where one is of another study or of another version, or a run is there twice.
pub fn merge(
    folder: &Path,
    parts: &[PathBuf],
    experiment: &Experiment,
    force: bool,
) -> Result<IndexSet, Error> {
    let mut files = vec![];
    let whole = folder.canonicalize().ok();
    for part in parts {
        // What is merged must not be what is replaced.
        if whole.is_some()
            && part
                .canonicalize()
                .is_ok_and(|part| Some(&*part) == whole.as_deref() || part.parent() == whole.as_deref())
        {
            return Err(Error::Usage(format!(
                "{} is to be merged into itself: choose another folder",
                part.display()
            )));
        }
        let found = if part.is_dir() { row_files(part)? } else { vec![part.clone()] };
        if found.is_empty() {
            return Err(Error::Usage(format!("{} has no rows of a study", part.display())));
        }
        files.extend(found);
    }
    let mut found = IndexSet::default();
    for path in &files {
        if read_mark(path)?.as_deref() != Some(experiment.fingerprint()) {
            return Err(Error::Usage(format!("{} {OTHERS}", path.display())));
        }
        for index in indices(path)? {
            if !found.insert(index) {
                return Err(twice(index, path));
            }
        }
    }
    let missing = found.missing(0..experiment.study().runs());
    if missing.is_empty() {
        let mut study = StudyFolder::open(folder, experiment, 0..experiment.study().runs(), force)?;
        join(&files, &folder.join(RUNS), &study.table, experiment.fingerprint())?;
        study.recall()?;
        study.finish()?;
    }
    Ok(missing)
}

/// Hands all rows of the study in `folder` to `take`, by index where it is complete.
///
/// # Errors
/// [`Error`] where they cannot be read.
pub fn for_every_row(
    folder: &Path,
    experiment: &Experiment,
    mut take: impl FnMut(RunRow),
) -> Result<(), Error> {
    let mut seen = IndexSet::default();
    for path in row_files(folder)? {
        let mut table = RowTable::new(experiment.design());
        append_columns(&path, table.columns_mut())?;
        table.rows().filter(|row| seen.insert(row.point.index)).for_each(&mut take);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::RowStatus;

    /// What the disk refused is written once when it takes it again.
    #[test]
    fn rows_that_the_disk_refused_are_not_lost_and_not_doubled() {
        let root = tempfile::tempdir().expect("a folder");
        let folder = root.path().join("study");
        let study = Study { seeds: 3, ..Study::of_scene("line-three", "t") };
        let experiment = Experiment::new(study).expect("an experiment");
        let row = |index| RunRow::of(experiment.design().point(index), RowStatus::Complete, String::new());
        let mut study = StudyFolder::open(&folder, &experiment, 0..3, false).expect("a folder");
        study.push(row(0)).expect("taken");
        fs::remove_dir(folder.join(PARTS)).expect("removed");
        study.flush().expect_err("no folder");
        fs::create_dir(folder.join(PARTS)).expect("made");
        study.push(row(2)).expect("taken");
        study.flush().expect("written");
        study.push(row(1)).expect("taken");
        study.finish().expect("joined");
        let mut found = vec![];
        for_every_row(&folder, &experiment, |row| found.push(row.point.index)).expect("rows");
        assert_eq!((found, indices(&folder.join(RUNS)).expect("indices")), (vec![0, 1, 2], vec![0, 1, 2]));
    }
}
