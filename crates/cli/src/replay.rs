//! `echelon replay`: does a recorded run come out the same again?

use crate::Outcome;
use crate::args::PictureArgs;
use crate::failure::Failure;
use crate::playback::Source;
use crate::print::{json, note, say};
use crate::progress::Progress;
use crate::recorded::Recorded;
use crate::run::{PROGRAM, STRIDE};
use crate::{capture, eyes, film, interrupt};
use clap::Args;
use metrics::Digest;
use recording::log::Log;
use recording::{Manifest, Status};
use scene::Scene;
use serde_json::json;
use simulation::Simulation;
use std::path::PathBuf;
use vocabulary::counted;

#[derive(Debug, Args)]
pub(crate) struct ReplayArgs {
    /// Folder of a run, such as runs/line-three-001, or a log.mcap alone
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// Make a film of what was recorded, without simulating
    #[arg(long, value_name = "FILE", conflicts_with = "capture")]
    film: Option<PathBuf>,
    /// Draw pictures of what was recorded at these times in s, such as 0,5,15, without simulating
    #[arg(long, value_name = "TIMES", value_delimiter = ',', allow_negative_numbers = true, value_parser = crate::args::time)]
    capture: Vec<f64>,
    /// Folder for the pictures; it may hold others
    #[arg(long, short, value_name = "DIR", default_value = ".", requires = "capture")]
    out: PathBuf,
    /// Frames a second of simulation time
    #[arg(long, requires = "film")]
    fps: Option<f64>,
    /// Encode with the ffmpeg on PATH instead of the built-in encoder
    #[arg(long, requires = "film")]
    ffmpeg: bool,
    /// Measures, cards and, where the scene has no storyboard, shots for a purpose
    #[arg(long, value_enum, requires = "film", conflicts_with = "view")]
    preset: Option<film::Preset>,
    #[command(flatten)]
    picture: PictureArgs,
    /// Adapter to draw with, pictures of cameras on robots included: vulkan, gl, or part of its name
    #[arg(long, default_value = "auto")]
    adapter: String,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// Print only what differs, and errors
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// A run as it was recorded and as it came out again.
struct Replay {
    manifest: Manifest,
    /// Of the run as it was recorded.
    recorded: String,
    /// Of the moments in its log, where there is one.
    log: Option<String>,
    /// Of the run as it is now.
    digest: String,
    samples: u64,
    /// When the moments of the log and those of the run first differ, in anything at all, s.
    apart: Option<f64>,
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
        let begins = crate::times::shown(begins);
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
    let source = || Ok(Source::Log(Box::new(log.records())));
    if let Some(path) = &args.film {
        let job = film::Job {
            picture: &args.picture,
            adapter: &args.adapter,
            path: path.clone(),
            ffmpeg: args.ffmpeg,
            fps: args.fps,
            preset: args.preset,
            fresh: false,
            quiet: args.quiet,
            json: args.json,
            name,
            fleet,
            description,
            duration,
            settings,
            view: &view,
            judging: expect.judging(duration),
            run: format!("{:?}", log.manifest()),
            captions: scene.as_ref().map_or_else(Vec::new, film::captions),
        };
        return film::shoot(job, |_| source());
    }
    let job = capture::Job {
        picture: &args.picture,
        adapter: &args.adapter,
        out: &args.out,
        at: &args.capture,
        quiet: args.quiet,
        json: args.json,
        of: &args.run,
        name,
        fleet,
        duration,
        settings: &settings,
        view: &view,
    };
    capture::draw(&job, |_| source())
}

/// The folder's name, or that of the file where it says more than that it is a log.
fn name(run: &std::path::Path) -> String {
    let whole = std::fs::canonicalize(run).unwrap_or_else(|_| run.to_owned());
    let folder = if run.ends_with(recording::log::FILE) { whole.parent().unwrap_or(&whole) } else { &whole };
    crate::load::stem(folder)
}

/// Runs the scene again.
fn verify(args: &ReplayArgs, run: &Recorded) -> Outcome {
    let quiet = args.quiet || args.json;
    run.needs_the_start("a replay")?;
    let mut manifest = run.manifest.clone();
    let logged = run.logged(quiet)?;
    let recorded = match (&manifest.digest, &logged) {
        (Some(digest), _) => digest.clone(),
        (None, Some((samples, digest))) => {
            manifest.samples = *samples;
            digest.clone()
        }
        (None, None) => {
            return Err(Failure::Usage(format!(
                "{} has no digest and no log to compare with: the run is under way, or was cut off by the machine",
                args.run.display()
            )));
        }
    };
    let scene: Scene = run.scene()?;
    let setup = simulation::build(&scene)
        .map_err(|error| Failure::Usage(format!("{}: {error}", run.scene.0.display())))?;
    let mut simulation = Simulation::new(setup);
    eyes::open(&mut simulation, None, &args.adapter, None)?;
    let progress = Progress::begin(&format!("Replaying {}", scene.title), simulation.len(), quiet);
    let cut = matches!(manifest.status, Status::Interrupted | Status::Running);
    let most = if cut { manifest.samples } else { u64::MAX };
    let (samples, digest, apart) = run_again(&mut simulation, most, run.records(), &progress)?;
    progress.end();
    let sees = simulation.needs_cameras();
    let log = logged.map(|(_, digest)| digest);
    let replay = Replay { manifest, recorded, log, digest, samples, apart, sees };
    if args.json {
        replay.as_json();
    } else if !args.quiet {
        replay.as_text();
    } else if !replay.same() {
        note(&replay.verdict());
    }
    if replay.same() { Ok(()) } else { Err(Failure::Expectation) }
}

/// Runs `most` samples at most; how many there were, their digest, and when they first differ from those of `log`, s.
fn run_again(
    simulation: &mut Simulation,
    most: u64,
    log: Option<&Log>,
    progress: &Progress,
) -> Result<(u64, String, Option<f64>), Failure> {
    let (mut digest, mut samples, mut apart) = (Digest::default(), 0, None);
    let mut logged = log.map(Log::records);
    while samples < most {
        let Some(record) = simulation.next_record() else { break };
        digest.push(record);
        // The digest is that of motions and commands; this is everything.
        if let (None, Some(logged)) = (apart, &mut logged)
            && let Some(then) = logged.next().transpose()?
            && then != *record
        {
            apart = Some(record.snapshot.time);
        }
        samples += 1;
        if samples % STRIDE == 0 {
            progress.at(samples);
            if interrupt::asked() {
                return Err(Failure::Interrupted(format!("after {}", counted(samples, "sample"))));
            }
        }
    }
    match simulation.fault() {
        Some(fault) => Err(fault.into()),
        None => Ok((samples, digest.text(), apart)),
    }
}

impl Replay {
    fn same(&self) -> bool {
        self.digest == self.recorded && self.samples == self.manifest.samples && self.log_agrees()
    }

