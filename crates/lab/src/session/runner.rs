//! The simulation. It receives requests and sends events; neither it nor the window waits for the other.

use super::branches::Branches;
use super::checked_scene::CheckedScene;
use super::prediction::Predictor;
pub use super::run_event::{Fork, RunEvent};
pub use super::run_request::RunRequest;
use crate::background::{Background, Next, Task};
use rendering::{Gpu, GpuCameraRenderer};
use scene::Scene;
use simulation::Simulation;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, Sender, channel};
use vocabulary::{FleetInfo, StepRecord};
use web_time::{Duration, Instant};

/// The simulation and its channels.
pub struct Runner {
    background: Background<RunRequest>,
    events: Receiver<RunEvent>,
    unread: Arc<AtomicUsize>,
}

/// Maximum number of batches that wait for the window: if it falls this far behind, the run waits.
const MOST_UNREAD: usize = 600;
/// Why a scene with cameras does not run.
const BLIND: &str = if cfg!(target_family = "wasm") {
    "A page renders no camera images: `echelon lab SCENE`, with this scene or link, opens it in a window."
} else {
    "There is no adapter to render camera images."
};
/// Records of a recorded run in a batch.
#[cfg(not(target_family = "wasm"))]
const BATCH: usize = 200;
/// Longest computing time before a run that has been opened is shown where it is.
const CATCH_UP: Duration = Duration::from_secs(1);
/// Interval between two predictions while the run plays.
const PREDICTION_INTERVAL: Duration = Duration::from_millis(300);
/// Interval between two batches of samples while the run plays.
const BATCH_INTERVAL: Duration = Duration::from_millis(12);

impl Runner {
    /// Starts it; `gpu` renders camera images, and `wake` is called for every event.
    pub fn start(predictor: Predictor, gpu: Option<Gpu>, wake: impl Fn() + Send + 'static) -> Self {
        let (outbox, events) = channel();
        let unread = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&unread);
        let background = Background::start("run", move || RunWorker {
            outbox,
            unread: count,
            wake: Box::new(wake),
            branches: None,
            recorded: (0, String::new()),
            active: 0,
            playing: false,
            pace: 1.0,
            owed: 0.0,
            played: None,
            until: None,
            held: Vec::new(),
            goal: None,
            predictor,
            gpu,
            ahead: 0.0,
            predicted: None,
        });
        Self { background, events, unread }
    }

    /// Sends a request.
    pub fn request(&self, request: RunRequest) {
        // The thread lives as long as the window.
        self.background.ask(request);
    }

    /// Simulates and predicts for a share of a frame, where there is no thread for it; when it needs the next.
    pub(crate) fn tick(&mut self, share: Duration) -> Next {
        self.background.tick(share)
    }

    /// The next event, if there is one.
    pub fn next_event(&self) -> Option<RunEvent> {
        let event = self.events.try_recv().ok()?;
        self.unread.fetch_sub(1, Relaxed);
        Some(event)
    }
}

impl Drop for Runner {
    fn drop(&mut self) {
        self.background.finish();
    }
}

/// The state of the simulation.
struct RunWorker {
    outbox: Sender<RunEvent>,
    unread: Arc<AtomicUsize>,
    wake: Box<dyn Fn() + Send>,
    branches: Option<Branches>,
    /// Number of samples of the recorded run, and their digest.
    recorded: (u64, String),
    active: usize,
    playing: bool,
    pace: f64,
    /// Simulated time that is due, s.
    owed: f64,
    /// Until when the run was played.
    played: Option<Instant>,
    /// Where a run that has been opened goes on at once: to this time, s, unless it takes longer than this.
    until: Option<(f64, Duration)>,
    /// Requests that wait until it is there.
    held: Vec<RunRequest>,
    /// Number of samples that it has to reach first.
    goal: Option<u64>,
    predictor: Predictor,
    gpu: Option<Gpu>,
    ahead: f64,
    predicted: Option<Instant>,
}

impl Task for RunWorker {
    type Request = RunRequest;

