//! Hybrid A*: over positions, headings and levels of the formation, with the footprint of all robots.
//!
//! A node is where the lead is, heading, curvature and level, and what the followers' headings remember of the way there. Steps
//! are the [primitives](crate::primitive), over which the level stays, or goes to the next. A step is swept when its node is
//! taken from the queue, not before: most are never taken. Now and then a [shot](crate::shot) tries to end it. The first plan
//! is looked for with the first weight of the estimate, better ones with the second while the effort lasts.
//!
//! The grid by which nodes are told apart lies along the start's pose: who moves and turns a map with all on it moves the plan.
//! D. Dolgov, S. Thrun, M. Montemerlo and J. Diebel, *Path planning for autonomous vehicles in unknown semi-structured
//! environments*, International Journal of Robotics Research 29 (2010).

use crate::convex::apart;
use crate::frame::FixedFrame;
use crate::heuristic::{Heuristic, HeuristicSetup};
use crate::leg::{CurvatureKnot, KnotList, Leg};
use crate::mission::{CostWeights, PlanRequest};
use crate::primitive::Primitives;
use crate::reeds_shepp::shortest_reeds_shepp;
use crate::search_record::SearchRecord;
use crate::shot::{ShotStart, Turning, shot};
use crate::trailing::{Convoy, Sweep, Trailing};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};
use std::f64::consts::TAU;
use std::hash::{BuildHasherDefault, Hasher};
use vocabulary::{Pose, math, wrap};

/// A way that was found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FoundWay {
    pub legs: Vec<Leg>,
    pub cost: f64,
}

/// How a search went.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SearchOutcome {
    pub way: Option<FoundWay>,
    /// Steps that were swept.
    pub expansions: usize,
    /// Why there is no way, if there is none.
    pub ended: Ended,
    /// What it looked at, if asked for.
    pub record: SearchRecord,
}

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ended {
    /// It found a way.
    Found,
    /// The lead's body alone does not get there.
    Unreachable,
    /// Everything was tried.
    Exhausted,
    /// The effort is used up.
    OutOfEffort,
    /// It was told to stop.
    Stopped,
}

#[derive(Debug, Clone, Copy)]
struct SearchNode {
    pose: Pose,
    cost: f64,
    parent: u32,
    /// Where its convoy's memory begins, once its step has been swept.
    memory: u32,
    curvature: u16,
    /// Curvature with which the step to it began.
    begins: u16,
    level: u16,
    backwards: bool,
}

const NOBODY: u32 = u32::MAX;
/// Where the start is in its cell, as a share: straight ways of whole steps must not run along the edges of cells.
const CELL_OFFSET: f64 = 0.4567;
/// The estimate takes the column to be wider by this, for its bends.
const RESERVE: f64 = 1.5;
/// What has no way after half of the effort is searched with a weight larger by this.
const GREEDY: f64 = 2.5;
/// Nodes at most: they are numbered by 32 bits, and take memory.
const NODES_MOST: usize = 8_000_000;
/// Estimates are compared in so many parts of a metre: what differs by rounding only is equal, wherever the map lies.
const GRAINS: f64 = 1_048_576.0;
/// Shots are tried from every one of so many nodes, and from all that are this near, in steps.
const SHOT_EVERY: usize = 6;
const SHOT_NEAR: f64 = 4.0;
/// Shots longer than this times the way left are not tried.
const SHOT_DETOUR: f64 = 1.6;
/// The caller is asked whether to stop after so many steps.
const ASKS_EVERY: usize = 64;

/// Hashes numbers of cells by a multiplication: the standard hash is slower, and its order is never used.
#[derive(Default)]
struct CellHasher(u64);

impl Hasher for CellHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u64(u64::from(*byte));
        }
    }

    fn write_u64(&mut self, value: u64) {
        let mixed = (self.0 ^ value).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 29);
    }
}

type Cells = HashSet<u64, BuildHasherDefault<CellHasher>>;

/// A cost in whole parts of a metre, to compare.
fn grains(cost: f64) -> u64 {
    (cost * GRAINS).round() as u64
}

