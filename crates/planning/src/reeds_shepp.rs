//! Shortest ways of a car that also reverses, without obstacles.
//!
//! J. A. Reeds and L. A. Shepp, *Optimal paths for a car that goes both forwards and backwards*, Pacific Journal of Mathematics
//! 145 (1990): equations 8.1 to 8.11. Their words are found from eight by three symmetries: backwards in time, mirrored, and
//! from the end to the beginning.

use std::f64::consts::{FRAC_PI_2, PI};
use vocabulary::{Pose, math, wrap};

/// A part of a way: an arc or a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReedsSheppPart {
    /// 1 to the left, −1 to the right, 0 straight on.
    pub turn: f64,
    /// m; negative backwards.
    pub length: f64,
}

/// A way of up to five parts.
#[derive(Debug, Clone, PartialEq)]
pub struct ReedsSheppPath {
    /// Its parts, none of length 0.
    pub parts: Vec<ReedsSheppPart>,
    /// Of its turns, m.
    pub radius: f64,
}

impl ReedsSheppPath {
    /// m.
    pub fn length(&self) -> f64 {
        self.parts.iter().map(|part| part.length.abs()).sum()
    }
}

/// Parts shorter than this, in radii, are none.
const NONE: f64 = 1e-10;

/// The shortest way from one pose to another with turns of `radius` m.
pub fn shortest_reeds_shepp(from: Pose, to: Pose, radius: f64) -> ReedsSheppPath {
    let [x, y] = from.body_from_world(to.x, to.y).map(|value| value / radius);
    let goal = [x, y, wrap(to.heading - from.heading)];
    let mut best: (f64, Vec<[f64; 2]>) = (f64::INFINITY, vec![]);
    for word in 0..WORDS {
        for symmetry in Symmetry::all(word) {
            let [x, y, phi] = symmetry.goal(goal);
            let Some(parts) = solved(word, x, y, phi) else { continue };
            let length: f64 = parts.iter().map(|[_, length]| length.abs()).sum();
            if length < best.0 - NONE {
                best = (length, symmetry.parts(parts));
            }
        }
    }
    let parts = best.1.into_iter().filter(|[_, length]| length.abs() > NONE);
    ReedsSheppPath {
        parts: parts.map(|[turn, length]| ReedsSheppPart { turn, length: length * radius }).collect(),
        radius,
    }
}

/// A symmetry of the problem.
#[derive(Debug, Clone, Copy)]
struct Symmetry {
    flipped: bool,
    mirrored: bool,
    reversed: bool,
}

impl Symmetry {
    fn all(word: usize) -> impl Iterator<Item = Self> {
        let reversals = if REVERSIBLE.contains(&word) { 2 } else { 1 };
        (0..4 * reversals).map(|k| Self { flipped: k & 1 > 0, mirrored: k & 2 > 0, reversed: k & 4 > 0 })
    }

    fn goal(self, [x, y, phi]: [f64; 3]) -> [f64; 3] {
        let (x, phi) = if self.flipped { (-x, -phi) } else { (x, phi) };
        let (y, phi) = if self.mirrored { (-y, -phi) } else { (y, phi) };
        let (sin, cos) = math::sin_cos(phi);
        if self.reversed { [x * cos + y * sin, x * sin - y * cos, phi] } else { [x, y, phi] }
    }

    fn parts(self, mut parts: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
        if self.reversed {
            parts.reverse();
        }
        let [turn, way] = [self.mirrored, self.flipped].map(|is| if is { -1.0 } else { 1.0 });
        parts.into_iter().map(|[turns, length]| [turn * turns, way * length]).collect()
    }
}

const WORDS: usize = 8;
/// Words that differ from themselves when they are driven from the end to the beginning.
const REVERSIBLE: [usize; 3] = [2, 5, 6];
const L: f64 = 1.0;
const R: f64 = -1.0;
const S: f64 = 0.0;

fn polar(x: f64, y: f64) -> [f64; 2] {
    [(x * x + y * y).sqrt(), math::atan2(y, x)]
}

