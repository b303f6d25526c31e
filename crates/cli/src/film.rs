//! `echelon film`: a scene as a film.

use crate::args::{PictureArgs, SceneArgs};
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::print::{json, say};
use crate::terminal::Terminal;
use crate::{Outcome, cameras};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use footage::{DrawJob, FilmJob, Filmed, Preset};
use rendering::Gpu;
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;
use studies::RecordSource;
use vocabulary::{Word, counted};

#[derive(Debug, Args)]
pub(crate) struct FilmArgs {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    picture: PictureArgs,
    /// Frames per second of simulation time
    #[arg(long)]
    fps: Option<f64>,
    /// Film file: .mp4, .m4v or .gif (480x270 at 10 frames per second unless the scene sets them); without an extension, a
    /// folder of PNG frames; .webm, .mkv, .mov, .avi, .mpg, .mpeg, .ogv, .ts, .flv and .wmv need ffmpeg. By default
    /// NAME.mp4
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Encode with the ffmpeg on PATH instead of the built-in encoder
    #[arg(long)]
    ffmpeg: bool,
    /// Measures, cards and, where the scene has no storyboard, shots for a purpose
    #[arg(long, value_parser = presets(), conflicts_with = "view")]
    preset: Option<Preset>,
    /// Start over instead of resuming the same film where it was interrupted
    #[arg(long)]
    fresh: bool,
}

/// Takes the word of a preset.
pub(crate) fn presets() -> impl TypedValueParser<Value = Preset> {
    let words = Preset::WORDS.iter().map(|(word, _, about)| PossibleValue::new(*word).help(about.trim()));
    PossibleValuesParser::new(words).map(|word| {
        let known = Preset::WORDS.iter().find(|(other, ..)| *other == word);
        known.map_or(Preset::WORDS[0].1, |(_, preset, _)| *preset)
    })
}

pub(crate) fn film(args: &FilmArgs) -> Outcome {
    let SceneArgs { scene, adapter, quiet, json, .. } = &args.scene;
    let mut loaded = load(&args.scene)?;
    let draw =
        DrawJob { name: stem(scene), ..DrawJob::of(scene, &loaded, &adapter.name, args.picture.options()) };
    let path = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.mp4", draw.name)));
    let job = FilmJob {
        ffmpeg: args.ffmpeg,
        fps: args.fps,
        preset: args.preset,
        fresh: args.fresh,
        ..FilmJob::of(&loaded, draw, &path)
    };
    shoot(job, *quiet, *json, |gpu| {
        cameras::attach(&mut loaded, Some(gpu), &adapter.name, None)?;
        Ok(RecordSource::Run(Box::new(loaded.simulation)))
    })
}

/// Makes the film of the records of `source`, which may use the adapter that draws, and prints what it is.
pub(crate) fn shoot(
    job: FilmJob,
    quiet: bool,
    as_json: bool,
    source: impl FnOnce(&Gpu) -> Result<RecordSource, Failure>,
) -> Outcome {
    let began = Instant::now();
    let (terminal, path) = (Terminal::new(quiet), job.path.clone());
    let shot = footage::shoot(job, &terminal, source);
    if !matches!(&shot, Err(Failure::Usage(_) | Failure::Machine(_) | Failure::Broken(_))) {
        terminal.tell_replaced();
    }
    let Filmed { frames, found, fps, size, adapter } = shot?;
    let seconds = began.elapsed().as_secs_f64();
    if as_json {
        json(&json!({
            "file": path.display().to_string(), "frames": frames, "fps": fps, "size": size,
            "adapter": adapter, "wall_seconds": seconds, "frames_found": found,
        }));
    } else if !quiet {
        let (length, [width, height]) = (frames as f64 / fps, size);
        say(&format!(
            "{}: {length:.2} s, {} of {width}×{height} at {fps} a second",
            path.display(),
            counted(frames, "frame")
        ));
        say(&format!("drawn in {seconds:.1} s with {adapter}"));
    }
    Ok(())
}