/// Looks for a way; `stop` is asked now and then, with the number of steps swept.
pub(crate) fn search(
    request: &PlanRequest<'_>,
    trailing: &Trailing,
    stop: &mut dyn FnMut(usize) -> bool,
) -> SearchOutcome {
    let mut lattice = Lattice::new(request, trailing);
    let mut outcome = SearchOutcome {
        way: None,
        expansions: 0,
        ended: Ended::Unreachable,
        record: SearchRecord::default(),
    };
    if lattice.heuristic.left(request.mission.start.pose).is_infinite() {
        return outcome;
    }
    let [first, better] = request.effort.weights;
    let all = request.effort.expansions;
    outcome.ended = lattice.run(first, all / 2, &mut outcome, stop);
    if outcome.ended == Ended::OutOfEffort && outcome.way.is_none() {
        outcome.ended = lattice.run(GREEDY * first, all, &mut outcome, stop);
    }
    if outcome.way.is_some() {
        if outcome.ended != Ended::Stopped {
            lattice.run(better, all, &mut outcome, stop);
        }
        outcome.ended = Ended::Found;
    }
    outcome
}

/// What legs cost.
pub(crate) fn cost_of(legs: &[Leg], levels: usize, costs: &CostWeights) -> f64 {
    let of_level = level_cost(levels, costs);
    let mut cost = 0.0;
    for (k, leg) in legs.iter().enumerate() {
        let per_metre = if leg.backwards { 1.0 + costs.backwards } else { 1.0 };
        for pair in leg.knots.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            cost += (b.way - a.way) * (per_metre + of_level * 0.5 * (a.level + b.level));
            cost +=
                costs.turning * (b.curvature - a.curvature).abs() + costs.change * (b.level - a.level).abs();
        }
        if k > 0 {
            let [before, after] = [&legs[k - 1], leg].map(|leg| leg.backwards);
            cost += if before == after { 0.0 } else { costs.cusp };
            let [last, first] = [legs[k - 1].knots.last(), leg.knots.first()];
            let jump = last.zip(first).map_or(0.0, |(a, b)| (b.curvature - a.curvature).abs());
            cost += costs.turning * jump;
        }
    }
    cost
}

fn level_cost(levels: usize, costs: &CostWeights) -> f64 {
    if levels > 1 { costs.level / (levels - 1) as f64 } else { 0.0 }
}

struct Lattice<'a> {
    request: &'a PlanRequest<'a>,
    primitives: Primitives,
    heuristic: Heuristic,
    frame: FixedFrame,
    sweep: Sweep<'a>,
    nodes: Vec<SearchNode>,
    memory: Vec<f64>,
    open: BinaryHeap<Reverse<[u64; 2]>>,
    closed: Cells,
    convoy: Convoy,
    columns: f64,
}

impl<'a> Lattice<'a> {
    fn new(request: &'a PlanRequest<'a>, trailing: &'a Trailing) -> Self {
        let PlanRequest { map, model, limits, mission, effort, .. } = *request;
        let (start, goal) = (mission.start, mission.goal);
        let primitives = Primitives::new(trailing.largest(), limits.sharpness, effort.step, start.curvature);
        let most = primitives.largest.iter().copied().fold(1e-3, f64::max);
        let setup = HeuristicSetup {
            frame: start.pose,
            goal: goal.pose(start.pose.heading),
            with_heading: goal.heading.is_some(),
            need: model.body(0).core() + map.clearance(),
            column: model.body(0).core() + map.clearance() + RESERVE * trailing.column_half_width(),
            radius: 1.0 / most,
            reverses: limits.reverses,
        };
        let extent = 2.0 * map.ground().reach() + apart(map.ground().centre(), [start.pose.x, start.pose.y]);
        Self {
            request,
            primitives,
            heuristic: Heuristic::new(map, &setup),
            frame: FixedFrame::new(start.pose),
            sweep: Sweep::new(map, trailing, &limits),
            nodes: vec![],
            memory: vec![],
            open: BinaryHeap::new(),
            closed: Cells::default(),
            convoy: trailing.begin(request, start.level),
            columns: (2.0 * extent / effort.cell).ceil() + 2.0,
        }
    }

