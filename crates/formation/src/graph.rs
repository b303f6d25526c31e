//! The formation control graph (definition 2.2): named robots and directed edges from leader to follower.

use petgraph::Direction;
use petgraph::algo::{kosaraju_scc, toposort};
use petgraph::graph::{DiGraph, NodeIndex};
use std::collections::HashMap;
use thiserror::Error;
use vocabulary::Edge;

/// Why robots and edges do not make a formation. Every message names the robots.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum GraphError {
    /// No robots at all.
    #[error("a formation needs at least one robot")]
    Empty,
    /// Two robots of one name.
    #[error("two robots are named `{0}`: names must differ")]
    DuplicateName(String),
    /// An edge names a robot that is not there.
    #[error("`{follower}` follows `{leader}`, but there is no robot of that name")]
    UnknownLeader {
        /// The robot that follows.
        follower: String,
        /// The name that was not found.
        leader: String,
    },
    /// An edge from or to nowhere, by follower.
    #[error("an edge leads to `{0}`, but there is no robot of that name")]
    UnknownFollower(String),
    /// A robot follows itself.
    #[error("`{0}` follows itself")]
    SelfEdge(String),
    /// A robot follows another one twice.
    #[error("`{follower}` follows `{leader}` twice: its leaders must differ")]
    Twice {
        /// The robot that follows.
        follower: String,
        /// Its leader.
        leader: String,
    },
    /// Followers lead one another in a ring.
    #[error("these robots follow each other in a ring: {}", .0.join(" → "))]
    Cycle(Vec<String>),
}

/// A checked formation graph: acyclic. Most followers have one leader; some laws look at several.
#[derive(Debug, Clone)]
pub struct Graph {
    robots: usize,
    edges: Vec<Edge>,
    /// The edges by which each robot follows, in the order they were given: all others are not in force.
    edges_of: Vec<Vec<usize>>,
    evaluation_order: Vec<usize>,
}

impl Graph {
    /// Builds the graph of `names` and (leader, follower) pairs of names.
    ///
    /// # Errors
    /// The first [`GraphError`] found.
    pub fn new<S: AsRef<str>>(names: &[S], pairs: &[(S, S)]) -> Result<Self, GraphError> {
        if names.is_empty() {
            return Err(GraphError::Empty);
        }
        let mut graph = DiGraph::with_capacity(names.len(), pairs.len());
        let mut index = HashMap::with_capacity(names.len());
        for name in names.iter().map(AsRef::as_ref) {
            if index.insert(name, graph.add_node(name).index()).is_some() {
                return Err(GraphError::DuplicateName(name.to_owned()));
            }
        }
        let mut edges = Vec::with_capacity(pairs.len());
        for (leader, follower) in pairs {
            let edge = resolve(&graph, &index, leader.as_ref(), follower.as_ref())?;
            graph.add_edge(NodeIndex::new(edge.leader), NodeIndex::new(edge.follower), edges.len());
            edges.push(edge);
        }
        let order =
            toposort(&graph, None).map_err(|cycle| GraphError::Cycle(ring(&graph, cycle.node_id())))?;
        let mut edges_of = vec![vec![]; names.len()];
        for (index, edge) in edges.iter().enumerate() {
            edges_of[edge.follower].push(index);
        }
        let evaluation_order = order.into_iter().flat_map(|node| edges_of[node.index()].clone()).collect();
        Ok(Self { robots: names.len(), edges, edges_of, evaluation_order })
    }

    /// The edges in the order in which they are evaluated, by the depth of their followers: those of one depth do not lead each
    /// other.
    pub fn depths(&self) -> Vec<Vec<usize>> {
        let mut depths = vec![0; self.robots];
        let mut stages: Vec<Vec<usize>> = vec![];
        for own in self.evaluation_order.chunk_by(|a, b| self.edges[*a].follower == self.edges[*b].follower) {
            let depth = own.iter().map(|edge| depths[self.edges[*edge].leader]).max().unwrap_or(0);
            depths[self.edges[own[0]].follower] = depth + 1;
            stages.resize_with(stages.len().max(depth + 1), Vec::new);
            stages[depth].extend(own);
        }
        stages
    }

