//! `echelon film`: a scene as a film, by its storyboard or a ready-made one, in simulation time whatever the machine's speed.

mod board;
mod plots;
mod preset;
mod words;

use crate::args::{PictureArgs, SceneArgs};
use crate::failure::Failure;
use crate::load::load;
use crate::picture::{DrawJob, RenderSetup};
use crate::playback::Playback;
use crate::print::{json, note, say};
use crate::progress::Progress;
use crate::replaced::Replaced;
use crate::{Outcome, cameras, interrupt};
use board::Board;
use clap::Args;
use film::{Film, FilmKind};
use metrics::MetricsBuilder;
use output::Place;
use plots::Plots;
pub(crate) use preset::Preset;
use rendering::{Gpu, Overlays, PictureSpec, ReservedSpace};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;
use studies::RecordSource;
use vocabulary::{Judging, counted};

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
    #[arg(long, value_enum, conflicts_with = "view")]
    preset: Option<Preset>,
    /// Start over instead of resuming the same film where it was interrupted
    #[arg(long)]
    fresh: bool,
}

/// What a film is made of.
pub(crate) struct FilmJob<'a> {
    pub(crate) draw: DrawJob<'a>,
    /// The film file.
    pub(crate) path: PathBuf,
    pub(crate) ffmpeg: bool,
    /// Frames a second, where asked for.
    pub(crate) fps: Option<f64>,
    pub(crate) preset: Option<Preset>,
    /// Begin anew where the same film was interrupted.
    pub(crate) fresh: bool,
    /// What the scene is about.
    pub(crate) description: String,
    pub(crate) judging: Judging,
    /// What is the same only for the same run.
    pub(crate) run: String,
    /// Law and gains in one line, and from when on, s; in the order of time.
    pub(crate) captions: Vec<(f64, String)>,
}

/// What the laws of a scene become as its run goes.
pub(crate) fn captions(scene: &scene::Scene) -> Vec<(f64, String)> {
    scene.changes.iter().map(|change| (change.at, studies::caption(&change.then))).collect()
}

pub(crate) fn film(args: &FilmArgs) -> Outcome {
    let mut loaded = load(&args.scene)?;
    let draw = DrawJob::of(&args.scene, &args.picture, &loaded);
    let scene = &loaded.scene;
    let job = FilmJob {
        path: args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.mp4", draw.name))),
        draw,
        ffmpeg: args.ffmpeg,
        fps: args.fps,
        preset: args.preset,
        fresh: args.fresh,
        description: scene.description.clone(),
        judging: scene.judging(),
        run: scene.to_toml(),
        captions: captions(scene),
    };
    shoot(job, |gpu| {
        cameras::attach(&mut loaded, Some(gpu), &args.scene.adapter.name, None)?;
        Ok(RecordSource::Run(Box::new(loaded.simulation)))
    })
}

