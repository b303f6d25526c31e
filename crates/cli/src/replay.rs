//! `echelon replay`: does a recorded run come out the same again?

use crate::args::{AdapterArgs, PictureArgs};
use crate::failure::Failure;
use crate::load::{build, stem};
use crate::print::{json, note, say};
use crate::progress::Progress;
use crate::recorded::Recorded;
use crate::{Outcome, cameras, capture, film, interrupt};
use clap::Args;
use footage::{CaptureJob, DrawJob, FilmJob, Preset, captions, times};
use recording::{Manifest, Status};
use serde_json::json;
use std::path::PathBuf;
use studies::replay::{Replay, RunDigest, run_again};
use studies::{PROGRAM, RecordSource};
use vocabulary::counted;

#[derive(Debug, Args)]
pub(crate) struct ReplayArgs {
    /// Run folder, such as runs/line-three-001, or a log.mcap
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// Render a film of the recording, without simulating
    #[arg(long, value_name = "FILE", conflicts_with = "capture")]
    film: Option<PathBuf>,
    /// Render pictures of the recording at these times in s, such as 0,5,15, without simulating
    #[arg(long, value_name = "TIMES", value_delimiter = ',', allow_negative_numbers = true, value_parser = crate::args::time)]
    capture: Vec<f64>,
    /// Folder for the pictures; it may hold others
    #[arg(long, short, value_name = "DIR", default_value = ".", requires = "capture")]
    out: PathBuf,
    /// Frames per second of simulation time
    #[arg(long, requires = "film")]
    fps: Option<f64>,
    /// Encode with the ffmpeg on PATH instead of the built-in encoder
    #[arg(long, requires = "film")]
    ffmpeg: bool,
    /// Measures, cards and, where the scene has no storyboard, shots for a purpose
    #[arg(long, value_parser = film::presets(), requires = "film", conflicts_with = "view")]
    preset: Option<Preset>,
    #[command(flatten)]
    picture: PictureArgs,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// Print only differences and errors
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// A replay, and what is printed about it.
struct ReplayReport {
    manifest: Manifest,
    replay: Replay,
    /// Whether cameras on robots took pictures.
    sees: bool,
}

pub(crate) fn replay(args: &ReplayArgs) -> Outcome {
    let run = Recorded::open(&args.run)?;
    if args.film.is_some() || !args.capture.is_empty() { draw(args, run) } else { verify(args, &run) }
}

/// Draws what was recorded.
fn draw(args: &ReplayArgs, run: Recorded) -> Outcome {
    // Pictures need no more of a scene than its taste; that of another program may not be readable here.
    let scene = run.scene().ok();
    let mut settings = scene.as_ref().map_or_else(scene::Film::default, |scene| scene.film.clone());
    let view = scene.as_ref().map_or_else(|| scene::Views::default().default, |s| s.views.default.clone());
    let description = scene.as_ref().map_or_else(String::new, |scene| scene.description.clone());
    let expect = scene.as_ref().map_or_else(scene::Expect::default, |scene| scene.expect);
    if args.film.is_some() {
        run.needs_the_start("a film")?;
    }
    let samples = run.manifest.samples;
    let name = name(&args.run);
    let log = run.log()?;
    let begins = log.begins();
    if let Some(early) = args.capture.iter().find(|time| **time < begins - 1e-9) {
        let begins = times::shown(begins);
        let text = format!("{early} s is not in {}: it begins at {begins} s", log.path().display());
        return Err(Failure::Usage(text));
    }
    let fleet = log.fleet().clone();
    let mut duration = fleet.duration;
    if log.manifest().status != Status::Complete {
        duration = duration.min(samples.saturating_sub(1) as f64 * log.manifest().period);
        // A storyboard goes with the whole run.
        settings.shots.clear();
    }
    let source = || Ok(RecordSource::Log(Box::new(log.records())));
    let draw = DrawJob {
        picture: args.picture.options(),
        adapter: args.adapter.name.clone(),
        name,
        fleet,
        duration,
        settings,
        view,
    };
    if let Some(path) = &args.film {
        let job = FilmJob {
            draw,
            path: path.clone(),
            ffmpeg: args.ffmpeg,
            fps: args.fps,
            preset: args.preset,
            fresh: false,
            description,
            judging: expect.judging(duration),
            run: format!("{:?}", log.manifest()),
            captions: scene.as_ref().map_or_else(Vec::new, captions),
        };
        return film::shoot(job, args.quiet, args.json, |_| source());
    }
    let job = CaptureJob { draw, out: &args.out, at: &args.capture, of: &args.run };
    capture::draw(&job, args.quiet, args.json, |_| source())
}

/// The folder's name, or that of the file where it says more than that it is a log.
fn name(run: &std::path::Path) -> String {
    let whole = std::fs::canonicalize(run).unwrap_or_else(|_| run.to_owned());
    let folder = if run.ends_with(recording::log::FILE) { whole.parent().unwrap_or(&whole) } else { &whole };
    stem(folder)
}

/// Runs the scene again.
fn verify(args: &ReplayArgs, run: &Recorded) -> Outcome {
    let quiet = args.quiet || args.json;
    run.needs_the_start("a replay")?;
    let manifest = run.manifest.clone();
    let logged = run.logged(quiet)?;
    let recorded = match (&manifest.digest, &logged) {
        (Some(digest), _) => RunDigest { samples: manifest.samples, digest: digest.clone() },
        (None, Some(logged)) => logged.clone(),
        (None, None) => {
            return Err(Failure::Usage(format!(
                "{} has no digest and no log to compare with: the run is under way, or was cut off by the machine",
                args.run.display()
            )));
        }
    };
    let mut again = build(run.scene()?, &run.scene.0.display())?;
    cameras::attach(&mut again, None, &args.adapter.name, None)?;
    let sees = again.simulation.needs_cameras();
    let title = &again.scene.title;
    let progress = Progress::begin(&format!("Replaying {title}"), again.simulation.len(), quiet);
    let cut = matches!(manifest.status, Status::Interrupted | Status::Running);
    let most = if cut { recorded.samples } else { u64::MAX };
    let (now, apart) = run_again(&mut again, most, run.records(), |samples| {
        progress.at(samples);
        !interrupt::asked()
    })?;
    drop(progress);
    let replay = Replay { recorded, log: logged.map(|logged| logged.digest), now, apart };
    let report = ReplayReport { manifest, replay, sees };
    if args.json {
        report.as_json();
    } else if !args.quiet {
        report.as_text();
    } else if !report.replay.same() {
        note(&report.verdict());
    }
    if report.replay.same() { Ok(()) } else { Err(Failure::Expectation) }
}

impl ReplayReport {
    /// What made the run, if that is not this program.
    fn other_program(&self) -> Option<String> {
        let commit = |commit: Option<&str>| commit.map_or_else(String::new, |commit| format!(" ({commit})"));
        let recorded = format!("{}{}", self.manifest.program, commit(self.manifest.commit.as_deref()));
        let now = format!("{PROGRAM}{}", commit(studies::COMMIT));
        (recorded != now).then(|| format!("recorded by {recorded}; this is {now}"))
    }

