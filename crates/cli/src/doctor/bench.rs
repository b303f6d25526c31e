//! The measurements of `echelon doctor --bench`: shipped scenes, drawn and run as the other commands draw and run them.

use crate::doctor::table::{FILM_RATE, Row, Subject};
use crate::failure::Failure;
use crate::{cameras, interrupt};
use film::{Film, FilmKind};
use footage::Playback;
use rendering::{Gpu, PictureSpec, Renderer, Style, ViewLayout, Viewpoint};
use scene::{Scene, shipped};
use studies::pace::{Pace, PaceBench};
use studies::{RecordSource, SceneRun};
use vocabulary::{FleetInfo, StepRecord};

/// Scenes of 3, 7 and 100 robots, and the sizes at which each is drawn.
const DRAWN: [&str; 3] = ["circle-three", "figure-eight-seven", "hundred"];
const SIZES: [[u32; 2]; 4] = [[640, 360], [1280, 720], [1920, 1080], [3840, 2160]];
/// The scene that is filmed, in which size, and how many frames a repetition has.
const FILMED: &str = "circle-three";
const FILM_SIZE: [u32; 2] = [1280, 720];
const FRAMES: u32 = 20;
/// A scene whose followers have cameras.
const SEEING: &str = "vision-seven-v";
/// Instants of a repetition with cameras: those of 0.1 s, a whole number of control samples.
const INSTANTS: f64 = 3.0;
/// Scenes that run without pictures.
const RUN: [&str; 2] = ["figure-eight-seven", "cars-seven-v"];
/// When a run is drawn, s: its robots have left tracks by then.
const DRAWN_AT: f64 = 5.0;
/// Samples per pixel, as commands have it by default.
const SAMPLES: u32 = 4;

/// Measures everything, one after the other; `tell` gets each row when it is there.
pub(crate) fn measure(gpu: &Gpu, bench: &PaceBench<'_>, mut tell: impl FnMut(Row)) -> Result<(), Failure> {
    let mut found = |subject, scene: &'static str, robots: usize, pace: Option<Pace>| {
        let stopped = || Failure::Interrupted("what was measured until then is printed".into());
        tell(Row { subject, scene, robots, pace: pace.ok_or_else(stopped)? });
        Ok::<_, Failure>(())
    };
    for name in DRAWN {
        let mut studio = Studio::new(gpu, name)?;
        let moments = studio.moments()?;
        for size in SIZES {
            let pace = studio.picture(bench, size, &moments)?;
            found(Subject::Picture(size), name, studio.fleet.robots.len(), pace)?;
        }
    }
    let mut studio = Studio::new(gpu, FILMED)?;
    let frame = studio.film(bench)?;
    found(Subject::Frame(FILM_SIZE), FILMED, studio.fleet.robots.len(), frame)?;

    let mut renderer = cameras::factory(Some(gpu));
    let scene = parsed(SEEING)?;
    let mut rates = scene.followers().map(|(_, follow)| follow.sensing.rate);
    let (rate, cameras) = (rates.next().unwrap_or(f64::NAN), 1 + rates.count());
    let robots = scene.robots.len();
    let pace = bench.simulation(scene, &mut renderer, INSTANTS / rate)?;
    let pace = pace.map(|pace| Pace { seconds: pace.seconds / INSTANTS, ..pace });
    found(Subject::Instant { cameras, period: 1.0 / rate }, SEEING, robots, pace)?;
    for name in RUN {
        let scene = parsed(name)?;
        let robots = scene.robots.len();
        let pace = bench.simulation(scene, &mut renderer, 1.0)?;
        found(Subject::Second, name, robots, pace)?;
    }
    Ok(())
}

/// How to measure what only a window can tell.
pub(crate) fn window() -> String {
    let command = |name| format!("`echelon lab {name} --size 1280x800 --timings`");
    format!("the lab's window: {} and\n{} print theirs when it is closed", command(RUN[0]), command(RUN[1]))
}

fn parsed(name: &str) -> Result<Scene, Failure> {
    let text = shipped(name).map_or("", |shipped| shipped.text);
    Scene::parse(text, name, &[])
        .map(|loaded| loaded.scene)
        .map_err(|errors| Failure::Usage(errors.to_string()))
}

