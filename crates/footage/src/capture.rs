//! Pictures of a run at given times.

use crate::audience::Audience;
use crate::draw_job::DrawJob;
use crate::error::Error;
use crate::playback::Playback;
use crate::render_setup::RenderSetup;
use crate::times;
use film::png;
use output::Place;
use rendering::{Gpu, PictureSpec};
use std::path::{Path, PathBuf};
use studies::RecordSource;
use vocabulary::counted;

/// What pictures are made of.
pub struct CaptureJob<'a> {
    /// The run, and how its pictures look.
    pub draw: DrawJob,
    /// Folder for the pictures.
    pub out: &'a Path,
    /// Times asked for, s; the end of the run if none.
    pub at: &'a [f64],
    /// The scene file or the recorded run.
    pub of: &'a Path,
}

/// Pictures that were written.
#[derive(Debug, Clone)]
pub struct Captured {
    /// In the order of time.
    pub files: Vec<PathBuf>,
    /// Their times, s.
    pub times: Vec<f64>,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// What drew them.
    pub adapter: String,
}

/// Fewer pictures than this are there before their progress is read.
const FEW: usize = 4;

/// Draws pictures of the records of `source`, which may use the adapter that draws.
///
/// # Errors
/// [`Error`]; what was written before stays.
pub fn capture<E: From<Error>>(
    job: &CaptureJob<'_>,
    audience: &dyn Audience,
    source: impl FnOnce(&Gpu) -> Result<RecordSource, E>,
) -> Result<Captured, E> {
    let draw = &job.draw;
    let times = times::within(job.at, draw.duration)?;
    let _place = Place::folder(job.out).map_err(Error::from)?;
    if job.at.len() > times.len() {
        let (asked, drawn) = (counted(job.at.len(), "time"), counted(times.len(), "picture"));
        audience.about("at", &format!("names {asked} for {drawn}: those that are the same share one"));
    }
    let size = draw.settings.size;
    let studio = RenderSetup::open(&draw.adapter, &draw.picture, &draw.fleet, &draw.view, size, audience)?;
    let stops = || audience.stops();
    let playback = Playback::new(&draw.fleet, source(&studio.gpu)?, &stops);
    if times.len() >= FEW {
        let what = format!("Drawing {} of {}", counted(times.len(), "picture"), draw.name);
        audience.begin(&what, times.len() as u64);
    }
    let captured = pictures(job, &times, studio, playback, audience)?;
    audience.end();
    Ok(captured)
}

fn pictures(
    job: &CaptureJob<'_>,
    times: &[f64],
    mut studio: RenderSetup,
    mut playback: Playback<'_>,
    audience: &dyn Audience,
) -> Result<Captured, Error> {
    let adapter = studio.gpu.description();
    let mut captured = Captured { files: vec![], times: vec![], size: studio.size, adapter };
    let all = counted(times.len(), "picture");
    for (count, time) in times.iter().enumerate() {
        let record = playback.at(*time);
        if audience.stops() {
            return Err(Error::Interrupted(format!("{count} of {} pictures are written", times.len())));
        }
        playback.check()?;
        // A run that ended early has no later times: the picture is that of its end, once, and is called so.
        let (end, early) = (record.snapshot.time, record.snapshot.time < time - 1e-9);
        let time = if early { end } else { *time };
        if early {
            let end = times::shown(end);
            audience
                .note(&format!("the run ended at {end} s: a picture shows its end, later times have none"));
        }
        let spec = PictureSpec::new(playback.trail(), &record, &studio.layout, &studio.style);
        let picture = studio.renderer.draw(spec)?;
        let path = job.out.join(format!("{}-{}.png", job.draw.name, times::in_names(time)));
        let (at, of) = (time.to_string(), job.of.display().to_string());
        let metadata = [
            ("Software", studies::PROGRAM),
            ("Scene", &*of),
            ("Time", &*at),
            ("Adapter", &*captured.adapter),
        ];
        audience.writes(&path);
        png::write(&path, &picture, &metadata)
            .map_err(|error| Error::from(error).but(&format!("{count} of {all} were written before")))?;
        captured.files.push(path);
        captured.times.push(time);
        audience.at(count as u64 + 1);
        if early {
            break;
        }
    }
    Ok(captured)
}
