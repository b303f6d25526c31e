//! `echelon capture`: pictures of a scene at given times.

use crate::Outcome;
use crate::args::CaptureArgs;
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::picture::Studio;
use crate::playback::Playback;
use crate::print::{json, say};
use crate::progress::Progress;
use crate::{interrupt, run};
use rendering::png;
use serde_json::json;

pub(crate) fn capture(args: &CaptureArgs) -> Outcome {
    let mut loaded = load(&args.scene)?;
    let times = times(&args.at, loaded.scene.time.duration)?;
    let cast = loaded.simulation.cast().clone();
    let mut studio = Studio::open(
        (&args.scene, &args.picture),
        &cast,
        &loaded.scene.views.default,
        loaded.scene.film.size,
    )?;
    loaded.open_eyes(Some(&studio.gpu), &args.scene)?;
    std::fs::create_dir_all(&args.out)
        .map_err(|e| Failure::Machine(format!("cannot create {}: {e}", args.out.display())))?;
    let stem = stem(&args.scene.scene);
    let adapter = studio.gpu.description();
    let mut playback = Playback::new(loaded.simulation);
    let what = format!("Drawing {} pictures of {stem}", times.len());
    let progress = Progress::begin(&what, times.len() as u64, args.scene.quiet || times.len() < 4);
    let decimals = decimals(&times);
    let width = decimals + 4;
    let mut files = Vec::new();
    for (count, time) in times.iter().enumerate() {
        let moment = playback.at(*time);
        if interrupt::asked() {
            return Err(Failure::Interrupted(format!("{count} of {} pictures are written", times.len())));
        }
        playback.check()?;
        let picture = studio.renderer.draw(playback.trail(), &moment, &studio.layout, &studio.style)?;
        let path = args.out.join(format!("{stem}-{time:0width$.decimals$}.png"));
        let time_text = time.to_string();
        let scene_text = args.scene.scene.display().to_string();
        let metadata = [
            ("Software", run::PROGRAM),
            ("Scene", &*scene_text),
            ("Time", &*time_text),
            ("Adapter", &*adapter),
        ];
        png::write(&path, &picture, &metadata)?;
        files.push(path.display().to_string());
        progress.at(count as u64 + 1);
    }
    progress.end();
    if args.scene.json {
        json(&json!({ "files": files, "times": times, "size": studio.size, "adapter": adapter }));
    } else if !args.scene.quiet {
        for file in &files {
            say(file);
        }
    }
    Ok(())
}

/// Digits after the point that file names need: milliseconds, or as many as tell all times apart.
fn decimals(times: &[f64]) -> usize {
    let apart = |digits: usize| {
        times.windows(2).all(|t| format!("{:.digits$}", t[0]) != format!("{:.digits$}", t[1]))
    };
    (3..17).find(|digits| apart(*digits)).unwrap_or(17)
}

/// The times asked for, checked and in order, each once; the end of the run if none.
fn times(asked: &[f64], duration: f64) -> Result<Vec<f64>, Failure> {
    if let Some(bad) = asked.iter().find(|t| !(0.0..=duration).contains(*t)) {
        return Err(Failure::Usage(format!(
            "--at {bad}: times are from 0 to {duration} s, the length of the run"
        )));
    }
    let mut times = if asked.is_empty() { vec![duration] } else { asked.to_vec() };
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}
