//! The prediction: a copy of the run, simulated ahead on its own thread.

use metrics::clearance::Clearance;
use simulation::Simulation;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering::Relaxed},
};
use std::time::Instant;
use vocabulary::{EntityId, Pose, StepRecord};

/// Maximum number of points of a path.
const MOST_POINTS: usize = 160;
/// Interval between two measurements of clearance, s.
const ROOM_EVERY: f64 = 0.1;
/// Final share of the prediction over which [`Prediction::late_error`] is taken.
const LATE: f64 = 0.1;

/// The next seconds of a run.
#[derive(Debug, Clone, Default)]
pub struct Prediction {
    /// Its branch.
    pub branch: usize,
    /// Start and end time, s.
    pub span: [f64; 2],
    /// One path per robot.
    pub paths: Vec<Vec<PathPoint>>,
    /// Speed, m/s, and turn rate, rad/s, of every robot at the points of its path.
    pub motions: Vec<Vec<[f64; 2]>>,
    /// Final pose of every robot.
    pub end: Vec<Pose>,
    /// Largest |error| of every edge in the last tenth of the prediction, [m, rad].
    pub late_error: Vec<[f64; 2]>,
    /// First contact: time, s, and the robots or props in it.
    pub contact: Option<(f64, [EntityId; 2])>,
    /// First saturated command: time, s, and edge.
    pub limited: Option<(f64, usize)>,
    /// Computing time, s.
    pub took: f64,
    /// Number of predictions requested before this one.
    pub number: usize,
}

/// A point of a predicted path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// m, world frame.
    pub at: [f64; 2],
    /// The problem there.
    pub trouble: Trouble,
}

/// A problem at a point of a predicted path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Trouble {
    /// Nothing.
    #[default]
    None,
    /// The command is saturated.
    Limited,
    /// The robot touches something.
    Contact,
}

/// The prediction thread. It serves the newest request and drops older ones.
pub struct Predictor {
    questions: Sender<PredictionRequest>,
    open: Arc<AtomicUsize>,
}

struct PredictionRequest {
    branch: usize,
    run: Simulation,
    seconds: f64,
    number: usize,
}

impl Predictor {
    /// Starts the thread; the receiver delivers predictions, and `wake` is called for each.
    pub fn start(wake: impl Fn() + Send + 'static) -> (Self, Receiver<Prediction>) {
        let (questions, inbox) = channel::<PredictionRequest>();
        let (outbox, predictions) = channel();
        let open = Arc::new(AtomicUsize::new(0));
        let left = Arc::clone(&open);
        let work = move || {
            while let Ok(mut question) = inbox.recv() {
                let mut taken = 1;
                while let Ok(newer) = inbox.try_recv() {
                    question = newer;
                    taken += 1;
                }
                let newer = || left.load(Relaxed) > taken;
                let prediction = ahead(question, &newer);
                left.fetch_sub(taken, Relaxed);
                if prediction.is_some_and(|prediction| outbox.send(prediction).is_err()) {
                    return;
                }
                wake();
            }
        };
        // Without a thread there are no predictions, and everything else works.
        let _ = std::thread::Builder::new().name("ahead".to_owned()).spawn(work);
        (Self { questions, open }, predictions)
    }

    /// Whether a prediction is being computed.
    pub fn busy(&self) -> bool {
        self.open.load(Relaxed) > 0
    }

    /// Requests a prediction from a copy of a run over `seconds`.
    pub fn look(&self, branch: usize, run: Simulation, seconds: f64) {
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        self.open.fetch_add(1, Relaxed);
        let number = NUMBER.fetch_add(1, Relaxed);
        if self.questions.send(PredictionRequest { branch, run, seconds, number }).is_err() {
            self.open.fetch_sub(1, Relaxed);
        }
    }
}

