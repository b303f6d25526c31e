//! What is asked of a new leader before a robot follows it.

use super::{Duty, trigger::hidden};
use crate::simulation::Simulation;
use perception::sensors::SensorKind;
use std::f64::consts::PI;
use vocabulary::{EventKind, EventRecord, Refusal, Relative, math, wrap};

/// A leader may be this much farther away than a place may be: a robot that moves up comes from behind.
const COMES_FROM: f64 = 1.5;
/// Room between bodies beside the circles around them, m.
const BODIES_APART: f64 = 0.05;
/// A leader slower than this is on no curve, m/s.
const DRIVES: f64 = 0.1;

/// Whether a robot looks for its leader with a camera, and does not know by other means where it is.
fn sees(run: &Simulation, robot: usize) -> bool {
    let Some(sensing) = &run.sensing else { return false };
    let edge = run.formation.graph().slot_of(robot);
    let sensor = edge.and_then(|edge| sensing.sensor_config.sensors.get(edge));
    sensor.is_some_and(|sensor| matches!(sensor.source, SensorKind::Geometric { .. } | SensorKind::Camera))
}

/// Why `robot` cannot follow `leader` at [distance, bearing] in m and rad, its present place where there is none; `None`
/// where it can.
pub(super) fn refused(
    run: &Simulation,
    robot: usize,
    leader: usize,
    place: Option<[f64; 2]>,
) -> Option<EventRecord> {
    let wanted = EventRecord::done(EventKind::Follow, robot, Some(leader));
    let because = |refusal| Some(EventRecord { refusal, ..wanted });
    let measured = |refusal, measured| Some(EventRecord { refusal, measured, ..wanted });
    let duty = |robot: usize| &run.events.duties[robot];
    if matches!(duty(robot), Duty::Failed { .. } | Duty::Stays) {
        return because(Refusal::Failed);
    }
    let graph = run.formation.graph();
    if run.fleet.has_several_leaders(robot) {
        return because(Refusal::Several);
    }
    if graph.comes_after(leader, robot) {
        return because(Refusal::Cycle);
    }
    let mut idle = (0..run.fleet.robots.len()).filter(|other| !matches!(duty(*other), Duty::Drives));
    if idle.any(|other| graph.comes_after(leader, other)) {
        return because(Refusal::Leaderless);
    }
    let robots = &run.plant.world().snapshot().robots;
    let now = Relative::between(robots[leader].motion.pose, robots[robot].motion.pose);
    let [nearest, farthest] = run.events.plan.hand_over.distance;
    if now.distance > COMES_FROM * farthest {
        return measured(Refusal::Far, [now.distance, COMES_FROM * farthest]);
    }
    let [distance, bearing] = place.unwrap_or([now.distance, now.bearing]);
    let bodies = [robot, leader].map(|robot| run.fleet.robots[robot].body.radius());
    let nearest = nearest.max(bodies[0] + bodies[1] + BODIES_APART);
    if distance < nearest {
        return measured(Refusal::Near, [distance, nearest]);
    }
    if distance > farthest {
        return measured(Refusal::PlaceFar, [distance, farthest]);
    }
    let (off, most) = (wrap(bearing + PI).abs(), run.events.plan.hand_over.bearing_max);
    if off > most {
        return measured(Refusal::Bearing, [off, most]);
    }
    if let Some(thing) = hidden(run, robot, leader).filter(|_| sees(run, robot)) {
        let obstacle = Some(thing).filter(|thing| *thing != vocabulary::EntityId::Ground);
        return Some(EventRecord { refusal: Refusal::Hidden, obstacle, ..wanted });
    }
    let leads = &robots[leader].motion;
    if leads.speed > DRIVES {
        let curvature = leads.turn_rate / leads.speed;
        let (sin, cos) = math::sin_cos(bearing);
        let speed = leads.speed * math::hypot(1.0 - curvature * distance * sin, curvature * distance * cos);
        let most = run.formation.limits(robot).speed_max;
        if speed > most {
            return measured(Refusal::Speed, [speed, most]);
        }
    }
    None
}
