//! A leg of a way: the curvature over the way gone, piecewise linear, and so its poses.
//!
//! With u the way gone from the beginning of a leg and d = 1, or −1 backwards,
//!
//! ```text
//! dx/du = d cos θ    dy/du = d sin θ    dθ/du = d κ    κ piecewise linear in u
//! ```

use vocabulary::{Pose, math};

/// A corner of the curvature's and the level's course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvatureKnot {
    /// Way gone from the beginning of the leg, m.
    pub way: f64,
    /// 1/m, positive to the left.
    pub curvature: f64,
    /// Level of the formation: between two it moves from one to the other, as 3x² − 2x³.
    pub level: f64,
}

/// The level at a share of the way between two knots: 3x² − 2x³, so that places begin and end to move without a jump.
pub(crate) fn level_between([from, to]: [f64; 2], share: f64) -> f64 {
    if share >= 1.0 { to } else { from + (to - from) * share * share * (3.0 - 2.0 * share) }
}

/// A part of a way that is driven without a stop, in one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// Where it begins.
    pub start: Pose,
    /// Whether it is driven backwards.
    pub backwards: bool,
    /// Corners of its curvature, at rising ways from 0; one at least.
    pub knots: Vec<CurvatureKnot>,
}

/// A short piece of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    /// Way gone at its end, m from the beginning of the leg.
    pub way: f64,
    /// m.
    pub length: f64,
    /// Heading in its middle, rad, not wrapped.
    pub middle: f64,
    /// Pose at its end; the heading is not wrapped.
    pub end: Pose,
    /// At its end, 1/m.
    pub curvature: f64,
    /// At its end.
    pub level: f64,
}

/// Nodes and weights of Gauss and Legendre's rule of order six on [0, 1].
const NODES: [[f64; 2]; 3] =
    [[0.112_701_665_379_258_3, 5.0 / 18.0], [0.5, 4.0 / 9.0], [0.887_298_334_620_741_7, 5.0 / 18.0]];

/// A stretch over which the curvature changes linearly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clothoid {
    /// At its beginning, 1/m.
    pub curvature: f64,
    /// dκ/du, 1/m².
    pub sharpness: f64,
    /// 1, or −1 backwards.
    pub direction: f64,
}

impl Clothoid {
    /// What the heading has changed by after `way` m, rad.
    pub(crate) fn turn(&self, way: f64) -> f64 {
        self.direction * way * (self.curvature + 0.5 * self.sharpness * way)
    }

    /// The pose `length` m after the way `from` m, at which the pose is `pose`. The rule errs by less than 1e-9 m for pieces
    /// that turn by less than half a radian.
    pub(crate) fn advance(&self, pose: Pose, from: f64, length: f64) -> Pose {
        let (mut x, mut y) = (pose.x, pose.y);
        let before = self.turn(from);
        for [node, weight] in NODES {
            let heading = pose.heading + self.turn(from + node * length) - before;
            let (sin, cos) = math::sin_cos(heading);
            let way = self.direction * weight * length;
            x += way * cos;
            y += way * sin;
        }
        Pose { x, y, heading: pose.heading + self.turn(from + length) - before }
    }
}

impl Leg {
    /// Its length, m.
    pub fn length(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.way)
    }

    /// 1, or −1 backwards.
    pub fn direction(&self) -> f64 {
        if self.backwards { -1.0 } else { 1.0 }
    }

    /// Pieces of at most `step` m, which end at every knot.
    pub(crate) fn pieces(&self, step: f64) -> impl Iterator<Item = Piece> + '_ {
        let direction = self.direction();
        let mut pose = self.start;
        self.knots.windows(2).filter(|pair| pair[1].way > pair[0].way).flat_map(move |pair| {
            let [a, b] = [pair[0], pair[1]];
            let span = b.way - a.way;
            let parts = (span / step).ceil().max(1.0);
            let sharpness = (b.curvature - a.curvature) / span;
            let clothoid = Clothoid { curvature: a.curvature, sharpness, direction };
            let length = span / parts;
            let begin = pose;
            let mut ends = Vec::with_capacity(parts as usize);
            for k in 0..parts as usize {
                let from = k as f64 * length;
                let middle = begin.heading + clothoid.turn(from + 0.5 * length);
                pose = clothoid.advance(pose, from, length);
                let share = (k as f64 + 1.0) / parts;
                ends.push(Piece {
                    way: if k + 1 == parts as usize { b.way } else { a.way + from + length },
                    length,
                    middle,
                    end: pose,
                    curvature: a.curvature + share * (b.curvature - a.curvature),
                    level: level_between([a.level, b.level], share),
                });
            }
            ends
        })
    }

    /// Where it ends; the heading is not wrapped.
    pub fn end(&self) -> Pose {
        self.pieces(PRECISE).last().map_or(self.start, |piece| piece.end)
    }

    /// The leg in two parts, at the knot nearest to its middle; `None` where all knots are ends.
    pub(crate) fn halves(&self) -> Option<[Self; 2]> {
        let off = |k: &usize| (self.knots[*k].way - 0.5 * self.length()).abs();
        let at = (1..self.knots.len().checked_sub(1)?).min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let first = Self { knots: self.knots[..=at].to_vec(), ..self.clone() };
        let begins = self.knots[at].way;
        let knots =
            self.knots[at..].iter().map(|knot| CurvatureKnot { way: knot.way - begins, ..*knot }).collect();
        let second = Self { start: first.end(), knots, ..self.clone() };
        Some([first, second])
    }

    /// The same leg with knots at most `step` m apart, but where the level changes.
    pub(crate) fn refined(&self, step: f64) -> Self {
        let mut knots = self.knots[..1].to_vec();
        for pair in self.knots.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let parts =
                if a.level == b.level { ((b.way - a.way) / step).ceil().max(1.0) as usize } else { 1 };
            knots.extend((1..=parts).map(|k| {
                let share = k as f64 / parts as f64;
                let mix = |from: f64, to: f64| if k == parts { to } else { from + share * (to - from) };
                CurvatureKnot {
                    way: mix(a.way, b.way),
                    curvature: mix(a.curvature, b.curvature),
                    level: mix(a.level, b.level),
                }
            }));
        }
        Self { knots, ..self.clone() }
    }
}

