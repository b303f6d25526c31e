//! Writing a run folder while the run goes.

use crate::log::{self, Pipe, Roll};
use crate::table::{TableKind, TableWriter};
use crate::{Error, Manifest, Status};
use metrics::{CertificateMetrics, Digest, JudgedExpectation, Metrics, MetricsBuilder};
use output::{Claim, write_whole};
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};
use vocabulary::{Contact, FleetInfo, Judging, StepRecord};

/// What a recorder has to know before the first moment.
#[derive(Debug, Clone)]
pub struct RunOptions {
    /// Also write tables as CSV.
    pub csv: bool,
    /// Leave out the log.
    pub no_log: bool,
    /// Where pictures of cameras come from, for the log; nowhere by default.
    pub roll: Roll,
    /// Replace a run that is there already.
    pub force: bool,
    /// The resolved scene, as text.
    pub scene: String,
    /// Name and version of the program.
    pub program: String,
    /// Commit it was built from, where known.
    pub commit: Option<String>,
    /// Seed of the run.
    pub seed: u64,
    /// Control period, s.
    pub period: f64,
    /// What the metrics are judged by.
    pub judging: Judging,
}

/// Writes a run folder; dropped without [`Recorder::finish`], it leaves what it had, marked `running`.
pub struct Recorder {
    folder: PathBuf,
    fleet: FleetInfo,
    manifest: Manifest,
    tables: Vec<TableWriter>,
    log: Option<Pipe>,
    metrics: MetricsBuilder,
    digest: Digest,
    /// Last, so that it is given up when all files are closed.
    _claim: Claim,
}

/// What came of a run.
#[derive(Debug)]
pub struct Finished {
    /// Errors, effort, clearance, contacts, certificates.
    pub metrics: Metrics,
    /// Of its trajectory.
    pub digest: String,
    /// What was written down of it, or why it was not.
    pub written: Result<Manifest, Error>,
}

/// `metrics.json`.
#[derive(Serialize)]
struct MetricsFile<'a> {
    #[serde(flatten)]
    metrics: &'a Metrics,
    /// What the scene expects, where it was checked.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    expectations: &'a [JudgedExpectation],
}

/// The text of `metrics.json`.
///
/// # Errors
/// What the library says where it cannot write a number.
pub fn metrics_text(metrics: &Metrics, expectations: &[JudgedExpectation]) -> Result<String, String> {
    json_text(&MetricsFile { metrics, expectations }).map_err(|error| error.to_string())
}

/// What a run folder may contain that we wrote ourselves and may replace.
const OURS: [&str; 6] = ["manifest.json", "scene.toml", "metrics.json", "tables", "frames", log::FILE];

impl Recorder {
    /// Makes `folder` and writes what is known before the run.
    ///
    /// # Errors
    /// [`Error::Output`] where the folder holds a run (unless `force`) or anything else, where another run is being
    /// written there, and where it cannot be written.
    pub fn create(folder: &Path, fleet: &FleetInfo, options: RunOptions) -> Result<Self, Error> {
        let ours =
            |folder: &Path| folder.join("manifest.json").exists().then(|| OURS.map(str::to_owned).to_vec());
        let claim = Claim::new(folder, "a run", options.force, ours)?;
        let tables = folder.join("tables");
        fs::create_dir(&tables).map_err(Error::io("create", &tables))?;
        write_whole(&folder.join("scene.toml"), options.scene.as_bytes())?;
        let writer = |kind| TableWriter::create(&tables, kind, options.csv);
        let manifest = Manifest {
            program: options.program,
            commit: options.commit,
            seed: options.seed,
            period: options.period,
            ..Manifest::of(fleet)
        };
        let log = if options.no_log {
            None
        } else {
            let path = folder.join(log::FILE);
            Some(Pipe::create(&path, fleet, &options.scene, &manifest, options.roll)?)
        };
        let recorder = Self {
            folder: folder.to_owned(),
            fleet: fleet.clone(),
            tables: TableKind::of(fleet).into_iter().map(writer).collect::<Result<_, _>>()?,
            metrics: MetricsBuilder::new(fleet, options.judging),
            digest: Digest::default(),
            log,
            manifest,
            _claim: claim,
        };
        recorder.write_manifest()?;
        Ok(recorder)
    }

