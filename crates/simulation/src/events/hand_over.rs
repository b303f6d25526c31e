//! Changes of leader: what is decided, the time in which a new observer settles, and what takes hold.

use super::{Duty, check::refused};
use crate::simulation::Simulation;
use formation::{EdgeLaw, Estimate, HandOver, Observer, SetPointTrajectory};
use std::sync::Arc;
use vocabulary::{Edge, EventKind, EventRecord, Limits, Observation, Refusal, Relative, Trajectory};

/// A robot that is about to follow another.
#[derive(Debug, Clone)]
pub(crate) struct Move {
    /// Number of its edge.
    pub(crate) edge: usize,
    /// Whom it is to follow.
    pub(crate) leader: usize,
    /// Where; `None` where it keeps the place that it has.
    pub(crate) place: Option<SetPointTrajectory>,
    /// What its new observer believes, where it has one.
    pub(crate) estimate: Option<Estimate>,
}

/// Robots that are about to follow others, together.
#[derive(Debug, Clone)]
struct Pending {
    moves: Vec<Move>,
    /// When they do, s.
    due: f64,
    /// By which event.
    event: Option<usize>,
}

/// All changes of leader that are about to take hold.
#[derive(Debug, Clone, Default)]
pub(crate) struct HandOvers {
    pending: Vec<Pending>,
}

/// A new observer has had its time after this many of its ε, within these bounds in s.
const SETTLES: f64 = 10.0;
const SETTLING: [f64; 2] = [0.1, 1.0];

impl HandOvers {
    /// Everybody who is about to follow another.
    pub(crate) fn moves(&mut self) -> impl Iterator<Item = &mut Move> {
        self.pending.iter_mut().flat_map(|pending| &mut pending.moves)
    }
}

/// Robot `robot` shall follow `leader`.
pub(super) fn follow(
    run: &mut Simulation,
    robot: usize,
    leader: usize,
    place: Option<SetPointTrajectory>,
    time: f64,
) {
    let kind = kind(run, robot, leader);
    let wanted = place.as_ref().map(|place| place.at(time).value);
    if let Some(refused) = refused(run, robot, leader, wanted) {
        run.events.tell(EventRecord { kind, ..refused });
        return;
    }
    let Some(edge) = run.formation.graph().slot_of(robot) else {
        let refusal = Refusal::Nothing;
        run.events.tell(EventRecord { refusal, ..EventRecord::done(kind, robot, Some(leader)) });
        return;
    };
    begin(run, vec![Move { edge, leader, place, estimate: None }], time);
}

/// Whether a robot that is to follow `leader` does already, and only moves.
fn kind(run: &Simulation, robot: usize, leader: usize) -> EventKind {
    let follows = run.formation.graph().leader_of(robot) == Some(leader);
    if follows { EventKind::Move } else { EventKind::Follow }
}

/// Lets new observers settle before robots follow others, all of them at once.
pub(super) fn begin(run: &mut Simulation, mut moves: Vec<Move>, time: f64) {
    let mut settling: f64 = 0.0;
    for step in &mut moves {
        let law = &run.formation.laws()[step.edge];
        let observes = law.observes() && law.tracker.is_none();
        step.estimate = observes.then(|| estimate_now(run, step));
        if observes {
            settling = settling.max(settling_time(&law.observer));
        }
    }
    // What is decided last holds.
    let moved: Vec<usize> = moves.iter().map(|step| step.edge).collect();
    overtake(run, &moved);
    let event = run.events.current;
    run.events.hand_overs.pending.push(Pending { moves, due: time + settling, event });
}

/// Changes of leader by these edges do not take hold; where the scene asks for one, that is told.
fn overtake(run: &mut Simulation, edges: &[usize]) {
    let mut told = vec![];
    for pending in &mut run.events.hand_overs.pending {
        let event = pending.event.filter(|event| run.events.plan.events[*event].action.is_follow());
        pending.moves.retain(|step| {
            let stays = !edges.contains(&step.edge);
            if !stays && event.is_some() {
                let follower = run.formation.edges()[step.edge].follower;
                let wanted = EventRecord::done(EventKind::Follow, follower, Some(step.leader));
                told.push(EventRecord { refusal: Refusal::Overtaken, event, ..wanted });
            }
            stays
        });
    }
    for event in told {
        run.events.tell(event);
    }
}

fn settling_time(observer: &Observer) -> f64 {
    let slowest = observer.epsilon[0].max(observer.epsilon[1]);
    (SETTLES * slowest).clamp(SETTLING[0], SETTLING[1])
}

/// Where a robot is relative to the one that it is about to follow.
fn relative(run: &Simulation, step: &Move) -> (Relative, f64) {
    let robots = &run.plant.world().snapshot().robots;
    let Edge { follower, .. } = run.formation.edges()[step.edge];
    let seen = Observation::true_of([&robots[step.leader].motion, &robots[follower].motion]);
    (seen.relative, seen.own_heading)
}

/// How far the heading that a follower holds its bearing against is behind its new leader's own, rad: on a curve a path's
/// heading lags.
fn behind(run: &Simulation, step: &Move) -> f64 {
    let law = &run.formation.laws()[step.edge].law;
    let speed = run.plant.world().snapshot().robots[step.leader].motion.speed;
    let robot = run.formation.edges()[step.edge].follower;
    let known = run.state.memories[step.edge].path_turn_rate(law);
    let turn_rate = known.unwrap_or(run.state.commands[robot].turn_rate);
    law.heading.filter().filter(|_| speed > STANDS).map_or(0.0, |filter| filter.lag * turn_rate / speed)
}

