//! Robots that fail, and what becomes of those who follow them: they are grafted, promoted, placed anew, or wait.
//!
//! Nobody waits for ever: who finds no leader tries again at intervals, and after a while stays where it is.

use super::hand_over::{self, Move, let_stand, set_alone};
use super::trigger::BLOCKED;
use super::{Duty, assignment, check::refused};
use crate::simulation::Simulation;
use formation::SetPointTrajectory;
use formation::column::cartesian;
use formation::lead::AnalyticTrajectory;
use std::f64::consts::PI;
use std::sync::Arc;
use vocabulary::{EventKind, EventRecord, Refusal, Trajectory, math};

/// What becomes of those who follow a robot that fails. Where that cannot be, the next is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Recovery {
    /// They follow its leader, and keep their places.
    Graft,
    /// The nearest takes its place, the nearest of whose followers takes that one's, and so on.
    Promote,
    /// All robots of the formation take the places that are left.
    Assign,
    /// They wait.
    Wait,
}

/// A robot that waits for a leader.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wait {
    /// Since when, s.
    since: f64,
    /// When it tried last, s.
    tried: f64,
    lost: Lost,
}

/// The place of a robot that has failed.
#[derive(Debug, Clone, Copy)]
struct Lost {
    /// Whom it followed, or who leads in its place.
    leader: usize,
    /// Where it was to be, [forward, left] of that leader in m.
    place: [f64; 2],
    /// Whether it led.
    led: bool,
}

/// A robot fails.
pub(super) fn fail(run: &mut Simulation, robot: usize, kind: EventKind, recovery: Recovery, time: f64) {
    let done = EventRecord::done(kind, robot, None);
    if matches!(run.events.duties[robot], Duty::Failed { .. }) {
        run.events.tell(EventRecord { refusal: Refusal::Failed, ..done });
        return;
    }
    let graph = run.formation.graph();
    let followers: Vec<usize> = graph.followers_of(robot).collect();
    let led = graph.edge_of(robot).map(|edge| (edge, run.formation.edges()[edge].leader));
    let above = led.map(|(edge, leader)| Lost { leader, place: place_of(run, edge, time), led: false });
    let motion = run.formation.leads().iter().find(|(lead, _)| *lead == robot);
    let motion = motion.map(|(_, motion)| motion.clone());
    let head = graph.head_of(robot);

    let now = run.plant.world().snapshot().robots[robot].motion;
    let curvature = if now.speed > 0.01 { now.turn_rate / now.speed } else { 0.0 };
    run.events.duties[robot] = Duty::Failed { kind, curvature };
    stand(run, robot);
    run.plant.world_mut().fail(robot, kind == EventKind::Remove);
    run.events.tell(done);

    match (above, motion) {
        (Some(lost), _) if recovery == Recovery::Assign => {
            assignment::close_ranks(run, head, robot, lost.place, lost.leader, time)
                .unwrap_or_else(|| recover(run, &followers, lost, Recovery::Graft, time));
        }
        (Some(lost), _) => recover(run, &followers, lost, recovery, time),
        (None, Some(motion)) => succeed(run, robot, &followers, motion, recovery, time),
        (None, None) => {}
    }
}

/// The nearest of the followers of a lead robot that has failed leads in its place, and the others keep their places.
fn succeed(
    run: &mut Simulation,
    failed: usize,
    followers: &[usize],
    motion: Arc<dyn Trajectory>,
    recovery: Recovery,
    time: f64,
) {
    let robots = &run.plant.world().snapshot().robots;
    let place = robots[failed].motion.pose;
    let away = |robot: &usize| {
        let pose = robots[*robot].motion.pose;
        math::hypot(pose.x - place.x, pose.y - place.y)
    };
    let able = |robot: &usize| run.events.drives(*robot) && !run.fleet.has_several_leaders(*robot);
    let able = followers.iter().copied().filter(able);
    let Some(next) = able.min_by(|a, b| away(a).total_cmp(&away(b))) else {
        // Whoever has another leader beside it keeps no place by that one alone.
        recover(run, followers, Lost { leader: failed, place: [0.0; 2], led: true }, Recovery::Wait, time);
        return;
    };
    let slot = run.formation.graph().slot_of(next);
    let [x, y] = slot.map_or([0.0; 2], |edge| place_of(run, edge, time));
    hand_over::lead(run, next, motion, time);
    let others: Vec<usize> = followers.iter().copied().filter(|robot| *robot != next).collect();
    // Places stay where they are beside the new lead robot; nobody moves up to one that leads.
    let recovery = if recovery == Recovery::Wait { recovery } else { Recovery::Graft };
    recover(run, &others, Lost { leader: next, place: [-x, -y], led: true }, recovery, time);
}

