//! The prediction: a copy of the run, simulated ahead beside it.

use crate::background::{Background, Next, Task};
use metrics::clearance::Clearance;
use simulation::Simulation;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering::Relaxed},
};
use vocabulary::{EntityId, PlannedPath, Pose, StepRecord};
use web_time::{Duration, Instant};

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
    /// Plans to goals that are made at its first sample.
    pub plans: Vec<Arc<PlannedPath>>,
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

/// Makes predictions. It serves the newest request and drops older ones.
pub struct Predictor {
    background: Background<PredictionRequest>,
    open: Arc<AtomicUsize>,
}

struct PredictionRequest {
    branch: usize,
    run: Simulation,
    seconds: f64,
    number: usize,
}

impl Predictor {
    /// Starts it; the receiver delivers predictions, and `wake` is called for each.
    pub fn start(wake: impl Fn() + Send + 'static) -> (Self, Receiver<Prediction>) {
        let (outbox, predictions) = channel();
        let open = Arc::new(AtomicUsize::new(0));
        let left = Arc::clone(&open);
        let background = Background::start("ahead", move || PredictionWorker {
            outbox,
            open: left,
            wake: Box::new(wake),
            under_way: None,
            newest: None,
        });
        (Self { background, open }, predictions)
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
        // Without a thread there are no predictions, and everything else works.
        if !self.background.ask(PredictionRequest { branch, run, seconds, number }) {
            self.open.fetch_sub(1, Relaxed);
        }
    }

    /// Predicts for a share of a frame, where there is no thread for it; when it needs the next.
    pub(crate) fn tick(&mut self, share: Duration) -> Next {
        self.background.tick(share)
    }
}

/// The state of the predictor.
struct PredictionWorker {
    outbox: Sender<Prediction>,
    /// Number of requests without an answer.
    open: Arc<AtomicUsize>,
    wake: Box<dyn Fn() + Send>,
    under_way: Option<PredictionUnderWay>,
    newest: Option<PredictionRequest>,
}

impl Task for PredictionWorker {
    type Request = PredictionRequest;

    fn take(&mut self, request: PredictionRequest) {
        if self.newest.replace(request).is_some() {
            self.open.fetch_sub(1, Relaxed);
        }
    }

    fn tick(&mut self, share: Duration) -> Next {
        if self.under_way.is_none() {
            self.under_way = self.newest.take().map(PredictionUnderWay::new);
        }
        let Some(under_way) = &mut self.under_way else { return Next::Asked };
        let done = under_way.go_on(share);
        let dropped = self.newest.is_some() && under_way.may_be_dropped();
        if !done && !dropped {
            return Next::After(Duration::ZERO);
        }
        if let Some(under_way) = self.under_way.take().filter(|_| done) {
            // Without a listener nobody asks either.
            let _ = self.outbox.send(under_way.finish());
        }
        self.open.fetch_sub(1, Relaxed);
        (self.wake)();
        if self.newest.is_some() { Next::After(Duration::ZERO) } else { Next::Asked }
    }
}

/// A prediction that is being computed.
struct PredictionUnderWay {
    branch: usize,
    number: usize,
    run: Simulation,
    /// Samples so far, and in all.
    done: u64,
    samples: u64,
    builder: PredictionBuilder,
    /// Computing time so far.
    took: Duration,
}

impl PredictionUnderWay {
    fn new(request: PredictionRequest) -> Self {
        let PredictionRequest { branch, mut run, seconds, number } = request;
        // Camera images cannot be rendered ahead of time: followers use the true values.
        if run.needs_cameras() {
            run.trust();
        }
        let period = run.period();
        let samples = (seconds / period).round().max(1.0) as u64;
        let start = run.sample() as f64 * period;
        let builder = PredictionBuilder::new(&run, samples, [start, start + samples as f64 * period]);
        Self { branch, number, run, done: 0, samples, builder, took: Duration::ZERO }
    }

    /// Simulates for about `share`; whether the prediction is complete.
    fn go_on(&mut self, share: Duration) -> bool {
        let began = Instant::now();
        while self.done < self.samples {
            let Some(record) = self.run.next_record() else {
                self.builder.end(self.run.record());
                self.done = self.samples;
                break;
            };
            self.builder.take(self.done, record);
            self.done += 1;
            if began.elapsed() >= share {
                break;
            }
        }
        self.took += began.elapsed();
        self.done == self.samples
    }

    /// Whether a newer request replaces it. Later the work is finished: otherwise a stream of requests would never get an
    /// answer.
    fn may_be_dropped(&self) -> bool {
        self.done <= self.samples / 4 && self.took.as_millis() > 60
    }

    fn finish(self) -> Prediction {
        Prediction {
            branch: self.branch,
            number: self.number,
            took: self.took.as_secs_f64(),
            ..self.builder.out
        }
    }
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
        if k == 0 {
            self.out.plans.clone_from(&record.plans);
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A page predicts in pieces, a thread in one go.
    #[test]
    fn a_prediction_in_pieces_is_the_same() {
        let shipped = scene::shipped("cars-line-three").expect("a shipped scene");
        let scene = scene::Scene::parse(shipped.text, "t.toml", &[]).expect("a scene").scene;
        let mut run = Simulation::new(simulation::build(&scene).expect("a run"));
        run.next_record().expect("a record");
        let under_way = || {
            let request = PredictionRequest { branch: 1, run: run.save(), seconds: 0.5, number: 2 };
            PredictionUnderWay::new(request)
        };
        let (mut whole, mut pieces) = (under_way(), under_way());
        assert!(whole.go_on(Duration::MAX));
        let mut turns = 1;
        while !pieces.go_on(Duration::ZERO) {
            turns += 1;
        }
        assert_eq!(turns, pieces.samples);
        let [whole, pieces] = [whole, pieces].map(|under_way| Prediction { took: 0.0, ..under_way.finish() });
        assert_eq!(format!("{whole:?}"), format!("{pieces:?}"));
    }

    /// While a run is paused nothing but the prediction tells where the new plan leads.
    #[test]
    fn a_goal_that_has_moved_is_in_the_prediction() {
        let text = scene::shipped("maze-three").expect("a shipped scene").text;
        let read = |text: &str| scene::Scene::parse(text, "t.toml", &[]).expect("a scene").scene;
        let mut run = Simulation::new(simulation::build(&read(text)).expect("a run"));
        run.next_record().expect("a record");
        let predicted = |run: &Simulation| {
            let mut under_way = PredictionUnderWay::new(PredictionRequest {
                branch: 0,
                run: run.save(),
                seconds: 0.05,
                number: 0,
            });
            assert!(under_way.go_on(Duration::MAX));
            under_way.finish().plans
        };
        assert_eq!(predicted(&run), []);
        let moved = read(&text.replace("[20.0, 0.0, 0.0]", "[18.0, -6.0, 0.0]"));
        run.apply_parameters(&simulation::build(&moved).expect("a run"));
        let plans = predicted(&run);
        let end = plans[0].points.last().expect("a point").poses[0];
        assert!(plans.len() == 1 && vocabulary::math::hypot(end.x - 18.0, end.y + 6.0) < 0.1, "{end:?}");
    }
}