/// Computes a prediction; `None` if a newer request has arrived during the first quarter.
fn ahead(question: PredictionRequest, newer: &dyn Fn() -> bool) -> Option<Prediction> {
    let began = Instant::now();
    let PredictionRequest { branch, mut run, seconds, number } = question;
    // Camera images cannot be rendered ahead of time: followers use the true values.
    if run.needs_cameras() {
        run.trust();
    }
    let period = run.period();
    let samples = (seconds / period).round().max(1.0) as u64;
    let start = run.sample() as f64 * period;
    let mut builder = PredictionBuilder::new(&run, samples, [start, start + samples as f64 * period]);
    for k in 0..samples {
        let Some(record) = run.next_record() else {
            builder.end(run.record());
            break;
        };
        builder.take(k, record);
        // Later the work is finished: otherwise a stream of requests would never get an answer.
        if k == samples / 4 && newer() && began.elapsed().as_millis() > 60 {
            return None;
        }
    }
    Some(Prediction { branch, number, took: began.elapsed().as_secs_f64(), ..builder.out })
}

/// Builds a prediction from records.
struct PredictionBuilder {
    out: Prediction,
    stride: u64,
    samples: u64,
    room_every: u64,
    clearance: Clearance,
    edges: Vec<vocabulary::Edge>,
    trouble: Vec<Trouble>,
}

impl PredictionBuilder {
    fn new(run: &Simulation, samples: u64, span: [f64; 2]) -> Self {
        let fleet = run.fleet();
        let robots = fleet.robots.len();
        Self {
            out: Prediction {
                span,
                paths: vec![Vec::new(); robots],
                motions: vec![Vec::new(); robots],
                late_error: vec![[0.0; 2]; fleet.edges.len()],
                ..Prediction::default()
            },
            stride: samples.div_ceil(MOST_POINTS as u64).max(1),
            samples,
            room_every: (ROOM_EVERY / run.period()).ceil().max(1.0) as u64,
            clearance: Clearance::new(fleet),
            edges: fleet.edges.clone(),
            trouble: vec![Trouble::None; robots],
        }
    }

    fn take(&mut self, k: u64, record: &StepRecord) {
        self.limits(record);
        self.contacts(k, record);
        self.errors(k, record);
        if k + 1 == self.samples {
            self.end(record);
        } else if k.is_multiple_of(self.stride) {
            self.places(record);
        }
    }

    /// Adds the last moment, also where the run stops early.
    fn end(&mut self, record: &StepRecord) {
        self.places(record);
        self.out.end = record.snapshot.robots.iter().map(|robot| robot.motion.pose).collect();
    }

    fn places(&mut self, record: &StepRecord) {
        let paths = self.out.paths.iter_mut().zip(&mut self.out.motions);
        for ((path, motions), (robot, trouble)) in
            paths.zip(record.snapshot.robots.iter().zip(&mut self.trouble))
        {
            let motion = robot.motion;
            path.push(PathPoint { at: [motion.pose.x, motion.pose.y], trouble: std::mem::take(trouble) });
            motions.push([motion.speed, motion.turn_rate]);
        }
    }

    fn limits(&mut self, record: &StepRecord) {
        for (index, (edge, state)) in self.edges.iter().zip(&record.edges).enumerate() {
            if state.limited {
                self.trouble[edge.follower] = self.trouble[edge.follower].max(Trouble::Limited);
                self.out.limited.get_or_insert((record.snapshot.time, index));
            }
        }
    }

    /// Contacts of dynamic bodies, and overlaps of kinematic ones.
    fn contacts(&mut self, k: u64, record: &StepRecord) {
        let time = record.snapshot.time;
        let mut touch = |things: [EntityId; 2]| {
            for thing in things {
                if let EntityId::Robot(robot) = thing {
                    self.trouble[robot] = Trouble::Contact;
                }
            }
            self.out.contact.get_or_insert((time, things));
        };
        for contact in record.contacts.iter().filter(|contact| contact.of_robot() && contact.open) {
            touch(contact.things);
        }
        if k.is_multiple_of(self.room_every) {
            self.clearance.push(&record.snapshot);
            let least = self.clearance.least().iter().enumerate();
            for (robot, room) in least.filter_map(|(robot, room)| Some((robot, room.as_ref()?))) {
                if room.clearance <= 0.0 && room.time == time {
                    touch([EntityId::Robot(robot), room.nearest]);
                }
            }
        }
    }

    fn errors(&mut self, k: u64, record: &StepRecord) {
        if (k as f64) < (1.0 - LATE) * self.samples as f64 {
            return;
        }
        for (late, state) in self.out.late_error.iter_mut().zip(&record.edges) {
            for (late, error) in late.iter_mut().zip(state.error) {
                *late = late.max(error.abs());
            }
        }
    }
}
