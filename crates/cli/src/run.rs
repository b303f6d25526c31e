//! `echelon run`: simulate, record, judge.

use crate::Outcome;
use crate::args::RunArgs;
use crate::eyes;
use crate::failure::Failure;
use crate::interrupt;
use crate::junit::{self, Case};
use crate::load::{Loaded, load, stem};
use crate::print::note;
use crate::progress::Progress;
use crate::summary::{self, Summary};
use metrics::{CertificateMetrics, Digest, Metrics, MetricsBuilder};
use output::Place;
use recording::log::{self, Log, Roll};
use recording::{Finished, Recorder, RunOptions, Status};
use simulation::Fault;
use simulation::certify::Examiner;
use simulation::verdict::{Finding, verdict};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Name and version, as manifests and pictures carry it.
pub(crate) const PROGRAM: &str = concat!("echelon ", env!("CARGO_PKG_VERSION"));

/// Steps between two looks at the bar and at Ctrl-C.
pub(crate) const STRIDE: u64 = 16;

pub(crate) fn run(args: &RunArgs) -> Outcome {
    let began = Instant::now();
    let _report = junit::open(args.junit.as_deref(), args.scene.json)?;
    let mut cases = vec![];
    let outcome = judge(args, &mut cases);
    junit::close(
        args.junit.as_deref(),
        &stem(&args.scene.scene),
        cases,
        (outcome, began.elapsed()),
        args.scene.quiet,
    )
}

/// Runs the scene; `cases` are what became of its expectations.
fn judge(args: &RunArgs, cases: &mut Vec<Case>) -> Outcome {
    let mut loaded = load(&args.scene)?;
    for late in loaded.scene.late().iter().filter(|_| !args.scene.quiet && !args.scene.json) {
        note(&format!("note: {late}"));
    }
    let roll = Roll::default();
    let logs = !args.no_record && !args.no_log;
    let drawn = eyes::open(&mut loaded.simulation, None, &args.scene.adapter, logs.then_some(&roll))?;
    let Loaded { scene, mut simulation } = loaded;
    let folder = if args.no_record { None } else { Some(folder(args)?) };
    let mut sink = match &folder {
        Some(folder) => Sink::record(folder, args, &scene, &simulation, roll)?,
        None => Sink::Judge(Box::new((
            MetricsBuilder::new(simulation.fleet(), scene.judging()),
            Digest::default(),
        ))),
    };
    let steps = simulation.len();
    let what = format!("Simulating {}, {} s", stem(&args.scene.scene), scene.time.duration);
    let progress = Progress::begin(&what, steps, args.scene.quiet || args.scene.json);
    let began = Instant::now();
    let mut step = 0;
    let mut examiner = Examiner::new(&scene, &simulation);
    while let Some(record) = simulation.next_record() {
        if let Err(error) = sink.push(record) {
            sink.abandon();
            return Err(Failure::from(error).but(&folder.as_deref().map_or_else(String::new, kept)));
        }
        examiner.push(&simulation);
        step += 1;
        if step % STRIDE == 0 {
            progress.at(step);
            if interrupt::asked() {
                break;
            }
        }
    }
    let broken = match simulation.fault() {
        Some(Fault::NotFinite(what)) => Some(Finding::not_finite(what)),
        Some(fault @ Fault::CameraRenderer(_)) => {
            sink.abandon();
            return Err(fault.into());
        }
        None => None,
    };
    let wall = began.elapsed().as_secs_f64();
    progress.end();
    let status = match step == steps {
        true => Status::Complete,
        false if simulation.stopped() || broken.is_some() => Status::Stopped,
        false => Status::Interrupted,
    };
    let certificates = examiner.finish(&simulation);
    let certificates = certificates.iter().map(|c| c.metrics(simulation.fleet())).collect();
    let findings: Vec<Finding> = match status {
        Status::Interrupted => vec![],
        _ => verdict(&scene, &sink.metrics(), status == Status::Complete).into_iter().chain(broken).collect(),
    };
    let (metrics, digest, written) = sink.finish(status, certificates, &findings);
    if status == Status::Interrupted {
        let why = format!("the run was interrupted at {:.2} s", metrics.duration);
        cases.extend(verdict(&scene, &metrics, false).iter().map(|finding| Case::unjudged(finding, &why)));
        written?;
        let place = folder.map_or_else(String::new, |f| format!(", recorded in {}", f.display()));
        return Err(Failure::Interrupted(format!(
            "{:.2} of {} s{place}",
            metrics.duration, scene.time.duration
        )));
    }
    cases.extend(findings.iter().map(Case::of));
    let met = !findings.iter().any(Finding::failed);
    let summary = Summary {
        scene: &scene,
        metrics: &metrics,
        findings: &findings,
        digest,
        folder,
        wall,
        drawn,
        steps: step,
    };
    if args.scene.json {
        summary::as_json(&summary);
    } else if !args.scene.quiet {
        summary::as_text(&summary);
    } else if !met {
        summary::failures(&summary);
    }
    // What came out is told, whatever becomes of a file.
    written.map_err(|error| {
        let kept = args.out.as_ref().map_or_else(|| "the folder".to_owned(), |out| out.display().to_string());
        Failure::from(error).but(&format!("{kept} keeps what was written before"))
    })?;
    if met { Ok(()) } else { Err(Failure::Expectation) }
}

