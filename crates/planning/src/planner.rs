//! From a request to a plan: checks, search, smoothing, speeds.

use crate::error::InputError;
use crate::leg::Leg;
use crate::mission::{Mission, PlanGoal, PlanRequest, PlanStart};
use crate::offer::{NoWay, NoWayReason, blocked_by, why_not, with_offer};
use crate::plan::MotionPlan;
use crate::search::{join, search};
use crate::smooth::smoothed;
use crate::timing::Unavoidable;
use crate::trailing::{Blocked, Convoy, STEP, Sweep, Trailing};
use thiserror::Error;

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// The request makes no sense.
    #[error(transparent)]
    Input(#[from] InputError),
    /// It has no way.
    #[error(transparent)]
    NoWay(Box<NoWay>),
    /// It has one, and something moves there whenever it goes.
    #[error(transparent)]
    Meets(Unavoidable),
}

/// Plans a way. `stop` is asked now and then whether to go on, with the number of steps swept so far: what has been found
/// by then is the plan.
///
/// # Errors
/// The request makes no sense, or there is no way: then with the reason, what there is a way for, and the gap in the way.
pub fn plan(request: &PlanRequest<'_>, stop: &mut dyn FnMut(usize) -> bool) -> Result<MotionPlan, PlanError> {
    request.mission.check(request.model, &request.limits)?;
    request.effort.check()?;
    request.check_held()?;
    let no_way = |no_way: NoWay| PlanError::NoWay(Box::new(no_way));
    let trailing = Trailing::new(request.model, &request.limits);
    if let Some(reason) = at_the_ends(request, &trailing) {
        let starts =
            request.effort.explains && matches!(reason, NoWayReason::StartBlocked { robot, .. } if robot > 0);
        return Err(no_way(if starts { with_offer(request, reason, stop) } else { NoWay::because(reason) }));
    }
    let outcome = search(request, &trailing, stop);
    let Some(way) = outcome.way else {
        let mut found = why_not(request, outcome.ended, stop);
        found.expansions += outcome.expansions;
        found.record = outcome.record;
        return Err(no_way(found));
    };
    let (legs, changed) =
        if request.effort.smooths { smooth(request, &trailing, &way.legs) } else { (way.legs, false) };
    let mut plan = MotionPlan::along(request, &trailing, legs);
    plan.searched_cost = way.cost;
    plan.expansions = outcome.expansions;
    plan.smoothed = changed;
    plan.record = outcome.record;
    Ok(plan)
}

/// Plans a way over several goals, at each of which the formation stops; a plan for each, which begins as the one before ends.
///
/// # Errors
/// There are no goals, or one has no way: with its number.
pub fn plan_tour(
    request: &PlanRequest<'_>,
    goals: &[PlanGoal],
    stop: &mut dyn FnMut(usize) -> bool,
) -> Result<Vec<MotionPlan>, TourError> {
    if goals.is_empty() {
        return Err(TourError { goal: 0, error: InputError::NoGoals.into() });
    }
    let mut start = request.mission.start;
    let mut plans: Vec<MotionPlan> = vec![];
    for (goal, to) in goals.iter().enumerate() {
        let held = plans.last().map_or(request.held, |before| Some(&before.held));
        let request = PlanRequest { mission: Mission { start, goal: *to }, held, ..*request };
        let found = plan(&request, stop).map_err(|error| TourError { goal, error })?;
        if let Some(end) = found.points.last() {
            start = PlanStart { level: end.level, curvature: end.curvature, ..PlanStart::at(end.pose) };
        }
        plans.push(found);
    }
    Ok(plans)
}

/// Why a tour has no plan.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("goal {goal} of the tour: {error}")]
pub struct TourError {
    /// Number of the goal, from 0.
    pub goal: usize,
    /// Why there is no way to it.
    pub error: PlanError,
}

/// What is wrong with the start or the goal, whatever lies between.
pub(crate) fn at_the_ends(request: &PlanRequest<'_>, trailing: &Trailing) -> Option<NoWayReason> {
    let PlanRequest { map, model, mission, limits, .. } = request;
    let (start, goal) = (mission.start, mission.goal);
    if map.ground().distance([start.pose.x, start.pose.y]) > 0.0 {
        return Some(NoWayReason::StartOutside);
    }
    if map.ground().distance(goal.position) > 0.0 {
        return Some(NoWayReason::GoalOutside);
    }
    let mut sweep = Sweep::new(map, trailing, limits);
    let convoy = trailing.begin(request, start.level);
    if let Err(Blocked::Touches { robot, .. }) = sweep.begin(&convoy) {
        let (_, by) = map.nearest(convoy.positions[robot]);
        return Some(NoWayReason::StartBlocked { robot, by });
    }
    let need = model.body(0).core() + map.clearance() - goal.tolerance;
    blocked_by(map, goal.position, need).map(|by| NoWayReason::GoalBlocked { by })
}

/// Smooths part by part: each ends where it ended, so that the next one stays as it is.
fn smooth(request: &PlanRequest<'_>, trailing: &Trailing, legs: &[Leg]) -> (Vec<Leg>, bool) {
    let mut sweep = Sweep::new(request.map, trailing, &request.limits);
    let mut convoy = trailing.begin(request, request.mission.start.level);
    let mut left: Vec<Leg> = legs.iter().rev().cloned().collect();
    let (mut done, mut changed) = (vec![], false);
    while let Some(leg) = left.pop() {
        let is_short = leg.length() <= LONGEST_PART;
        let found = if is_short { smoothed(request, &mut sweep, &convoy, &leg) } else { None };
        let found = found.filter(|found| rest_is_clear(trailing, &mut sweep, &convoy, found, &left));
        changed |= found.is_some();
        let halves = if found.is_none() && leg.length() > SHORTEST_PART { leg.halves() } else { None };
        if let Some([first, second]) = halves {
            left.extend([second, first]);
            continue;
        }
        let leg = found.unwrap_or(leg);
        drive(trailing, &mut convoy, &leg);
        join(&mut done, leg);
    }
    (done, changed)
}

/// Parts that are longer, m, are smoothed in halves; so are those of which nothing came, if they are longer than the second.
const LONGEST_PART: f64 = 60.0;
const SHORTEST_PART: f64 = 12.0;

/// Whether followers whose headings remember another way stay clear on all that is left.
fn rest_is_clear(
    trailing: &Trailing,
    sweep: &mut Sweep<'_>,
    convoy: &Convoy,
    leg: &Leg,
    left: &[Leg],
) -> bool {
    let mut convoy = convoy.clone();
    drive(trailing, &mut convoy, leg);
    sweep.resume();
    left.iter().rev().all(|leg| sweep.leg(&mut convoy, leg).is_ok())
}

fn drive(trailing: &Trailing, convoy: &mut Convoy, leg: &Leg) {
    for piece in leg.pieces(STEP) {
        for robot in 0..trailing.robots() {
            trailing.step(convoy, robot, &piece);
        }
    }
}
