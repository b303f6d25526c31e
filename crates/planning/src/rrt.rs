//! RRT*, to compare with: the same bodies, places and shots, but nodes drawn at random.
//!
//! S. Karaman and E. Frazzoli, *Sampling-based algorithms for optimal motion planning*, International Journal of Robotics Research
//! 30 (2011). A node is a pose of the lead, at which it drives straight on, and a level. What followers' headings remember
//! depends on the way to a node, so that only nodes are rewired from which no way goes on.

use crate::convex::apart;
use crate::leg::{KnotList, Leg};
use crate::mission::PlanRequest;
use crate::plan::MotionPlan;
use crate::primitive::Primitives;
use crate::search::{cost_of, join, with_levels};
use crate::shot::{ShotStart, Turning, shot};
use crate::trailing::{Convoy, Sweep, Trailing};
use crate::trial::Draws;
use vocabulary::{Pose, math, wrap};

/// How RRT* goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RrtEffort {
    /// Poses that are drawn.
    pub samples: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Farthest from a node to the next, m.
    pub reach: f64,
    /// Nodes that are tried as parents.
    pub parents: usize,
    /// Of so many draws one is the goal.
    pub goal_every: usize,
}

impl Default for RrtEffort {
    fn default() -> Self {
        Self { samples: 3000, seed: 1, reach: 8.0, parents: 8, goal_every: 20 }
    }
}

struct TreeNode {
    pose: Pose,
    level: usize,
    cost: f64,
    parent: usize,
    children: usize,
    leg: Option<Leg>,
    convoy: Convoy,
}

struct RandomTree<'a> {
    request: &'a PlanRequest<'a>,
    trailing: &'a Trailing,
    sweep: Sweep<'a>,
    largest: Vec<f64>,
    nodes: Vec<TreeNode>,
}

/// Headings that are drawn are off the line from the nearest node by up to this, rad: few others can be reached.
const AWRY: f64 = 0.8;
/// Weight of headings in the choice of near nodes, m per rad.
const HEADING: f64 = 2.0;

/// The best way that RRT* finds, not smoothed; `None` where it finds none.
pub fn rrt_star(request: &PlanRequest<'_>, effort: &RrtEffort) -> Option<MotionPlan> {
    request.mission.check(request.model, &request.limits).ok()?;
    let trailing = Trailing::new(request.model, &request.limits);
    let start = request.mission.start;
    let primitives = Primitives::new(trailing.largest(), request.limits.sharpness, request.effort.step, 0.0);
    let mut tree = RandomTree {
        request,
        trailing: &trailing,
        sweep: Sweep::new(request.map, &trailing, &request.limits),
        largest: primitives.largest,
        nodes: vec![],
    };
    let convoy = trailing.steady(start.pose, 0.0, start.level.round());
    tree.sweep.begin(&convoy).ok()?;
    let root = TreeNode {
        pose: start.pose,
        level: start.level.round() as usize,
        cost: 0.0,
        parent: 0,
        children: 0,
        leg: None,
        convoy,
    };
    tree.nodes.push(root);
    let mut draws = Draws::new(effort.seed);
    let mut best: Option<usize> = None;
    for sample in 0..effort.samples {
        let at_goal = (sample + 1).is_multiple_of(effort.goal_every);
        let (pose, level) = tree.draw(&mut draws, at_goal);
        let Some(added) = tree.extend(pose, level, effort, at_goal) else { continue };
        let is_best = best.is_none_or(|best| tree.nodes[added].cost < tree.nodes[best].cost);
        if at_goal && is_best {
            best = Some(added);
        }
    }
    let mut plan = MotionPlan::along(request, &trailing, tree.legs(best?));
    plan.expansions = effort.samples;
    Some(plan)
}