/// Pieces in which a leg is integrated for its end, m.
const PRECISE: f64 = 0.125;

/// A course of curvature that grows piece by piece.
#[derive(Debug, Clone, Default)]
pub(crate) struct KnotList(pub(crate) Vec<CurvatureKnot>);

impl KnotList {
    pub(crate) fn starting(curvature: f64, level: f64) -> Self {
        Self(vec![CurvatureKnot { way: 0.0, curvature, level }])
    }

    /// Goes on over `length` m to another curvature and level.
    pub(crate) fn push(&mut self, length: f64, curvature: f64, level: f64) {
        let way = self.0.last().map_or(0.0, |knot| knot.way);
        if length > 1e-12 {
            self.0.push(CurvatureKnot { way: way + length, curvature, level });
        }
    }

    /// Length so far, m.
    pub(crate) fn length(&self) -> f64 {
        self.0.last().map_or(0.0, |knot| knot.way)
    }

    /// Sets levels by the way gone, linear between `corners` of [way, level], with a knot at each.
    pub(crate) fn set_levels(&mut self, corners: &[[f64; 2]]) {
        for &[way, _] in corners {
            let Some(after) = self.0.iter().position(|knot| knot.way >= way - 1e-9) else { continue };
            if after > 0 && self.0[after].way > way + 1e-9 {
                let [a, b] = [self.0[after - 1], self.0[after]];
                let share = (way - a.way) / (b.way - a.way);
                let curvature = a.curvature + share * (b.curvature - a.curvature);
                self.0.insert(after, CurvatureKnot { way, curvature, level: a.level });
            }
        }
        for knot in &mut self.0 {
            knot.level = interpolated(corners, knot.way);
        }
    }
}

/// Linear between [at, value] corners at rising places, constant beyond.
fn interpolated(corners: &[[f64; 2]], at: f64) -> f64 {
    let after = corners.iter().position(|corner| corner[0] >= at);
    match after {
        None => corners.last().map_or(0.0, |corner| corner[1]),
        Some(0) => corners[0][1],
        Some(k) => {
            let [a, b] = [corners[k - 1], corners[k]];
            a[1] + (b[1] - a[1]) * (at - a[0]) / (b[0] - a[0])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knot(way: f64, curvature: f64) -> CurvatureKnot {
        CurvatureKnot { way, curvature, level: 0.0 }
    }

    #[test]
    fn a_circle_is_a_circle() {
        let knots = vec![knot(0.0, 0.5), knot(std::f64::consts::TAU, 0.5)];
        let leg = Leg { start: Pose::new(1.0, 0.0, 0.0), backwards: false, knots };
        let end = leg.end();
        assert!((end.x - 1.0).abs() < 1e-9 && (end.y - 4.0).abs() < 1e-9, "{end:?}");
        let back = Leg { start: end, backwards: true, ..leg };
        let end = back.end();
        assert!((end.x - 1.0).abs() < 1e-9 && end.y.abs() < 1e-9 && end.heading.abs() < 1e-12, "{end:?}");
    }

    /// Against small Euler steps with the heading in their middle.
    #[test]
    fn a_clothoid_is_integrated_exactly() {
        let knots = vec![knot(0.0, -0.2), knot(3.0, 0.9), knot(4.0, 0.4)];
        let leg = Leg { start: Pose::new(0.0, 0.0, 0.3), backwards: false, knots };
        let (mut x, mut y, mut heading, n) = (0.0, 0.0, 0.3, 400_000);
        let step = 4.0 / f64::from(n);
        for k in 0..n {
            let u = (f64::from(k) + 0.5) * step;
            let curvature = if u < 3.0 { -0.2 + 1.1 * u / 3.0 } else { 0.9 - 0.5 * (u - 3.0) };
            let (sin, cos) = math::sin_cos(heading + 0.5 * step * curvature);
            (x, y, heading) = (x + step * cos, y + step * sin, heading + step * curvature);
        }
        for refined in [leg.clone(), leg.refined(0.4)] {
            let end = refined.end();
            let error = (end.x - x).abs() + (end.y - y).abs() + (end.heading - heading).abs();
            assert!(error < 1e-7, "{end:?} {x} {y} {heading}");
        }
        assert_eq!(leg.pieces(0.1).last().map(|piece| piece.way), Some(4.0));
    }

    #[test]
    fn levels_are_laid_over_a_course() {
        let mut list = KnotList::starting(0.0, 2.0);
        list.push(4.0, 0.4, 2.0);
        list.set_levels(&[[1.0, 2.0], [2.0, 1.0]]);
        let levels: Vec<_> = list.0.iter().map(|k| [k.way, k.curvature, k.level]).collect();
        assert_eq!(levels, [[0.0, 0.0, 2.0], [1.0, 0.1, 2.0], [2.0, 0.2, 1.0], [4.0, 0.4, 1.0]]);
    }
}