/// A shipped scene and what draws it.
struct Studio {
    fleet: FleetInfo,
    name: &'static str,
    renderer: Renderer,
    layout: ViewLayout,
    style: Style,
}

/// Two moments to draw in turn, and the run with what was before them: whatever a renderer keeps from one picture to the next
/// is of no use then, as where robots drive.
struct Moments {
    playback: Playback<'static>,
    records: [StepRecord; 2],
}

impl Studio {
    fn new(gpu: &Gpu, name: &'static str) -> Result<Self, Failure> {
        let run = SceneRun::new(parsed(name)?).map_err(studies::Error::from)?;
        let fleet = run.simulation.fleet().clone();
        let [width, height] = FILM_SIZE;
        let renderer = Renderer::new(gpu, &fleet, width, height, SAMPLES)?;
        Ok(Self {
            fleet,
            name,
            renderer,
            layout: ViewLayout::single(Viewpoint::Snake),
            style: Style::default(),
        })
    }

    /// The run, and how it is when there is something to draw.
    fn playback(&self) -> Result<(Playback<'static>, StepRecord), Failure> {
        let run = SceneRun::new(parsed(self.name)?).map_err(studies::Error::from)?;
        let mut playback =
            Playback::new(&self.fleet, RecordSource::Run(Box::new(run.simulation)), &interrupt::asked);
        let record = playback.at(DRAWN_AT);
        playback.check()?;
        Ok((playback, record))
    }

    fn moments(&self) -> Result<Moments, Failure> {
        let (mut playback, first) = self.playback()?;
        let second = playback.at(DRAWN_AT + 1.0 / FILM_RATE);
        Ok(Moments { playback, records: [first, second] })
    }

    /// Pictures of one size, drawn and read back.
    fn picture(
        &mut self,
        bench: &PaceBench<'_>,
        size: [u32; 2],
        moments: &Moments,
    ) -> Result<Option<Pace>, Failure> {
        self.renderer.resize(size[0], size[1])?;
        self.style.scale = Style::scale_for(size[0], size[1]);
        let mut turns = moments.records.iter().cycle();
        bench.repeat(|| {
            let Some(record) = turns.next() else { return Ok(None) };
            let spec = PictureSpec::new(moments.playback.trail(), record, &self.layout, &self.style);
            let seconds = bench.time(|| self.renderer.draw(spec).map(drop))?;
            Ok(Some(seconds))
        })
    }

    /// Short films, drawn and encoded; the pace is that of a frame.
    fn film(&mut self, bench: &PaceBench<'_>) -> Result<Option<Pace>, Failure> {
        let [width, height] = FILM_SIZE;
        let folder = tempfile::tempdir()
            .map_err(|error| Failure::Machine(format!("no folder for a film that is measured: {error}")))?;
        let path = folder.path().join("film.mp4");
        let pace = bench.repeat(|| {
            let (playback, _) = self.playback()?;
            let film = Film::create(&path, FilmKind::Mp4, width, height, FILM_RATE)?;
            let mut complete = false;
            let seconds = bench.time(|| {
                complete = self.shoot(playback, film)?;
                Ok::<_, Failure>(())
            })?;
            Ok::<_, Failure>(complete.then_some(seconds))
        })?;
        Ok(pace.map(|pace| Pace { seconds: pace.seconds / f64::from(FRAMES), ..pace }))
    }

    /// Shoots a film; whether it came to its end.
    fn shoot(&mut self, mut playback: Playback<'_>, mut film: Film) -> Result<bool, Failure> {
        for frame in 0..FRAMES {
            if interrupt::asked() {
                return Ok(false);
            }
            let record = playback.at(DRAWN_AT + f64::from(frame) / FILM_RATE);
            let spec = PictureSpec::new(playback.trail(), &record, &self.layout, &self.style);
            if let Some(picture) = self.renderer.draw_next(spec)? {
                film.push(picture)?;
            }
        }
        if let Some(picture) = self.renderer.finish()? {
            film.push(picture)?;
        }
        film.finish()?;
        Ok(true)
    }
}