    /// Records a moment.
    ///
    /// # Errors
    /// [`Error`] when the disk does not take it.
    pub fn push(&mut self, record: &StepRecord) -> Result<(), Error> {
        self.digest.push(record);
        self.metrics.push(record);
        for table in &mut self.tables {
            table.push(&self.fleet, record)?;
        }
        self.log.as_mut().map_or(Ok(()), |log| log.push(record))?;
        self.manifest.samples += 1;
        Ok(())
    }

    /// What was measured so far.
    pub fn metrics(&self) -> Metrics {
        self.metrics.finish()
    }

    /// Digest of the records so far.
    pub fn digest(&self) -> String {
        self.digest.text()
    }

    /// The contacts that are open, as if they ended now.
    pub fn closed_contacts(&self) -> Vec<Contact> {
        self.metrics.close_contacts()
    }

    /// Closes the tables and writes metrics and manifest.
    ///
    /// # Errors
    /// [`Error`] when the disk does not take it.
    pub fn finish(self, status: Status) -> Result<(Manifest, Metrics), Error> {
        let Finished { metrics, written, .. } = self.conclude(status, vec![], &[]);
        Ok((written?, metrics))
    }

    /// As [`Recorder::finish`], with what the theorems say of the run and what became of the scene's expectations; what
    /// came out is told, whether or not the disk takes it.
    pub fn conclude(
        mut self,
        status: Status,
        certificates: Vec<CertificateMetrics>,
        expectations: &[JudgedExpectation],
    ) -> Finished {
        let last = StepRecord { contacts: self.closed_contacts(), ..StepRecord::default() };
        let metrics = Metrics { certificates, ..self.metrics.finish() };
        let digest = self.digest.text();
        self.manifest.status = status;
        self.manifest.digest = Some(digest.clone());
        let written = self.close(&last, &MetricsFile { metrics: &metrics, expectations });
        Finished { metrics, digest, written: written.map(|()| self.manifest) }
    }

    fn close(&mut self, last: &StepRecord, file: &MetricsFile<'_>) -> Result<(), Error> {
        for table in &mut self.tables {
            table.push(&self.fleet, last)?;
            table.finish()?;
        }
        write_json(&self.folder.join("metrics.json"), file)?;
        self.log.take().map_or(Ok(()), |log| log.finish(&self.manifest))?;
        self.write_manifest()
    }

    /// Marks the run as interrupted after its disk refused a moment; tables keep the parts that were closed.
    pub fn abandon(mut self) {
        self.manifest.status = Status::Interrupted;
        // The disk has just refused: if it refuses again, the error before is the one to tell.
        let _ = self.log.take().map_or(Ok(()), |log| log.finish(&self.manifest));
        if self.write_manifest().is_err() {
            // Where there is no room for a file beside it, the old one is overwritten: it has its room already.
            let _ = serde_json::to_string_pretty(&self.manifest)
                .map(|text| fs::write(self.folder.join("manifest.json"), text));
        }
    }

    fn write_manifest(&self) -> Result<(), Error> {
        write_json(&self.folder.join("manifest.json"), &self.manifest)
    }
}

fn write_json<T: serde::Serialize>(path: &Path, value: &T) -> Result<(), Error> {
    let text = json_text(value).map_err(Error::table(path))?;
    Ok(write_whole(path, text.as_bytes())?)
}