impl RandomTree<'_> {
    fn draw(&self, draws: &mut Draws, at_goal: bool) -> (Pose, usize) {
        let (goal, ground) = (self.request.mission.goal, self.request.map.ground());
        let heading = draws.between(-AWRY, AWRY);
        let any =
            (draws.between(0.0, self.trailing.levels() as f64) as usize).min(self.trailing.levels() - 1);
        if at_goal {
            return (goal.pose(0.0), goal.level.unwrap_or(any));
        }
        let ([x, y], reach) = (ground.centre(), ground.reach());
        let at = [x, y].map(|middle| draws.between(middle - reach, middle + reach));
        (Pose::new(at[0], at[1], heading), any)
    }

    fn distance(&self, node: usize, pose: Pose) -> f64 {
        let from = self.nodes[node].pose;
        apart([from.x, from.y], [pose.x, pose.y]) + HEADING * wrap(pose.heading - from.heading).abs()
    }

    /// Adds a node towards a pose, from the best of its near parents; exactly there, if asked for.
    fn extend(&mut self, pose: Pose, level: usize, effort: &RrtEffort, exactly: bool) -> Option<usize> {
        let mut near: Vec<usize> = (0..self.nodes.len()).collect();
        near.sort_by(|a, b| self.distance(*a, pose).total_cmp(&self.distance(*b, pose)).then(a.cmp(b)));
        near.truncate(effort.parents);
        let first = self.nodes[*near.first()?].pose;
        let far = apart([first.x, first.y], [pose.x, pose.y]);
        let share = if exactly { 1.0 } else { (effort.reach / far).min(1.0) };
        let mix = |a: f64, b: f64| a + share * (b - a);
        let line = math::atan2(pose.y - first.y, pose.x - first.x);
        let heading = if exactly { pose.heading } else { line + pose.heading };
        let pose = Pose { x: mix(first.x, pose.x), y: mix(first.y, pose.y), heading };
        let edges = near.iter().filter_map(|parent| self.edge(*parent, pose, level));
        let edges: Vec<_> = edges.collect();
        let mut best: Option<TreeNode> = None;
        for edge in edges {
            if best.as_ref().is_none_or(|best| edge.cost < best.cost)
                && let Some(convoy) = self.swept(&edge)
            {
                best = Some(TreeNode { convoy, ..edge });
            }
        }
        let node = best?;
        let added = self.nodes.len();
        self.nodes[node.parent].children += 1;
        self.nodes.push(node);
        self.rewire(added, &near);
        Some(added)
    }

    /// A node by a shot from a parent, not swept yet: of early and late levels the cheaper.
    fn edge(&self, parent: usize, pose: Pose, level: usize) -> Option<TreeNode> {
        let from = &self.nodes[parent];
        let (low, high) = (from.level.min(level), from.level.max(level));
        let curvature = self.largest[low..=high].iter().copied().fold(f64::INFINITY, f64::min);
        let turning = Turning { curvature, sharpness: self.request.limits.sharpness };
        let list = shot(ShotStart { pose: from.pose, curvature: 0.0 }, pose, turning)?;
        let lists =
            with_levels(&list, [from.level, level].map(|level| level as f64), self.request.effort.step);
        let legs = lists.into_iter().map(|KnotList(knots)| Leg { start: from.pose, backwards: false, knots });
        let cost =
            |leg: &Leg| cost_of(std::slice::from_ref(leg), self.trailing.levels(), &self.request.costs);
        let leg = legs.min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
        let cost = from.cost + cost(&leg);
        Some(TreeNode {
            pose: leg.end(),
            level,
            cost,
            parent,
            children: 0,
            leg: Some(leg),
            convoy: from.convoy.clone(),
        })
    }

    /// Where the convoy of a node's parent is after its leg, if that is clear.
    fn swept(&mut self, node: &TreeNode) -> Option<Convoy> {
        let mut convoy = node.convoy.clone();
        self.sweep.resume();
        self.sweep.leg(&mut convoy, node.leg.as_ref()?).ok()?;
        Some(convoy)
    }

    /// Leads near leaves over a new node where that is cheaper.
    fn rewire(&mut self, through: usize, near: &[usize]) {
        for &leaf in near {
            if self.nodes[leaf].children > 0
                || self.nodes[leaf].leg.is_none()
                || leaf == self.nodes[through].parent
            {
                continue;
            }
            let (pose, level) = (self.nodes[leaf].pose, self.nodes[leaf].level);
            let Some(edge) = self.edge(through, pose, level).filter(|edge| edge.cost < self.nodes[leaf].cost)
            else {
                continue;
            };
            if let Some(convoy) = self.swept(&edge) {
                let before = self.nodes[leaf].parent;
                self.nodes[before].children -= 1;
                self.nodes[through].children += 1;
                self.nodes[leaf] = TreeNode { convoy, ..edge };
            }
        }
    }

    fn legs(&self, node: usize) -> Vec<Leg> {
        let mut chain = vec![];
        let mut at = node;
        while let Some(leg) = &self.nodes[at].leg {
            chain.push(leg.clone());
            at = self.nodes[at].parent;
        }
        let mut legs = vec![];
        for leg in chain.into_iter().rev() {
            join(&mut legs, leg);
        }
        legs
    }
}