    fn log_agrees(&self) -> bool {
        self.apart.is_none() && self.log.as_ref().is_none_or(|log| *log == self.recorded)
    }

    /// What made the run, if that is not this program.
    fn other_program(&self) -> Option<String> {
        let commit = |commit: Option<&str>| commit.map_or_else(String::new, |commit| format!(" ({commit})"));
        let recorded = format!("{}{}", self.manifest.program, commit(self.manifest.commit.as_deref()));
        let now = format!("{PROGRAM}{}", commit(option_env!("ECHELON_COMMIT")));
        (recorded != now).then(|| format!("recorded by {recorded}; this is {now}"))
    }

    fn verdict(&self) -> String {
        let Manifest { samples, .. } = self.manifest;
        if self.same() {
            return "same: bit for bit".to_owned();
        }
        if self.samples != samples {
            return format!(
                "DIFFERENT: it had {} when it was recorded, and has {} now",
                counted(samples, "sample"),
                self.samples
            );
        }
        if self.digest == self.recorded && !self.log_agrees() {
            let when = self.apart.map_or_else(String::new, |time| format!(", from {time:.2} s on"));
            return format!("DIFFERENT: the run comes out the same, but its log holds another{when}");
        }
        let why = if self.other_program().is_some() {
            "another program need not come to the same bits"
        } else if self.sees {
            "what cameras see depends on adapter and processor too; or a file of the folder was edited"
        } else {
            "a file of the folder was edited, or the processor calculates differently"
        };
        format!("DIFFERENT: {why}")
    }

    fn as_text(&self) {
        let Manifest { title, status, period, samples, .. } = &self.manifest;
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
        say(&format!("recorded {}\nnow      {}\n{}", self.recorded, self.digest, self.verdict()));
    }

    fn as_json(&self) {
        json(&json!({
            "same": self.same(),
            "title": self.manifest.title,
            "status": self.manifest.status,
            "recorded": {
                "digest": self.recorded,
                "log_digest": self.log,
                "samples": self.manifest.samples,
                "program": self.manifest.program,
                "commit": self.manifest.commit,
            },
            "now": {
                "digest": self.digest,
                "samples": self.samples,
                "program": PROGRAM,
                "commit": option_env!("ECHELON_COMMIT"),
            },
        }));
    }
}
