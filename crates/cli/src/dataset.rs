//! `echelon dataset`: what the cameras of a scene see, with the truth about every tag and what the detector makes of it.

use crate::args::{SceneArgs, within};
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::progress::Progress;
use crate::{Outcome, cameras, interrupt, print};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;
use studies::dataset::{DatasetExport, DatasetOptions, DatasetStatus, followed_edges};
use vocabulary::{Word, counted};

#[derive(Debug, Args)]
pub(crate) struct DatasetArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder for the images, dataset.json and coco.json
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Interval between two images of a camera, s
    #[arg(long, value_name = "SECONDS", default_value = "0.2", value_parser = within(0.001..=1e5, "write seconds from 0.001 to 100000"))]
    every: f64,
    /// Followers whose cameras take images; by default all
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    edges: Vec<String>,
    /// Search for the leader in the whole image, instead of the region around it
    #[arg(long)]
    whole: bool,
    /// Replace an earlier data set in the folder
    #[arg(long)]
    force: bool,
}

pub(crate) fn dataset(args: &DatasetArgs) -> Outcome {
    let began = Instant::now();
    let mut run = load(&args.scene)?;
    let edges = followed_edges(run.simulation.fleet(), &args.edges)?;
    let gpu = args.scene.adapter.open()?;
    cameras::attach(&mut run, Some(&gpu), &args.scene.adapter.name, None)?;
    let (cameras, adapter) = (edges.len(), gpu.description());
    let options = DatasetOptions {
        out: args.out.clone(),
        force: args.force,
        every: args.every,
        edges,
        whole: args.whole,
        adapter: adapter.clone(),
    };
    let frames = options.frames(run.scene.time.duration);
    let mut export = DatasetExport::create(run, &mut cameras::factory(Some(&gpu)), options)?;
    let what = format!(
        "Exporting {}, {}, to {}",
        stem(&args.scene.scene),
        counted(frames.saturating_mul(cameras as u64), "picture"),
        args.out.display()
    );
    let progress = Progress::begin(&what, frames, args.scene.quiet || args.scene.json);
    let status = export.take_all(|frame| progress.at(frame), &|| !interrupt::asked()).map_err(|error| {
        let count = counted(export.pictures(), "picture");
        let kept = format!("{} keeps the first {count}; --force begins anew", args.out.display());
        Failure::from(error).but(&kept)
    })?;
    drop(progress);
    if status == DatasetStatus::Interrupted {
        let count = counted(export.pictures(), "picture");
        let text = format!("{} holds the first {count}", args.out.display());
        return Err(Failure::Interrupted(text));
    }
    let seconds = began.elapsed().as_secs_f64();
    let summary = export.summary();
    if args.scene.json {
        print::json(&json!({
            "folder": args.out.display().to_string(), "status": status.word(), "adapter": adapter,
            "wall_seconds": seconds, "summary": summary,
        }));
    } else if !args.scene.quiet {
        print::say(&format!(
            "{}: {} of {}, {} in view, {} readable, {} detected",
            args.out.display(),
            counted(&summary["pictures"], "picture"),
            counted(cameras, "camera"),
            counted(&summary["tags"], "tag"),
            summary["readable"],
            summary["detected"]
        ));
        print::say(&format!("drawn in {seconds:.1} s with {adapter}"));
    }
    Ok(())
}
