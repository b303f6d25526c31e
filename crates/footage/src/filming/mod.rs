//! A run as a film, by its storyboard or a ready-made one, in simulation time whatever the machine's speed.

mod board;
mod plots;
mod preset;
mod words;

use crate::audience::Audience;
use crate::draw_job::DrawJob;
use crate::error::Error;
use crate::playback::Playback;
use crate::render_setup::RenderSetup;
use board::Board;
use film::{Film, FilmKind};
use metrics::MetricsBuilder;
use output::Place;
use plots::Plots;
pub use preset::Preset;
use rendering::{Gpu, Overlays, PictureSpec, ReservedSpace};
use std::path::{Path, PathBuf};
use studies::{RecordSource, SceneRun};
use vocabulary::{Judging, counted};

/// What a film is made of.
#[derive(Debug, Clone)]
pub struct FilmJob {
    /// The run, and how its pictures look.
    pub draw: DrawJob,
    /// The film file.
    pub path: PathBuf,
    /// Whether the ffmpeg on the path encodes it.
    pub ffmpeg: bool,
    /// Frames a second, where asked for.
    pub fps: Option<f64>,
    /// What it is for.
    pub preset: Option<Preset>,
    /// Begin anew where the same film was interrupted.
    pub fresh: bool,
    /// What the scene is about.
    pub description: String,
    /// What the metrics on the end card are judged by.
    pub judging: Judging,
    /// What is the same only for the same run.
    pub run: String,
    /// Law and gains in one line, and from when on, s; in the order of time.
    pub captions: Vec<(f64, String)>,
}

impl FilmJob {
    /// That of a scene, to be written to `path`.
    pub fn of(run: &SceneRun, draw: DrawJob, path: &Path) -> Self {
        let scene = &run.scene;
        Self {
            draw,
            path: path.to_owned(),
            ffmpeg: false,
            fps: None,
            preset: None,
            fresh: false,
            description: scene.description.clone(),
            judging: scene.judging(),
            run: scene.to_toml(),
            captions: captions(scene),
        }
    }
}

/// A film that was written.
#[derive(Debug, Clone)]
pub struct Filmed {
    /// Frames, those of an interrupted film that were there included.
    pub frames: u64,
    /// Frames of an interrupted film that were there.
    pub found: u64,
    /// Frames a second.
    pub fps: f64,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// What drew it.
    pub adapter: String,
}

/// What the laws of a scene become as its run goes.
pub fn captions(scene: &scene::Scene) -> Vec<(f64, String)> {
    scene.changes.iter().map(|change| (change.at, studies::caption(&change.then))).collect()
}

/// Makes the film of the records of `source`, which may use the adapter that draws.
///
/// # Errors
/// [`Error`], with what is kept of the film.
pub fn shoot<E: From<Error>>(
    mut job: FilmJob,
    audience: &dyn Audience,
    source: impl FnOnce(&Gpu) -> Result<RecordSource, E>,
) -> Result<Filmed, E> {
    let kind = FilmKind::of(&job.path, job.ffmpeg).map_err(Error::from)?;
    if kind == FilmKind::Gif {
        lighten(&mut job.draw.settings);
    }
    if let Some(preset) = job.preset {
        preset.apply(&mut job.draw.settings, job.draw.duration);
    }
    let _place = match kind {
        FilmKind::PngSequence => Place::new_folder(&job.path),
        _ => Place::file(&job.path),
    }
    .map_err(Error::from)?;
    let DrawJob { fleet, settings, .. } = &job.draw;
    let rate = job.fps.unwrap_or(settings.fps);
    if !(1.0..=240.0).contains(&rate) {
        return Err(Error::from(film::Error::FrameRate(rate)).into());
    }
    let view = settings.view.as_deref().unwrap_or(&job.draw.view);
    let names: Vec<String> = fleet.robots.iter().map(|m| m.name.clone()).collect();
    // A view that is asked for holds from beginning to end.
    let board = Board::new(settings, job.draw.picture.view.as_deref(), view, job.draw.duration, &names)?;
    let size = settings.size;
    let studio = RenderSetup::open(&job.draw.adapter, &job.draw.picture, fleet, view, size, audience)?;
    let told = settings.shots.iter().map(|shot| shot.line.as_str()).chain([job.description.as_str()]);
    studio.check_texts(told, audience);
    let source = source(&studio.gpu)?;
    Ok(FilmShoot { job: &job, kind, rate, board, audience }.shoot(studio, source)?)
}

/// A film under way.
struct FilmShoot<'a> {
    job: &'a FilmJob,
    kind: FilmKind,
    rate: f64,
    board: Board,
    audience: &'a dyn Audience,
}