/// Makes the film of the records of `source`, which may use the adapter that draws.
pub(crate) fn shoot(
    mut job: FilmJob<'_>,
    source: impl FnOnce(&Gpu) -> Result<RecordSource, Failure>,
) -> Outcome {
    let began = Instant::now();
    let kind = FilmKind::of(&job.path, job.ffmpeg)?;
    if kind == FilmKind::Gif {
        lighten(&mut job.draw.settings);
    }
    if let Some(preset) = job.preset {
        preset.apply(&mut job.draw.settings, job.draw.duration);
    }
    let _place = match kind {
        FilmKind::PngSequence => Place::new_folder(&job.path)?,
        _ => Place::file(&job.path)?,
    };
    let path = &job.path;
    let DrawJob { name, fleet, settings, .. } = &job.draw;
    let rate = job.fps.unwrap_or(settings.fps);
    if !(1.0..=240.0).contains(&rate) {
        return Err(film::Error::FrameRate(rate).into());
    }
    let view = settings.view.as_deref().unwrap_or(&job.draw.view);
    let names: Vec<String> = fleet.robots.iter().map(|m| m.name.clone()).collect();
    // A view given on the command line holds from beginning to end.
    let board = Board::new(settings, job.draw.picture.view.as_deref(), view, job.draw.duration, &names)?;
    let frames = board.frames(rate);
    let mut studio = RenderSetup::open(job.draw.adapter, job.draw.picture, fleet, view, settings.size)?;
    let told = settings.shots.iter().map(|shot| shot.line.as_str()).chain([job.description.as_str()]);
    studio.check_texts(told);
    let source = source(&studio.gpu)?;
    let (mut film, done) = begin(&job, kind, &studio, rate)?;
    let mut replaced = Replaced::default();
    // What an interrupted film left is its own beginning.
    if done == 0 {
        replaced.look(path);
    }

    let what = format!("Filming {name}, {}, to {}", counted(frames, "frame"), path.display());
    let progress = Progress::begin(&what, frames, job.draw.quiet);
    if done > 0 && !job.draw.quiet {
        note(&format!("going on after {:.2} s that are there from an interrupted film", done as f64 / rate));
    }
    let mut playback = Playback::new(fleet, source).measured(MetricsBuilder::new(fleet, job.judging));
    let mut plots = Plots::new(fleet, job.draw.duration);
    let plain = studio.style.clone();
    // Where a line or a panel comes and goes, no camera moves.
    let room = ReservedSpace { panel: plain.inset, rows: board.rows(fleet.edges.len()) };
    // A run that ends before its time has fewer frames than its storyboard.
    let (mut index, mut shot, mut shown) = (0, 0, f64::NEG_INFINITY);
    while index < frames && !interrupt::asked() {
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
            ready.map_or(Ok(()), |picture| film.push(picture)).map_err(|e| refused(e, &job, kind, rate))?;
        }
        (index, shot) = (index + 1, shot + 1);
        progress.at(index);
    }
    if let Some(picture) = studio.renderer.finish()? {
        film.push(picture).map_err(|e| refused(e, &job, kind, rate))?;
    }
    if shot <= done && index < frames {
        // Nothing new: what was kept stays.
        return Err(Failure::Interrupted("no film was written".into()));
    }
    if index < frames {
        film.pause().map_err(|e| refused(e, &job, kind, rate))?;
        replaced.tell(job.draw.quiet);
        drop(progress);
        let seconds = shot as f64 / rate;
        // Whole groups of frames alone outlive the program.
        let kept = if kind == FilmKind::Mp4 { Film::kept(path, rate) as f64 / rate } else { 0.0 };
        let more =
            if kept > 0.0 { format!("; the same command goes on after {kept:.2} s") } else { String::new() };
        return Err(Failure::Interrupted(format!("{} holds the first {seconds:.2} s{more}", path.display())));
    }
    film.finish().map_err(|e| refused(e, &job, kind, rate))?;
    drop(progress);
    replaced.tell(job.draw.quiet);
    if let Some(end) = playback.ended().filter(|_| shot < frames && !job.draw.quiet) {
        note(&format!("the run ended at {end:.2} s of {:.2} s, and the film with it", job.draw.duration));
    }
    let seconds = began.elapsed().as_secs_f64();
    let adapter = studio.gpu.description();
    if job.draw.json {
        json(&json!({
            "file": path.display().to_string(), "frames": shot, "fps": rate, "size": studio.size,
            "adapter": adapter, "wall_seconds": seconds, "frames_found": done,
        }));
    } else if !job.draw.quiet {
        let length = shot as f64 / rate;
        let [width, height] = studio.size;
        say(&format!(
            "{}: {length:.2} s, {} of {width}×{height} at {rate} a second",
            path.display(),
            counted(shot, "frame")
        ));
        say(&format!("drawn in {seconds:.1} s with {adapter}"));
    }
    Ok(())
}

/// A disk that refuses a film, with what it keeps of it.
fn refused(error: film::Error, job: &FilmJob<'_>, kind: FilmKind, rate: f64) -> Failure {
    let kept = if kind == FilmKind::Mp4 { Film::kept(&job.path, rate) } else { 0 };
    let text = match (kind, kept) {
        (FilmKind::Mp4, 0) => "nothing of the film is kept yet".to_owned(),
        (FilmKind::Mp4, frames) => format!(
            "the first {:.2} s are kept beside it, and the same command goes on from there once there is room",
            frames as f64 / rate
        ),
        _ => "nothing of the film is kept; an .mp4 would go on from where it was".to_owned(),
    };
    Failure::from(error).but(&text)
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
fn begin(job: &FilmJob<'_>, kind: FilmKind, studio: &RenderSetup, rate: f64) -> Result<(Film, u64), Failure> {
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