/// Parts [turn, length in radii] of a word that leads to (x, y, φ), if it does.
fn solved(word: usize, x: f64, y: f64, phi: f64) -> Option<Vec<[f64; 2]>> {
    let (sin, cos) = math::sin_cos(phi);
    let same = [x - sin, y - 1.0 + cos];
    let other = [x + sin, y - 1.0 - cos];
    match word {
        0 => left_straight_left(same, phi),
        1 => left_straight_right(other, phi),
        2 => left_right_left(same, phi),
        3 | 4 => four_turns(word == 3, other, phi),
        5 => left_right_straight_left(same, phi),
        6 => left_right_straight_right(other, phi),
        _ => five_parts(other, phi),
    }
}

fn left_straight_left([x, y]: [f64; 2], phi: f64) -> Option<Vec<[f64; 2]>> {
    let [u, t] = polar(x, y);
    let v = wrap(phi - t);
    (t >= -NONE && v >= -NONE).then(|| vec![[L, t], [S, u], [L, v]])
}

fn left_straight_right([x, y]: [f64; 2], phi: f64) -> Option<Vec<[f64; 2]>> {
    let [rho, theta] = polar(x, y);
    if rho < 2.0 {
        return None;
    }
    let u = (rho * rho - 4.0).sqrt();
    let t = wrap(theta + math::atan2(2.0, u));
    let v = wrap(t - phi);
    (t >= -NONE && v >= -NONE).then(|| vec![[L, t], [S, u], [R, v]])
}

fn left_right_left([x, y]: [f64; 2], phi: f64) -> Option<Vec<[f64; 2]>> {
    let [rho, theta] = polar(x, y);
    if rho > 4.0 {
        return None;
    }
    let u = -2.0 * math::asin(0.25 * rho);
    let t = wrap(theta + 0.5 * u + PI);
    let v = wrap(phi - t + u);
    (t >= -NONE && u <= NONE).then(|| vec![[L, t], [R, u], [L, v]])
}

/// First and last turn of four, with turns of u and v between.
fn outer_turns(u: f64, v: f64, [x, y]: [f64; 2], phi: f64) -> [f64; 2] {
    let delta = wrap(u - v);
    let ((sin_u, cos_u), (sin_d, cos_d)) = (math::sin_cos(u), math::sin_cos(delta));
    let [a, b] = [sin_u - sin_d, cos_u - cos_d - 1.0];
    let first = math::atan2(y * a - x * b, x * a + y * b);
    let behind = 2.0 * (cos_d - math::cos(v) - cos_u) + 3.0 < 0.0;
    let first = wrap(if behind { first + PI } else { first });
    [first, wrap(first - u + v - phi)]
}

fn four_turns(cusp_in_the_middle: bool, xy: [f64; 2], phi: f64) -> Option<Vec<[f64; 2]>> {
    let square = xy[0] * xy[0] + xy[1] * xy[1];
    if cusp_in_the_middle {
        let rho = 0.25 * (2.0 + square.sqrt());
        let u = if rho <= 1.0 { math::acos(rho) } else { return None };
        let [t, v] = outer_turns(u, -u, xy, phi);
        return (t >= -NONE && v <= NONE).then(|| vec![[L, t], [R, u], [L, -u], [R, v]]);
    }
    let rho = (20.0 - square) / 16.0;
    if !(0.0..=1.0).contains(&rho) {
        return None;
    }
    let u = -math::acos(rho);
    let [t, v] = outer_turns(u, u, xy, phi);
    (t >= -NONE && v >= -NONE).then(|| vec![[L, t], [R, u], [L, u], [R, v]])
}

fn left_right_straight_left([x, y]: [f64; 2], phi: f64) -> Option<Vec<[f64; 2]>> {
    let [rho, theta] = polar(x, y);
    if rho < 2.0 {
        return None;
    }
    let r = (rho * rho - 4.0).sqrt();
    let u = 2.0 - r;
    let t = wrap(theta + math::atan2(r, -2.0));
    let v = wrap(phi - FRAC_PI_2 - t);
    (t >= -NONE && u <= NONE && v <= NONE).then(|| vec![[L, t], [R, -FRAC_PI_2], [S, u], [L, v]])
}

