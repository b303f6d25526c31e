//! `echelon capture`: pictures of a scene at given times.

use crate::args::{PictureArgs, SceneArgs, time};
use crate::failure::Failure;
use crate::load::load;
use crate::picture::{DrawJob, RenderSetup};
use crate::playback::Playback;
use crate::print::{json, note, say};
use crate::progress::Progress;
use crate::replaced::Replaced;
use crate::{Outcome, cameras, interrupt, link, times};
use clap::Args;
use film::png;
use output::Place;
use rendering::{Gpu, PictureSpec};
use serde_json::json;
use std::path::{Path, PathBuf};
use studies::RecordSource;
use vocabulary::counted;

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

/// What pictures are made of.
pub(crate) struct CaptureJob<'a> {
    pub(crate) draw: DrawJob<'a>,
    /// Folder for the pictures.
    pub(crate) out: &'a Path,
    /// Times asked for, s.
    pub(crate) at: &'a [f64],
    /// The scene file or the recorded run.
    pub(crate) of: &'a Path,
}

pub(crate) fn capture(args: &CaptureArgs) -> Outcome {
    let mut loaded = load(&args.scene)?;
    let linked = link::meant(&args.scene.scene)?.and_then(|link| link.time);
    let at = if args.at.is_empty() { linked.into_iter().collect() } else { args.at.clone() };
    let draw = DrawJob::of(&args.scene, &args.picture, &loaded);
    let job = CaptureJob { draw, out: &args.out, at: &at, of: &args.scene.scene };
    self::draw(&job, |gpu| {
        cameras::attach(&mut loaded, Some(gpu), &args.scene.adapter.name, None)?;
        Ok(RecordSource::Run(Box::new(loaded.simulation)))
    })
}

/// Draws pictures of the records of `source`, which may use the adapter that draws.
pub(crate) fn draw(
    job: &CaptureJob<'_>,
    source: impl FnOnce(&Gpu) -> Result<RecordSource, Failure>,
) -> Outcome {
    let times = times::within(job.at, job.draw.duration)?;
    let _place = Place::folder(job.out)?;
    if job.at.len() > times.len() && !job.draw.quiet {
        let (asked, drawn) = (counted(job.at.len(), "time"), counted(times.len(), "picture"));
        note(&format!("--at names {asked} for {drawn}: those that are the same share one"));
    }
    let DrawJob { fleet, name, .. } = &job.draw;
    let mut studio =
        RenderSetup::open(job.draw.adapter, job.draw.picture, fleet, &job.draw.view, job.draw.settings.size)?;
    let source = source(&studio.gpu)?;
    let adapter = studio.gpu.description();
    let mut playback = Playback::new(fleet, source);
    let what = format!("Drawing {} of {name}", counted(times.len(), "picture"));
    let progress = Progress::begin(&what, times.len() as u64, job.draw.quiet || times.len() < 4);
    let (mut files, mut shown, mut replaced) = (Vec::new(), Vec::new(), Replaced::default());
    for (count, time) in times.iter().enumerate() {
        let record = playback.at(*time);
        if interrupt::asked() {
            return Err(Failure::Interrupted(format!("{count} of {} pictures are written", times.len())));
        }
        playback.check()?;
        // A run that ended early has no later times: the picture is that of its end, once, and is called so.
        let (end, early) = (record.snapshot.time, record.snapshot.time < time - 1e-9);
        let time = if early { end } else { *time };
        if early {
            let end = times::shown(end);
            note(&format!("the run ended at {end} s: a picture shows its end, later times have none"));
        }
        let spec = PictureSpec::new(playback.trail(), &record, &studio.layout, &studio.style);
        let picture = studio.renderer.draw(spec)?;
        let path = job.out.join(format!("{name}-{}.png", times::in_names(time)));
        let time_text = time.to_string();
        let scene_text = job.of.display().to_string();
        let metadata = [
            ("Software", studies::PROGRAM),
            ("Scene", &*scene_text),
            ("Time", &*time_text),
            ("Adapter", &*adapter),
        ];
        replaced.look(&path);
        png::write(&path, &picture, &metadata).map_err(|error| {
            let all = counted(times.len(), "picture");
            Failure::from(error).but(&format!("{count} of {all} were written before"))
        })?;
        files.push(path.display().to_string());
        shown.push(time);
        progress.at(count as u64 + 1);
        if early {
            break;
        }
    }
    drop(progress);
    replaced.tell(job.draw.quiet);
    if job.draw.json {
        json(&json!({ "files": files, "times": shown, "size": studio.size, "adapter": adapter }));
    } else if !job.draw.quiet {
        for file in &files {
            say(file);
        }
    }
    Ok(())
}
