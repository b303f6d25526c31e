//! Events: robots that change their leader, fail, join and part while a run goes.
//!
//! At every control sample [`happen`] looks at what is due: events whose trigger holds, changes of leader whose new
//! observer has had the time to settle, and robots that wait for a leader. An event that cannot be is refused with a
//! reason, and the run goes on. `docs/events.md` says what happens, and who waits for how long.

mod assignment;
mod check;
mod failure;
mod hand_over;
mod plan;
mod trigger;

use crate::simulation::Simulation;
use formation::{HandOverParameters, SetPointTrajectory};
use hand_over::HandOvers;
use std::sync::Arc;
use vocabulary::{Command, EventKind, EventRecord, Limits, Motion, Trajectory};

pub use failure::Recovery;
pub(crate) use hand_over::let_stand;
pub(crate) use plan::event_plan;
pub use trigger::{Holds, Trigger};

/// What is to happen in a run.
#[derive(Debug, Clone, Default)]
pub struct EventPlan {
    /// In the order of the scene.
    pub events: Vec<PlannedEvent>,
    /// How robots change their leader.
    pub hand_over: HandOverRules,
}

/// An event that is to happen.
#[derive(Debug, Clone)]
pub struct PlannedEvent {
    /// When.
    pub trigger: Trigger,
    /// What.
    pub action: EventAction,
}

/// What happens to a robot, by index.
#[derive(Debug, Clone)]
pub enum EventAction {
    /// It follows another robot.
    Follow {
        /// The robot.
        robot: usize,
        /// Whom it follows.
        leader: usize,
        /// Where; `None` where it keeps the place that it has.
        place: Option<SetPointTrajectory>,
    },
    /// It follows nobody, and has this motion.
    Lead {
        /// The robot.
        robot: usize,
        /// Its motion, counted from the event on.
        motion: Arc<dyn Trajectory>,
    },
    /// It fails.
    Fail {
        /// The robot.
        robot: usize,
        /// `Stop`, `Coast` or `Remove`.
        kind: EventKind,
        /// What becomes of those who follow it.
        recovery: Recovery,
    },
    /// Those who follow it take their places anew.
    Assign {
        /// The robot.
        head: usize,
    },
}

impl EventAction {
    /// Whether it is that a robot follows another.
    pub(crate) fn is_follow(&self) -> bool {
        matches!(self, Self::Follow { .. })
    }
}

/// How robots change their leader, and what is asked of the new one.
#[derive(Debug, Clone, Copy)]
pub struct HandOverRules {
    /// How a robot goes to its place.
    pub way: HandOverParameters,
    /// [nearest, farthest] that a place may be from its leader, m.
    pub distance: [f64; 2],
    /// Farthest that the leader may be off straight ahead, rad.
    pub bearing_max: f64,
    /// How often a robot that waits tries to follow again, s.
    pub retry: f64,
    /// How long it waits, s.
    pub patience: f64,
    /// How long a follower may be held up before it is left behind, s; `None` where it may be for ever.
    pub held_up: Option<f64>,
}

impl Default for HandOverRules {
    fn default() -> Self {
        Self {
            way: HandOverParameters { speed: 0.4, acceleration: 0.5, fade: 0.5 },
            distance: [0.5, 4.1],
            bearing_max: 105_f64.to_radians(),
            retry: 1.0,
            patience: 10.0,
            held_up: None,
        }
    }
}

/// What has become of a robot.
#[derive(Debug, Clone, Default)]
enum Duty {
    /// It leads or follows.
    #[default]
    Drives,
    /// It has failed, and comes to a stand with this curvature of its way, 1/m.
    Failed { kind: EventKind, curvature: f64 },
    /// It stands, and looks for a leader.
    Waits(failure::Wait),
    /// It has waited in vain.
    Stays,
}

/// What is to happen, and what has become of the robots.
#[derive(Debug, Clone)]
pub(crate) struct Events {
    plan: Arc<EventPlan>,
    /// Since when the trigger of each event holds, and whether it has happened.
    watches: Vec<trigger::Watch>,
    duties: Vec<Duty>,
    /// Whether each robot has stood or led since the start, and has no least speed.
    may_stand: Vec<bool>,
    /// Since when each robot has been held up, s.
    held_up: Vec<Option<f64>>,
    hand_overs: HandOvers,
    /// Which event of the plan happens now.
    current: Option<usize>,
    /// What happened at this sample.
    told: Vec<EventRecord>,
}