/// What a disk that refuses has left of the run in `folder`.
fn kept(folder: &Path) -> String {
    let shown = folder.display();
    let log = Log::open(&folder.join(log::FILE)).ok();
    let period = log.as_ref().map_or(0.0, |log| log.manifest().period);
    match log.map_or(0, |log| log.manifest().samples) {
        0 => format!("{shown} keeps the parts of its tables that were closed, and says interrupted"),
        samples => format!(
            "{shown} keeps the run up to {:.2} s, which `echelon replay {shown}` draws with --capture or --film, and says \
             interrupted",
            (samples - 1) as f64 * period
        ),
    }
}

/// Where moments go.
enum Sink {
    Record(Box<Recorder>),
    Judge(Box<(MetricsBuilder, Digest)>),
}

impl Sink {
    fn record(
        folder: &Path,
        args: &RunArgs,
        scene: &scene::Scene,
        simulation: &simulation::Simulation,
        roll: Roll,
    ) -> Result<Self, Failure> {
        let options = RunOptions {
            csv: args.csv,
            no_log: args.no_log,
            roll,
            force: args.force,
            scene: scene.to_toml(),
            program: PROGRAM.to_owned(),
            commit: option_env!("ECHELON_COMMIT").map(str::to_owned),
            seed: scene.seed,
            period: scene.time.period,
            judging: scene.judging(),
        };
        Ok(Self::Record(Box::new(Recorder::create(folder, simulation.fleet(), options)?)))
    }

    fn push(&mut self, record: &vocabulary::StepRecord) -> Result<(), recording::Error> {
        match self {
            Self::Record(recorder) => recorder.push(record),
            Self::Judge(judge) => {
                judge.0.push(record);
                judge.1.push(record);
                Ok(())
            }
        }
    }

    fn abandon(self) {
        if let Self::Record(recorder) = self {
            recorder.abandon();
        }
    }

    fn metrics(&self) -> Metrics {
        match self {
            Self::Record(recorder) => recorder.metrics(),
            Self::Judge(judge) => judge.0.finish(),
        }
    }

    /// Metrics, digest, and whether what was to be written is.
    fn finish(
        self,
        status: Status,
        certificates: Vec<CertificateMetrics>,
        findings: &[Finding],
    ) -> (Metrics, String, Result<(), recording::Error>) {
        match self {
            Self::Record(mut recorder) => {
                recorder.certify(certificates);
                recorder.judge(findings.iter().map(Finding::metrics).collect());
                let Finished { metrics, digest, written } = recorder.conclude(status);
                (metrics, digest, written.map(drop))
            }
            Self::Judge(judge) => (Metrics { certificates, ..judge.0.finish() }, judge.1.text(), Ok(())),
        }
    }
}

/// The folder asked for, or the next free runs/NAME-001, made at once so that runs started together get one each.
fn folder(args: &RunArgs) -> Result<PathBuf, Failure> {
    if let Some(folder) = &args.out {
        return Ok(folder.clone());
    }
    let stem = stem(&args.scene.scene);
    let refused =
        |path: &Path, e: &std::io::Error| Failure::Machine(format!("cannot create {}: {e}", path.display()));
    let runs = Path::new("runs");
    let _place = Place::folder(runs)?;
    let mut number = 1;
    loop {
        let path = runs.join(format!("{stem}-{number:03}"));
        match std::fs::create_dir(&path) {
            Ok(()) => return Ok(path),
            Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => number += 1,
            Err(e) => return Err(refused(&path, &e)),
        }
    }
}
