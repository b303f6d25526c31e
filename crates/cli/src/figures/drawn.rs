//! What has to be drawn: a snake view for print, and a short film, both from one pass through a run.

use super::folder::Folder;
use super::meter::Meter;
use super::{Subject, ready, stop};
use crate::failure::Failure;
use crate::interrupt;
use film::{FilmKind, png};
use footage::Playback;
use rendering::{Gpu, PictureSpec, Renderer, Style, ViewLayout};
use report::{Case, FinishedRun, PlannedRun, Report, ReportFilm, ReportPicture, add_picture, find};
use studies::{PROGRAM, RecordSource};
use vocabulary::FleetInfo;

/// A run to draw.
pub(super) struct FilmedRun {
    case: Case,
    /// File name of the film, without its ending.
    name: String,
    job: PlannedRun,
    picture: Option<PictureOfRun>,
}

/// A picture of a run.
struct PictureOfRun {
    /// File name without its ending.
    stem: &'static str,
    /// s.
    time: f64,
}

/// 170 mm, two columns, at 300 dots an inch.
const PICTURE: [u32; 2] = [2008, 1130];
/// Text of a picture: seven points of print.
const PICTURE_TEXT: f64 = 2.1;
const FILM: [u32; 2] = [640, 360];
/// Frames a second of film.
const RATE: f64 = 20.0;
/// About as long as films get, s.
const LENGTH: f64 = 8.0;

impl FilmedRun {
    fn duration(&self) -> f64 {
        self.job.scene.time.duration
    }

    /// Times real time, at which it is shown.
    fn speed(&self) -> f64 {
        let least = self.duration() / LENGTH;
        if least <= 1.0 { 1.0 } else { least.ceil() }
    }

    /// Frames of its film.
    pub(super) fn frames(&self) -> u64 {
        ((self.duration() * RATE / self.speed()).round() as u64).max(1)
    }
}

/// What is drawn of a subject: the film of every case, and the picture of some.
pub(super) fn shows(subject: &Subject) -> Vec<FilmedRun> {
    let cases = [
        (Case::Line, "line", None),
        (Case::Circle, "circle", Some("figure-13")),
        (Case::Seven, "seven", Some("figure-14")),
        (Case::Own, "film", Some("snake")),
    ];
    let show = |(case, name, stem): (Case, &str, Option<&'static str>)| {
        // The paper's films are those of its own ε, which is the scenes'.
        let mut of = subject.jobs.iter().filter(|job| job.case == case);
        let job = if case == Case::Own { of.next() } else { of.next_back() }?;
        let time = if case == Case::Own { 0.8 } else { 0.6 } * job.scene.time.duration;
        let picture = stem.map(|stem| PictureOfRun { stem, time });
        Some(FilmedRun { case, name: name.to_owned(), job: job.clone(), picture })
    };
    cases.into_iter().filter_map(show).collect()
}

/// Draws one run: its film into the folder, its picture into the report.
pub(super) fn draw(
    show: &FilmedRun,
    gpu: &Gpu,
    adapter: &str,
    runs: &[FinishedRun],
    folder: &mut Folder,
    meter: &mut Meter,
    report: &mut Report,
) -> Result<(), Failure> {
    let simulation = ready(&show.job, Some(gpu), adapter)?.simulation;
    let fleet = simulation.fleet().clone();
    let layout = layout(show, &fleet)?;
    let style = Style::without(&["caption", "inset", "labels"])?;
    let mut renderer = Renderer::new(gpu, &fleet, FILM[0], FILM[1], 4)?;
    let file = format!("{}.mp4", show.name);
    let path = folder.place(&file);
    let mut film = film::Film::create(&path, FilmKind::Mp4, FILM[0], FILM[1], RATE)?;
    let mut playback = Playback::new(&fleet, RecordSource::Run(Box::new(simulation)), &interrupt::asked);
    let mut due = show.picture.as_ref();
    for frame in 0..show.frames() {
        let time = frame as f64 * show.speed() / RATE;
        if let Some(of) = due.filter(|of| of.time <= time) {
            picture(show, of, gpu, &layout, &mut playback, runs, report)?;
            due = None;
        }
        let record = playback.at(time);
        playback.check()?;
        stop(meter)?;
        let ready = renderer.draw_next(PictureSpec::new(playback.trail(), &record, &layout, &style))?;
        ready.map_or(Ok(()), |picture| film.push(picture))?;
        meter.frame();
    }
    if let Some(picture) = renderer.finish()? {
        film.push(picture)?;
    }
    film.finish()?;
    let mp4 =
        std::fs::read(&path).map_err(|e| Failure::Machine(format!("cannot read {}: {e}", path.display())))?;
    let speed = show.speed();
    let fast = if speed > 1.0 { format!(", {speed} times as fast as it is") } else { String::new() };
    report.films.push(ReportFilm { file, caption: format!("{}{fast}.", fleet.title), mp4 });
    Ok(())
}

/// The view of the scene; the paper's is the snake's.
fn layout(show: &FilmedRun, fleet: &FleetInfo) -> Result<ViewLayout, Failure> {
    let names: Vec<String> = fleet.robots.iter().map(|m| m.name.clone()).collect();
    let view = if show.case == Case::Own { show.job.scene.views.default.as_str() } else { "snake" };
    Ok(ViewLayout::parse(view, &names)?)
}

fn picture(
    show: &FilmedRun,
    of: &PictureOfRun,
    gpu: &Gpu,
    layout: &ViewLayout,
    playback: &mut Playback<'_>,
    runs: &[FinishedRun],
    report: &mut Report,
) -> Result<(), Failure> {
    let PictureOfRun { stem, time } = *of;
    let Some(trace) = find(runs, show.case, show.job.variant) else { return Ok(()) };
    let fleet = &trace.fleet;
    let mut style = Style::without(&["caption", "inset", "time"])?;
    style.scale = PICTURE_TEXT;
    let mut renderer = Renderer::new(gpu, fleet, PICTURE[0], PICTURE[1], 4)?;
    let record = playback.at(time);
    playback.check()?;
    let picture = renderer.draw(PictureSpec::new(playback.trail(), &record, layout, &style))?;
    let (at, adapter) = (format!("{time}"), gpu.description());
    let texts = [("Software", PROGRAM), ("Title", &*fleet.title), ("Time", &*at), ("Adapter", &*adapter)];
    let view =
        if show.job.scene.views.default == "snake" || show.case != Case::Own { "Snake view" } else { "View" };
    let shot = ReportPicture {
        stem: stem.to_owned(),
        caption: format!(
            "{view}: {}, at {time:.1} s. Ribbons are where the robots drove, rings where the followers should be.",
            fleet.title
        ),
        png: png::encode(&picture, &texts)?,
        size: PICTURE,
        time,
    };
    add_picture(report, shot, trace);
    Ok(())
}