fn left_right_straight_right([x, y]: [f64; 2], phi: f64) -> Option<Vec<[f64; 2]>> {
    let [rho, t] = polar(-y, x);
    if rho < 2.0 {
        return None;
    }
    let u = 2.0 - rho;
    let v = wrap(t + FRAC_PI_2 - phi);
    (t >= -NONE && u <= NONE && v <= NONE).then(|| vec![[L, t], [R, -FRAC_PI_2], [S, u], [R, v]])
}

fn five_parts([x, y]: [f64; 2], phi: f64) -> Option<Vec<[f64; 2]>> {
    let [rho, _] = polar(x, y);
    if rho < 2.0 {
        return None;
    }
    let u = 4.0 - (rho * rho - 4.0).sqrt();
    if u > NONE {
        return None;
    }
    let t = wrap(math::atan2((4.0 - u) * x - 2.0 * y, -2.0 * x + (u - 4.0) * y));
    let v = wrap(t - phi);
    let parts = vec![[L, t], [R, -FRAC_PI_2], [S, u], [L, -FRAC_PI_2], [R, v]];
    (t >= -NONE && v >= -NONE).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dubins::shortest_dubins;
    use crate::leg::{CurvatureKnot, Leg};
    use proptest::prelude::*;

    fn end_of(path: &ReedsSheppPath) -> Pose {
        path.parts.iter().fold(Pose::default(), |start, part| {
            let knots = [0.0, part.length.abs()].map(|way| CurvatureKnot {
                way,
                curvature: part.turn / path.radius,
                level: 0.0,
            });
            Leg { start, backwards: part.length < 0.0, knots: knots.to_vec() }.end()
        })
    }

    #[test]
    fn known_lengths() {
        for (to, length) in [
            (Pose::new(-3.0, 0.0, 0.0), 3.0),
            (Pose::new(1.0, -1.0, -FRAC_PI_2), FRAC_PI_2),
            // Turning about on the spot: three arcs of a sixth of a circle.
            (Pose::new(0.0, 0.0, PI), PI),
        ] {
            let found = shortest_reeds_shepp(Pose::default(), to, 1.0);
            assert!((found.length() - length).abs() < 1e-9, "{to:?}: {found:?}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]
        #[test]
        fn a_way_ends_where_it_should_and_is_no_longer_than_dubins(
            x in -6.0..6.0, y in -6.0..6.0, heading in -3.1..3.1, radius in 0.5..2.0
        ) {
            let to = Pose::new(x, y, heading);
            let path = shortest_reeds_shepp(Pose::default(), to, radius);
            let end = end_of(&path);
            let error = (end.x - x).abs() + (end.y - y).abs() + wrap(end.heading - heading).abs();
            prop_assert!(error < 1e-6, "{path:?} {end:?}");
            prop_assert!(path.length() <= shortest_dubins(Pose::default(), to, radius).length() + 1e-9);
            let back = shortest_reeds_shepp(to, Pose::default(), radius);
            prop_assert!((back.length() - path.length()).abs() < 1e-6, "{path:?} {back:?}");
        }

        /// Any way of up to five arcs and lines is at least as long as the shortest to its end.
        #[test]
        fn nothing_driven_at_random_is_shorter(
            parts in prop::collection::vec((-1i32..=1, -2.5..2.5), 1..6)
        ) {
            let parts = parts.into_iter().map(|(turn, length)| ReedsSheppPart { turn: f64::from(turn), length });
            let driven = ReedsSheppPath { parts: parts.collect(), radius: 1.0 };
            let shortest = shortest_reeds_shepp(Pose::default(), end_of(&driven), 1.0);
            prop_assert!(shortest.length() <= driven.length() + 1e-6, "{driven:?} {shortest:?}");
        }
    }
}