/// Those who followed the robot at `lost` follow somebody else, or wait.
fn recover(run: &mut Simulation, followers: &[usize], lost: Lost, recovery: Recovery, time: f64) {
    let followers: Vec<usize> = followers.iter().copied().filter(|robot| run.events.drives(*robot)).collect();
    // Who keeps its place by several leaders has it by none of them alone.
    let (several, mut left): (Vec<_>, Vec<_>) =
        followers.into_iter().partition(|robot| run.fleet.has_several_leaders(*robot));
    let mut moves = vec![];
    if recovery == Recovery::Graft {
        left.retain(|robot| match graft(run, *robot, lost, time) {
            Ok(step) => {
                moves.push(step);
                false
            }
            Err(refused) => {
                run.events.tell(refused);
                true
            }
        });
    }
    // Nobody moves up to the place of a robot that leads.
    if recovery != Recovery::Wait && !left.is_empty() && !lost.led {
        match promote(run, &left, lost) {
            Ok(chain) => {
                moves.extend(chain);
                left.clear();
            }
            Err(refused) => run.events.tell(refused),
        }
    }
    if recovery != Recovery::Wait {
        left.retain(|robot| match draw_in(run, *robot, lost, &moves, time) {
            Some(step) => {
                moves.push(step);
                false
            }
            None => true,
        });
    }
    if !moves.is_empty() {
        hand_over::begin(run, moves, time);
    }
    for robot in several.into_iter().chain(left) {
        run.events.duties[robot] = Duty::Waits(Wait { since: time, tried: time, lost });
        stand(run, robot);
        run.events.tell(EventRecord::done(EventKind::Wait, robot, None));
    }
}

/// A follower of the robot at `lost` follows that one's leader, and keeps its place.
fn graft(run: &Simulation, robot: usize, lost: Lost, time: f64) -> Result<Move, EventRecord> {
    let nothing = EventRecord::done(EventKind::Follow, robot, Some(lost.leader));
    let nothing = EventRecord { refusal: Refusal::Nothing, ..nothing };
    let edge = run.formation.graph().slot_of(robot).ok_or(nothing)?;
    let own = place_of(run, edge, time);
    let place = polar([lost.place[0] + own[0], lost.place[1] + own[1]]);
    if let Some(refused) = refused(run, robot, lost.leader, Some(place)) {
        return Err(refused);
    }
    let place = SetPointTrajectory::constant(place[0], place[1]);
    Ok(Move { edge, leader: lost.leader, place: Some(place), estimate: None })
}

/// A follower that cannot keep its place takes the nearest one that its new leader can be followed from, if nobody else has
/// it.
fn draw_in(run: &Simulation, robot: usize, lost: Lost, moves: &[Move], time: f64) -> Option<Move> {
    let edge = run.formation.graph().slot_of(robot)?;
    let own = place_of(run, edge, time);
    let [distance, bearing] = polar([lost.place[0] + own[0], lost.place[1] + own[1]]);
    let rules = &run.events.plan.hand_over;
    let least = PI - rules.bearing_max;
    let side = if bearing < 0.0 { -1.0 } else { 1.0 };
    let place = [distance.clamp(rules.distance[0], rules.distance[1]), side * bearing.abs().max(least)];
    let [x, y] = cartesian(place);
    let followers = run.formation.graph().followers_of(lost.leader).filter(|other| *other != robot);
    let places = followers.filter_map(|other| {
        let edge = run.formation.graph().edge_of(other)?;
        Some((other, place_of(run, edge, time)))
    });
    let planned = moves.iter().filter(|step| step.leader == lost.leader).filter_map(|step| {
        let follower = run.formation.edges()[step.edge].follower;
        Some((follower, cartesian(step.place.as_ref()?.at(time).value)))
    });
    let radius = |robot: usize| run.fleet.robots[robot].body.radius();
    let taken = places.chain(planned).any(|(other, [ox, oy])| {
        math::hypot(x - ox, y - oy) < PLACES_APART * (radius(robot) + radius(other))
    });
    if taken || refused(run, robot, lost.leader, Some(place)).is_some() {
        return None;
    }
    let place = SetPointTrajectory::constant(place[0], place[1]);
    Some(Move { edge, leader: lost.leader, place: Some(place), estimate: None })
}

/// Places are at least so many times as far from each other as bodies that touch.
const PLACES_APART: f64 = 1.5;

