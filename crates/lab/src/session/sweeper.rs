//! Sweeps beside the window: threads make the runs, and the window takes their rows when it likes.

use super::sweep_job::SweepJob;
use crate::background::{Background, Next, Task};
use scene::Study;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use sweeps::{Experiment, ExperimentRun, RunRow};
use web_time::{Duration, Instant};

/// Interval between two calls of the window while rows come.
const WAKE_INTERVAL: Duration = Duration::from_millis(60);
/// Most threads that make runs.
const MOST_THREADS: usize = 16;

/// A sweep that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepOrder {
    /// Counted by who asks.
    pub number: u64,
    /// What varies.
    pub study: Study,
    /// Text of the scene.
    pub text: String,
    /// Names the scene in messages; files are looked for beside it.
    pub home: PathBuf,
}

/// A request to the threads.
#[derive(Debug, Clone)]
pub enum SweepRequest {
    /// See whether a sweep can be made.
    Check(Box<SweepOrder>),
    /// Make its runs.
    Make(Arc<SweepJob>),
    /// Make no more of them.
    Stop(Arc<SweepJob>),
}

/// What the threads say.
#[derive(Debug)]
pub enum SweepEvent {
    /// A sweep can be made.
    Ready(Arc<SweepJob>),
    /// A sweep cannot be made: its number, and why.
    Refused(u64, String),
    /// A run of a sweep has ended.
    Row(u64, Box<RunRow>),
}

/// The threads of sweeps; they start when they are needed.
pub struct Sweeper {
    workers: Vec<Background<SweepRequest>>,
    outbox: Sender<SweepEvent>,
    events: Receiver<SweepEvent>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl Sweeper {
    /// Without threads; `wake` is called when there are events.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (outbox, events) = channel();
        Self { workers: Vec::new(), outbox, events, wake: Arc::new(wake) }
    }

    /// Passes a request on.
    pub fn request(&mut self, request: &SweepRequest) {
        // One core is left to the run and the window. A page has no threads: there it is the window that works.
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let wanted = match request {
            SweepRequest::Stop(job) => return job.stop(),
            SweepRequest::Check(_) => 1,
            SweepRequest::Make(_) if cfg!(target_family = "wasm") => 1,
            SweepRequest::Make(_) => (cores - 1).clamp(1, MOST_THREADS),
        };
        while self.workers.len() < wanted {
            let (outbox, wake) = (self.outbox.clone(), Arc::clone(&self.wake));
            let name = format!("sweep {}", self.workers.len());
            self.workers.push(Background::start(&name, move || SweepWorker {
                outbox,
                wake,
                woke: None,
                check: None,
                job: None,
                run: None,
            }));
        }
        for worker in &self.workers[..wanted] {
            // The threads live as long as the window.
            worker.ask(request.clone());
        }
    }

    /// The next event, if there is one.
    pub fn next_event(&self) -> Option<SweepEvent> {
        self.events.try_recv().ok()
    }

    /// Makes runs for a share of a frame, where there is no thread for it; when it needs the next.
    pub(crate) fn tick(&mut self, share: Duration) -> Next {
        self.workers.iter_mut().map(|worker| worker.tick(share)).min().unwrap_or(Next::Asked)
    }
}

impl Drop for Sweeper {
    fn drop(&mut self) {
        for worker in &mut self.workers {
            worker.finish();
        }
    }
}

/// What a thread is at.
struct SweepWorker {
    outbox: Sender<SweepEvent>,
    wake: Arc<dyn Fn() + Send + Sync>,
    woke: Option<Instant>,
    check: Option<Box<SweepOrder>>,
    job: Option<Arc<SweepJob>>,
    run: Option<ExperimentRun>,
}

impl Task for SweepWorker {
    type Request = SweepRequest;

    fn take(&mut self, request: SweepRequest) {
        match request {
            SweepRequest::Check(order) => self.check = Some(order),
            SweepRequest::Make(job) => (self.job, self.run) = (Some(job), None),
            // The job itself says so.
            SweepRequest::Stop(_) => {}
        }
    }

    fn tick(&mut self, share: Duration) -> Next {
        let began = Instant::now();
        if let Some(order) = self.check.take() {
            let event = checked(*order);
            self.tell(event, true);
        }
        while let Some(job) = self.job.take() {
            let next = || job.claim().map(|index| job.experiment.begin(index));
            let Some(mut run) = self.run.take().filter(|_| !job.stopped()).or_else(next) else {
                (self.wake)();
                break;
            };
            let left = run.advance(&|| began.elapsed() < share && !job.stopped());
            let number = job.number;
            self.job = Some(job);
            if left {
                self.run = Some(run);
            } else if let Some(row) = run.row(None) {
                self.tell(SweepEvent::Row(number, Box::new(row)), false);
            }
            if began.elapsed() >= share {
                return Next::After(Duration::ZERO);
            }
        }
        Next::Asked
    }
}

impl SweepWorker {
    /// Says something, and calls the window at once or now and then.
    fn tell(&mut self, event: SweepEvent, at_once: bool) {
        // Nobody listens when the window is closed.
        let _ = self.outbox.send(event);
        if at_once || self.woke.is_none_or(|woke| woke.elapsed() >= WAKE_INTERVAL) {
            self.woke = Some(Instant::now());
            (self.wake)();
        }
    }
}

/// Whether a sweep can be made.
fn checked(order: SweepOrder) -> SweepEvent {
    let SweepOrder { number, study, text, home } = order;
    let experiment = Experiment::of_text(study, &text, home).and_then(|experiment| {
        experiment.check()?;
        Ok(experiment)
    });
    match experiment {
        Ok(experiment) => SweepEvent::Ready(Arc::new(SweepJob::new(number, experiment))),
        Err(error) => SweepEvent::Refused(number, error.to_string()),
    }
}
