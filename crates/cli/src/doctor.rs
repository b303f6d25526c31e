//! `echelon doctor`: what this machine can draw and encode with, what is missing, and how fast it is.

mod bench;
mod table;

use crate::args::{AdapterArgs, within};
use crate::failure::Failure;
use crate::print::{json, say};
use crate::{Outcome, interrupt};
use clap::Args;
use rendering::{Gpu, adapters};
use serde_json::{Value, json};
use std::process::Command;
use std::time::Instant;
use studies::PROGRAM;
use studies::pace::{LEAST, PaceBench};

#[derive(Debug, Args)]
pub(crate) struct DoctorArgs {
    /// Measure how fast this machine draws, films, sees and simulates, and print what to expect of it: 16 lines, about
    /// half a minute unless --budget is longer
    #[arg(long)]
    bench: bool,
    /// Seconds for each line of --bench; each is measured at least three times, however long that takes
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0, requires = "bench", allow_negative_numbers = true,
        value_parser = within(0.0..=60.0, "write a number from 0 to 60"))]
    budget: f64,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

const NO_ADAPTER: &str = "no graphics adapter: install a driver, or the software one with \
    `apt-get install mesa-vulkan-drivers` (Debian, Ubuntu), `dnf install mesa-vulkan-drivers` (Fedora)";

pub(crate) fn doctor(args: &DoctorArgs) -> Outcome {
    let found = adapters();
    let opened = args.adapter.open();
    let ffmpeg = ffmpeg();
    let description = opened.as_ref().map(Gpu::description);
    let adapter = |a: &rendering::AdapterInfo| json!({ "name": a.name, "backend": a.backend, "driver": a.driver, "software": a.software });
    let mut report = json!({
        "program": PROGRAM,
        "adapters": found.iter().map(adapter).collect::<Vec<_>>(),
        "opened": description.as_ref().ok(),
        "encoders": { "h264": "built in", "gif": "built in", "png": "built in", "ffmpeg": ffmpeg },
    });
    if !args.json {
        say(&format!("{PROGRAM}\n\nadapters, in the order they are tried; --adapter takes the number"));
        for (place, a) in found.iter().enumerate() {
            let kind = if a.software { "software" } else { "hardware" };
            say(&format!("  {place}  {} ({}, {}) {kind}", a.name, a.backend, a.driver));
        }
        match &description {
            Ok(name) => say(&format!("  drawing works with {name}")),
            Err(error) => say(&format!("  drawing does not work: {error}")),
        }
        say("\nencoders\n  .mp4 (H.264), .gif and PNG frames are built in");
        match &ffmpeg {
            Some(version) => say(&format!("  --ffmpeg: {version}")),
            None => say("  --ffmpeg: no ffmpeg on PATH; not needed, `apt-get install ffmpeg` adds it"),
        }
    }
    let outcome = match (opened, found.is_empty()) {
        (Ok(gpu), _) if args.bench => measure(args, &gpu, &mut report),
        (Ok(_), _) => Ok(()),
        (Err(_), true) => Err(Failure::Machine(NO_ADAPTER.to_owned())),
        (Err(error), false) => Err(error.into()),
    };
    if args.json {
        json(&report);
    }
    outcome
}

/// Measures, prints each line as it comes, and adds it to `report`.
fn measure(args: &DoctorArgs, gpu: &Gpu, report: &mut Value) -> Outcome {
    let began = Instant::now();
    interrupt::watch();
    let clock = || began.elapsed().as_secs_f64();
    let bench = PaceBench { clock: &clock, budget: args.budget, go_on: &|| !interrupt::asked() };
    if !args.json {
        let each = format!("medians of {LEAST} repetitions or more, {} s for each line", args.budget);
        say(&format!("\nspeed of {}\n{each}\n\n{}", gpu.description(), table::head()));
    }
    report["bench"] = json!([]);
    let measured = bench::measure(gpu, &bench, |row| {
        if !args.json {
            say(&row.text());
        }
        if let Some(rows) = report["bench"].as_array_mut() {
            rows.push(row.as_json());
        }
    });
    if !args.json {
        let ended = if measured.is_ok() { "measured in" } else { "not finished: ended after" };
        say(&format!("\n{}\n{}\n{ended} {:.0} s", table::legend(), bench::window(), clock()));
    }
    measured
}

/// First line of `ffmpeg -version`.
fn ffmpeg() -> Option<String> {
    let output = Command::new("ffmpeg").arg("-version").output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().next().map(str::to_owned)
}