    fn take(&mut self, request: RunRequest) {
        if matches!(request, RunRequest::Open { .. }) {
            (self.until, self.held) = (None, Vec::new());
        }
        if self.until.is_some() {
            self.held.push(request);
            return;
        }
        self.handle(request);
        if !self.playing {
            self.played = None;
        }
    }

    fn tick(&mut self, share: Duration) -> Next {
        let now = Instant::now();
        if let Some((until, left)) = self.until {
            // Nobody can do anything before it is there, so that it takes more than its share.
            let there = self.catch_up(until, left.min(4 * share));
            let left = left.saturating_sub(now.elapsed());
            if !there && !left.is_zero() {
                self.until = Some((until, left));
                return Next::After(Duration::ZERO);
            }
            self.until = None;
            self.predict(true);
            for request in std::mem::take(&mut self.held) {
                self.take(request);
            }
        }
        let own = if let Some(goal) = self.goal {
            self.pursue(goal, share)
        } else if self.playing {
            let passed = self.played.replace(now).map_or(0.0, |before| (now - before).as_secs_f64());
            // A run that cannot keep up becomes slower; it does not jump afterwards.
            self.owed = (self.owed + passed * self.pace).min(0.1 * self.pace.max(1.0));
            self.advance_due(share);
            Next::After(BATCH_INTERVAL.saturating_sub(now.elapsed()))
        } else {
            Next::Asked
        };
        own.min(self.predictor.tick(share.saturating_sub(now.elapsed())))
    }
}

impl RunWorker {
    /// Simulates towards `goal` samples.
    fn pursue(&mut self, goal: u64, share: Duration) -> Next {
        if self.unread.load(Relaxed) > MOST_UNREAD {
            return Next::After(BATCH_INTERVAL);
        }
        let began = Instant::now();
        let Some(branches) = &mut self.branches else {
            self.goal = None;
            return Next::Asked;
        };
        let (mut records, mut there) = (Vec::new(), false);
        while !there && began.elapsed() < share {
            let record = branches.advance(self.active).cloned();
            there = record.is_none() || branches.list()[self.active].simulation().sample() >= goal;
            records.extend(record);
        }
        let digest = branches.list()[self.active].digest();
        self.report(records);
        if there {
            self.goal = None;
            self.send(RunEvent::Reached(Some(digest)));
            self.predict(true);
        }
        Next::After(Duration::ZERO)
    }

    /// Gives up what the run was to reach: it is another one, or somebody wants to see it from here on.
    fn leave_goal(&mut self) {
        if self.goal.take().is_some() {
            self.send(RunEvent::Reached(None));
        }
    }

    /// Simulates the samples that are due.
    fn advance_due(&mut self, share: Duration) {
        if self.unread.load(Relaxed) > MOST_UNREAD {
            return;
        }
        let began = Instant::now();
        let mut records = Vec::new();
        let Some(branches) = &mut self.branches else { return };
        let period = branches.list()[self.active].simulation().period();
        let mut ended = false;
        while self.owed >= period && began.elapsed() < share {
            self.owed -= period;
            let Some(record) = branches.advance(self.active) else {
                ended = true;
                break;
            };
            records.push(record.clone());
        }
        self.report(records);
        if ended {
            self.stop();
        }
        self.predict(false);
    }

    fn stop(&mut self) {
        self.playing = false;
        let why = self.branches.as_ref().and_then(|branches| {
            let simulation = branches.list()[self.active].simulation();
            let touched = || simulation.stopped().then(|| "The run stops here: bodies touched.".to_owned());
            simulation.fault().map(ToString::to_string).or_else(touched)
        });
        self.send(RunEvent::Stopped(why));
    }

    fn report(&mut self, records: Vec<StepRecord>) {
        if !records.is_empty() {
            self.send(RunEvent::Records(self.active, records));
        }
    }

