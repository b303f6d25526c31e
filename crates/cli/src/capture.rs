//! `echelon capture`: pictures of a scene at given times.

use crate::Outcome;
use crate::args::{CaptureArgs, PictureArgs};
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::picture::Studio;
use crate::playback::{Playback, Source};
use crate::print::{json, say};
use crate::progress::Progress;
use crate::{interrupt, run};
use rendering::{Gpu, png};
use serde_json::json;
use std::path::Path;
use vocabulary::Cast;

/// What pictures are made of.
pub(crate) struct Job<'a> {
    pub(crate) picture: &'a PictureArgs,
    pub(crate) adapter: &'a str,
    /// Folder for the pictures.
    pub(crate) out: &'a Path,
    /// Times asked for, s.
    pub(crate) at: &'a [f64],
    pub(crate) quiet: bool,
    pub(crate) json: bool,
    /// The scene file or the recorded run.
    pub(crate) of: &'a Path,
    /// What files are called by.
    pub(crate) name: String,
    pub(crate) cast: Cast,
    /// s.
    pub(crate) duration: f64,
    pub(crate) settings: &'a scene::Film,
    pub(crate) view: &'a str,
}

pub(crate) fn capture(args: &CaptureArgs) -> Outcome {
    let mut loaded = load(&args.scene)?;
    let scene = loaded.scene.clone();
    let job = Job {
        picture: &args.picture,
        adapter: &args.scene.adapter,
        out: &args.out,
        at: &args.at,
        quiet: args.scene.quiet,
        json: args.scene.json,
        of: &args.scene.scene,
        name: stem(&args.scene.scene),
        cast: loaded.simulation.cast().clone(),
        duration: scene.time.duration,
        settings: &scene.film,
        view: &scene.views.default,
    };
    draw(&job, |gpu| {
        loaded.open_eyes(Some(gpu), &args.scene)?;
        Ok(Source::Run(Box::new(loaded.simulation)))
    })
}

/// Draws pictures of what `source` tells; it may use the adapter that draws.
pub(crate) fn draw(job: &Job<'_>, source: impl FnOnce(&Gpu) -> Result<Source, Failure>) -> Outcome {
    let times = times(job.at, job.duration)?;
    let Job { cast, name, .. } = job;
    let mut studio = Studio::open((job.adapter, job.picture), cast, job.view, job.settings.size)?;
    let source = source(&studio.gpu)?;
    std::fs::create_dir_all(job.out)
        .map_err(|e| Failure::Machine(format!("cannot create {}: {e}", job.out.display())))?;
    let adapter = studio.gpu.description();
    let mut playback = Playback::new(cast, source);
    let what = format!("Drawing {} pictures of {name}", times.len());
    let progress = Progress::begin(&what, times.len() as u64, job.quiet || times.len() < 4);
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
        let path = job.out.join(format!("{name}-{time:0width$.decimals$}.png"));
        let time_text = time.to_string();
        let scene_text = job.of.display().to_string();
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
    if job.json {
        json(&json!({ "files": files, "times": times, "size": studio.size, "adapter": adapter }));
    } else if !job.quiet {
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
            "{bad} s is no time of the run: times are from 0 to {duration} s"
        )));
    }
    let mut times = if asked.is_empty() { vec![duration] } else { asked.to_vec() };
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}