impl Events {
    pub(crate) fn new(plan: Arc<EventPlan>, robots: usize) -> Self {
        Self {
            watches: vec![trigger::Watch::default(); plan.events.len()],
            plan,
            duties: vec![Duty::Drives; robots],
            may_stand: vec![false; robots],
            held_up: vec![None; robots],
            hand_overs: HandOvers::default(),
            current: None,
            told: vec![],
        }
    }

    /// Whether nothing is to happen, and nothing has happened.
    pub(crate) fn is_idle(&self) -> bool {
        self.plan.events.is_empty() && self.plan.hand_over.held_up.is_none()
    }

    /// Other events are to happen than were planned, those that have happened apart.
    pub(crate) fn replan(&mut self, plan: Arc<EventPlan>) {
        self.watches.resize(plan.events.len(), trigger::Watch::default());
        self.plan = plan;
    }

    /// What happened at this sample.
    pub(crate) fn told(&self) -> &[EventRecord] {
        &self.told
    }

    /// Notes what happened at this sample; what is known already is not said again.
    pub(crate) fn tell(&mut self, event: EventRecord) {
        let event = EventRecord { event: event.event.or(self.current), ..event };
        if !self.told.contains(&event) {
            self.told.push(event);
        }
    }

    /// Whether a robot leads or follows.
    pub(crate) fn drives(&self, robot: usize) -> bool {
        matches!(self.duties[robot], Duty::Drives)
    }

    /// Whether a robot has no least speed by what happened.
    pub(crate) fn may_stand(&self, robot: usize) -> bool {
        self.may_stand[robot]
    }

    /// The command of a robot that has failed or waits, and whether it is still its own master: then its filter may move it.
    pub(crate) fn command(&self, robot: usize, now: &Motion, limits: &Limits) -> Option<(Command, bool)> {
        let brake = |rate: f64, most: f64| -(rate * now.speed).min(most.min(limits.acceleration_max));
        match self.duties[robot] {
            Duty::Drives => None,
            Duty::Failed { kind: EventKind::Coast, curvature } => Some((
                Command { acceleration: brake(STOPS, COASTS), turn_rate: curvature * now.speed },
                false,
            )),
            Duty::Failed { .. } => {
                Some((Command { acceleration: brake(STOPS, f64::INFINITY), turn_rate: 0.0 }, false))
            }
            Duty::Waits(_) | Duty::Stays => {
                Some((Command { acceleration: brake(WAITS, f64::INFINITY), turn_rate: 0.0 }, true))
            }
        }
    }

    /// Whom robots observe that are about to follow them; to be carried on over a period like other observers.
    pub(crate) fn hand_overs(&mut self) -> &mut HandOvers {
        &mut self.hand_overs
    }
}

/// A robot that fails and stops brakes as hard as it can, with this rate in the end, 1/s.
const STOPS: f64 = 10.0;
/// One that rolls to a stand loses this much speed, m/s².
const COASTS: f64 = 0.3;
/// One that waits brakes at this rate, 1/s.
const WAITS: f64 = 2.0;

/// Lets happen what is due at `time` s.
pub(crate) fn happen(run: &mut Simulation, time: f64) {
    run.events.told.clear();
    if run.events.is_idle() {
        return;
    }
    hand_over::complete(run, time);
    let plan = run.events.plan.clone();
    for (index, event) in plan.events.iter().enumerate() {
        if trigger::fires(run, index, &event.trigger, time) {
            run.events.current = Some(index);
            start(run, &event.action, time);
            run.events.current = None;
        }
    }
    failure::retry(run, time);
    if let Some(patience) = plan.hand_over.held_up {
        failure::leave_behind(run, patience, time);
    }
}

fn start(run: &mut Simulation, action: &EventAction, time: f64) {
    match action {
        EventAction::Follow { robot, leader, place } => {
            hand_over::follow(run, *robot, *leader, place.clone(), time);
        }
        EventAction::Lead { robot, motion } => {
            let motion = Arc::new(formation::lead::Delayed { motion: motion.clone(), by: time });
            hand_over::lead(run, *robot, motion, time);
        }
        EventAction::Fail { robot, kind, recovery } => failure::fail(run, *robot, *kind, *recovery, time),
        EventAction::Assign { head } => assignment::assign(run, *head, time),
    }
}
