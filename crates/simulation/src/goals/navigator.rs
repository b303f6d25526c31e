//! One lead robot with goals: what it wants, its plan, and what it is up to.

use super::goal_formation::shape;
use super::known_things::map;
use super::motion::{PlannedMotion, PlannedPart};
use planning::{
    Convex, FormationModel, InputError, Map, Mission, MotionPlan, MovingThing, PlanError, PlanGoal,
    PlanRequest, PlanStart, Schedule, TrackPoint, TravelLimits, plan_among,
};
use scene::{Travel, Vehicle};
use std::sync::Arc;
use vocabulary::{EntityId, Pose, TourGoal};

/// Goals of one lead robot at most, over all rounds of a tour: every one of them is planned before the run begins.
pub(super) const GOALS_MOST: usize = 200;

/// A lead robot that has goals.
#[derive(Debug, Clone)]
pub(crate) struct Navigator {
    /// Its number.
    pub(super) lead: usize,
    /// Number of the robot whose goals they were at first: another leads in its place where that has failed.
    pub(super) asked: usize,
    pub(super) wish: Arc<GoalWish>,
    /// How it gets there.
    pub(super) motion: Arc<PlannedMotion>,
    pub(super) phase: Phase,
    /// Whether its plans know of each prop.
    pub(super) knows: Vec<bool>,
    /// Where each prop was seen last.
    pub(super) places: Vec<Pose>,
    /// Whether it is to plan again, since its goals are others.
    pub(super) replans: bool,
    /// Number of the plans of all that it has been held against.
    pub(super) version: u64,
    /// How many of its goals it has reached.
    pub(super) reached: usize,
    /// Parts of its motion before this one lead to goals that it wanted before; `usize::MAX` until it has a plan for what it
    /// wants now.
    pub(super) since: usize,
}

/// Where a lead robot wants to go, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct GoalWish {
    /// All of its goals, those of a tour once a round.
    pub goals: Vec<PlanGoal>,
    /// How many of them are a round.
    pub round: usize,
    /// How long it stays at each, s.
    pub pause: f64,
    /// How it goes there.
    pub travel: Travel,
}

/// What a lead robot is up to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Phase {
    /// It drives by its plan, or has arrived.
    Drives,
    /// It stands, or comes to a stand, and there is no way.
    Waits {
        /// Since when, s.
        since: f64,
        /// When it looked for a way last, s.
        tried: f64,
    },
    /// It stays where it is for good.
    Stays,
}

/// What plans are made for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PlanPurpose {
    /// They are driven.
    Driving,
    /// They are drawn, with what the searches looked at.
    Drawing,
    /// They show that there is a way: the first that is found will do.
    Checking,
}

/// A formation and what is known of its surroundings: what a plan is made of.
#[derive(Clone, Copy)]
pub(super) struct PlanTask<'a> {
    pub(super) model: &'a FormationModel,
    pub(super) limits: TravelLimits,
    pub(super) standing: &'a [(EntityId, Convex)],
    pub(super) moving: &'a [(EntityId, MovingThing)],
    /// Whether safety filters keep its robots off things.
    pub(super) filtered: bool,
    /// What the plan is for.
    pub(super) purpose: PlanPurpose,
    /// Whether somebody wants to know why there is no way.
    pub(super) explains: bool,
}

/// Where and how a formation is when it begins to plan.
pub(super) struct Departure {
    pub(super) start: PlanStart,
    /// θ̄ and κ̄ of its followers, if they are known.
    pub(super) held: Option<Vec<[f64; 2]>>,
    /// s.
    pub(super) time: f64,
}

/// Robots whose filters keep less free stay off things by this, m.
const LEAST_CLEARANCE: f64 = 0.25;
/// What plans leave beside that where there is a way, m: filters let robots come to their edge only slowly, and who is held up
/// there is late for its place and in the way of those behind.
const EASE: f64 = 0.15;
/// How much longer such a way may take.
const LONGER: f64 = 1.25;

impl GoalWish {
    /// Plans to all goals from number `next` on, `clearance` m off all things and, where filters act, farther off if that is not
    /// much longer.
    ///
    /// # Errors
    /// The number of the goal that there is no way to, and why.
    pub(super) fn parts(
        &self,
        task: &PlanTask<'_>,
        departure: &Departure,
        next: usize,
        clearance: f64,
    ) -> Result<Vec<PlannedPart>, (usize, PlanError)> {
        let near = self.parts_off(task, departure, next, clearance)?;
        if !task.filtered || self.travel.clearance.is_some() || task.purpose == PlanPurpose::Checking {
            return Ok(near);
        }
        let lasts = |parts: &[PlannedPart]| parts.iter().map(|part| part.plan.duration()).sum::<f64>();
        let silent = PlanTask { explains: false, ..*task };
        let Ok(far) = self.parts_off(&silent, departure, next, clearance + EASE) else { return Ok(near) };
        let is_long = lasts(&far) > LONGER * lasts(&near);
        let (mut chosen, aside) = if is_long { (near, far) } else { (far, near) };
        for (part, aside) in chosen.iter_mut().zip(&aside) {
            part.plan.reject(&aside.plan);
        }
        Ok(chosen)
    }