/// A leader slower than this drives no curve, m/s.
const STANDS: f64 = 0.1;

fn estimate_now(run: &Simulation, step: &Move) -> Estimate {
    let law: &EdgeLaw = &run.formation.laws()[step.edge];
    let (relative, own_heading) = relative(run, step);
    Estimate::at(&law.law.heading.output(&relative, own_heading))
}

/// Changes of leader that are due take hold.
pub(super) fn complete(run: &mut Simulation, time: f64) {
    let due = |pending: &Pending| pending.due <= time + 1e-9;
    let all = std::mem::take(&mut run.events.hand_overs.pending);
    let (ready, pending): (Vec<_>, Vec<_>) = all.into_iter().partition(due);
    run.events.hand_overs.pending = pending;
    for pending in ready {
        take_hold(run, pending);
    }
}

fn take_hold(run: &mut Simulation, Pending { moves, event, .. }: Pending) {
    let told = |run: &Simulation, step: &Move, refusal| {
        let robot = run.formation.edges()[step.edge].follower;
        let done = EventRecord::done(kind(run, robot, step.leader), robot, Some(step.leader));
        EventRecord { refusal, event, ..done }
    };
    // Somebody may have failed in the meantime: of those who fail themselves nothing is pending any more.
    let fails = |robot: usize| matches!(run.events.duties[robot], Duty::Failed { .. } | Duty::Stays);
    let (moves, vain): (Vec<_>, Vec<_>) = moves.into_iter().partition(|step| !fails(step.leader));
    for step in vain {
        let refused = told(run, &step, Refusal::Leaderless);
        run.events.tell(refused);
    }
    let place = |step: &Move| {
        step.place.clone().unwrap_or_else(|| {
            let (now, _) = relative(run, step);
            SetPointTrajectory::constant(now.distance, vocabulary::wrap(now.bearing + behind(run, step)))
        })
    };
    let changes: Vec<_> = moves.iter().map(|step| (step.edge, Some((step.leader, place(step))))).collect();
    let done: Vec<_> = moves.iter().map(|step| told(run, step, Refusal::None)).collect();
    if !run.formation.rewire(&changes) {
        for done in done {
            run.events.tell(EventRecord { refusal: Refusal::Cycle, ..done });
        }
        return;
    }
    for (step, done) in moves.iter().zip(done) {
        let robot = run.formation.edges()[step.edge].follower;
        if run.formation.leads().iter().any(|(lead, _)| *lead == robot) {
            run.plant.world_mut().release(robot);
            run.chases.end(robot);
            run.formation.set_lead(robot, None);
        }
        run.events.duties[robot] = Duty::Drives;
        let estimate = step.estimate.unwrap_or_else(|| estimate_now(run, step));
        let hand_over = HandOver::new(run.events.plan.hand_over.way, run.state.commands[robot]);
        let law = &run.formation.laws()[step.edge].law;
        run.state.change_leader(step.edge, law, estimate, hand_over);
        let (now, _) = relative(run, step);
        if let Some(sensing) = &mut run.sensing {
            sensing.change_leader(step.edge, step.leader, now);
        }
        run.events.tell(done);
    }
}

/// Robot `robot` follows nobody from now on, and drives by `motion`.
pub(super) fn lead(run: &mut Simulation, robot: usize, motion: Arc<dyn Trajectory>, time: f64) {
    let done = EventRecord::done(EventKind::Lead, robot, None);
    if matches!(run.events.duties[robot], Duty::Failed { .. } | Duty::Stays) {
        run.events.tell(EventRecord { refusal: Refusal::Failed, ..done });
        return;
    }
    set_alone(run, robot, motion.clone());
    let_stand(run, robot);
    let now = run.plant.world().snapshot().robots[robot].motion;
    let limits = *run.formation.limits(robot);
    run.chases.begin(robot, &now, limits, &run.fleet.robots[robot], motion, time);
    run.events.duties[robot] = Duty::Drives;
    run.events.tell(done);
}

/// A robot has no least speed from now on: it stops where its motion does.
pub(crate) fn let_stand(run: &mut Simulation, robot: usize) {
    run.events.may_stand[robot] = true;
    let limits = Limits { speed_min: 0.0, ..*run.formation.limits(robot) };
    run.formation.set_limits(robot, limits);
    run.handling[robot].limits = limits;
    run.plant.world_mut().apply_parameters(&run.handling);
}

/// A robot follows nobody from now on; those who follow it take `motion` for its own.
pub(super) fn set_alone(run: &mut Simulation, robot: usize, motion: Arc<dyn Trajectory>) {
    let own: Vec<_> = run.formation.graph().edges_of(robot).iter().map(|edge| (*edge, None)).collect();
    if !own.is_empty() {
        // Edges less make no ring.
        let _ = run.formation.rewire(&own);
    }
    if let Some(edge) = run.formation.graph().slot_of(robot) {
        overtake(run, &[edge]);
    }
    run.plant.world_mut().release(robot);
    run.chases.end(robot);
    run.formation.set_lead(robot, Some(motion));
}