    /// A search with one weight, of so many steps until the first way.
    fn run(
        &mut self,
        weight: f64,
        limit: usize,
        outcome: &mut SearchOutcome,
        stop: &mut dyn FnMut(usize) -> bool,
    ) -> Ended {
        self.clear();
        self.plant(weight);
        let mut after = 0;
        while let Some(Reverse([estimate, last])) = self.open.pop() {
            if outcome.way.as_ref().is_some_and(|way| estimate >= grains(way.cost)) {
                return Ended::Found;
            }
            let index = (u64::from(NOBODY) - last) as usize;
            let key = self.key(index);
            if self.closed.contains(&key) {
                continue;
            }
            if self.is_spent(outcome, after, limit) {
                return Ended::OutOfEffort;
            }
            if outcome.expansions.is_multiple_of(ASKS_EVERY) && stop(outcome.expansions) {
                return Ended::Stopped;
            }
            outcome.expansions += 1;
            after += usize::from(outcome.way.is_some());
            if self.request.effort.records {
                let pose = self.nodes[index].pose;
                outcome.record.tried.push([pose.x, pose.y]);
            }
            if !self.arrives(index) {
                continue;
            }
            self.closed.insert(key);
            if let Some(way) = self.ends(index, outcome.expansions) {
                let is_better = outcome.way.as_ref().is_none_or(|best| grains(way.cost) < grains(best.cost));
                let aside = if is_better { outcome.way.replace(way) } else { Some(way) };
                if let Some(aside) = aside.filter(|_| self.request.effort.records) {
                    outcome.record.reject(&aside.legs);
                }
            }
            let bound = outcome.way.as_ref().map_or(f64::INFINITY, |way| way.cost);
            self.expand(index, weight, bound);
        }
        Ended::Exhausted
    }

    fn is_spent(&self, outcome: &SearchOutcome, after: usize, limit: usize) -> bool {
        let effort = &self.request.effort;
        let spent = match outcome.way {
            Some(_) => after >= effort.improvement,
            None => outcome.expansions >= limit,
        };
        spent || self.nodes.len() >= NODES_MOST
    }

    fn clear(&mut self) {
        self.nodes.clear();
        self.memory.clear();
        self.open.clear();
        self.closed.clear();
    }

    /// The root.
    fn plant(&mut self, weight: f64) {
        let start = self.request.mission.start;
        let root = SearchNode {
            pose: start.pose,
            cost: 0.0,
            parent: NOBODY,
            memory: NOBODY,
            curvature: self.primitives.number(start.curvature) as u16,
            begins: self.primitives.number(start.curvature) as u16,
            level: start.level.round() as u16,
            backwards: false,
        };
        self.push(root, weight);
    }

    fn push(&mut self, node: SearchNode, weight: f64) {
        let left = self.heuristic.left(node.pose);
        if left.is_finite() {
            let index = self.nodes.len() as u64;
            let estimate = node.cost + weight * left;
            self.nodes.push(node);
            // Of equal estimates the youngest comes first.
            self.open.push(Reverse([grains(estimate), u64::from(NOBODY) - index]));
        }
    }

    /// Number of the cell of a node.
    fn key(&self, index: usize) -> u64 {
        let node = &self.nodes[index];
        let effort = self.request.effort;
        let cell =
            self.frame.inside([node.pose.x, node.pose.y]).map(|x| (x / effort.cell + CELL_OFFSET).floor());
        let turn = self.frame.turn(node.pose.heading).rem_euclid(TAU) / TAU;
        let heading = ((turn * effort.headings as f64 + 0.5) as u64) % effort.headings as u64;
        let place = (cell[1] + 0.5 * self.columns) * self.columns + cell[0] + 0.5 * self.columns;
        let curvature = self.primitives.curvatures[usize::from(node.curvature)];
        let side = if curvature.abs() < 1e-9 { 1 } else { 2 * u64::from(curvature > 0.0) };
        let levels = self.request.model.levels() as u64;
        let rest = (heading * levels + u64::from(node.level)) * 3 + side;
        place.max(0.0) as u64 * (effort.headings as u64 * levels * 3) * 2
            + rest * 2
            + u64::from(node.backwards)
    }

