//! Pictures and films, rendered beside the window, which never waits for them. A page may not wait either: there a picture
//! is asked for from frame to frame until it is there, and films are left to the program.

use crate::background::{Background, Next, Task};
use crate::outlet;
#[cfg(not(target_family = "wasm"))]
use film::{Film, FilmKind};
use rendering::{Gpu, PictureSpec, Renderer, Style, Trail, ViewLayout};
use std::error::Error;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering::Relaxed},
};
use vocabulary::{FleetInfo, Picture, StepRecord};
use web_time::Duration;

/// Frames of a film a second.
pub const RATE: f64 = 30.0;

/// A frame to render.
#[derive(Clone)]
pub struct FrameSpec {
    /// The moment.
    pub record: Arc<StepRecord>,
    /// The views.
    pub layout: ViewLayout,
    /// Elements and annotations.
    pub style: Style,
    /// Title and caption.
    pub words: [String; 2],
}

/// A file to write, and what all its frames share.
pub struct ExportTarget {
    /// The file.
    pub path: PathBuf,
    /// Robots and edges.
    pub fleet: Arc<FleetInfo>,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// The past of the moment.
    pub trail: Trail,
}

/// A job of the exporter.
pub enum ExportJob {
    /// A picture.
    Picture {
        /// Its file.
        target: Box<ExportTarget>,
        /// The frame.
        shot: Box<FrameSpec>,
        /// Text chunks of the file.
        texts: Texts,
    },
    /// Start a film; its width and height are even.
    Begin(Box<ExportTarget>),
    /// Replace the past: the branch has changed.
    Trail(Box<Trail>),
    /// Records since the last frame.
    Records(Vec<Arc<StepRecord>>),
    /// Add a frame to the film.
    Frame(Box<FrameSpec>),
    /// End the film.
    End,
}

/// A result of the exporter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ExportEvent {
    /// A file is complete.
    Written(PathBuf),
    /// Why a file could not be written.
    Failed(String),
}

/// The exporter and its channels.
pub struct Exporter {
    background: Background<ExportJob>,
    events: Receiver<ExportEvent>,
    waiting: Arc<AtomicUsize>,
}

impl Exporter {
    /// Starts it; it calls `wake` for every event.
    pub fn start(gpu: Gpu, wake: impl Fn() + Send + 'static) -> Self {
        let (outbox, events) = channel();
        let waiting = Arc::new(AtomicUsize::new(0));
        let left = Arc::clone(&waiting);
        let background = Background::start("studio", move || ExportWorker {
            outbox,
            waiting: left,
            wake: Box::new(wake),
            studio: Studio::new(gpu),
        });
        Self { background, events, waiting }
    }

    /// Sends a request.
    pub fn ask(&self, job: ExportJob) {
        self.waiting.fetch_add(1, Relaxed);
        self.background.ask(job);
    }

    /// Works for a share of a frame, where there is no thread for it; when it needs the next.
    pub(crate) fn tick(&mut self, share: Duration) -> Next {
        self.background.tick(share)
    }

    /// The next event, if there is one.
    pub fn next_event(&self) -> Option<ExportEvent> {
        self.events.try_recv().ok()
    }

    /// Number of jobs that are not finished.
    pub fn waiting(&self) -> usize {
        self.waiting.load(Relaxed)
    }
}

impl Drop for Exporter {
    fn drop(&mut self) {
        self.background.finish();
    }
}

/// The state of the exporter.
struct ExportWorker {
    outbox: Sender<ExportEvent>,
    /// Number of jobs that are not finished.
    waiting: Arc<AtomicUsize>,
    wake: Box<dyn Fn() + Send>,
    studio: Studio,
}

impl Task for ExportWorker {
    type Request = ExportJob;

    fn take(&mut self, job: ExportJob) {
        let done = self.studio.take(job);
        self.waiting.fetch_sub(1, Relaxed);
        self.tell(done);
    }

    fn tick(&mut self, _: Duration) -> Next {
        let (done, next) = self.studio.look();
        self.tell(done);
        next
    }

    /// The window was closed during a film: the film is completed as far as it is.
    fn end(&mut self) {
        let _ = self.studio.take(ExportJob::End);
    }
}

impl ExportWorker {
    /// Sends the file that is complete, or why it is not.
    fn tell(&self, done: Done) {
        let event = match done {
            Ok(None) => return,
            Ok(Some(path)) => ExportEvent::Written(path),
            Err(error) => ExportEvent::Failed(error.to_string()),
        };
        // Without a listener the last film is still finished.
        let _ = self.outbox.send(event);
        (self.wake)();
    }
}

/// The file that a job has completed, if any.
type Done = Result<Option<PathBuf>, Box<dyn Error>>;

