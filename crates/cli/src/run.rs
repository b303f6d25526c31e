//! `echelon run`: simulate, record, judge.

use crate::args::SceneArgs;
use crate::failure::Failure;
use crate::junit::{self, ReportedCheck};
use crate::load::{load, stem};
use crate::print::note;
use crate::progress::Progress;
use crate::summary::{self, Summary};
use crate::{Outcome, cameras, interrupt, link};
use clap::Args;
use output::Place;
use recording::log::{self, Log, Roll};
use recording::{Recorder, RunOptions, Status};
use std::path::{Path, PathBuf};
use std::time::Instant;
use studies::run::JudgedRun;
use studies::verdict::verdict;
use studies::{Error, run_options};

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub(crate) struct RunArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Run folder; by default runs/NAME-001, -002, …
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Also write the tables as CSV
    #[arg(long)]
    csv: bool,
    /// Do not write log.mcap, which other tools open and replays are rendered from
    #[arg(long)]
    no_log: bool,
    /// Replace an earlier run in the folder
    #[arg(long)]
    force: bool,
    /// Also write the results of the scene's expectations as JUnit XML for CI systems; `-` writes it to standard
    /// output and moves the report for people to standard error
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Record nothing: only simulate and check expectations
    #[arg(long, conflicts_with_all = ["out", "csv", "force", "no_log"])]
    no_record: bool,
}

pub(crate) fn run(args: &RunArgs) -> Outcome {
    let SceneArgs { scene, json, quiet, .. } = &args.scene;
    junit::reported(args.junit.as_deref(), &stem(scene), *json, *quiet, |cases| judge(args, cases))
}

/// Runs the scene; `cases` are what became of its expectations.
fn judge(args: &RunArgs, cases: &mut Vec<ReportedCheck>) -> Outcome {
    let mut run = load(&args.scene)?;
    let link = link::meant(&args.scene.scene)?;
    if !args.scene.quiet && !args.scene.json {
        for remark in run.scene.late().into_iter().chain(run.scene.unused()) {
            note(&format!("note: {remark}"));
        }
    }
    let roll = Roll::default();
    let logs = !args.no_record && !args.no_log;
    let drawn = cameras::attach(&mut run, None, &args.scene.adapter.name, logs.then_some(&roll))?;
    let scene = run.scene.clone();
    let sees = run.simulation.needs_cameras();
    let folder = if args.no_record { None } else { Some(folder(args)?) };
    let options =
        || RunOptions { csv: args.csv, no_log: args.no_log, roll, force: args.force, ..run_options(&scene) };
    let recorder = match &folder {
        Some(folder) => Some(Recorder::create(folder, run.simulation.fleet(), options())?),
        None => None,
    };
    let what = format!("Simulating {}, {} s", stem(&args.scene.scene), scene.time.duration);
    let progress = Progress::begin(&what, run.simulation.len(), args.scene.quiet || args.scene.json);
    let began = Instant::now();
    let then = link.as_ref().and_then(|link| link.time);
    let judged = studies::run::run(run, recorder, then, |step| {
        progress.at(step);
        !interrupt::asked()
    });
    let wall = began.elapsed().as_secs_f64();
    let JudgedRun { status, steps, metrics, digest, digest_then, findings, written, .. } =
        judged.map_err(|error| match error {
            Error::Recording(error) => {
                Failure::from(error).but(&folder.as_deref().map_or_else(String::new, kept))
            }
            other => other.into(),
        })?;
    drop(progress);
    if status == Status::Interrupted {
        let why = format!("the run was interrupted at {:.2} s", metrics.duration);
        cases.extend(
            verdict(&scene, &metrics, false).iter().map(|finding| ReportedCheck::unjudged(finding, &why)),
        );
        written?;
        let place = folder.map_or_else(String::new, |f| format!(", recorded in {}", f.display()));
        return Err(Failure::Interrupted(format!(
            "{:.2} of {} s{place}",
            metrics.duration, scene.time.duration
        )));
    }
    cases.extend(findings.iter().map(ReportedCheck::of));
    let linked = link.zip(digest_then).and_then(|(link, then)| link::compare(&link, then, &args.scene, sees));
    let summary = Summary {
        scene: &scene,
        metrics: &metrics,
        findings: &findings,
        digest,
        linked,
        folder,
        wall,
        drawn,
        steps,
    };
    let met = summary.met();
    if args.scene.json {
        summary::as_json(&summary);
    } else if !args.scene.quiet {
        summary::as_text(&summary);
    } else if !met {
        summary::failures(&summary);
    }
    // Results are printed even if a file cannot be written.
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
        0 => {
            format!("{shown} keeps the parts of its tables that were complete; its manifest says interrupted")
        }
        samples => format!(
            "{shown} keeps the run up to {:.2} s, which `echelon replay {shown}` draws with --capture or --film; its \
             manifest says interrupted",
            (samples - 1) as f64 * period
        ),
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
