//! Pictures and films, rendered on their own thread so that the window never waits for them.

use film::{Film, FilmKind, png};
use rendering::{Gpu, PictureSpec, Renderer, Style, Trail, ViewLayout};
use std::error::Error;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering::Relaxed},
};
use std::thread::JoinHandle;
use vocabulary::{FleetInfo, Picture, StepRecord};

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
        texts: Vec<(&'static str, String)>,
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

/// The thread and its channels.
pub struct Exporter {
    jobs: Option<Sender<ExportJob>>,
    events: Receiver<ExportEvent>,
    waiting: Arc<AtomicUsize>,
    thread: Option<JoinHandle<()>>,
}

impl Exporter {
    /// Starts the thread; it calls `wake` for every event.
    pub fn start(gpu: Gpu, wake: impl Fn() + Send + 'static) -> Self {
        let (jobs, inbox) = channel();
        let (outbox, events) = channel();
        let waiting = Arc::new(AtomicUsize::new(0));
        let left = Arc::clone(&waiting);
        let work = move || {
            let mut work = ExportWorker { gpu, drawer: None, film: None };
            while let Ok(job) = inbox.recv() {
                let done = work.take(job);
                left.fetch_sub(1, Relaxed);
                let word = match done {
                    Ok(None) => continue,
                    Ok(Some(path)) => ExportEvent::Written(path),
                    Err(error) => ExportEvent::Failed(error.to_string()),
                };
                // Without a listener the last film is still finished.
                let _ = outbox.send(word);
                wake();
            }
            // The window was closed during a film: the film is completed as far as it is.
            let _ = work.take(ExportJob::End);
        };
        let thread = std::thread::Builder::new().name("studio".to_owned()).spawn(work).ok();
        Self { jobs: Some(jobs), events, waiting, thread }
    }

    /// Sends a request.
    pub fn ask(&self, job: ExportJob) {
        if let Some(jobs) = &self.jobs {
            self.waiting.fetch_add(1, Relaxed);
            let _ = jobs.send(job);
        }
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
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The state of the thread.
struct ExportWorker {
    gpu: Gpu,
    drawer: Option<(Arc<FleetInfo>, Renderer)>,
    film: Option<OpenFilm>,
}

/// A film under way.
struct OpenFilm {
    film: Film,
    target: ExportTarget,
}

impl ExportWorker {
    /// Does a job; the file that it completes, if any.
    fn take(&mut self, job: ExportJob) -> Result<Option<PathBuf>, Box<dyn Error>> {
        match job {
            ExportJob::Picture { target, shot, texts } => {
                let picture = self.draw(&target, &shot)?;
                let texts: Vec<(&str, &str)> = texts.iter().map(|(key, text)| (*key, &**text)).collect();
                png::write(&target.path, &picture, &texts)?;
                Ok(Some(target.path))
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
