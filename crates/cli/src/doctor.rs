//! `echelon doctor`: what this machine can draw and encode with, and what is missing.

use crate::Outcome;
use crate::failure::Failure;
use crate::print::{json, say};
use clap::Args;
use rendering::{AdapterChoice, Gpu, adapters};
use serde_json::json;
use std::process::Command;
use studies::PROGRAM;

#[derive(Debug, Args)]
pub(crate) struct DoctorArgs {
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

const NO_ADAPTER: &str = "no graphics adapter: install a driver, or the software one with \
    `apt-get install mesa-vulkan-drivers` (Debian, Ubuntu), `dnf install mesa-vulkan-drivers` (Fedora)";

pub(crate) fn doctor(args: &DoctorArgs) -> Outcome {
    let found = adapters();
    let opened = Gpu::open(&AdapterChoice::Auto).map(|gpu| gpu.description());
    let ffmpeg = ffmpeg();
    if args.json {
        let adapter = |a: &rendering::AdapterInfo| json!({ "name": a.name, "backend": a.backend, "driver": a.driver, "software": a.software });
        json(&json!({
            "program": PROGRAM,
            "adapters": found.iter().map(adapter).collect::<Vec<_>>(),
            "opened": opened.as_ref().ok(),
            "encoders": { "h264": "built in", "gif": "built in", "png": "built in", "ffmpeg": ffmpeg },
        }));
    } else {
        say(&format!("{PROGRAM}\n\nadapters, in the order they are tried; --adapter takes the number"));
        for (place, a) in found.iter().enumerate() {
            let kind = if a.software { "software" } else { "hardware" };
            say(&format!("  {place}  {} ({}, {}) {kind}", a.name, a.backend, a.driver));
        }
        match &opened {
            Ok(name) => say(&format!("  drawing works with {name}")),
            Err(error) => say(&format!("  drawing does not work: {error}")),
        }
        say("\nencoders\n  .mp4 (H.264), .gif and PNG frames are built in");
        match &ffmpeg {
            Some(version) => say(&format!("  --ffmpeg: {version}")),
            None => say("  --ffmpeg: no ffmpeg on PATH; not needed, `apt-get install ffmpeg` adds it"),
        }
    }
    match (opened, found.is_empty()) {
        (Ok(_), _) => Ok(()),
        (Err(_), true) => Err(Failure::Machine(NO_ADAPTER.to_owned())),
        (Err(error), false) => Err(error.into()),
    }
}

/// First line of `ffmpeg -version`.
fn ffmpeg() -> Option<String> {
    let output = Command::new("ffmpeg").arg("-version").output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().next().map(str::to_owned)
}
