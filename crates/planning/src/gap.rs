//! Gaps between things: the two sides of a narrow place, and the narrowest place on the widest way.

use crate::convex::{Convex, box_of};
use crate::map::{Boundary, Map};
use std::collections::BinaryHeap;

/// A narrow place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// A point between its two sides, m.
    pub at: [f64; 2],
    /// What is to both sides.
    pub between: [Boundary; 2],
    /// From one to the other, m.
    pub width: f64,
}

/// The other side of a gap lies away from the first by more than this: the cosine of the angle between.
const OPPOSITE: f64 = -0.3;
/// A gap's other side is no farther away than this, m.
const REACH: f64 = 6.0;

impl Gap {
    /// The gap at a point: what is nearest, and what is nearest of all that is opposite.
    pub fn at(map: &Map, point: [f64; 2]) -> Option<Self> {
        let (nearest, first) = map.nearest(point);
        let opposite = |direction: [f64; 2]| {
            direction[0] * nearest.direction[0] + direction[1] * nearest.direction[1] < OPPOSITE
        };
        let mut best: Option<(f64, Boundary)> = None;
        let mut offer = |distance: f64, boundary: Boundary| {
            if distance < REACH && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, boundary));
            }
        };
        for index in map.within(point, REACH) {
            let found = map.obstacles()[index].nearest(point);
            if Boundary::Obstacle(index) != first && opposite(found.direction) {
                offer(found.distance, Boundary::Obstacle(index));
            }
        }
        for (side, found) in map.ground().sides_from_inside(point).enumerate() {
            if Boundary::Ground(side) != first && opposite(found.direction) {
                offer(found.distance, Boundary::Ground(side));
            }
        }
        let (_, second) = best?;
        Some(Self { at: point, between: [first, second], width: width(map, first, second, point) })
    }

    /// The narrowest gap on the way between two points whose narrowest gap is the widest.
    pub fn narrowest_on_widest_way(map: &Map, from: [f64; 2], to: [f64; 2]) -> Option<Self> {
        Self::at(map, Widest::new(map).narrowest(map, from, to)?)
    }
}

fn width(map: &Map, first: Boundary, second: Boundary, point: [f64; 2]) -> f64 {
    let to_side = |body: &Convex, side: usize| map.ground().inside_of(side, body);
    match (first, second) {
        (Boundary::Obstacle(a), Boundary::Obstacle(b)) => map.obstacles()[a].distance_to(&map.obstacles()[b]),
        (Boundary::Obstacle(a), Boundary::Ground(side)) | (Boundary::Ground(side), Boundary::Obstacle(a)) => {
            to_side(&map.obstacles()[a], side)
        }
        (Boundary::Ground(a), Boundary::Ground(b)) => {
            let here = Convex::new(&[point], 0.0);
            to_side(&here, a) + to_side(&here, b)
        }
    }
}

/// A grid for widest ways.
struct Widest {
    low: [f64; 2],
    cell: f64,
    size: [usize; 2],
}

const CELL: f64 = 0.2;
const CELLS_MOST: f64 = 400.0;

impl Widest {
    fn new(map: &Map) -> Self {
        let corners: Vec<_> = map.ground().corners().collect();
        let [low, high] = box_of(&corners);
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let cell = CELL.max(extent / CELLS_MOST);
        Self { low, cell, size: [0, 1].map(|k| (((high[k] - low[k]) / cell).ceil() as usize).max(1)) }
    }

    fn square(&self, point: [f64; 2]) -> Option<usize> {
        let [c, r] = [0, 1].map(|k| (point[k] - self.low[k]) / self.cell);
        let inside = c >= 0.0 && r >= 0.0 && c < self.size[0] as f64 && r < self.size[1] as f64;
        inside.then(|| r as usize * self.size[0] + c as usize)
    }

    fn middle(&self, square: usize) -> [f64; 2] {
        let [c, r] = [square % self.size[0], square / self.size[0]];
        [0, 1].map(|k| self.low[k] + ([c, r][k] as f64 + 0.5) * self.cell)
    }

    /// Dijkstra's algorithm for the largest least distance; `None` where things overlap on every way.
    fn narrowest(&self, map: &Map, from: [f64; 2], to: [f64; 2]) -> Option<[f64; 2]> {
        let (from, to) = (self.square(from)?, self.square(to)?);
        let n = self.size[0] * self.size[1];
        let mut parents = vec![usize::MAX; n];
        let mut heap = BinaryHeap::from([(u64::MAX, from, from)]);
        while let Some((width, square, parent)) = heap.pop() {
            if parents[square] != usize::MAX {
                continue;
            }
            parents[square] = parent;
            if square == to {
                break;
            }
            for next in self.neighbours(square).filter(|next| parents[*next] == usize::MAX) {
                let distance = map.distance(self.middle(next));
                if distance > 0.0 || next == to {
                    // Positive numbers order as their bits.
                    heap.push((width.min(distance.max(0.0).to_bits()), next, square));
                }
            }
        }
        if parents[to] == usize::MAX {
            return None;
        }
        let mut way = vec![to];
        while let Some(&square) = way.last().filter(|square| **square != from) {
            way.push(parents[square]);
        }
        // Both ends are where they are; what lies between may be narrow.
        let inner = if way.len() > 2 { &way[1..way.len() - 1] } else { &way[..] };
        let narrow = inner.iter().map(|square| self.middle(*square));
        narrow.min_by(|a, b| map.distance(*a).total_cmp(&map.distance(*b)))
    }

    fn neighbours(&self, square: usize) -> impl Iterator<Item = usize> {
        let [columns, rows] = self.size;
        let (c, r) = (square % columns, square / columns);
        let near = |at: usize, size: usize| at.saturating_sub(1)..=(at + 1).min(size - 1);
        let (across, up) = (near(c, columns), near(r, rows));
        up.flat_map(move |r| across.clone().map(move |c| r * columns + c)).filter(move |next| *next != square)
    }
}
