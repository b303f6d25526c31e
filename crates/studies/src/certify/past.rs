//! The quantities of the theorems of a run that is over, or of what is kept of it: from moments alone.

use formation::Estimate;
use formation::certificate::{Circumstances, Instant, StatementFinding, Witness, WitnessRow, certify};
use scene::{Follow, Robot, Role, Scene, SensingKind};
use simulation::edge_law;
use vocabulary::{Edge, Motion, MotionInput, MotionPhase, SetPoint, StepRecord, TimeMode, wrap};

/// What the theorems say of edge number `index` along `records`, so far, and the quantities they speak of.
pub fn so_far(
    records: &[&StepRecord],
    index: usize,
    edge: Edge,
    follow: &Follow,
    scene: &Scene,
) -> (Vec<StatementFinding>, Vec<WitnessRow>) {
    let witness = witness(records, index, edge, follow);
    let wheels = |robot: usize| scene.robots.get(robot).is_some_and(|robot| robot.vehicle.kind.has_wheels());
    let smooth = |robot: &Robot| matches!(robot.role, Role::Lead { .. }) && !robot.safety.acts(true);
    let smooth = scene.robots.get(edge.leader).is_none_or(smooth);
    let held = scene.time.mode != TimeMode::Continuous;
    let first = records.first().map(|record| record.snapshot.time);
    let circumstances = Circumstances {
        held: held.then_some(scene.time.period),
        sampled_measurement: scene.time.mode == TimeMode::Measured,
        custom: follow.law.custom().is_some(),
        measures: follow.sensing.kind != SensingKind::Truth,
        wheels: wheels(edge.leader) || wheels(edge.follower),
        several_leaders: follow.leaders.are_several(),
        // A leader that follows, or has a filter, is told its commands period by period.
        rough_leader: first.filter(|_| held && !smooth),
    };
    (certify(&witness, &circumstances), witness.rows().to_vec())
}

/// The quantities of edge number `index` along `records`, which may be thinned; its law is that of `follow`. Rates of
/// set points and of turn rates are differences from moment to moment.
pub fn rows(records: &[&StepRecord], index: usize, edge: Edge, follow: &Follow) -> Vec<WitnessRow> {
    witness(records, index, edge, follow).rows().to_vec()
}

fn witness(records: &[&StepRecord], index: usize, edge: Edge, follow: &Follow) -> Witness {
    let law = edge_law(follow, &follow.leaders.first, [0.0; 2]);
    let mut witness = Witness::new(law.law, law.observer).keeping();
    let observes = law.observes();
    let mut before: Option<(f64, Motion, [f64; 2])> = None;
    for record in records {
        let robots = &record.snapshot.robots;
        let (Some(state), Some(leader), Some(follower)) =
            (record.edges.get(index), robots.get(edge.leader), robots.get(edge.follower))
        else {
            continue;
        };
        let (time, motion, value) = (record.snapshot.time, leader.motion, state.set_point);
        let (turn_acceleration, moved) = before.map_or((0.0, [0.0; 2]), |(then, last, point)| {
            let step = (time - then).max(1e-9);
            let moved = [value[0] - point[0], wrap(value[1] - point[1])].map(|d| d / step);
            ((motion.turn_rate - last.turn_rate) / step, moved)
        });
        before = Some((time, motion, value));
        let Motion { speed, acceleration, turn_rate, .. } = motion;
        witness.push(&Instant {
            time,
            relative: state.relative,
            follower_speed: follower.motion.speed.max(1e-6),
            leader: MotionInput { speed, acceleration, turn_rate, turn_acceleration },
            set_point: SetPoint { value, rate: moved, acceleration: [0.0; 2] },
            error: state.error,
            estimate: observes.then_some(Estimate { output: state.estimate, rates: state.rates }),
            limited: state.limited && !record.is_filtered(edge.follower),
            diverted: record.is_filtered(edge.follower),
            untold: [0.0; 2],
            at_speed_bound: false,
            stands: state.phase != MotionPhase::Law,
            too_close: state.too_close,
        });
    }
    witness
}
