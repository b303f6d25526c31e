//! `echelon capture`: pictures of a scene at given times.

use crate::args::{PictureArgs, SceneArgs, time};
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::print::{json, say};
use crate::terminal::Terminal;
use crate::{Outcome, cameras, link};
use clap::Args;
use footage::{CaptureJob, Captured, DrawJob};
use rendering::Gpu;
use serde_json::json;
use std::path::PathBuf;
use studies::RecordSource;

#[derive(Debug, Args)]
pub(crate) struct CaptureArgs {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    picture: PictureArgs,
    /// Times in s, such as 0,5,15; by default the end of the run, or the time of a link
    #[arg(long, value_name = "TIMES", value_delimiter = ',', allow_negative_numbers = true, value_parser = time)]
    at: Vec<f64>,
    /// Folder for the pictures; it may hold others
    #[arg(long, short, value_name = "DIR", default_value = ".")]
    out: PathBuf,
}

pub(crate) fn capture(args: &CaptureArgs) -> Outcome {
    let SceneArgs { scene, adapter, quiet, json, .. } = &args.scene;
    let mut loaded = load(&args.scene)?;
    let linked = link::meant(scene)?.and_then(|link| link.time);
    let at = if args.at.is_empty() { linked.into_iter().collect() } else { args.at.clone() };
    let draw =
        DrawJob { name: stem(scene), ..DrawJob::of(scene, &loaded, &adapter.name, args.picture.options()) };
    let job = CaptureJob { draw, out: &args.out, at: &at, of: scene };
    self::draw(&job, *quiet, *json, |gpu| {
        cameras::attach(&mut loaded, Some(gpu), &adapter.name, None)?;
        Ok(RecordSource::Run(Box::new(loaded.simulation)))
    })
}

/// Draws pictures of the records of `source`, which may use the adapter that draws, and prints where they are.
pub(crate) fn draw(
    job: &CaptureJob<'_>,
    quiet: bool,
    as_json: bool,
    source: impl FnOnce(&Gpu) -> Result<RecordSource, Failure>,
) -> Outcome {
    let terminal = Terminal::new(quiet);
    let Captured { files, times, size, adapter } = footage::capture(job, &terminal, source)?;
    terminal.tell_replaced();
    let files: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    if as_json {
        json(&json!({ "files": files, "times": times, "size": size, "adapter": adapter }));
    } else if !quiet {
        for file in &files {
            say(file);
        }
    }
    Ok(())
}
