//! Maps to plan on, and the usual request.

use planning::{Convex, Map, MotionPlan, PlanError, PlanRequest, TravelLimits, plan, trial};
use vocabulary::Pose;

pub(crate) fn vee_plan(map: &Map) -> Result<MotionPlan, PlanError> {
    plan(&PlanRequest::new(map, &trial::vee(), TravelLimits::default(), trial::mission()), &mut |_| false)
}

pub(crate) fn no_way(found: Result<MotionPlan, PlanError>) -> planning::NoWay {
    match found {
        Err(PlanError::NoWay(no_way)) => *no_way,
        Err(error) => panic!("{error}"),
        Ok(plan) => panic!("a plan of {} m", plan.length()),
    }
}

/// A map with everything on it, moved by turning it about the origin and then shifting it.
pub(crate) fn moved(map: &Map, by: Pose) -> Map {
    let obstacles = map.obstacles().iter().map(|obstacle| obstacle.moved(by)).collect();
    Map::new(map.ground().moved(by), obstacles, map.clearance()).expect("a map")
}

pub(crate) fn empty(side: f64) -> Map {
    let ground = Convex::rectangle(Pose::new(0.5 * side, 0.5 * side, 0.0), [0.5 * side; 2]).expect("a box");
    Map::new(ground, vec![], 0.25).expect("a map")
}

pub(crate) fn with(map: &Map, more: Vec<Convex>) -> Map {
    let obstacles = map.obstacles().iter().cloned().chain(more).collect();
    Map::new(map.ground().clone(), obstacles, map.clearance()).expect("a map")
}

pub(crate) fn block(x: [f64; 2], y: [f64; 2]) -> Convex {
    let middle = Pose::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.0);
    Convex::rectangle(middle, [0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0])]).expect("a box")
}