    /// Sweeps the step that leads to a node; afterwards the convoy is there.
    fn arrives(&mut self, index: usize) -> bool {
        let node = self.nodes[index];
        let trailing = self.sweep.trailing();
        if node.parent == NOBODY {
            self.convoy = trailing.begin(self.request, self.level_of(&node));
            if self.sweep.begin(&self.convoy).is_err() {
                return false;
            }
        } else {
            let parent = self.nodes[node.parent as usize];
            self.recall(&parent);
            let levels = [&parent, &node].map(|node| self.level_of(node));
            let steps = self.primitives.from(usize::from(node.begins), node.backwards);
            let Some(step) = steps.iter().find(|step| step.to == usize::from(node.curvature)) else {
                return false;
            };
            self.sweep.resume();
            for piece in step.pieces(parent.pose, levels) {
                if self.sweep.piece(&mut self.convoy, &piece).is_err() {
                    return false;
                }
            }
        }
        self.nodes[index].memory = self.memory.len() as u32;
        trailing.remember(&self.convoy, &mut self.memory);
        true
    }

    /// Level at a node: a start may be between two.
    fn level_of(&self, node: &SearchNode) -> f64 {
        if node.parent == NOBODY { self.request.mission.start.level } else { f64::from(node.level) }
    }

    fn recall(&mut self, node: &SearchNode) {
        let trailing = self.sweep.trailing();
        let from = node.memory as usize;
        let memory = &self.memory[from..from + trailing.memory_size()];
        let level = self.level_of(node);
        trailing.recall(&mut self.convoy, node.pose, level, memory);
    }

    /// All steps from a node.
    fn expand(&mut self, index: usize, weight: f64, bound: f64) {
        let node = self.nodes[index];
        let levels = self.request.model.levels();
        let directions: &[bool] = if self.request.limits.reverses { &[false, true] } else { &[false] };
        let near = [Some(node.level), node.level.checked_sub(1), Some(node.level + 1)];
        for level in near.into_iter().flatten().filter(|level| usize::from(*level) < levels) {
            for &backwards in directions {
                let turns_about = node.parent != NOBODY && node.backwards != backwards;
                for begins in self.steered(&node, turns_about) {
                    let next = SearchNode {
                        parent: index as u32,
                        memory: NOBODY,
                        begins,
                        level,
                        backwards,
                        cost: node.cost + self.cost_of_turning_about(&node, begins, turns_about),
                        ..node
                    };
                    self.push_steps(&node, &next, weight, bound);
                }
            }
        }
    }

    /// Numbers of curvatures with which a step may begin: that of the node, and where the robot stands to turn about any of a few.
    fn steered(&self, node: &SearchNode, turns_about: bool) -> Vec<u16> {
        let mut begins = vec![node.curvature];
        if turns_about {
            let most = self.primitives.largest[usize::from(node.level)];
            let more = [-most, 0.0, most].map(|curvature| self.primitives.number(curvature) as u16);
            begins.extend(more.into_iter().filter(|number| *number != node.curvature));
        }
        begins
    }

    fn cost_of_turning_about(&self, node: &SearchNode, begins: u16, turns_about: bool) -> f64 {
        let [from, to] =
            [node.curvature, begins].map(|number| self.primitives.curvatures[usize::from(number)]);
        let costs = &self.request.costs;
        if turns_about { costs.cusp + costs.turning * (to - from).abs() } else { 0.0 }
    }

