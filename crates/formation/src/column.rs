//! Places in a column: where each robot of a formation files in behind its lead, whatever shape it leaves for that.
//!
//! Whoever is farther ahead files in first, of those that are level the one nearer to the middle, the left one before the
//! right, and everyone behind its own leader. Robots of the left wing keep to the left of the lead's track, those of the right
//! to the right: wings close like a zipper, nobody changes its leader, and each sees it past the one in between.

use crate::graph::Graph;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use vocabulary::math;

/// How a follower files in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filing {
    /// How far behind the robot before it in the column, m.
    pub spacing: f64,
    /// How far beside the lead's track, m.
    pub stagger: f64,
}

/// Nearer to the middle than this, m, a robot is of neither wing; closer together along the track, two are level.
const LEVEL: f64 = 1e-3;

/// Who files in first: by [−forward, away from the middle, −left], in units of [`LEVEL`].
type Turn = Reverse<([i64; 3], usize)>;

/// The place of every edge's follower in the column, [forward, left] of its own leader, m. `places` are those of the shape
/// at rest, `filings` has `None` for followers that keep them.
pub fn column(graph: &Graph, places: &[[f64; 2]], filings: &[Option<Filing>]) -> Vec<[f64; 2]> {
    let edges = graph.edges();
    let mut wide = vec![[0.0; 2]; graph.robots()];
    let mut heads: Vec<usize> = (0..graph.robots()).collect();
    let mut followers = vec![vec![]; graph.robots()];
    for &index in graph.evaluation_order() {
        let edge = edges[index];
        let [x, y] = wide[edge.leader];
        wide[edge.follower] = [x + places[index][0], y + places[index][1]];
        heads[edge.follower] = heads[edge.leader];
        followers[edge.leader].push(index);
    }
    let turn = |index: usize| -> Turn {
        let [x, y] = wide[edges[index].follower].map(|value| (value / LEVEL).round() as i64);
        Reverse(([-x, y.abs(), -y], index))
    };
    let mut filed = vec![[0.0; 2]; graph.robots()];
    for lead in (0..graph.robots()).filter(|robot| heads[*robot] == *robot) {
        let mut end = 0.0;
        let mut waiting: BinaryHeap<Turn> = followers[lead].iter().map(|index| turn(*index)).collect();
        while let Some(Reverse((_, index))) = waiting.pop() {
            let robot = edges[index].follower;
            filed[robot] = match filings[index] {
                Some(Filing { spacing, stagger }) => {
                    end -= spacing;
                    let [_, y] = wide[robot];
                    let side = if y.abs() < LEVEL { 0.0 } else { 1_f64.copysign(y) };
                    [end, side * stagger]
                }
                // It keeps its place, wherever its leader is now.
                None => [0, 1].map(|k| filed[edges[index].leader][k] + places[index][k]),
            };
            waiting.extend(followers[robot].iter().map(|index| turn(*index)));
        }
    }
    edges.iter().map(|edge| [0, 1].map(|k| filed[edge.follower][k] - filed[edge.leader][k])).collect()
}

/// Half the width of the formation to either side of each robot's lead, [right, left] in m, by the places of its edges'
/// followers, to the middles of the robots.
pub fn half_widths(graph: &Graph, places: &[[f64; 2]], lead: usize) -> [f64; 2] {
    let mut across = vec![None; graph.robots()];
    across[lead] = Some(0.0);
    let mut found = [0.0_f64; 2];
    for &index in graph.evaluation_order() {
        let edge = graph.edges()[index];
        let Some(of_leader) = across[edge.leader] else { continue };
        let y: f64 = of_leader + places[index][1];
        across[edge.follower] = Some(y);
        found = [found[0].max(-y), found[1].max(y)];
    }
    found
}

/// [forward, left] of a set point's [distance in m, bearing in rad], m.
pub fn cartesian([distance, bearing]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = math::sin_cos(bearing);
    [distance * cos, distance * sin]
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILING: Option<Filing> = Some(Filing { spacing: 1.0, stagger: 0.3 });

    /// Robots 0 to n − 1, each with the one it follows and its place there; columns of all.
    fn columns(robots: &[(usize, [f64; 2])], filings: &[Option<Filing>]) -> Vec<[f64; 2]> {
        let names: Vec<String> = (0..=robots.len()).map(|k| k.to_string()).collect();
        let pairs: Vec<_> = robots
            .iter()
            .enumerate()
            .map(|(k, (leader, _))| (names[*leader].clone(), names[k + 1].clone()))
            .collect();
        let graph = Graph::new(&names, &pairs).expect("a tree");
        let places: Vec<_> = robots.iter().map(|(_, place)| *place).collect();
        column(&graph, &places, filings)
    }

    fn near(a: &[[f64; 2]], b: &[[f64; 2]]) {
        assert_eq!(a.len(), b.len());
        for (p, q) in a.iter().zip(b) {
            assert!((p[0] - q[0]).abs() < 1e-9 && (p[1] - q[1]).abs() < 1e-9, "{a:?} {b:?}");
        }
    }

    /// Right wing first, as scenes number it: the left child goes to (−d, s), the right to (−2 d, −s), all others 2 d behind
    /// their own leaders.
    #[test]
    fn the_wings_of_a_v_close_like_a_zipper() {
        let (right, left) = ([-1.4, -1.4], [-1.4, 1.4]);
        let v = [(0, right), (0, left), (1, right), (2, left), (3, right), (4, left)];
        let behind = [-2.0, 0.0];
        near(&columns(&v, &[FILING; 6]), &[[-2.0, -0.3], [-1.0, 0.3], behind, behind, behind, behind]);
    }

    #[test]
    fn whoever_follows_the_lead_files_in_by_its_place() {
        let star = [(0, [-2.8, 2.8]), (0, [-1.4, -1.4]), (0, [-1.4, 1.4]), (0, [-5.0, 0.0])];
        near(&columns(&star, &[FILING; 4]), &[[-3.0, 0.3], [-2.0, -0.3], [-1.0, 0.3], [-4.0, 0.0]]);
        // One that goes ahead of its leader files in behind it.
        near(&columns(&[(0, [2.0, 0.0]), (1, [2.0, 0.0])], &[FILING; 2]), &[[-1.0, 0.0], [-1.0, 0.0]]);
    }

    #[test]
    fn who_does_not_narrow_keeps_its_place_and_leaves_the_column_to_the_others() {
        let chain = [(0, [-1.0, 1.0]), (1, [-1.0, 1.0])];
        near(&columns(&chain, &[None, FILING]), &[[-1.0, 1.0], [0.0, -0.7]]);
    }

    #[test]
    fn long_bodies_take_more_room() {
        let long = Some(Filing { spacing: 3.0, stagger: 0.5 });
        near(&columns(&[(0, [-1.0, 0.0]), (1, [-1.0, 0.0])], &[long, FILING]), &[[-3.0, 0.0], [-1.0, 0.0]]);
    }

    #[test]
    fn a_width_is_that_of_all_robots_behind_one_lead() {
        let names = ["a", "b", "c", "d"];
        let graph = Graph::new(&names, &[("a", "b"), ("b", "c")]).expect("a tree");
        let places = [[-1.0, 2.0], [-1.0, -3.0]];
        assert_eq!(half_widths(&graph, &places, 0), [1.0, 2.0]);
        assert_eq!(half_widths(&graph, &places, 3), [0.0, 0.0]);
    }
}