impl FilmShoot<'_> {
    fn shoot(&self, mut studio: RenderSetup, source: RecordSource) -> Result<Filmed, Error> {
        let Self { job, kind, rate, board, audience } = self;
        let (rate, path) = (*rate, &job.path);
        let DrawJob { name, fleet, .. } = &job.draw;
        let frames = board.frames(rate);
        let (mut film, done) = begin(job, *kind, &studio, rate)?;
        // What an interrupted film left is its own beginning.
        if done == 0 {
            audience.writes(path);
        }
        let what = format!("Filming {name}, {}, to {}", counted(frames, "frame"), path.display());
        audience.begin(&what, frames);
        if done > 0 {
            let there = done as f64 / rate;
            audience.remark(&format!("going on after {there:.2} s that are there from an interrupted film"));
        }
        let stops = || audience.stops();
        let mut playback =
            Playback::new(fleet, source, &stops).measured(MetricsBuilder::new(fleet, job.judging));
        let mut plots = Plots::new(fleet, job.draw.duration);
        let plain = studio.style.clone();
        // Where a line or a panel comes and goes, no camera moves.
        let room = ReservedSpace { panel: plain.inset, rows: board.rows(fleet.edges.len()) };
        // A run that ends before its time has fewer frames than its storyboard.
        let (mut index, mut shot, mut shown) = (0, 0, f64::NEG_INFINITY);
        while index < frames && !audience.stops() {
            let frame = board.at(index, rate);
            let record = playback.at(frame.time);
            playback.check()?;
            // Its last moment is shown, and not once more.
            if frame.cards[1] == 0.0 && playback.ended().is_some_and(|end| shown >= end) {
                index = board.last_card(rate);
                continue;
            }
            shown = record.snapshot.time;
            plots.record(&record);
            if shot >= done {
                let mut style = plain.clone();
                for element in frame.without {
                    style.set(element, false)?;
                }
                style.show = Overlays {
                    card: words::card(&frame, &job.description, fleet, || playback.metrics()),
                    line: words::line(&frame, fleet, &record),
                    plots: plots.shown(frame.plots),
                    room,
                };
                if let Some((_, caption)) = job.captions.iter().rfind(|(at, _)| *at <= record.snapshot.time) {
                    studio.renderer.retitle(&fleet.title, caption);
                }
                let spec = PictureSpec::new(playback.trail(), &record, &frame.layout, &style);
                let ready = studio.renderer.draw_next(spec)?;
                ready.map_or(Ok(()), |picture| film.push(picture)).map_err(|e| self.refused(e))?;
            }
            (index, shot) = (index + 1, shot + 1);
            audience.at(index);
        }
        if let Some(picture) = studio.renderer.finish()? {
            film.push(picture).map_err(|e| self.refused(e))?;
        }
        if shot <= done && index < frames {
            // Nothing new: what was kept stays.
            return Err(Error::Interrupted("no film was written".into()));
        }
        if index < frames {
            film.pause().map_err(|e| self.refused(e))?;
            audience.end();
            return Err(self.paused(shot));
        }
        film.finish().map_err(|e| self.refused(e))?;
        audience.end();
        if let Some(end) = playback.ended().filter(|_| shot < frames) {
            let whole = job.draw.duration;
            audience.remark(&format!("the run ended at {end:.2} s of {whole:.2} s, and the film with it"));
        }
        let adapter = studio.gpu.description();
        Ok(Filmed { frames: shot, found: done, fps: rate, size: studio.size, adapter })
    }

    /// What an interrupted film of so many frames leaves.
    fn paused(&self, shot: u64) -> Error {
        let (path, rate) = (&self.job.path, self.rate);
        let seconds = shot as f64 / rate;
        // Whole groups of frames alone outlive the program.
        let kept = if self.kind == FilmKind::Mp4 { Film::kept(path, rate) as f64 / rate } else { 0.0 };
        let more =
            if kept > 0.0 { format!("; the same command goes on after {kept:.2} s") } else { String::new() };
        Error::Interrupted(format!("{} holds the first {seconds:.2} s{more}", path.display()))
    }

    /// A disk that refuses a film, with what it keeps of it.
    fn refused(&self, error: film::Error) -> Error {
        let kept = if self.kind == FilmKind::Mp4 { Film::kept(&self.job.path, self.rate) } else { 0 };
        let text = match (self.kind, kept) {
            (FilmKind::Mp4, 0) => "nothing of the film is kept yet".to_owned(),
            (FilmKind::Mp4, frames) => format!(
                "the first {:.2} s are kept beside it, and the same command goes on from there once there is room",
                frames as f64 / self.rate
            ),
            _ => "nothing of the film is kept; an .mp4 would go on from where it was".to_owned(),
        };
        Error::from(error).but(&text)
    }
}

/// An animation stores every pixel that changes, and on moving ground all do: it is smaller and slower than a film, unless
/// the scene says otherwise.
fn lighten(settings: &mut scene::Film) {
    let plain = scene::Film::default();
    if settings.size == plain.size {
        settings.size = [480, 270];
    }
    if settings.fps == plain.fps {
        settings.fps = 10.0;
    }
}

/// A film to write, and how many frames of it are there.
fn begin(job: &FilmJob, kind: FilmKind, studio: &RenderSetup, rate: f64) -> Result<(Film, u64), Error> {
    let [width, height] = studio.size;
    if kind != FilmKind::Mp4 {
        return Ok((Film::create(&job.path, kind, width, height, rate)?, 0));
    }
    // The same film is made of the same run, by the same program on the same adapter, with the same words.
    let mut whole = xxhash_rust::xxh3::Xxh3::new();
    let program = (studies::PROGRAM, studies::COMMIT, studio.gpu.description());
    whole
        .update(format!("{program:?}{:?}{:?}{:?}", studio.layout, studio.style, job.draw.picture).as_bytes());
    whole.update(format!("{:?}{:?}{}", job.preset, job.draw.settings, job.run).as_bytes());
    let made_of = format!("{:032x}", whole.digest128());
    if job.fresh {
        // What belongs to another film is begun anew.
        drop(Film::resume(&job.path, width, height, rate, &format!("not {made_of}"))?);
    }
    Ok(Film::resume(&job.path, width, height, rate, &made_of)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_animation_has_the_measures_of_its_scene() {
        let mut plain = scene::Film::default();
        lighten(&mut plain);
        assert_eq!((plain.size, plain.fps), ([480, 270], 10.0));
        let mut own = scene::Film { size: [320, 180], fps: 25.0, ..scene::Film::default() };
        lighten(&mut own);
        assert_eq!((own.size, own.fps), ([320, 180], 25.0));
    }
}
