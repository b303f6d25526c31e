//! Robots that take the places of a formation anew, so that together they go the least way.

use super::check::refused;
use super::failure::place_of;
use super::hand_over::{self, Move};
use crate::simulation::Simulation;
use formation::{SetPointTrajectory, assignment::least_way};
use vocabulary::{EventKind, EventRecord, Refusal};

/// A place of a formation.
#[derive(Debug, Clone)]
struct Slot {
    /// The place in front of it, by number; the head itself where there is none.
    front: Option<usize>,
    set_point: SetPointTrajectory,
    /// [forward, left] of the head, m.
    at: [f64; 2],
}

/// All who follow `head`, directly or through others, take their places anew.
pub(super) fn assign(run: &mut Simulation, head: usize, time: f64) {
    let (robots, slots) = formation(run, head, time);
    let done = EventRecord::done(EventKind::Assign, head, None);
    if robots.is_empty() {
        run.events.tell(EventRecord { refusal: Refusal::Nothing, ..done });
        return;
    }
    match moves(run, head, &robots, &slots) {
        Ok(moves) => {
            run.events.tell(done);
            hand_over::begin(run, moves, time);
        }
        Err(refused) => run.events.tell(refused),
    }
}

/// The robots of `head` take the places that are left when one has failed whose place was `place` behind `leader`.
/// `None` where they cannot, after telling why.
pub(super) fn close_ranks(
    run: &mut Simulation,
    head: usize,
    failed: usize,
    place: [f64; 2],
    leader: usize,
    time: f64,
) -> Option<()> {
    // The failed robot follows nobody any more; its place is put back among those that there are.
    let order = ordered(run, head, Some((failed, leader)));
    let slots = slots(run, head, &order, Some((failed, place, leader)), time);
    let robots: Vec<usize> = order.iter().copied().filter(|robot| *robot != failed).collect();
    match moves(run, head, &robots, &slots) {
        Ok(moves) => {
            hand_over::begin(run, moves, time);
            Some(())
        }
        Err(refused) => {
            run.events.tell(refused);
            None
        }
    }
}

/// Robots that follow `head`, those in front first, and their places.
fn formation(run: &Simulation, head: usize, time: f64) -> (Vec<usize>, Vec<Slot>) {
    let order = ordered(run, head, None);
    let slots = slots(run, head, &order, None, time);
    (order, slots)
}

/// Whoever follows `head`, those in front first; `lost` is a robot that has failed, and whom it followed.
fn ordered(run: &Simulation, head: usize, lost: Option<(usize, usize)>) -> Vec<usize> {
    let graph = run.formation.graph();
    let (mut order, mut next) = (vec![], vec![head]);
    while let Some(front) = next.pop() {
        let own: Vec<usize> = graph.followers_of(front).collect();
        let back = lost.filter(|(_, leader)| *leader == front).map(|(failed, _)| failed);
        for robot in own.into_iter().chain(back) {
            order.push(robot);
            next.push(robot);
        }
    }
    order.retain(|robot| run.events.drives(*robot) || lost.is_some_and(|(failed, _)| failed == *robot));
    order
}

fn slots(
    run: &Simulation,
    head: usize,
    order: &[usize],
    lost: Option<(usize, [f64; 2], usize)>,
    time: f64,
) -> Vec<Slot> {
    let mut slots: Vec<Slot> = vec![];
    for robot in order {
        let lost = lost.filter(|(failed, ..)| failed == robot);
        let graph = run.formation.graph();
        let leader = lost.map_or_else(|| graph.leader_of(*robot), |(.., leader)| Some(leader));
        let Some(edge) = graph.slot_of(*robot) else { continue };
        let front = leader.filter(|leader| *leader != head);
        let front = front.and_then(|leader| order.iter().position(|robot| *robot == leader));
        let [x, y] = lost.map_or_else(|| place_of(run, edge, time), |(_, place, _)| place);
        let [fx, fy] = front.and_then(|front| slots.get(front)).map_or([0.0; 2], |slot| slot.at);
        let set_point = run.formation.laws()[edge].set_point.clone();
        slots.push(Slot { front, set_point, at: [fx + x, fy + y] });
    }
    slots
}

/// Who moves so that the places are filled by the least way; where there are more places than robots, of those at the end
/// of the formation that one stays empty without which the way is least.
fn moves(run: &Simulation, head: usize, robots: &[usize], slots: &[Slot]) -> Result<Vec<Move>, EventRecord> {
    if robots.iter().any(|robot| run.fleet.has_several_leaders(*robot)) {
        let refusal = Refusal::Several;
        return Err(EventRecord { refusal, ..EventRecord::done(EventKind::Assign, head, None) });
    }
    let poses = &run.plant.world().snapshot().robots;
    let front = poses[head].motion.pose;
    let places: Vec<[f64; 2]> = robots
        .iter()
        .map(|robot| {
            let pose = poses[*robot].motion.pose;
            front.body_from_world(pose.x, pose.y)
        })
        .collect();
    let last = |slot: &usize| slots.iter().all(|other| other.front != Some(*slot));
    let all: Vec<usize> = (0..slots.len()).collect();
    let candidates: Vec<Vec<usize>> = if slots.len() > robots.len() {
        let without = |empty: usize| all.iter().copied().filter(|slot| *slot != empty).collect();
        all.iter().copied().filter(last).map(without).collect()
    } else {
        vec![all]
    };
    let tried = candidates.into_iter().map(|candidate| {
        let at: Vec<[f64; 2]> = candidate.iter().map(|slot| slots[*slot].at).collect();
        let (way, taken) = least_way(&places, &at);
        (way, taken.into_iter().map(|k| candidate[k]).collect::<Vec<usize>>())
    });
    let Some((_, taken)) = tried.min_by(|a, b| a.0.total_cmp(&b.0)) else { return Ok(vec![]) };
    let who = |slot: usize| taken.iter().position(|other| *other == slot).map(|k| robots[k]);
    let graph = run.formation.graph();
    let mut moves = vec![];
    for (robot, slot) in robots.iter().zip(&taken) {
        let slot = &slots[*slot];
        let leader = slot.front.map_or(Some(head), who);
        let (Some(leader), Some(edge)) = (leader, graph.slot_of(*robot)) else { continue };
        let own = &run.formation.laws()[edge].set_point;
        if graph.leader_of(*robot) == Some(leader) && *own == slot.set_point {
            continue;
        }
        moves.push(Move { edge, leader, place: Some(slot.set_point.clone()), estimate: None });
    }
    // Rings apart, which places taken anew do not make.
    let trouble = moves.iter().find_map(|step| {
        let robot = run.formation.edges()[step.edge].follower;
        let refused = refused(run, robot, step.leader, None)?;
        matches!(refused.refusal, Refusal::Far | Refusal::Failed).then_some(refused)
    });
    trouble.map_or(Ok(moves), Err)
}
