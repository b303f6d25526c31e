//! `echelon film`: a scene as a film, in simulation time whatever the machine's speed.

use crate::Outcome;
use crate::args::FilmArgs;
use crate::failure::Failure;
use crate::interrupt;
use crate::load::{load, stem};
use crate::picture::Studio;
use crate::playback::Playback;
use crate::print::{json, say};
use crate::progress::Progress;
use rendering::{Film, FilmKind};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

pub(crate) fn film(args: &FilmArgs) -> Outcome {
    let began = Instant::now();
    let mut loaded = load(&args.scene)?;
    let settings = loaded.scene.film.clone();
    let name = stem(&args.scene.scene);
    let path = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.mp4")));
    let kind = if args.ffmpeg { FilmKind::Ffmpeg } else { FilmKind::of(&path) };
    // An animation stores every pixel that changes, and on moving ground all do.
    let (size, fps) = if kind == FilmKind::Gif { ([480, 270], 10) } else { (settings.size, settings.fps) };
    let rate = args.fps.unwrap_or(f64::from(fps));
    if !(1.0..=240.0).contains(&rate) {
        return Err(rendering::Error::FrameRate(rate).into());
    }
    let frames = ((loaded.scene.time.duration * rate).round() as u64).max(1);
    let view = settings.view.as_deref().unwrap_or(&loaded.scene.views.default);
    let cast = loaded.simulation.cast().clone();
    let mut studio = Studio::open((&args.scene, &args.picture), &cast, view, size)?;
    loaded.open_eyes(Some(&studio.gpu), &args.scene)?;
    let mut film = Film::create(&path, kind, studio.size[0], studio.size[1], rate)?;

    let what = format!("Filming {name}, {frames} frames, to {}", path.display());
    let progress = Progress::begin(&what, frames, args.scene.quiet);
    let mut playback = Playback::new(loaded.simulation);
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
    if args.scene.json {
        json(&json!({
            "file": path.display().to_string(), "frames": frames, "fps": rate, "size": studio.size,
            "adapter": adapter, "wall_seconds": seconds,
        }));
    } else if !args.scene.quiet {
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