    fn send(&self, event: RunEvent) {
        self.unread.fetch_add(1, Relaxed);
        // Without a listener the inbox is closed too, and the thread ends.
        let _ = self.outbox.send(event);
        (self.wake)();
    }

    fn handle(&mut self, request: RunRequest) {
        if !matches!(
            request,
            RunRequest::Play(_)
                | RunRequest::Pace(_)
                | RunRequest::Ahead(_)
                | RunRequest::Digest { .. }
                | RunRequest::Summarize(_)
        ) {
            self.leave_goal();
        }
        match request {
            RunRequest::Open { scene, until } => self.open(scene, until),
            #[cfg(not(target_family = "wasm"))]
            RunRequest::Recorded(log) => self.look_through(&log),
            RunRequest::ResumeRecording(scene) => self.resume_recording(scene),
            RunRequest::Play(on) => {
                if on {
                    self.leave_goal();
                }
                self.playing = on && self.branches.is_some();
                self.owed = 0.0;
            }
            RunRequest::Pace(pace) => self.pace = pace,
            RunRequest::Step => {
                self.playing = false;
                self.step();
            }
            RunRequest::Change(checked) => self.change(&checked),
            RunRequest::Fork { from, sample, name } => self.fork(from, sample, name),
            RunRequest::Switch(branch) => {
                if self.branches.as_ref().is_some_and(|branches| branch < branches.list().len()) {
                    self.active = branch;
                    self.predict(true);
                }
            }
            RunRequest::Ahead(seconds) => {
                self.ahead = seconds;
                self.predict(true);
            }
            RunRequest::Reach(time) => self.reach(time),
            RunRequest::Digest { branch, samples } => {
                let digest = self.branches.as_ref().and_then(|branches| branches.digest_at(branch, samples));
                if let Some(digest) = digest {
                    self.send(RunEvent::Digest { branch, samples, digest });
                }
            }
            RunRequest::Summarize(branch) => self.summarize(branch),
        }
    }

    /// The branches of a scene; on failure `None`, after sending the reason.
    fn branches_of(&self, scene: Arc<Scene>) -> Option<Branches> {
        let mut blind = None;
        let opened = Branches::open(scene, |simulation| {
            if simulation.needs_cameras() {
                match self.gpu.as_ref().map(|gpu| GpuCameraRenderer::new(gpu, simulation.fleet())) {
                    Some(Ok(eyes)) => simulation.attach_cameras(Box::new(eyes)),
                    Some(Err(error)) => blind = Some(error.to_string()),
                    None => blind = Some(BLIND.to_owned()),
                }
            }
        });
        match (opened, blind) {
            (Ok(branches), None) => return Some(branches),
            (Err(error), _) => self.send(RunEvent::Refused(error.to_string())),
            (Ok(_), Some(why)) => self.send(RunEvent::Refused(why)),
        }
        None
    }

    fn open(&mut self, scene: Arc<Scene>, until: f64) {
        let planned = scene.time.duration;
        let Some(branches) = self.branches_of(scene) else { return };
        let simulation = branches.list()[0].simulation();
        let fleet = FleetInfo { duration: planned, ..simulation.fleet().clone() };
        let (fleet, period) = (Arc::new(fleet), simulation.period());
        self.active = 0;
        self.owed = 0.0;
        self.branches = Some(branches);
        self.send(RunEvent::Opened { fleet, period });
        self.until = Some((until, CATCH_UP));
    }

    /// Sends the records of a recorded run.
    #[cfg(not(target_family = "wasm"))]
    fn look_through(&mut self, log: &recording::log::Log) {
        (self.branches, self.active, self.playing) = (None, 0, false);
        let (fleet, period) = (Arc::new(log.fleet().clone()), log.manifest().period);
        self.send(RunEvent::Opened { fleet, period });
        let (mut batch, mut digest, mut samples) = (Vec::new(), metrics::Digest::default(), 0);
        let mut fault = None;
        for record in log.records() {
            match record {
                Ok(record) => {
                    digest.push(&record);
                    samples += 1;
                    batch.push(record);
                }
                Err(error) => fault = Some(error.to_string()),
            }
            if batch.len() == BATCH {
                self.report(std::mem::take(&mut batch));
            }
        }
        self.report(batch);
        self.recorded = (samples, digest.text());
        if let Some(fault) = fault {
            self.send(RunEvent::Refused(fault));
        }
    }

