//! The formation control graph (definition 2.2): named robots and directed edges from leader to follower.

use petgraph::Direction;
use petgraph::algo::toposort;
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
    /// A robot has two leaders.
    #[error("`{follower}` follows both `{first}` and `{second}`: a follower has one leader")]
    TwoLeaders {
        /// The robot that follows.
        follower: String,
        /// Its first leader.
        first: String,
        /// Its second leader.
        second: String,
    },
    /// Followers lead one another in a ring.
    #[error("these robots follow each other in a ring: {}", .0.join(" → "))]
    Cycle(Vec<String>),
}

/// A checked formation graph: acyclic, every follower with one leader.
#[derive(Debug, Clone)]
pub struct Graph {
    robots: usize,
    edges: Vec<Edge>,
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
        let evaluation_order = order.into_iter().filter_map(|node| incoming(&graph, node)).collect();
        Ok(Self { robots: names.len(), edges, evaluation_order })
    }

    /// Robots.
    pub fn robots(&self) -> usize {
        self.robots
    }

    /// Edges in the order they were given.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Indices of edges such that every leader's own edge comes before those of its followers.
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
    if let Some(first) = graph.neighbors_directed(NodeIndex::new(f), Direction::Incoming).next() {
        return Err(GraphError::TwoLeaders {
            follower: follower.to_owned(),
            first: graph[first].to_owned(),
            second: leader.to_owned(),
        });
    }
    Ok(Edge { leader: l, follower: f })
}

fn incoming(graph: &DiGraph<&str, usize>, node: NodeIndex) -> Option<usize> {
    graph.edges_directed(node, Direction::Incoming).next().map(|edge| *edge.weight())
}

/// Names along the ring that `node` lies on, each followed by the robot it leads, back to the start.
fn ring(graph: &DiGraph<&str, usize>, node: NodeIndex) -> Vec<String> {
    // With one leader each, walking from follower to leader must run into the ring and around it.
    let leader = |n: NodeIndex| graph.neighbors_directed(n, Direction::Incoming).next();
    let mut on_ring = node;
    for _ in 0..graph.node_count() {
        on_ring = leader(on_ring).unwrap_or(on_ring);
    }
    let mut names = vec![graph[on_ring].to_owned()];
    let mut at = leader(on_ring);
    while let Some(next) = at.filter(|&n| n != on_ring) {
        names.push(graph[next].to_owned());
        at = leader(next);
    }
    names.push(graph[on_ring].to_owned());
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
    fn every_error_names_its_robots() {
        let cases: [(Result<Graph, GraphError>, &[&str]); 7] = [
            (build(&[], &[]), &["at least one robot"]),
            (build(&["ann", "ann"], &[]), &["ann"]),
            (build(&["ann", "bob"], &[("eve", "bob")]), &["bob", "eve"]),
            (build(&["ann"], &[("ann", "eve")]), &["eve"]),
            (build(&["ann"], &[("ann", "ann")]), &["ann", "itself"]),
            (build(&["ann", "bob", "cy"], &[("ann", "cy"), ("bob", "cy")]), &["cy", "ann", "bob"]),
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