fn json_text<T: Serialize>(value: &T) -> serde_json::Result<String> {
    let mut text = serde_json::to_string_pretty(value)?;
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Column;
    use crate::table::read_table;
    use vocabulary::{Body, Edge, EdgeState, RobotInfo, RobotState, Snapshot};

    fn fleet() -> FleetInfo {
        let member = |name: &str| RobotInfo::new(name, name == "ann", Body::default());
        FleetInfo {
            title: "two".into(),
            duration: 20.0,
            robots: vec![member("ann"), member("bob")],
            edges: vec![Edge { leader: 0, follower: 1 }],
            ..FleetInfo::default()
        }
    }

    fn step_record(k: u32) -> StepRecord {
        let time = f64::from(k) * 0.01;
        let mut robots = vec![RobotState::default(); 2];
        robots[1].motion.pose.x = time / 3.0;
        let edge = EdgeState { error: [time, -time], limited: k.is_multiple_of(2), ..EdgeState::default() };
        StepRecord {
            snapshot: Snapshot { time, robots, props: vec![] },
            edges: vec![edge],
            ..StepRecord::default()
        }
    }

    fn options(force: bool) -> RunOptions {
        RunOptions {
            csv: true,
            no_log: false,
            roll: Roll::default(),
            force,
            scene: "schema = 1\n".into(),
            program: "test".into(),
            commit: None,
            seed: 7,
            period: 0.01,
            judging: Judging { settling_band: [0.02; 2], settled_after: 0.0 },
        }
    }

    fn record(folder: &Path, samples: u32) -> Recorder {
        let mut recorder = Recorder::create(folder, &fleet(), options(false)).expect("a recorder");
        for k in 0..samples {
            recorder.push(&step_record(k)).expect("recorded");
        }
        recorder
    }

    fn manifest(folder: &Path) -> Manifest {
        let text = fs::read_to_string(folder.join("manifest.json")).expect("a manifest");
        serde_json::from_str(&text).expect("valid")
    }

    #[test]
    fn a_whole_run_reads_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let (written, metrics) = record(folder.path(), 2001).finish(Status::Complete).expect("finished");
        assert_eq!(manifest(folder.path()), written);
        assert_eq!((written.status, written.samples), (Status::Complete, 2001));
        assert!((metrics.edges[0].final_error[0] - 20.0).abs() < 1e-12);
        let robots = read_table(folder.path(), TableKind::Robots).expect("a table");
        let (Column::Text(names), Column::Number(x)) = (&robots[1], &robots[2]) else { panic!("{robots:?}") };
        assert_eq!((names.len(), &*names[1]), (4002, "bob"));
        assert_eq!(x[4001], 2000.0 * 0.01 / 3.0);
        assert!(!folder.path().join("tables/robots.parts").exists());
        let csv = fs::read_to_string(folder.path().join("tables/edges.csv")).expect("csv");
        assert_eq!(csv.lines().count(), 2002);
        assert!(csv.lines().nth(2).expect("a row").contains("ann,bob"));
    }

    #[test]
    fn a_run_that_is_dropped_leaves_its_closed_parts_and_says_running() {
        let folder = tempfile::tempdir().expect("a folder");
        drop(record(folder.path(), 1600));
        assert_eq!(manifest(folder.path()).status, Status::Running);
        let edges = read_table(folder.path(), TableKind::Edges).expect("parts");
        let Column::Number(time) = &edges[0] else { panic!("{edges:?}") };
        assert_eq!(time.len(), 1500);
    }

    #[test]
    fn a_folder_in_use_is_never_overwritten_without_force() {
        let folder = tempfile::tempdir().expect("a folder");
        record(folder.path(), 3).finish(Status::Interrupted).expect("finished");
        let refused = Recorder::create(folder.path(), &fleet(), options(false)).err().expect("refused");
        let Error::Output(refused) = refused else { panic!("{refused}") };
        assert!(matches!(refused, output::Error::Occupied { what: Some("a run"), .. }), "{refused}");
        fs::write(folder.path().join("notes.txt"), "mine").expect("written");
        Recorder::create(folder.path(), &fleet(), options(true)).expect("replaced");
        assert_eq!(fs::read_to_string(folder.path().join("notes.txt")).expect("kept"), "mine");
        let other = tempfile::tempdir().expect("a folder");
        fs::write(other.path().join("thesis.tex"), "years").expect("written");
        let refused = Recorder::create(other.path(), &fleet(), options(true)).err().expect("refused");
        assert!(refused.to_string().contains("other files"), "{refused}");
    }

    #[test]
    fn a_folder_that_a_run_is_writing_is_nobody_elses() {
        let folder = tempfile::tempdir().expect("a folder");
        let live = record(folder.path(), 10);
        for force in [false, true] {
            let refused = Recorder::create(folder.path(), &fleet(), options(force)).err().expect("refused");
            assert!(refused.to_string().contains("another program"), "{refused}");
        }
        let (written, _) = live.finish(Status::Complete).expect("undisturbed");
        assert_eq!((manifest(folder.path()), written.samples), (written.clone(), 10));
        // Once it has ended it may be replaced.
        drop(Recorder::create(folder.path(), &fleet(), options(true)).expect("replaced"));
    }

    #[test]
    fn an_abandoned_run_says_interrupted() {
        let folder = tempfile::tempdir().expect("a folder");
        record(folder.path(), 800).abandon();
        let manifest = manifest(folder.path());
        assert_eq!((manifest.status, manifest.samples), (Status::Interrupted, 800));
    }

    #[test]
    fn an_unwritable_place_is_one_clear_error() {
        let error = Recorder::create(Path::new("/proc/nowhere/run"), &fleet(), options(false))
            .err()
            .expect("refused");
        assert!(error.to_string().contains("/proc/nowhere/run"), "{error}");
    }
}