    /// Simulates the scene of the recorded run to the end of the recording. The window has its records already.
    fn resume_recording(&mut self, scene: Arc<Scene>) {
        let Some(mut branches) = self.branches_of(scene) else { return };
        let (samples, digest) = &self.recorded;
        while branches.list()[0].simulation().sample() < *samples && branches.advance(0).is_some() {}
        let same = branches.list()[0].digest() == *digest;
        (self.active, self.owed) = (0, 0.0);
        self.branches = Some(branches);
        self.send(RunEvent::RecordingResumed(same));
    }

    /// Simulates for about `share`, at least a sample; whether the run has come to `until` s or to its end.
    fn catch_up(&mut self, until: f64, share: Duration) -> bool {
        let began = Instant::now();
        let Some(branches) = &mut self.branches else { return true };
        let (mut records, mut there) = (Vec::new(), false);
        while let Some(record) = branches.advance(self.active) {
            records.push(record.clone());
            there = record.snapshot.time >= until;
            if there || began.elapsed() > share {
                break;
            }
        }
        let ended = records.is_empty();
        self.report(records);
        if ended {
            self.stop();
        }
        there || ended
    }

    fn reach(&mut self, time: f64) {
        let Some(branches) = &self.branches else { return };
        let branch = &branches.list()[self.active];
        let goal = branch.simulation().sample_at(time) + 1;
        if branch.simulation().sample() == goal {
            let digest = branch.digest();
            self.send(RunEvent::Reached(Some(digest)));
        } else {
            self.goal = Some(goal);
        }
    }

    fn step(&mut self) {
        let Some(branches) = &mut self.branches else { return };
        match branches.advance(self.active).cloned() {
            Some(record) => self.report(vec![record]),
            None => self.stop(),
        }
        self.predict(true);
    }

    fn change(&mut self, checked: &CheckedScene) {
        let Some(branches) = &mut self.branches else { return };
        match branches.change(self.active, checked) {
            Ok(Some(change)) => self.send(RunEvent::Changed(self.active, change)),
            Ok(None) => {}
            Err(standing) => self.send(RunEvent::Refused(standing)),
        }
        self.predict(true);
    }

    fn fork(&mut self, from: usize, sample: u64, name: String) {
        let Some(branches) = &mut self.branches else { return };
        let Some(branch) = branches.fork(from, sample, name.clone()) else { return };
        let made = &branches.list()[branch];
        let changes = made.changes.clone();
        // The window does not keep every sample of a long history.
        let here = (made.simulation().sample() > 0).then(|| made.simulation().record().clone());
        self.active = branch;
        self.owed = 0.0;
        self.send(RunEvent::Forked(Fork { branch, from, sample, name, changes }));
        self.report(here.into_iter().collect());
        self.predict(true);
    }

    fn summarize(&mut self, branch: usize) {
        let Some(made) = self.branches.as_ref().and_then(|branches| branches.list().get(branch)) else {
            return;
        };
        let (changes, samples) = (made.changes.clone(), made.simulation().sample());
        self.send(RunEvent::Summary { branch, changes, samples, digest: made.digest() });
    }

    /// Requests a prediction: now, or once the last one is finished and old enough.
    fn predict(&mut self, now: bool) {
        let recent = self.predicted.is_some_and(|at| at.elapsed() < PREDICTION_INTERVAL);
        if self.ahead <= 0.0 || (!now && (recent || self.predictor.busy())) {
            return;
        }
        if let Some(branches) = &self.branches {
            let copy: Simulation = branches.list()[self.active].copy();
            self.predictor.look(self.active, copy, self.ahead);
            self.predicted = Some(Instant::now());
        }
    }
}
