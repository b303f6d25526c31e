//! One step of a simulation. New here? This is the page to read first.

use crate::events::happen;
use crate::fault::{Fault, not_finite};
use crate::goals::navigate;
use crate::parameters::{ParameterSet, wakes};
use crate::plant::Plant;
use crate::record::write_record;
use crate::simulation::Simulation;
use formation::{EdgeLaw, Estimate};
use vocabulary::{Command, Contact, Edge, TimeMode};
use world::World;

/// Computes the next control sample into `run.record`; false when the run is over.
pub(crate) fn step(run: &mut Simulation) -> bool {
    sense(run) && act(run)
}

/// The first half of a step: time goes on to the sample, and followers know what they know there. False when the run is over.
pub(crate) fn sense(run: &mut Simulation) -> bool {
    if run.is_over() {
        return false;
    }
    if run.sensed {
        return true;
    }
    // 1. The period between the last sample and this one: robots drive, observers follow.
    if run.sample > 0 {
        advance(run);
    }
    let time = run.sample as f64 * run.period;
    // 2. Scheduled changes of laws, set points and limits take effect.
    let woken = apply_changes(run);
    // 3. Robots change their leader, fail or join; lead robots with goals plan again.
    happen(run, time);
    navigate(run, time);
    // 4. The true relative position of every edge.
    perception::observe(run.plant.world().snapshot(), run.formation.edges(), &mut run.observations);
    for edge in woken {
        let (law, seen) = (&run.formation.laws()[edge].law, &run.observations[edge]);
        run.state.estimates[edge] = Estimate::at(&law.heading.output(&seen.relative, seen.own_heading));
    }
    // 5. Followers with sensors know their estimate in its place.
    if let Err(fault) = measure(run, time) {
        run.fault = Some(Fault::CameraRenderer(fault));
        return false;
    }
    prepare(run, time);
    run.sensed = true;
    true
}

/// The second half of a step, after [`sense`]: decisions, and the record. False where a fault ends the run.
pub(crate) fn act(run: &mut Simulation) -> bool {
    run.sensed = false;
    let time = run.sample as f64 * run.period;
    // 6. Every law decides on what its follower knows, leaders before followers (eqs 20, 22, 42). Places are taken as far as
    //    there is room, and what is decided is applied as far as it is safe.
    if let Err(fault) = decide(run, time) {
        run.fault = Some(Fault::Law(fault.to_string()));
        return false;
    }
    run.plant.world_mut().apply(&run.state.commands);
    // 7. State and decision are recorded, unless a number in them is not finite.
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

/// Safety filters and those who narrow look round, and memories of laws go on to the sample.
fn prepare(run: &mut Simulation, time: f64) {
    let Simulation { formation, state, observations, plant, safety, .. } = run;
    if let Some(safety) = safety {
        safety.begin();
        safety.look(formation, time, observations, state, plant.world().snapshot());
    }
    formation.prepare(time, observations, state);
}

/// Decides the commands of all robots.
///
/// # Errors
/// [`laws::Fault`] where a law for many followers gives none.
fn decide(run: &mut Simulation, time: f64) -> Result<(), laws::Fault> {
    let Simulation {
        formation,
        state,
        observations,
        plant,
        sensing,
        safety,
        chases,
        events,
        fleet,
        batch,
        ..
    } = run;
    if batch.is_none() && safety.is_none() && chases.is_empty() && events.is_idle() {
        formation.decide(time, observations, state);
        return Ok(());
    }
    let (snapshot, sensing) = (plant.world().snapshot(), sensing.as_ref());
    let filter = &mut |robot: usize, decided: Command| {
        let limits = formation.limits(robot);
        let (wished, master) =
            events.command(robot, &snapshot.robots[robot].motion, limits).unwrap_or_else(|| {
                (chases.command(robot, decided, snapshot, &fleet.robots[robot], limits), true)
            });
        match safety.as_mut().filter(|_| master) {
            Some(safety) => safety.admit(robot, wished, formation, observations, snapshot, sensing),
            None => wished,
        }
    };
    match batch {
        Some(batch) => formation.decide_with(time, observations, state, &mut *batch.law, filter)?,
        None => formation.decide_through(time, observations, state, filter),
    }
    if let Some(safety) = safety {
        safety.end();
    }
    Ok(())
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
    let mut laws = parameters.laws.clone();
    if let Some(batch) = &run.batch {
        batch.mark(run.formation.edges(), &mut laws);
    }
    let pairs = run.formation.laws().iter().zip(&laws).enumerate();
    woken.extend(pairs.filter(|(_, (before, after))| wakes(before, after)).map(|(edge, _)| edge));
    // Who has stood or led since has no least speed.
    for (robot, (now, next)) in run.handling.iter_mut().zip(&parameters.handling).enumerate() {
        now.clone_from(next);
        if run.events.may_stand(robot) {
            now.limits.speed_min = 0.0;
        }
    }
    let limits = run.handling.iter().map(|handling| handling.limits).collect();
    run.formation.apply_parameters(laws, limits);
    run.plant.apply_parameters(&run.handling, &run.formation);
    if let Some(safety) = &mut run.safety {
        safety.filters.clone_from(&parameters.filters);
    }
    run.goals.adopt(&parameters.wishes);
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
    run.chases.advance(run.period);
    match &mut run.plant {
        Plant::Held(world) => {
            world.advance(run.period);
            let world: &dyn World = world.as_ref();
            let measured = run.mode == TimeMode::Measured;
            let Simulation { formation, state, events, period, .. } = run;
            for (index, edge) in formation.edges().iter().enumerate() {
                let law = &formation.laws()[index];
                if law.observes() && law.tracker.is_none() {
                    observe(world, *edge, law, measured.then_some(*period), &mut state.estimates[index]);
                }
            }
            // Those who are about to follow another robot observe it already.
            for step in events.hand_overs().moves() {
                let edge = Edge { leader: step.leader, ..formation.edges()[step.edge] };
                if let Some(estimate) = &mut step.estimate {
                    observe(world, edge, &formation.laws()[step.edge], measured.then_some(*period), estimate);
                }
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

/// Carries an observer on over the period that has passed: along the plant's motion between samples, or, with a `period`,
/// by the samples alone.
fn observe(world: &dyn World, edge: Edge, law: &EdgeLaw, period: Option<f64>, estimate: &mut Estimate) {
    let reference = law.law.heading.reference();
    let Some(period) = period else {
        perception::tracks(world, edge, reference, |track| *estimate = law.observer.follow(estimate, track));
        return;
    };
    let mut before = perception::sample(world, edge, reference, 0.0);
    let after = perception::sample(world, edge, reference, period);
    before.acceleration = (after.own_speed - before.own_speed) / period;
    *estimate = law.observer.follow_samples(estimate, &before, &after.relative, period);
}