/// Text chunks of a picture's file.
pub type Texts = Vec<(&'static str, String)>;

/// Writes a picture with its texts.
fn write(path: PathBuf, picture: &Picture, texts: &Texts) -> Done {
    let texts: Vec<(&str, &str)> = texts.iter().map(|(key, text)| (*key, &**text)).collect();
    outlet::write(&path, &film::png::encode(picture, &texts)?)?;
    Ok(Some(path))
}

/// What a page has of a studio.
#[cfg(target_family = "wasm")]
struct Studio {
    gpu: Gpu,
    /// The picture that is being drawn.
    drawing: Option<(Renderer, PathBuf, Texts)>,
}

/// Interval in which a page looks whether a picture is there.
#[cfg(target_family = "wasm")]
const LOOK_EVERY: Duration = Duration::from_millis(20);

#[cfg(target_family = "wasm")]
impl Studio {
    fn new(gpu: Gpu) -> Self {
        Self { gpu, drawing: None }
    }

    /// Starts a picture, or says who does a job.
    fn take(&mut self, job: ExportJob) -> Done {
        match job {
            ExportJob::Picture { .. } if self.drawing.is_some() => {
                Err("the picture before this one is still being drawn".into())
            }
            ExportJob::Picture { target, shot, texts } => {
                let ExportTarget { path, fleet, size: [width, height], trail } = *target;
                let mut renderer = Renderer::new(&self.gpu, &fleet, width, height, 4)?;
                renderer.retitle(&shot.words[0], &shot.words[1]);
                renderer.draw_next(PictureSpec::new(&trail, &shot.record, &shot.layout, &shot.style))?;
                self.drawing = Some((renderer, path, texts));
                Ok(None)
            }
            ExportJob::Begin(target) => {
                let name = target.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let name = name.rsplit_once('-').map_or(&*name, |(scene, _)| scene);
                Err(format!(
                    "A page makes no films. Keep the run (K), then `echelon film {name}-lab-001.toml` films it."
                )
                .into())
            }
            _ => Ok(None),
        }
    }

    /// Looks whether the picture is there; when to look again.
    fn look(&mut self) -> (Done, Next) {
        let Some((mut renderer, path, texts)) = self.drawing.take() else { return (Ok(None), Next::Asked) };
        match renderer.arrived() {
            Ok(None) => {
                self.drawing = Some((renderer, path, texts));
                (Ok(None), Next::After(LOOK_EVERY))
            }
            Ok(Some(picture)) => (write(path, &picture, &texts), Next::Asked),
            Err(error) => (Err(error.into()), Next::Asked),
        }
    }
}

/// What renders and writes.
#[cfg(not(target_family = "wasm"))]
struct Studio {
    gpu: Gpu,
    drawer: Option<(Arc<FleetInfo>, Renderer)>,
    film: Option<OpenFilm>,
}

/// A film under way.
#[cfg(not(target_family = "wasm"))]
struct OpenFilm {
    film: Film,
    target: ExportTarget,
}

#[cfg(not(target_family = "wasm"))]
impl Studio {
    fn new(gpu: Gpu) -> Self {
        Self { gpu, drawer: None, film: None }
    }

    /// Nothing is under way between two jobs.
    #[expect(clippy::unused_self, reason = "a page looks for its picture")]
    fn look(&self) -> (Done, Next) {
        (Ok(None), Next::Asked)
    }

    /// Does a job.
    fn take(&mut self, job: ExportJob) -> Done {
        match job {
            ExportJob::Picture { target, shot, texts } => {
                let picture = self.draw(&target, &shot)?;
                write(target.path, &picture, &texts)
            }
            ExportJob::Begin(target) => {
                let ExportTarget { path, size: [width, height], .. } = &*target;
                let film = Film::create(path, FilmKind::of(path, false)?, *width, *height, RATE)?;
                self.film = Some(OpenFilm { film, target: *target });
                Ok(None)
            }
            ExportJob::Trail(trail) => {
                if let Some(reel) = &mut self.film {
                    reel.target.trail = *trail;
                }
                Ok(None)
            }
            ExportJob::Records(records) => {
                if let Some(reel) = &mut self.film {
                    for record in &records {
                        reel.target.trail.push(record);
                    }
                }
                Ok(None)
            }
            ExportJob::Frame(shot) => {
                let done = self.frame(&shot);
                if done.is_err() {
                    // A dropped film removes its incomplete file.
                    self.film = None;
                }
                done.map(|()| None)
            }
            ExportJob::End => match self.film.take() {
                Some(reel) if reel.film.frames() > 0 => {
                    reel.film.finish()?;
                    Ok(Some(reel.target.path))
                }
                _ => Ok(None),
            },
        }
    }

    fn frame(&mut self, shot: &FrameSpec) -> Result<(), Box<dyn Error>> {
        let Some(mut reel) = self.film.take() else { return Ok(()) };
        reel.film.push(self.draw(&reel.target, shot)?)?;
        self.film = Some(reel);
        Ok(())
    }

    fn draw(&mut self, target: &ExportTarget, shot: &FrameSpec) -> Result<Picture, Box<dyn Error>> {
        let ExportTarget { fleet, size: [width, height], trail, .. } = target;
        let fitting = self.drawer.take().filter(|(known, _)| Arc::ptr_eq(known, fleet));
        let drawer = match fitting {
            Some(drawer) => drawer,
            None => (Arc::clone(fleet), Renderer::new(&self.gpu, fleet, *width, *height, 4)?),
        };
        let (_, renderer) = self.drawer.insert(drawer);
        renderer.resize(*width, *height)?;
        renderer.retitle(&shot.words[0], &shot.words[1]);
        Ok(renderer.draw(PictureSpec::new(trail, &shot.record, &shot.layout, &shot.style))?)
    }
}
