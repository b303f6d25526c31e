//! `echelon film`: a scene as a film, by its storyboard or a ready-made one, in simulation time whatever the machine's speed.

mod board;
mod plots;
mod preset;
mod words;

use crate::Outcome;
use crate::args::FilmArgs;
use crate::failure::Failure;
use crate::interrupt;
use crate::load::{load, stem};
use crate::picture::Studio;
use crate::playback::Playback;
use crate::print::{json, note, say};
use crate::progress::Progress;
use board::Board;
use plots::Plots;
pub(crate) use preset::Preset;
use recording::{Judging, MetricsBuilder};
use rendering::{Film, FilmKind, Show};
use scene::Scene;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

pub(crate) fn film(args: &FilmArgs) -> Outcome {
    let began = Instant::now();
    let mut loaded = load(&args.scene)?;
    let scene = loaded.scene.clone();
    let mut settings = scene.film.clone();
    let name = stem(&args.scene.scene);
    let path = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.mp4")));
    let kind = if args.ffmpeg { FilmKind::Ffmpeg } else { FilmKind::of(&path) };
    // An animation stores every pixel that changes, and on moving ground all do.
    if kind == FilmKind::Gif {
        (settings.size, settings.fps) = ([480, 270], 10);
    }
    if let Some(preset) = args.preset {
        preset.apply(&mut settings, &scene);
    }
    let rate = args.fps.unwrap_or(f64::from(settings.fps));
    if !(1.0..=240.0).contains(&rate) {
        return Err(rendering::Error::FrameRate(rate).into());
    }
    let view = settings.view.as_deref().unwrap_or(&scene.views.default);
    let cast = loaded.simulation.cast().clone();
    let names: Vec<String> = cast.members.iter().map(|m| m.name.clone()).collect();
    // Whoever names a view wants that one, from beginning to end.
    let whole = args.picture.view.as_deref();
    let board = Board::new(&settings, (whole, view), scene.time.duration, &names)?;
    let frames = board.frames(rate);
    let mut studio = Studio::open((&args.scene, &args.picture), &cast, view, settings.size)?;
    loaded.open_eyes(Some(&studio.gpu), &args.scene)?;
    let (mut film, done) = begin(&path, kind, &studio, rate, args, &scene)?;

    let what = format!("Filming {name}, {frames} frames, to {}", path.display());
    let progress = Progress::begin(&what, frames, args.scene.quiet);
    if done > 0 && !args.scene.quiet {
        note(&format!("going on after {:.2} s that are there from an interrupted film", done as f64 / rate));
    }
    let settled_after = scene.expect.settled_after.unwrap_or(0.0);
    let judging = Judging { settling_band: scene.expect.settling_band, settled_after };
    let mut playback = Playback::new(loaded.simulation).measured(MetricsBuilder::new(&cast, judging));
    let mut plots = Plots::new(&cast, scene.time.duration);
    let plain = studio.style.clone();
    let mut shot = 0;
    while shot < frames && !interrupt::asked() {
        let frame = board.at(shot, rate);
        let moment = playback.at(frame.time);
        playback.check()?;
        plots.record(&moment);
        if shot >= done {
            let mut style = plain.clone();
            for element in frame.without {
                style.set(element, false)?;
            }
            style.show = Show {
                card: words::card(&frame, &scene, &cast, playback.metrics()),
                line: words::line(&frame, &cast, &moment),
                plots: plots.shown(frame.plots),
            };
            let ready = studio.renderer.draw_next(playback.trail(), &moment, &frame.layout, &style)?;
            ready.map_or(Ok(()), |picture| film.push(picture))?;
        }
        shot += 1;
        progress.at(shot);
    }
    if let Some(picture) = studio.renderer.finish()? {
        film.push(picture)?;
    }
    if shot <= done && shot < frames {
        // Nothing new: what was kept stays.
        return Err(Failure::Interrupted("no film was written".into()));
    }
    if shot < frames {
        film.pause()?;
        progress.end();
        let seconds = shot as f64 / rate;
        let more = if kind == FilmKind::Mp4 { "; the same command goes on from there" } else { "" };
        return Err(Failure::Interrupted(format!("{} holds the first {seconds:.2} s{more}", path.display())));
    }
    film.finish()?;
    progress.end();
    let seconds = began.elapsed().as_secs_f64();
    let adapter = studio.gpu.description();
    if args.scene.json {
        json(&json!({
            "file": path.display().to_string(), "frames": frames, "fps": rate, "size": studio.size,
            "adapter": adapter, "wall_seconds": seconds, "frames_found": done,
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

/// A film to write, and how many frames of it are there.
fn begin(
    path: &Path,
    kind: FilmKind,
    studio: &Studio,
    rate: f64,
    args: &FilmArgs,
    scene: &Scene,
) -> Result<(Film, u64), Failure> {
    let [width, height] = studio.size;
    if kind != FilmKind::Mp4 {
        return Ok((Film::create(path, kind, width, height, rate)?, 0));
    }
    // The same film is made of the same scene, by the same program on the same adapter, with the same words.
    let mut whole = xxhash_rust::xxh3::Xxh3::new();
    let program = (crate::run::PROGRAM, option_env!("ECHELON_COMMIT"), studio.gpu.description());
    whole.update(format!("{program:?}{:?}{:?}{:?}", studio.layout, studio.style, args.picture).as_bytes());
    whole.update(format!("{:?}{}", args.preset, scene.to_toml()).as_bytes());
    let fresh = if args.fresh { "fresh " } else { "" };
    let made_of = format!("{:032x}", whole.digest128());
    if args.fresh {
        // A journal of another film is begun anew.
        drop(Film::resume(path, (width, height), rate, &format!("{fresh}{made_of}"))?);
    }
    Ok(Film::resume(path, (width, height), rate, &made_of)?)
}
