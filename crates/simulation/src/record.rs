//! What a step leaves: the true state beside what was decided on it.

use crate::simulation::Simulation;
use std::f64::consts::PI;
use vocabulary::{EdgeState, Relative, wrap};

/// Fills in the record of the sample at `time` s.
pub(crate) fn write_record(run: &mut Simulation, time: f64) {
    run.record.snapshot.clone_from(run.plant.world().snapshot());
    run.record.snapshot.time = time;
    run.record.contacts.clear();
    run.record.contacts.extend_from_slice(run.plant.world().contacts());
    run.record.frames.clone_from(&run.frames);
    for (index, (edge, out)) in run.formation.edges().iter().zip(&mut run.record.edges).enumerate() {
        let robots = &mut run.record.snapshot.robots;
        let relative = Relative::between(robots[edge.leader].motion.pose, robots[edge.follower].motion.pose);
        let decision = &run.state.decisions[index];
        let wanted = decision.set_point;
        let sensing = run.sensing.as_ref().filter(|_| run.formation.laws()[index].tracker.is_some());
        let (age, pan) = sensing
            .map_or_else(|| (0.0, wrap(relative.view_angle - PI)), |sensing| sensing.age_and_pan(index));
        robots[edge.follower].camera_pan = pan;
        let known = &run.observations[index];
        *out = EdgeState {
            relative,
            seen: known.relative,
            sight: known.sight,
            age,
            set_point: wanted,
            error: [wanted[0] - relative.distance, wrap(wanted[1] - relative.bearing)],
            asked: decision.asked,
            applied: decision.applied,
            rates: decision.rates,
            estimate: run.state.estimates[index].output,
            limited: decision.limited,
            too_close: decision.too_close,
        };
    }
}
