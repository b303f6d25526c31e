//! `echelon film`: a scene as a film, in simulation time whatever the machine's speed.

use crate::Outcome;
use crate::args::{FilmArgs, PictureArgs};
use crate::failure::Failure;
use crate::interrupt;
use crate::load::{load, stem};
use crate::picture::Studio;
use crate::playback::{Playback, Source};
use crate::print::{json, say};
use crate::progress::Progress;
use rendering::{Film, FilmKind, Gpu};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;
use vocabulary::Cast;

/// What a film is made of.
pub(crate) struct Job<'a> {
    pub(crate) picture: &'a PictureArgs,
    pub(crate) adapter: &'a str,
    /// The film file.
    pub(crate) path: PathBuf,
    pub(crate) ffmpeg: bool,
    /// Frames a second, where asked for.
    pub(crate) fps: Option<f64>,
    pub(crate) quiet: bool,
    pub(crate) json: bool,
    /// Of the scene or the recorded run.
    pub(crate) name: String,
    pub(crate) cast: Cast,
    /// s.
    pub(crate) duration: f64,
    pub(crate) settings: &'a scene::Film,
    /// In place of the film's own, which the scene may leave out.
    pub(crate) view: &'a str,
}

pub(crate) fn film(args: &FilmArgs) -> Outcome {
    let mut loaded = load(&args.scene)?;
    let name = stem(&args.scene.scene);
    let scene = loaded.scene.clone();
    let job = Job {
        picture: &args.picture,
        adapter: &args.scene.adapter,
        path: args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.mp4"))),
        ffmpeg: args.ffmpeg,
        fps: args.fps,
        quiet: args.scene.quiet,
        json: args.scene.json,
        name,
        cast: loaded.simulation.cast().clone(),
        duration: scene.time.duration,
        settings: &scene.film,
        view: &scene.views.default,
    };
    shoot(&job, |gpu| {
        loaded.open_eyes(Some(gpu), &args.scene)?;
        Ok(Source::Run(Box::new(loaded.simulation)))
    })
}

/// Makes the film of what `source` tells; it may use the adapter that draws.
pub(crate) fn shoot(job: &Job<'_>, source: impl FnOnce(&Gpu) -> Result<Source, Failure>) -> Outcome {
    let began = Instant::now();
    let Job { path, name, cast, settings, .. } = job;
    let kind = if job.ffmpeg { FilmKind::Ffmpeg } else { FilmKind::of(path) };
    // An animation stores every pixel that changes, and on moving ground all do.
    let (size, fps) = if kind == FilmKind::Gif { ([480, 270], 10) } else { (settings.size, settings.fps) };
    let rate = job.fps.unwrap_or(f64::from(fps));
    if !(1.0..=240.0).contains(&rate) {
        return Err(rendering::Error::FrameRate(rate).into());
    }
    let frames = ((job.duration * rate).round() as u64).max(1);
    let view = settings.view.as_deref().unwrap_or(job.view);
    let mut studio = Studio::open((job.adapter, job.picture), cast, view, size)?;
    let mut playback = Playback::new(cast, source(&studio.gpu)?);
    let mut film = Film::create(path, kind, studio.size[0], studio.size[1], rate)?;

    let what = format!("Filming {name}, {frames} frames, to {}", path.display());
    let progress = Progress::begin(&what, frames, job.quiet);
    let mut shot = 0;
    while shot < frames && !interrupt::asked() {
        let moment = playback.at(shot as f64 / rate);
        playback.check()?;
        let ready = studio.renderer.draw_next(playback.trail(), &moment, &studio.layout, &studio.style)?;
        ready.map_or(Ok(()), |picture| film.push(picture))?;
        shot += 1;
        progress.at(shot);
    }
    if let Some(picture) = studio.renderer.finish()? {
        film.push(picture)?;
    }
    if shot == 0 {
        return Err(Failure::Interrupted("no film was written".into()));
    }
    film.finish()?;
    progress.end();
    if shot < frames {
        let seconds = shot as f64 / rate;
        return Err(Failure::Interrupted(format!("{} holds the first {seconds:.2} s", path.display())));
    }
    let seconds = began.elapsed().as_secs_f64();
    let adapter = studio.gpu.description();
    if job.json {
        json(&json!({
            "file": path.display().to_string(), "frames": frames, "fps": rate, "size": studio.size,
            "adapter": adapter, "wall_seconds": seconds,
        }));
    } else if !job.quiet {
        let length = frames as f64 / rate;
        let [width, height] = studio.size;
        say(&format!(
            "{}: {length:.2} s, {frames} frames of {width}×{height} at {rate} a second",
            path.display()
        ));
        say(&format!("drawn in {seconds:.1} s with {adapter}"));
    }
    Ok(())
}
