//! One step of a simulation. New here? This is the page to read first.

use crate::fault::{Fault, not_finite};
use crate::parameters::{ParameterSet, wakes};
use crate::plant::Plant;
use crate::record::write_record;
use crate::simulation::Simulation;
use formation::{Estimate, Formation, FormationState};
use vocabulary::{Contact, LawKind, TimeMode};
use world::World;

/// Computes the next control sample into `run.record`; false when the run is over.
pub(crate) fn step(run: &mut Simulation) -> bool {
    if run.sample > run.last_sample || run.stopped || run.fault.is_some() {
        return false;
    }
    // 1. The period between the last sample and this one: robots drive, observers follow.
    if run.sample > 0 {
        advance(run);
    }
    let time = run.sample as f64 * run.period;
    // 2. Scheduled changes of laws, set points and limits take effect.
    let woken = apply_changes(run);
    // 3. The true relative position of every edge.
    perception::observe(run.plant.world().snapshot(), run.formation.edges(), &mut run.observations);
    for edge in woken {
        let (law, seen) = (&run.formation.laws()[edge].law, &run.observations[edge]);
        run.state.estimates[edge] = Estimate::at(&law.heading.output(&seen.relative, seen.own_heading));
    }
    // 4. Followers with sensors know their estimate in its place.
    if let Err(fault) = measure(run, time) {
        run.fault = Some(Fault::CameraRenderer(fault));
        return false;
    }
    // 5. Every law decides on what its follower knows, leaders before followers (eqs 20, 22, 42).
    match &mut run.safety {
        None => run.formation.decide(time, &run.observations, &mut run.state),
        // What is decided is applied as far as it is safe, and places are taken as far as there is room.
        Some(safety) => {
            let snapshot = run.plant.world().snapshot();
            safety.look(&run.formation, time, &run.observations, &mut run.state, snapshot);
            safety.decide(
                &run.formation,
                time,
                &run.observations,
                &mut run.state,
                snapshot,
                run.sensing.as_ref(),
            );
        }
    }
    run.plant.world_mut().apply(&run.state.commands);
    // 6. State and decision are recorded, unless a number in them is not finite.
    std::mem::swap(&mut run.record, &mut run.spare);
    write_record(run, time);
    run.fault = not_finite(&run.record, &run.fleet).map(Fault::NotFinite);
    if run.fault.is_some() {
        std::mem::swap(&mut run.record, &mut run.spare);
        return false;
    }
    run.stopped = run.stop_at_contact && run.record.contacts.iter().any(Contact::of_robot);
    run.sample += 1;
    true
}

/// Applies the parameter sets that are due; returns the edges whose observers begin to run.
fn apply_changes(run: &mut Simulation) -> Vec<usize> {
    let mut woken = vec![];
    while let Some((_, parameters)) = run.changes.pop_front_if(|(sample, _)| *sample <= run.sample) {
        apply(run, &parameters, &mut woken);
    }
    if let Some(parameters) = run.adopted.take() {
        apply(run, &parameters, &mut woken);
    }
    woken
}

fn apply(run: &mut Simulation, parameters: &ParameterSet, woken: &mut Vec<usize>) {
    let pairs = run.formation.laws().iter().zip(&parameters.laws).enumerate();
    woken.extend(pairs.filter(|(_, (before, after))| wakes(before, after)).map(|(edge, _)| edge));
    let limits = parameters.handling.iter().map(|handling| handling.limits).collect();
    run.formation.apply_parameters(parameters.laws.clone(), limits);
    run.plant.apply_parameters(parameters, &run.formation);
    if let Some(safety) = &mut run.safety {
        safety.filters.clone_from(&parameters.filters);
    }
}

/// Followers with sensors take the measurements that are due, and correct their estimates by those that have arrived.
fn measure(run: &mut Simulation, time: f64) -> Result<(), String> {
    let Some(sensing) = &mut run.sensing else { return Ok(()) };
    sensing.measure(&run.formation, run.plant.world(), time, &mut run.frames)?;
    sensing.tell(run.formation.laws(), &mut run.observations, &mut run.state.estimates);
    Ok(())
}

/// Robots drive one period, and observers follow them.
fn advance(run: &mut Simulation) {
    if let Some(sensing) = &mut run.sensing {
        let time = (run.sample - 1) as f64 * run.period;
        sensing.begin(run.plant.world().snapshot(), time, run.period);
    }
    if let Some(safety) = &mut run.safety {
        safety.advance(run.period);
    }
    match &mut run.plant {
        Plant::Held(world) => {
            world.advance(run.period);
            let world: &dyn World = world.as_ref();
            match run.mode {
                TimeMode::Measured => follow_samples(run),
                _ => follow(&run.formation, &mut run.state, world),
            }
            if let Some(sensing) = &mut run.sensing {
                sensing.follow(&run.formation, run.plant.world(), run.period);
            }
        }
        Plant::Continuous(system) => {
            let time = (run.sample - 1) as f64 * run.period;
            system.advance(&run.formation, &mut run.state, time, run.period);
        }
    }
}

/// Observers that see samples only are integrated over the period that has passed.
fn follow_samples(run: &mut Simulation) {
    let world = run.plant.world();
    for (index, edge) in run.formation.edges().iter().enumerate() {
        let law = &run.formation.laws()[index];
        if law.law.kind != LawKind::OutputFeedback || law.tracker.is_some() {
            continue;
        }
        let reference = law.law.heading.reference();
        let mut before = perception::sample(world, *edge, reference, 0.0, None);
        let after = perception::sample(world, *edge, reference, run.period, None);
        before.acceleration = (after.own_speed - before.own_speed) / run.period;
        let estimate = &mut run.state.estimates[index];
        *estimate = law.observer.follow_samples(estimate, &before, &after.relative, run.period);
    }
}

/// Observers that see the plant between samples are integrated along its motion.
fn follow(formation: &Formation, state: &mut FormationState, world: &dyn World) {
    for (index, edge) in formation.edges().iter().enumerate() {
        let law = &formation.laws()[index];
        if law.law.kind == LawKind::OutputFeedback && law.tracker.is_none() {
            let estimate = &mut state.estimates[index];
            let reference = law.law.heading.reference();
            perception::tracks(world, *edge, reference, |track| {
                *estimate = law.observer.follow(estimate, track);
            });
        }
    }
}
