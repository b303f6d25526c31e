//! `echelon replay`: does a recorded run come out the same again?

use crate::Outcome;
use crate::args::ReplayArgs;
use crate::eyes;
use crate::failure::Failure;
use crate::interrupt;
use crate::load::load_file;
use crate::print::{json, note, say};
use crate::progress::Progress;
use crate::run::{PROGRAM, STRIDE};
use recording::{Digest, Manifest, Status};
use serde_json::json;
use simulation::Simulation;
use std::io::ErrorKind;
use std::path::Path;

/// A run as it was recorded and as it came out again.
struct Replay {
    manifest: Manifest,
    /// Of the run as it was recorded.
    recorded: String,
    /// Of the run as it is now.
    digest: String,
    samples: u64,
    /// Whether cameras on robots took pictures.
    sees: bool,
}

pub(crate) fn replay(args: &ReplayArgs) -> Outcome {
    let manifest = read_manifest(&args.run)?;
    let recorded = manifest.digest.clone().ok_or_else(|| {
        Failure::Usage(format!(
            "{} has no digest to compare with: the run is under way, or was cut off by the machine",
            args.run.display()
        ))
    })?;
    let (scene, setup) = load_file(&args.run.join("scene.toml"), &[])?;
    let mut simulation = Simulation::new(setup);
    eyes::open(&mut simulation, None, &args.adapter)?;
    let progress =
        Progress::begin(&format!("Replaying {}", scene.title), simulation.len(), args.quiet || args.json);
    let most = if manifest.status == Status::Interrupted { manifest.samples } else { u64::MAX };
    let (samples, digest) = run(&mut simulation, most, &progress)?;
    progress.end();
    let sees = simulation.needs_eyes();
    let replay = Replay { manifest, recorded, digest, samples, sees };
    if args.json {
        replay.as_json();
    } else if !args.quiet {
        replay.as_text();
    } else if !replay.same() {
        note(&replay.verdict());
    }
    if replay.same() { Ok(()) } else { Err(Failure::Expectation) }
}

/// The manifest of the run in `folder`.
fn read_manifest(folder: &Path) -> Result<Manifest, Failure> {
    let path = folder.join("manifest.json");
    let text = std::fs::read_to_string(&path).map_err(|error| match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => Failure::Usage(format!(
            "{} is no run folder: it has no manifest.json; `echelon run` leaves folders such as runs/line-three-001",
            folder.display()
        )),
        ErrorKind::InvalidData => Failure::Usage(format!("{} is no manifest: it is not text", path.display())),
        _ => Failure::Machine(format!("cannot read {}: {error}", path.display())),
    })?;
    serde_json::from_str(&text)
        .map_err(|error| Failure::Usage(format!("{} is no manifest of a run: {error}", path.display())))
}

/// Runs `most` samples at most; how many there were, and their digest.
fn run(simulation: &mut Simulation, most: u64, progress: &Progress) -> Result<(u64, String), Failure> {
    let (mut digest, mut samples) = (Digest::default(), 0);
    while samples < most {
        let Some(moment) = simulation.next_moment() else { break };
        digest.push(moment);
        samples += 1;
        if samples % STRIDE == 0 {
            progress.at(samples);
            if interrupt::asked() {
                return Err(Failure::Interrupted(format!("after {samples} samples")));
            }
        }
    }
    match simulation.fault() {
        Some(fault) => Err(Failure::Machine(fault.to_owned())),
        None => Ok((samples, digest.text())),
    }
}

impl Replay {
    fn same(&self) -> bool {
        self.digest == self.recorded && self.samples == self.manifest.samples
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
            return format!("DIFFERENT: {samples} samples were recorded, and it has {} now", self.samples);
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
            Status::Running | Status::Complete => "",
        };
        let duration = samples.saturating_sub(1) as f64 * period;
        say(&format!("{title}\n{samples} samples, {duration:.2} s{ended}"));
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
