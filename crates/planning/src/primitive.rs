//! Motion primitives: steps of one length over which the curvature goes linearly from one value to another.
//!
//! So a way of primitives has a continuous curvature of bounded rate by itself. Curvatures are multiples of one that the
//! widest shape can hold, so that it can hold its own largest.

use crate::leg::{CurvatureKnot, Leg, Piece, level_between};
use crate::trailing::STEP;
use vocabulary::{Pose, math};

/// A step in the frame of where it begins.
#[derive(Debug, Clone)]
pub(crate) struct Primitive {
    /// Number of the curvature at its end.
    pub to: usize,
    /// Change of curvature, 1/m.
    pub change: f64,
    pieces: Vec<Piece>,
}

/// All steps of a formation.
#[derive(Debug, Clone)]
pub(crate) struct Primitives {
    /// Length of a step, m.
    pub step: f64,
    /// Curvatures in rising order, 1/m; the last is that of the start where it is none of the others.
    pub curvatures: Vec<f64>,
    /// Largest curvature of every level, 1/m: a multiple.
    pub largest: Vec<f64>,
    /// [backwards][from].
    steps: [Vec<Vec<Primitive>>; 2],
}

/// Curvatures from straight on to the largest of the widest shape at least, where it turns at all.
const FEWEST: f64 = 1.0;
/// Curvatures from straight on to the largest at most.
const MOST: f64 = 24.0;
/// Changes of curvature in a step: none, the smallest, and up to the largest in as many.
const CHANGES: i64 = 3;

impl Primitives {
    /// Steps of `step` m for a formation whose levels hold these curvatures, 1/m, that starts with one of `start` 1/m.
    pub(crate) fn new(largest: &[f64], sharpness: f64, step: f64, start: f64) -> Self {
        let most = largest.iter().copied().fold(0.0, f64::max);
        let widest = largest.iter().copied().filter(|curvature| *curvature > 1e-6).fold(most, f64::min);
        let change = sharpness * step;
        let parts = (2.0 * widest / change).ceil().max(FEWEST);
        let unit = (widest / parts).max(most / MOST);
        let count =
            |curvature: f64| if unit > 0.0 { (curvature / unit * (1.0 + 1e-9)).floor() as i64 } else { 0 };
        let n = count(most);
        let mut curvatures: Vec<f64> = (-n..=n).map(|k| k as f64 * unit).collect();
        let largest = largest.iter().map(|curvature| count(*curvature) as f64 * unit).collect();
        if !curvatures.contains(&start) {
            curvatures.push(start);
        }
        let regular = (2 * n + 1) as usize;
        let reach = if unit > 0.0 { change / unit * (1.0 + 1e-9) } else { 0.0 };
        let steps = [false, true].map(|backwards| {
            let from_each = curvatures.iter();
            from_each
                .map(|from| {
                    let near = (0..regular).filter(|to| {
                        let units = if unit > 0.0 { (curvatures[*to] - from) / unit } else { 0.0 };
                        units.abs() <= reach && is_taken(units, reach)
                    });
                    near.map(|to| Primitive::new(step, [*from, curvatures[to]], to, backwards)).collect()
                })
                .collect()
        });
        Self { step, curvatures, largest, steps }
    }

    /// Number of a curvature.
    pub(crate) fn number(&self, curvature: f64) -> usize {
        let nearest = |best: usize, k: usize| {
            let off = |k: usize| (self.curvatures[k] - curvature).abs();
            if off(k) < off(best) { k } else { best }
        };
        (0..self.curvatures.len()).fold(0, nearest)
    }

    /// Steps from a curvature.
    pub(crate) fn from(&self, curvature: usize, backwards: bool) -> &[Primitive] {
        &self.steps[usize::from(backwards)][curvature]
    }
}

/// Whether a change of curvature by so many units is one of the few that are tried, where `reach` are possible.
fn is_taken(units: f64, reach: f64) -> bool {
    let size = units.abs().round() as i64;
    let most = reach.floor().max(1.0) as i64;
    let fine = (units - units.round()).abs() > 1e-6;
    fine || size <= 1 || (1..CHANGES).any(|k| size == most * k / (CHANGES - 1))
}

impl Primitive {
    fn new(step: f64, [from, to]: [f64; 2], number: usize, backwards: bool) -> Self {
        let knots =
            [[0.0, from], [step, to]].map(|[way, curvature]| CurvatureKnot { way, curvature, level: 0.0 });
        let leg = Leg { start: Pose::default(), backwards, knots: knots.to_vec() };
        Self { to: number, change: (to - from).abs(), pieces: leg.pieces(STEP).collect() }
    }

    /// Where it leads from a pose; the heading is not wrapped.
    pub(crate) fn end(&self, from: Pose) -> Pose {
        self.pieces.last().map_or(from, |piece| placed(from, math::sin_cos(from.heading).into(), piece.end))
    }

    /// Its pieces from a pose, from one level to another.
    pub(crate) fn pieces(&self, from: Pose, levels: [f64; 2]) -> impl Iterator<Item = Piece> + '_ {
        let turned: [f64; 2] = math::sin_cos(from.heading).into();
        let n = self.pieces.len() as f64;
        self.pieces.iter().enumerate().map(move |(k, piece)| Piece {
            middle: from.heading + piece.middle,
            end: placed(from, turned, piece.end),
            level: level_between(levels, (k as f64 + 1.0) / n),
            ..*piece
        })
    }
}

/// A pose in the frame of another whose heading has this sine and cosine.
fn placed(from: Pose, [sin, cos]: [f64; 2], by: Pose) -> Pose {
    Pose {
        x: from.x + cos * by.x - sin * by.y,
        y: from.y + sin * by.x + cos * by.y,
        heading: from.heading + by.heading,
    }
}