    fn verdict(&self) -> String {
        let Replay { recorded, now, apart, .. } = &self.replay;
        if self.replay.same() {
            return "same: bit for bit".to_owned();
        }
        if now.samples != recorded.samples {
            return format!(
                "DIFFERENT: it had {} when it was recorded, and has {} now",
                counted(recorded.samples, "sample"),
                now.samples
            );
        }
        if now.digest == recorded.digest && !self.replay.log_agrees() {
            let when = apart.map_or_else(String::new, |time| format!(", from {time:.2} s on"));
            return format!("DIFFERENT: the run comes out the same, but its log holds another{when}");
        }
        let why = if self.other_program().is_some() {
            "another program need not come to the same bits"
        } else if self.sees {
            "what cameras see depends on adapter and processor too; or a file of the folder was edited"
        } else {
            "a file of the folder was edited; if none was, this machine computes differently, which is worth a report"
        };
        format!("DIFFERENT: {why}")
    }

    fn as_text(&self) {
        let Manifest { title, status, period, .. } = &self.manifest;
        let Replay { recorded, now, .. } = &self.replay;
        let samples = recorded.samples;
        let ended = match status {
            Status::Interrupted => ", interrupted",
            Status::Stopped => ", stopped where bodies touched",
            Status::Running => ", cut off or under way",
            Status::Complete => "",
        };
        let duration = samples.saturating_sub(1) as f64 * period;
        say(&format!("{title}\n{}, {duration:.2} s{ended}", counted(samples, "sample")));
        if let Some(other) = self.other_program() {
            say(&other);
        }
        say(&format!("recorded {}\nnow      {}\n{}", recorded.digest, now.digest, self.verdict()));
    }

    fn as_json(&self) {
        let Replay { recorded, log, now, .. } = &self.replay;
        json(&json!({
            "same": self.replay.same(),
            "title": self.manifest.title,
            "status": self.manifest.status,
            "recorded": {
                "digest": recorded.digest,
                "log_digest": log,
                "samples": recorded.samples,
                "program": self.manifest.program,
                "commit": self.manifest.commit,
            },
            "now": {
                "digest": now.digest,
                "samples": now.samples,
                "program": PROGRAM,
                "commit": studies::COMMIT,
            },
        }));
    }
}