    /// Adds the steps from a node that begin as `next` does.
    fn push_steps(&mut self, node: &SearchNode, next: &SearchNode, weight: f64, bound: f64) {
        let PlanRequest { model, costs, map, .. } = *self.request;
        let need = model.body(0).core() + map.clearance();
        let from_level = self.level_of(node);
        let largest = [node.level, next.level].map(|level| self.primitives.largest[usize::from(level)]);
        let most = largest[0].min(largest[1]) * (1.0 + 1e-9);
        let from = self.primitives.curvatures[usize::from(next.begins)].abs();
        let per_metre = 1.0
            + if next.backwards { costs.backwards } else { 0.0 }
            + level_cost(model.levels(), &costs) * 0.5 * (from_level + f64::from(next.level));
        let cost = next.cost
            + self.primitives.step * per_metre
            + costs.change * (f64::from(next.level) - from_level).abs();
        for k in 0..self.primitives.from(usize::from(next.begins), next.backwards).len() {
            let step = &self.primitives.from(usize::from(next.begins), next.backwards)[k];
            let to = self.primitives.curvatures[step.to].abs();
            // A start may be on a sharper curve than its level holds, and leaves it.
            let is_held = from <= most && to <= most || to < from;
            let (pose, cost) = (step.end(node.pose), cost + costs.turning * step.change);
            if is_held && cost < bound && map.distance([pose.x, pose.y]) >= need {
                let curvature = step.to as u16;
                self.push(SearchNode { pose, cost, curvature, ..*next }, weight);
            }
        }
    }

    /// The way through a node, if it is at the goal or a shot from it is clear. The convoy is at the node.
    fn ends(&mut self, index: usize, count: usize) -> Option<FoundWay> {
        let node = self.nodes[index];
        let PlanRequest { model, costs, mission, effort, .. } = *self.request;
        let goal = mission.goal;
        let left = apart([node.pose.x, node.pose.y], goal.position);
        let at_level = goal.level.is_none_or(|level| level as f64 == self.level_of(&node));
        let off = goal.heading.map_or(0.0, |heading| wrap(heading - node.pose.heading).abs());
        let way = |legs: Vec<Leg>| FoundWay { cost: cost_of(&legs, model.levels(), &costs), legs };
        let found = (left <= goal.tolerance && at_level && off <= goal.heading_tolerance)
            .then(|| way(self.legs(index, vec![])));
        if count % SHOT_EVERY != 1 && left > SHOT_NEAR * effort.step {
            return found;
        }
        let shots = self.shots(&node);
        let clear: Vec<_> = shots.into_iter().filter(|legs| self.is_clear(&node, legs)).collect();
        let ways = clear.into_iter().map(|legs| way(self.legs(index, legs)));
        ways.chain(found).fold(None, |best: Option<FoundWay>, way| match best {
            Some(best) if grains(best.cost) <= grains(way.cost) => Some(best),
            _ => Some(way),
        })
    }

    /// Ways straight to the goal from a node.
    fn shots(&self, node: &SearchNode) -> Vec<Vec<Leg>> {
        let PlanRequest { limits, mission, effort, .. } = *self.request;
        let goal = mission.goal;
        let curvature = self.primitives.curvatures[usize::from(node.curvature)];
        let start = ShotStart { pose: node.pose, curvature };
        let level = usize::from(node.level);
        let to_level: Vec<usize> = match goal.level {
            Some(to) => vec![to],
            None if level > 0 => vec![0, level],
            None => vec![level],
        };
        let line = math::atan2(goal.position[1] - node.pose.y, goal.position[0] - node.pose.x);
        let mut found = vec![];
        for to in to_level {
            let (low, high) = (level.min(to), level.max(to));
            let largest = self.primitives.largest[low..=high].iter().copied().fold(f64::INFINITY, f64::min);
            let turning = Turning { curvature: largest, sharpness: limits.sharpness };
            let goal = goal.pose(line);
            let Some(list) = shot(start, goal, turning) else { continue };
            if list.length()
                > SHOT_DETOUR * self.heuristic.around([node.pose.x, node.pose.y]) + 2.0 * effort.step
            {
                continue;
            }
            found.extend(
                with_levels(&list, [self.level_of(node), to as f64], effort.step)
                    .into_iter()
                    .map(|list| vec![Leg { start: node.pose, backwards: false, knots: list.0 }]),
            );
        }
        if limits.reverses && goal.heading.is_some() {
            found.push(self.reversing_shot(node));
        }
        found
    }

