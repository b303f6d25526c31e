//! What is left to go, at the least: the larger of the way around obstacles for the lead's body, and of Dubins' way without
//! obstacles.
//!
//! The first comes from Dijkstra's algorithm over a grid of squares with eight neighbours. A square is closed only where no
//! point of it has room for the core of the lead's body, so that what the grid cannot reach nobody reaches. Where there is room
//! for that, but not for the column to both sides of it, a way counts several times: only a bent column gets by there. Ways over the grid
//! are longer than straight ones by up to 8 %, and the middles of squares are off: the estimate is not a bound to the last
//! centimetre, and a search by it finds the best way of its lattice up to its weight and that.

use crate::dubins::shortest_dubins;
use crate::frame::FixedFrame;
use crate::map::Map;
use crate::reeds_shepp::shortest_reeds_shepp;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use vocabulary::Pose;

/// Ways left over a grid in the frame of the start.
#[derive(Debug, Clone)]
pub(crate) struct Heuristic {
    frame: FixedFrame,
    low: [f64; 2],
    cell: f64,
    size: [usize; 2],
    /// m; infinite where there is no way.
    left: Vec<f64>,
    goal: Pose,
    with_heading: bool,
    /// m.
    radius: f64,
    reverses: bool,
}

/// What a heuristic has to know of a formation and its goal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HeuristicSetup {
    /// Origin and axes of the grid.
    pub frame: Pose,
    pub goal: Pose,
    pub with_heading: bool,
    /// Radius that the lead needs clear, m.
    pub need: f64,
    /// Half the width that the column needs clear, m.
    pub column: f64,
    /// Smallest radius of its turns, m.
    pub radius: f64,
    pub reverses: bool,
}

/// Squares are this large, m, where that does not take too many.
const CELL: f64 = 0.25;
const CELLS_MOST: f64 = 600.0;
/// Ways are counted in this many parts of a square, so that they are whole numbers.
const PARTS: f64 = 1024.0;
/// How many times ways count where the column is too wide: found by trial over random maps, as its reserve.
const NARROW: u32 = 5;
/// Farther than this many radii of turns from the goal headings hardly matter.
const NEAR: f64 = 8.0;

impl Heuristic {
    pub(crate) fn new(map: &Map, setup: &HeuristicSetup) -> Self {
        let frame = FixedFrame::new(setup.frame);
        let corners: Vec<_> = map.ground().corners().map(|corner| frame.inside(corner)).collect();
        let [low, high] = crate::convex::box_of(&corners);
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let cell = CELL.max(extent / CELLS_MOST);
        let size = [0, 1].map(|k| (((high[k] - low[k]) / cell).ceil() as usize).max(1));
        let mut heuristic = Self {
            frame,
            low,
            cell,
            size,
            left: vec![],
            goal: setup.goal,
            with_heading: setup.with_heading,
            radius: setup.radius,
            reverses: setup.reverses,
        };
        heuristic.left = heuristic.dijkstra(map, [setup.need, setup.column]);
        heuristic
    }

    /// Ways left from every square to the goal's.
    fn dijkstra(&self, map: &Map, needs: [f64; 2]) -> Vec<f64> {
        let [columns, rows] = self.size;
        // A square with a point that has room has room in its middle but for half its diagonal: that decides what is closed.
        let enough = [needs[0] - 0.5 * 2.0_f64.sqrt() * self.cell, needs[1]];
        let mut steps = vec![u32::MAX; columns * rows];
        let mut factors: Vec<Option<u32>> = vec![None; columns * rows];
        let mut heap = BinaryHeap::new();
        if let Some(goal) = self.square([self.goal.x, self.goal.y]) {
            steps[goal] = 0;
            heap.push(Reverse([0, goal as u32]));
        }
        let [straight, diagonal] = [PARTS, (2.0_f64.sqrt() * PARTS).floor()].map(|parts| parts as u32);
        while let Some(Reverse([way, square])) = heap.pop() {
            if way > steps[square as usize] {
                continue;
            }
            let (column, row) = (square as usize % columns, square as usize / columns);
            for right in [-1i64, 0, 1] {
                for up in [-1i64, 0, 1] {
                    let [c, r] = [column as i64 + right, row as i64 + up];
                    if (right == 0 && up == 0) || c < 0 || r < 0 || c >= columns as i64 || r >= rows as i64 {
                        continue;
                    }
                    let next = r as usize * columns + c as usize;
                    let step = if right == 0 || up == 0 { straight } else { diagonal };
                    if way.saturating_add(step) >= steps[next] {
                        continue;
                    }
                    let factor = *factors[next].get_or_insert_with(|| {
                        let distance = map.distance(self.middle(next));
                        if distance >= enough[1] {
                            1
                        } else if distance >= enough[0] {
                            NARROW
                        } else {
                            0
                        }
                    });
                    let to = way.saturating_add(factor * step);
                    if factor > 0 && to < steps[next] {
                        steps[next] = to;
                        heap.push(Reverse([to, next as u32]));
                    }
                }
            }
        }
        let metres =
            |way: u32| if way == u32::MAX { f64::INFINITY } else { f64::from(way) / PARTS * self.cell };
        steps.into_iter().map(metres).collect()
    }

    fn square(&self, point: [f64; 2]) -> Option<usize> {
        let place = self.frame.inside(point);
        let [c, r] = [0, 1].map(|k| (place[k] - self.low[k]) / self.cell);
        let inside = c >= 0.0 && r >= 0.0 && c < self.size[0] as f64 && r < self.size[1] as f64;
        inside.then(|| r as usize * self.size[0] + c as usize)
    }

    fn middle(&self, square: usize) -> [f64; 2] {
        let [c, r] = [square % self.size[0], square / self.size[0]];
        let [x, y] = [0, 1].map(|k| self.low[k] + ([c, r][k] as f64 + 0.5) * self.cell);
        self.frame.outside([x, y])
    }

    /// Way left around obstacles, m; infinite where there is none.
    pub(crate) fn around(&self, point: [f64; 2]) -> f64 {
        self.square(point).map_or(f64::INFINITY, |square| self.left[square])
    }

    /// Way left, m; infinite where there is none.
    pub(crate) fn left(&self, pose: Pose) -> f64 {
        let around = self.around([pose.x, pose.y]);
        let straight = crate::convex::apart([pose.x, pose.y], [self.goal.x, self.goal.y]);
        // Two squares' middles are up to a diagonal nearer or farther than their points.
        let around = (around - 1.5 * self.cell).max(straight);
        if !self.with_heading || straight > NEAR * self.radius || around.is_infinite() {
            return around;
        }
        let turning = if self.reverses {
            shortest_reeds_shepp(pose, self.goal, self.radius).length()
        } else {
            shortest_dubins(pose, self.goal, self.radius).length()
        };
        around.max(turning)
    }
}