    /// Plans to all goals from number `next` on, `clearance` m off all things.
    fn parts_off(
        &self,
        task: &PlanTask<'_>,
        departure: &Departure,
        next: usize,
        clearance: f64,
    ) -> Result<Vec<PlannedPart>, (usize, PlanError)> {
        let failed = |error: InputError| (next, PlanError::from(error));
        let map = self.map(task, departure, clearance).map_err(failed)?;
        let things: Vec<MovingThing> = task.moving.iter().map(|(_, thing)| thing.clone()).collect();
        let (mut start, mut held, mut time) = (departure.start, departure.held.clone(), departure.time);
        let mut parts: Vec<PlannedPart> = vec![];
        for (number, goal) in self.goals.iter().enumerate().skip(next) {
            let mission = Mission { start, goal: *goal };
            let mut request = PlanRequest {
                held: held.as_deref(),
                ..PlanRequest::new(&map, task.model, task.limits, mission)
            };
            let effort = &mut request.effort;
            (effort.records, effort.explains) = (task.purpose == PlanPurpose::Drawing, task.explains);
            if task.purpose == PlanPurpose::Checking {
                (effort.improvement, effort.smooths) = (0, false);
            }
            let is_last = number + 1 == self.goals.len();
            let schedule = Schedule { begins: time, stays: if is_last { f64::INFINITY } else { self.pause } };
            let plan = in_shape(&request, &things, schedule).map_err(|error| (number, error))?;
            if let Some(end) = plan.points.last() {
                start = PlanStart { level: end.level, curvature: end.curvature, ..PlanStart::at(end.pose) };
            }
            held = Some(plan.held.clone());
            let begins = time;
            time += plan.duration() + self.pause;
            parts.push(PlannedPart { begins, goal: Some(number), until: f64::INFINITY, plan });
        }
        Ok(parts)
    }

    /// Which goal of a tour goal number `goal` over all rounds is; `None` where it is the only one.
    pub(super) fn on_tour(&self, goal: usize) -> Option<TourGoal> {
        let (goals, round) = (self.goals.len(), self.round.max(1));
        let number = (goals > round).then_some(goal / round);
        (goals > 1).then_some(TourGoal { goal: goal % round, round: number })
    }

    /// How far robots stay off things, m.
    pub(super) fn clearance(&self, rooms: &[f64], robots: &[usize]) -> f64 {
        let kept = || robots.iter().map(|robot| rooms[*robot]).fold(LEAST_CLEARANCE, f64::max);
        self.travel.clearance.unwrap_or_else(kept)
    }

    fn map(&self, task: &PlanTask<'_>, departure: &Departure, clearance: f64) -> Result<Map, InputError> {
        let start = departure.start.pose;
        let places = [[start.x, start.y]].into_iter().chain(self.goals.iter().map(|goal| goal.position));
        map(task.standing, places, task.model, clearance)
    }
}

/// The plan that ends in the shape where the goal leaves that open and there is one.
fn in_shape(
    request: &PlanRequest<'_>,
    things: &[MovingThing],
    schedule: Schedule,
) -> Result<MotionPlan, PlanError> {
    let goal = request.mission.goal;
    let asked = |request: &PlanRequest<'_>| plan_among(request, things, schedule, &mut |_| false);
    if goal.level.is_some() {
        return asked(request);
    }
    let mut shaped =
        PlanRequest { mission: Mission { goal: goal.at_level(0), ..request.mission }, ..*request };
    // Where there is none, another is looked for, not a reason.
    shaped.effort.explains = false;
    match asked(&shaped) {
        Ok(plan) => Ok(plan),
        Err(error) => {
            let mut plan = asked(request)?;
            if let PlanError::NoWay(no_way) = error {
                plan.record.extend(&no_way.record);
            }
            Ok(plan)
        }
    }
}

impl Navigator {
    /// It wants something else from now on.
    pub(super) fn wants(&mut self, wish: Arc<GoalWish>) {
        // A tour of as many goals goes on where it was.
        let kept = self.wish.goals.len() == wish.goals.len() && wish.goals.len() > 1;
        self.reached = if kept { self.reached.min(wish.goals.len() - 1) } else { 0 };
        (self.wish, self.replans, self.phase) = (wish, true, Phase::Drives);
        self.since = usize::MAX;
    }

    /// The bodies of its robots on their ways, for those who yield to it.
    pub(super) fn tracks(&self, vehicles: &[Vehicle]) -> Vec<(EntityId, MovingThing)> {
        let robots = self.motion.robots.iter().enumerate();
        robots
            .filter_map(|(k, robot)| Some((EntityId::Robot(*robot), self.track(k, &vehicles[*robot])?)))
            .collect()
    }

    fn track(&self, k: usize, vehicle: &Vehicle) -> Option<MovingThing> {
        let mut track: Vec<TrackPoint> = vec![];
        for part in self.motion.parts() {
            for point in &part.plan.points {
                let time = part.begins + point.time;
                // Of a plan for others this robot is no part.
                let Some(pose) = point.robots.get(k) else { continue };
                if time < part.until && track.last().is_none_or(|last| last.time < time) {
                    track.push(TrackPoint { time, pose: *pose });
                }
            }
        }
        MovingThing::new(shape(vehicle).at(Pose::default()), track).ok()
    }
}