    /// Adds an edge that is not in force yet, for a robot that leads now and may follow later.
    pub fn add_waiting(&mut self, edge: Edge) {
        self.edges.push(edge);
    }

    /// The first edge by which `robot` follows; `None` where it follows nobody.
    pub fn edge_of(&self, robot: usize) -> Option<usize> {
        self.edges_of[robot].first().copied()
    }

    /// The edges by which `robot` follows, in the order they were given.
    pub fn edges_of(&self, robot: usize) -> &[usize] {
        &self.edges_of[robot]
    }

    /// The first edge that `robot` has, whether it is in force or not.
    pub fn slot_of(&self, robot: usize) -> Option<usize> {
        self.edges.iter().position(|edge| edge.follower == robot)
    }

    /// Whom `robot` follows by its first edge.
    pub fn leader_of(&self, robot: usize) -> Option<usize> {
        Some(self.edges[self.edge_of(robot)?].leader)
    }

    /// Whether edge number `index` is in force.
    pub fn is_in_force(&self, index: usize) -> bool {
        self.edges_of[self.edges[index].follower].contains(&index)
    }

    /// Whom the follower of each edge follows; `None` where it follows nobody.
    pub fn leaders(&self) -> impl Iterator<Item = Option<usize>> {
        let in_force = |(index, edge): (usize, &Edge)| self.is_in_force(index).then_some(edge.leader);
        self.edges.iter().enumerate().map(in_force)
    }

    /// Whether `robot` follows `other`, directly or through others, or is it.
    pub fn comes_after(&self, robot: usize, other: usize) -> bool {
        let (mut reached, mut open) = (vec![false; self.robots], vec![robot]);
        while let Some(robot) = open.pop() {
            if !std::mem::replace(&mut reached[robot], true) {
                open.extend(self.edges_of[robot].iter().map(|edge| self.edges[*edge].leader));
            }
        }
        reached[other]
    }

    /// The robot at the head of those that `robot` follows, by first edges; itself where it follows nobody.
    pub fn head_of(&self, robot: usize) -> usize {
        let up = |robot: &usize| self.leader_of(*robot);
        std::iter::successors(Some(robot), up).take(self.robots + 1).last().unwrap_or(robot)
    }

    /// Those who follow `robot` directly, in the order of the edges.
    pub fn followers_of(&self, robot: usize) -> impl Iterator<Item = usize> {
        let all = self.edges.iter().enumerate();
        let own = all.filter(move |(index, edge)| edge.leader == robot && self.is_in_force(*index));
        own.map(|(_, edge)| edge.follower)
    }

    /// Whom the followers of some edges follow by these from now on, or that they do not. Changes nothing and returns false
    /// where somebody would then follow himself, directly or through others.
    pub fn rewire(&mut self, changes: &[(usize, Option<usize>)]) -> bool {
        let mut next = self.clone();
        for (index, leader) in changes {
            let edge = &mut next.edges[*index];
            edge.leader = leader.unwrap_or(edge.leader);
            let own = &mut next.edges_of[edge.follower];
            own.retain(|other| other != index);
            if leader.is_some() {
                own.push(*index);
                own.sort_unstable();
            }
        }
        let mut graph = DiGraph::<(), ()>::with_capacity(next.robots, next.edges.len());
        for _ in 0..next.robots {
            graph.add_node(());
        }
        for index in next.edges_of.iter().flatten() {
            let edge = next.edges[*index];
            graph.add_edge(NodeIndex::new(edge.leader), NodeIndex::new(edge.follower), ());
        }
        let Ok(order) = toposort(&graph, None) else { return false };
        next.evaluation_order =
            order.into_iter().flat_map(|node| next.edges_of[node.index()].clone()).collect();
        *self = next;
        true
    }

