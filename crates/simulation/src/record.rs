//! What a step leaves: the true state beside what was decided on it.

use crate::simulation::Simulation;
use std::f64::consts::PI;
use vocabulary::{EdgeState, EventKind, EventRecord, LawState, Relative, wrap};

/// Fills in the record of the sample at `time` s.
pub(crate) fn write_record(run: &mut Simulation, time: f64) {
    run.record.snapshot.clone_from(run.plant.world().snapshot());
    run.record.snapshot.time = time;
    run.record.contacts.clear();
    run.record.contacts.extend_from_slice(run.plant.world().contacts());
    run.record.frames.clone_from(&run.frames);
    if let Some(safety) = &run.safety {
        safety.told().clone_into(&mut run.record.safety);
    }
    let graph = run.formation.graph();
    run.record.leaders.clear();
    if !run.events.is_idle() {
        run.record.leaders.extend(graph.leaders());
    }
    run.events.told().clone_into(&mut run.record.events);
    run.goals.told.clone_into(&mut run.record.plans);
    run.goals.told.clear();
    record_laws(run);
    let graph = run.formation.graph();
    for (index, (edge, out)) in run.formation.edges().iter().zip(&mut run.record.edges).enumerate() {
        let robots = &mut run.record.snapshot.robots;
        let decision = &run.state.decisions[index];
        let mut wanted = decision.set_point;
        let sensing = run.sensing.as_ref().filter(|_| run.formation.laws()[index].tracker.is_some());
        let known = &run.observations[index];
        let (relative, age, pan) = match sensing {
            // What a follower without a sensor knows is the truth.
            None => (known.relative, 0.0, wrap(known.relative.view_angle - PI)),
            Some(sensing) => {
                let [leader, follower] = [edge.leader, edge.follower].map(|k| robots[k].motion.pose);
                let (age, pan) = sensing.age_and_pan(index);
                (Relative::between(leader, follower), age, pan)
            }
        };
        for (k, at) in [relative.distance, relative.bearing].into_iter().enumerate() {
            if run.formation.laws()[index].free[k] {
                wanted[k] = at;
            }
        }
        // A robot with several leaders looks at the first.
        if graph.edge_of(edge.follower) == Some(index) {
            robots[edge.follower].camera_pan = pan;
        }
        let mut estimate = run.state.estimates[index].output;
        let heading = &run.formation.laws()[index].law.heading;
        if heading.filter().is_some() {
            // As a bearing from the leader's heading, like everything else in a record.
            let output = heading.output(&known.relative, known.own_heading);
            estimate[1] = known.relative.bearing + wrap(estimate[1] - output.bearing);
        }
        *out = EdgeState {
            relative,
            seen: known.relative,
            sight: known.sight,
            age,
            set_point: wanted,
            behind: decision.behind,
            error: [wanted[0] - relative.distance, wrap(wanted[1] - relative.bearing)],
            asked: decision.asked,
            applied: decision.applied,
            rates: decision.rates,
            estimate,
            limited: decision.limited,
            too_close: decision.too_close,
            phase: decision.phase,
            displacement: decision.displacement,
            narrowing: decision.narrowing,
        };
        if !graph.is_in_force(index) {
            *out = not_in_force(out);
        }
    }
}

/// What custom laws carry and show; one that breaks off is an event.
fn record_laws(run: &mut Simulation) {
    let graph = run.formation.graph();
    let mut told = 0;
    for (index, law) in run.formation.laws().iter().enumerate() {
        let follower = graph.edges()[index].follower;
        let asked = law.batch.is_none() && graph.edge_of(follower) == Some(index);
        let Some(custom) = law.custom.as_ref().filter(|_| asked) else {
            continue;
        };
        if run.record.laws.len() == told {
            run.record.laws.push(LawState::default());
        }
        let state = &mut run.record.laws[told];
        custom.record(follower, &run.state.customs[index], state);
        if !state.fault.is_empty() {
            run.record.events.push(EventRecord::done(EventKind::LawFault, follower, None));
        }
        told += 1;
    }
    run.record.laws.truncate(told);
}

/// An edge whose follower follows nobody: nothing is wanted and nothing is told.
fn not_in_force(state: &EdgeState) -> EdgeState {
    let EdgeState { relative, seen, sight, age, .. } = *state;
    let at = [relative.distance, relative.bearing];
    EdgeState { relative, seen, sight, age, set_point: at, estimate: at, ..EdgeState::default() }
}