    /// Reeds' and Shepp's way: between its parts the robot stands and steers.
    fn reversing_shot(&self, node: &SearchNode) -> Vec<Leg> {
        let goal = self.request.mission.goal.pose(node.pose.heading);
        let radius = 1.0 / self.primitives.largest[usize::from(node.level)].max(1e-3);
        let path = shortest_reeds_shepp(node.pose, goal, radius);
        let mut start = node.pose;
        let parts = path.parts.iter().map(|part| {
            let knot =
                |way: f64| CurvatureKnot { way, curvature: part.turn / radius, level: f64::from(node.level) };
            let knots = vec![knot(0.0), knot(part.length.abs())];
            let leg = Leg { start, backwards: part.length < 0.0, knots };
            start = leg.end();
            leg
        });
        parts.collect()
    }

    /// Whether legs from a node are clear.
    fn is_clear(&mut self, node: &SearchNode, legs: &[Leg]) -> bool {
        self.recall(node);
        self.sweep.resume();
        legs.iter().all(|leg| self.sweep.leg(&mut self.convoy, leg).is_ok())
    }

    /// The legs that lead to a node, and more.
    fn legs(&self, index: usize, more: Vec<Leg>) -> Vec<Leg> {
        let mut chain = vec![];
        let mut at = index as u32;
        while at != NOBODY {
            chain.push(self.nodes[at as usize]);
            at = self.nodes[at as usize].parent;
        }
        chain.reverse();
        let mut legs: Vec<Leg> = vec![];
        for pair in chain.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let begins = self.knot(to.begins, self.level_of(&from));
            let ends = self.knot(to.curvature, self.level_of(&to));
            let goes_on = legs.last().is_some_and(|leg| leg.backwards == to.backwards);
            if !goes_on {
                legs.push(Leg { start: from.pose, backwards: to.backwards, knots: vec![begins] });
            }
            if let Some(leg) = legs.last_mut() {
                let way = leg.length() + self.primitives.step;
                leg.knots.push(CurvatureKnot { way, ..ends });
            }
        }
        for leg in more {
            join(&mut legs, leg);
        }
        if legs.is_empty() {
            legs.push(Leg {
                start: chain[0].pose,
                backwards: false,
                knots: vec![self.knot(chain[0].curvature, self.level_of(&chain[0]))],
            });
        }
        legs
    }

    fn knot(&self, curvature: u16, level: f64) -> CurvatureKnot {
        let curvature = self.primitives.curvatures[usize::from(curvature)];
        CurvatureKnot { way: 0.0, curvature, level }
    }
}

/// Adds a leg to others: to the last of them, where it goes on in its direction with its curvature.
pub(crate) fn join(legs: &mut Vec<Leg>, leg: Leg) {
    let last = legs.last_mut().filter(|last| {
        let curvature = last.knots.last().map(|knot| knot.curvature);
        last.backwards == leg.backwards && curvature == leg.knots.first().map(|knot| knot.curvature)
    });
    match last {
        Some(last) => {
            let way = last.length();
            last.knots
                .extend(leg.knots[1..].iter().map(|knot| CurvatureKnot { way: knot.way + way, ..*knot }));
        }
        None => legs.push(leg),
    }
}

/// A course with the level going from one to another as early as it can, and as late.
pub(crate) fn with_levels(list: &KnotList, [from, to]: [f64; 2], step: f64) -> Vec<KnotList> {
    let ramp = (to - from).abs() * step;
    let length = list.length();
    if ramp > length {
        return vec![];
    }
    let begins: &[f64] = if ramp > 0.0 { &[0.0, length - ramp] } else { &[0.0] };
    let ramps = begins.iter().map(|begin| {
        let mut list = list.clone();
        list.set_levels(&[[*begin, from], [begin + ramp, to]]);
        list
    });
    ramps.collect()
}
