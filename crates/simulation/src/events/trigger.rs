//! When events happen.

use crate::simulation::Simulation;
use perception::proximity::gap_to;
use vocabulary::{EntityId, TrackingState, math};

/// When an event happens: once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trigger {
    /// At the first control sample at or after this, s.
    At(f64),
    /// Once something holds of a robot.
    When {
        /// The robot.
        robot: usize,
        /// What.
        holds: Holds,
    },
}

/// What has to hold of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Holds {
    /// Its pose is within a distance of a place, m.
    Reaches {
        /// [x, y], m.
        place: [f64; 2],
        /// m.
        within: f64,
    },
    /// Something is nearer than this to the circle around its body, m.
    ClearanceBelow(f64),
    /// It has not known where its leader is for this long, s.
    LostFor(f64),
    /// It has stood for this long while its leader drove, s.
    BlockedFor(f64),
}

/// A trigger as it is watched.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Watch {
    /// Since when what has to hold for a time has held, s.
    since: Option<f64>,
    happened: bool,
}

/// A robot slower than the first stands, a leader faster than the second drives, m/s.
pub(super) const BLOCKED: [f64; 2] = [0.02, 0.1];

/// Whether event number `index` happens now.
pub(crate) fn fires(run: &mut Simulation, index: usize, trigger: &Trigger, time: f64) -> bool {
    if run.events.watches[index].happened {
        return false;
    }
    let (holds, after) = match *trigger {
        Trigger::At(at) => (run.sample >= crate::parameters::sample_at(at, run.period), 0.0),
        Trigger::When { robot, holds } => (now(run, robot, &holds), wait(&holds)),
    };
    let watch = &mut run.events.watches[index];
    if !holds {
        watch.since = None;
        return false;
    }
    let since = *watch.since.get_or_insert(time);
    watch.happened = time - since >= after - 1e-9;
    watch.happened
}

/// For how long it has to hold, s.
fn wait(holds: &Holds) -> f64 {
    match *holds {
        Holds::LostFor(time) | Holds::BlockedFor(time) => time,
        Holds::Reaches { .. } | Holds::ClearanceBelow(_) => 0.0,
    }
}

fn now(run: &Simulation, robot: usize, holds: &Holds) -> bool {
    let snapshot = run.plant.world().snapshot();
    let motion = &snapshot.robots[robot].motion;
    match *holds {
        Holds::Reaches { place: [x, y], within } => {
            math::hypot(motion.pose.x - x, motion.pose.y - y) <= within
        }
        Holds::ClearanceBelow(below) => clearance(run, robot).is_some_and(|clearance| clearance < below),
        Holds::LostFor(_) => run.formation.graph().edges_of(robot).iter().any(|edge| {
            matches!(run.observations[*edge].sight, TrackingState::Lost | TrackingState::Waiting)
        }),
        Holds::BlockedFor(_) => run.formation.graph().edges_of(robot).iter().any(|edge| {
            let leader = run.formation.edges()[*edge].leader;
            let drives = snapshot.robots[leader].motion.speed > BLOCKED[1];
            drives && motion.speed.abs() < BLOCKED[0]
        }),
    }
}

/// Room between the circle around a robot's body and what is nearest, m: other robots by their circles, props by their
/// outlines.
fn clearance(run: &Simulation, robot: usize) -> Option<f64> {
    let snapshot = run.plant.world().snapshot();
    let middle = |index: usize| {
        let body = &run.fleet.robots[index].body;
        (snapshot.robots[index].motion.pose.world_from_body(0.5 * body.wheelbase, 0.0), body.radius())
    };
    let ([x, y], radius) = middle(robot);
    let others = (0..snapshot.robots.len())
        .filter(|other| *other != robot && snapshot.robots[*other].is_present())
        .map(|other| {
            let ([ox, oy], size) = middle(other);
            math::hypot(ox - x, oy - y) - size
        });
    let height = snapshot.robots[robot].attitude.height + 0.5 * run.fleet.robots[robot].body.height;
    let props = run.fleet.props.iter().zip(&snapshot.props);
    let props = props.filter_map(|(prop, placement)| Some(gap_to(&prop.solid, placement, [x, y], height)?.1));
    others.chain(props).min_by(f64::total_cmp).map(|gap| gap - radius)
}

/// What is nearest to the segment between two robots and hides one from the other.
pub(super) fn hidden(run: &Simulation, follower: usize, leader: usize) -> Option<EntityId> {
    let snapshot = run.plant.world().snapshot();
    let scenery = perception::sensors::Scenery {
        robots: &run.fleet.robots,
        props: &run.fleet.props,
        terrain: run.fleet.terrain.as_deref(),
    };
    let camera = run.fleet.robots[follower].camera_mount.world_from_camera(&snapshot.robots[follower]);
    let body = &run.fleet.robots[leader].body;
    let middle = [0.5 * body.wheelbase, 0.0, body.height];
    let to = snapshot.robots[leader].world_from_body().apply(middle);
    scenery.hides(snapshot, [follower, leader], camera.translation, to)
}