    /// Robots.
    pub fn robots(&self) -> usize {
        self.robots
    }

    /// Edges in the order they were given.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Indices of the edges in force, such that every leader's own edges come before those of its followers. Those of one
    /// follower stand together, in the order they were given.
    pub fn evaluation_order(&self) -> &[usize] {
        &self.evaluation_order
    }
}

fn resolve(
    graph: &DiGraph<&str, usize>,
    index: &HashMap<&str, usize>,
    leader: &str,
    follower: &str,
) -> Result<Edge, GraphError> {
    let &f = index.get(follower).ok_or_else(|| GraphError::UnknownFollower(follower.to_owned()))?;
    let &l = index.get(leader).ok_or_else(|| GraphError::UnknownLeader {
        follower: follower.to_owned(),
        leader: leader.to_owned(),
    })?;
    if l == f {
        return Err(GraphError::SelfEdge(follower.to_owned()));
    }
    if graph.contains_edge(NodeIndex::new(l), NodeIndex::new(f)) {
        return Err(GraphError::Twice { follower: follower.to_owned(), leader: leader.to_owned() });
    }
    Ok(Edge { leader: l, follower: f })
}

/// Names along a ring through `node`, each followed by a robot it leads, back to the start.
fn ring(graph: &DiGraph<&str, usize>, node: NodeIndex) -> Vec<String> {
    // The robots on rings with `node` are those that come both before and after it.
    let rings = kosaraju_scc(graph);
    let Some(on_ring) = rings.into_iter().find(|nodes| nodes.contains(&node)) else { return vec![] };
    let leader = |n: NodeIndex| {
        graph.neighbors_directed(n, Direction::Incoming).find(|leader| on_ring.contains(leader))
    };
    // Walking from follower to leader among them comes round.
    let mut seen = vec![];
    let mut at = Some(node);
    while let Some(next) = at.filter(|next| !seen.contains(next)) {
        seen.push(next);
        at = leader(next);
    }
    let from = at.and_then(|at| seen.iter().position(|one| *one == at)).unwrap_or(0);
    let round = seen[from..].iter().chain(seen.get(from));
    let mut names: Vec<_> = round.map(|n| graph[*n].to_owned()).collect();
    names.reverse();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn build(names: &[&str], pairs: &[(&str, &str)]) -> Result<Graph, GraphError> {
        Graph::new(names, pairs)
    }

    fn seven() -> Graph {
        let pairs = [("0", "1"), ("0", "2"), ("1", "3"), ("2", "4"), ("3", "5"), ("4", "6")];
        build(&["0", "1", "2", "3", "4", "5", "6"], &pairs).expect("a V of seven is a formation")
    }

    #[test]
    fn a_v_of_seven_answers_every_question() {
        let graph = seven();
        assert_eq!(graph.robots(), 7);
    }

    #[test]
    fn leaders_are_evaluated_before_their_followers() {
        let graph = build(&["c", "b", "a"], &[("b", "c"), ("a", "b")]).expect("a chain is a formation");
        assert_eq!(graph.evaluation_order(), [1, 0]);
    }

    #[test]
    fn whom_a_robot_follows_may_change_but_never_in_a_ring() {
        let mut graph = seven();
        assert_eq!((graph.leader_of(5), graph.head_of(5)), (Some(3), 0));
        assert!(graph.comes_after(5, 1) && !graph.comes_after(5, 2));
        assert_eq!(graph.followers_of(0).collect::<Vec<_>>(), [1, 2]);
        // Robot 1 follows robot 5, which follows it through robot 3.
        let before = graph.evaluation_order().to_vec();
        assert!(!graph.rewire(&[(0, Some(5))]));
        assert_eq!((graph.leader_of(1), graph.evaluation_order()), (Some(0), &before[..]));
        // Robot 3 fails; robot 5 follows robot 1 in its place.
        assert!(graph.rewire(&[(2, None), (4, Some(1))]));
        assert_eq!((graph.edge_of(3), graph.leader_of(5)), (None, Some(1)));
        assert_eq!(graph.evaluation_order().len(), 5);
        assert_eq!(graph.leaders().collect::<Vec<_>>()[2..5], [None, Some(2), Some(1)]);
        // Two that exchange their places: one after the other would be a ring.
        assert!(graph.rewire(&[(0, Some(5)), (4, Some(0))]));
        assert_eq!(graph.head_of(1), 0);
    }

    #[test]
    fn an_edge_that_waits_counts_only_once_it_is_in_force() {
        let mut graph = build(&["a", "b", "c"], &[("a", "b")]).expect("a formation");
        graph.add_waiting(Edge { leader: 1, follower: 2 });
        assert_eq!((graph.edge_of(2), graph.evaluation_order()), (None, &[0][..]));
        assert!(graph.rewire(&[(1, Some(1))]));
        assert_eq!((graph.leader_of(2), graph.evaluation_order()), (Some(1), &[0, 1][..]));
    }

    #[test]
    fn a_robot_may_have_several_leaders_and_comes_after_each_of_them() {
        let pairs = [("b", "d"), ("a", "b"), ("a", "c"), ("c", "d")];
        let mut graph = build(&["d", "c", "b", "a"], &pairs).expect("a diamond is a formation");
        assert_eq!((graph.edges_of(0), graph.leader_of(0)), (&[0, 3][..], Some(2)));
        assert!(graph.comes_after(0, 1) && graph.comes_after(0, 2) && graph.comes_after(0, 3));
        assert_eq!(graph.evaluation_order()[2..], [0, 3]);
        // One of its leaders would follow it.
        assert!(!graph.rewire(&[(2, Some(0))]));
        assert!(graph.rewire(&[(0, None)]));
        assert_eq!((graph.edges_of(0), graph.is_in_force(0)), (&[3][..], false));
        assert!(graph.rewire(&[(0, Some(3))]));
        assert_eq!((graph.edges_of(0), graph.leader_of(0)), (&[0, 3][..], Some(3)));
        let ring = build(&["a", "b", "c"], &[("a", "b"), ("c", "b"), ("b", "c"), ("a", "c")]);
        let Err(GraphError::Cycle(names)) = ring else { panic!("{ring:?}") };
        assert_eq!((names.len(), names.first()), (3, names.last()));
    }

    #[test]
    fn every_error_names_its_robots() {
        let cases: [(Result<Graph, GraphError>, &[&str]); 7] = [
            (build(&[], &[]), &["at least one robot"]),
            (build(&["ann", "ann"], &[]), &["ann"]),
            (build(&["ann", "bob"], &[("eve", "bob")]), &["bob", "eve"]),
            (build(&["ann"], &[("ann", "eve")]), &["eve"]),
            (build(&["ann"], &[("ann", "ann")]), &["ann", "itself"]),
            (build(&["ann", "cy"], &[("ann", "cy"), ("ann", "cy")]), &["cy", "ann", "twice"]),
            (
                build(&["ann", "bob", "cy", "dan"], &[("bob", "cy"), ("cy", "dan"), ("dan", "bob")]),
                &["bob", "cy", "dan", "ring"],
            ),
        ];
        for (result, words) in cases {
            let message = result.expect_err("must be refused").to_string();
            for word in words {
                assert!(message.contains(word), "`{message}` does not say `{word}`");
            }
        }
    }

    #[test]
    fn the_ring_is_told_in_the_order_of_leading() {
        let error = build(&["a", "b", "tail"], &[("b", "a"), ("a", "b"), ("a", "tail")]).expect_err("a ring");
        let GraphError::Cycle(names) = error else { panic!("{error}") };
        assert_eq!(names.len(), 3);
        assert_eq!(names.first(), names.last());
        assert!(!names.contains(&"tail".to_owned()));
    }
}