/// The nearest of the followers takes the place at `lost`, the nearest of its followers takes its place, and so on;
/// all others keep theirs behind whoever is in front of them.
fn promote(run: &Simulation, followers: &[usize], lost: Lost) -> Result<Vec<Move>, EventRecord> {
    let graph = run.formation.graph();
    let robots = &run.plant.world().snapshot().robots;
    let at = robots[lost.leader].motion.pose.world_from_body(lost.place[0], lost.place[1]);
    let away = |robot: &usize, [x, y]: [f64; 2]| {
        let pose = robots[*robot].motion.pose;
        math::hypot(pose.x - x, pose.y - y)
    };
    let polar_place = polar(lost.place);
    let (mut leader, mut at) = (lost.leader, at);
    let mut place = SetPointTrajectory::constant(polar_place[0], polar_place[1]);
    let mut behind = followers.to_vec();
    let mut moves = vec![];
    while let Some(next) = behind.iter().copied().min_by(|a, b| away(a, at).total_cmp(&away(b, at))) {
        let Some(edge) = graph.slot_of(next) else { break };
        if moves.is_empty()
            && let Some(refused) = refused(run, next, leader, Some(polar_place))
        {
            return Err(refused);
        }
        let pose = robots[next].motion.pose;
        for other in behind.iter().copied().filter(|other| *other != next) {
            if let Some(edge) = graph.slot_of(other) {
                let own = run.formation.laws()[edge].set_point.clone();
                moves.push(Move { edge, leader: next, place: Some(own), estimate: None });
            }
        }
        moves.push(Move { edge, leader, place: Some(place), estimate: None });
        place = run.formation.laws()[edge].set_point.clone();
        (leader, at) = (next, [pose.x, pose.y]);
        // Who has several leaders follows those as before, wherever they go.
        let moves_up = |robot: &usize| run.events.drives(*robot) && !run.fleet.has_several_leaders(*robot);
        behind = graph.followers_of(next).filter(moves_up).collect();
    }
    Ok(moves)
}

/// Robots that wait try to follow again when it is time; those that have waited long enough stay where they are.
pub(super) fn retry(run: &mut Simulation, time: f64) {
    let rules = run.events.plan.hand_over;
    for robot in 0..run.events.duties.len() {
        let Duty::Waits(wait) = run.events.duties[robot] else { continue };
        if time - wait.since > rules.patience {
            run.events.duties[robot] = Duty::Stays;
            run.events.tell(EventRecord::done(EventKind::GiveUp, robot, None));
        } else if time - wait.tried >= rules.retry - 1e-9 && !run.fleet.has_several_leaders(robot) {
            run.events.duties[robot] = Duty::Waits(Wait { tried: time, ..wait });
            // It tells nothing new where it is refused again.
            let found = graft(run, robot, wait.lost, time).map(|step| vec![step]).ok();
            let up = || promote(run, &[robot], wait.lost).ok().filter(|_| !wait.lost.led);
            let near = || draw_in(run, robot, wait.lost, &[], time).map(|step| vec![step]);
            if let Some(moves) = found.or_else(up).or_else(near) {
                hand_over::begin(run, moves, time);
            }
        }
    }
}

/// Followers that have been held up for longer than `patience` s stay where they are, and those behind them go on without.
pub(super) fn leave_behind(run: &mut Simulation, patience: f64, time: f64) {
    let robots = &run.plant.world().snapshot().robots;
    let speed = |robot: usize| robots[robot].motion.speed.abs();
    let mut left = vec![];
    for robot in 0..robots.len() {
        let graph = run.formation.graph();
        let mut leaders = graph.edges_of(robot).iter().map(|edge| run.formation.edges()[*edge].leader);
        let drives = leaders.any(|leader| speed(leader) > BLOCKED[1]);
        let held = drives && speed(robot) < BLOCKED[0];
        let since = &mut run.events.held_up[robot];
        if !held {
            *since = None;
        } else if time - *since.get_or_insert(time) > patience {
            left.push(robot);
        }
    }
    for robot in left {
        give_up(run, robot, time);
    }
}

/// A follower stays where it is for good; those who follow it follow its leader, and keep their places if they can.
fn give_up(run: &mut Simulation, robot: usize, time: f64) {
    let graph = run.formation.graph();
    let followers: Vec<usize> = graph.followers_of(robot).collect();
    let Some(edge) = graph.edge_of(robot) else { return };
    let leader = run.formation.edges()[edge].leader;
    let lost = Lost { leader, place: place_of(run, edge, time), led: false };
    run.events.duties[robot] = Duty::Stays;
    stand(run, robot);
    run.events.tell(EventRecord::done(EventKind::GiveUp, robot, None));
    recover(run, &followers, lost, Recovery::Graft, time);
}

/// A robot stands from now on, as fast as it can come to it, and follows nobody.
fn stand(run: &mut Simulation, robot: usize) {
    set_alone(run, robot, Arc::new(AnalyticTrajectory::constant(0.0, 0.0)));
    let_stand(run, robot);
}

/// Where the follower of an edge is to be, [forward, left] of its leader in m.
pub(super) fn place_of(run: &Simulation, edge: usize, time: f64) -> [f64; 2] {
    cartesian(run.formation.laws()[edge].set_point.at(time).value)
}

/// [distance, bearing] of a place, m and rad.
pub(super) fn polar([x, y]: [f64; 2]) -> [f64; 2] {
    [math::hypot(x, y), math::atan2(y, x)]
}
