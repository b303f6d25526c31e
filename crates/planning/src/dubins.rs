//! Shortest ways of a car that only drives forwards, without obstacles: two turns with a line or a third turn between.
//!
//! L. E. Dubins, *On curves of minimal length with a constraint on average curvature, and with prescribed initial and terminal
//! positions and tangents*, American Journal of Mathematics 79 (1957); formulas after A. M. Shkel and V. Lumelsky, *Classification
//! of the Dubins set*, Robotics and Autonomous Systems 34 (2001).

use std::f64::consts::TAU;
use vocabulary::{Pose, math};

/// One of the six kinds of ways between two poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DubinsPath {
    /// 1 to the left, −1 to the right, 0 straight on.
    pub turns: [f64; 3],
    /// Lengths of its parts, m.
    pub lengths: [f64; 3],
    /// Of its turns, m.
    pub radius: f64,
}

/// Differences below this are taken for rounding.
const ROUNDING: f64 = 1e-10;

/// An angle in [0, 2π); what is short of a whole turn by rounding is none.
fn turned(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > TAU - ROUNDING { 0.0 } else { turned }
}

/// All ways from one pose to another with turns of `radius` m, one of each kind that there is.
pub fn dubins_paths(from: Pose, to: Pose, radius: f64) -> impl Iterator<Item = DubinsPath> {
    let problem = Normalized::new(from, to, radius);
    (0..6).filter_map(move |kind| problem.path(kind)).map(move |(turns, parts)| DubinsPath {
        turns,
        lengths: parts.map(|part| part * radius),
        radius,
    })
}

/// The shortest of them.
pub fn shortest_dubins(from: Pose, to: Pose, radius: f64) -> DubinsPath {
    let none = DubinsPath { turns: [0.0; 3], lengths: [f64::INFINITY; 3], radius };
    dubins_paths(from, to, radius)
        .fold(none, |best, path| if path.length() < best.length() { path } else { best })
}

impl DubinsPath {
    /// m.
    pub fn length(&self) -> f64 {
        self.lengths.iter().sum()
    }
}

/// Angles of both ends against the line between them, and its length in radii.
struct Normalized {
    alpha: f64,
    beta: f64,
    distance: f64,
    sines: [f64; 2],
    cosines: [f64; 2],
}

const LEFT: f64 = 1.0;
const RIGHT: f64 = -1.0;
const STRAIGHT: f64 = 0.0;

impl Normalized {
    fn new(from: Pose, to: Pose, radius: f64) -> Self {
        let [dx, dy] = [to.x - from.x, to.y - from.y];
        let line = math::atan2(dy, dx);
        let [alpha, beta] = [turned(from.heading - line), turned(to.heading - line)];
        let ([sa, ca], [sb, cb]) = (sin_cos(alpha), sin_cos(beta));
        Self {
            alpha,
            beta,
            distance: (dx * dx + dy * dy).sqrt() / radius,
            sines: [sa, sb],
            cosines: [ca, cb],
        }
    }

    /// Turns and parts in radii of a kind, if it exists.
    fn path(&self, kind: usize) -> Option<([f64; 3], [f64; 3])> {
        match kind {
            0 => Some(self.outer(LEFT)),
            1 => Some(self.outer(RIGHT)),
            2 => self.inner(LEFT),
            3 => self.inner(RIGHT),
            4 => self.three_turns(LEFT),
            _ => self.three_turns(RIGHT),
        }
    }

    /// LSL or RSR. A way that turns right is the mirror image of one that turns left.
    fn outer(&self, side: f64) -> ([f64; 3], [f64; 3]) {
        let [sa, sb] = self.sines.map(|sine| side * sine);
        let [ca, cb] = self.cosines;
        let [along, across] = [self.distance + sa - sb, cb - ca];
        let line = math::atan2(across, along);
        let parts = [
            turned(line - side * self.alpha),
            (along * along + across * across).sqrt(),
            turned(side * self.beta - line),
        ];
        ([side, STRAIGHT, side], parts)
    }

    /// LSR or RSL.
    fn inner(&self, side: f64) -> Option<([f64; 3], [f64; 3])> {
        let [sa, sb] = self.sines.map(|sine| side * sine);
        let [ca, cb] = self.cosines;
        let [along, across] = [self.distance + sa + sb, -ca - cb];
        let square = along * along + across * across - 4.0;
        if square < -ROUNDING {
            return None;
        }
        let straight = square.max(0.0).sqrt();
        let line = math::atan2(across, along) - math::atan2(-2.0, straight);
        let parts = [turned(line - side * self.alpha), straight, turned(line - side * self.beta)];
        Some(([side, STRAIGHT, -side], parts))
    }

    /// LRL or RLR.
    fn three_turns(&self, side: f64) -> Option<([f64; 3], [f64; 3])> {
        let [sa, sb] = self.sines.map(|sine| side * sine);
        let [ca, cb] = self.cosines;
        let [along, across] = [self.distance + sa - sb, cb - ca];
        let square = along * along + across * across;
        if square > 16.0 {
            return None;
        }
        // Middles of the first and last circle are 4 sin of half the middle turn's rest apart.
        let middle = TAU - 2.0 * math::asin((0.25 * square.sqrt()).min(1.0));
        let line = math::atan2(across, along);
        let first = turned(line - side * self.alpha + 0.5 * middle);
        let last = turned(side * self.beta - side * self.alpha - first + middle);
        Some(([side, -side, side], [first, middle, last]))
    }
}

fn sin_cos(angle: f64) -> [f64; 2] {
    let (sin, cos) = math::sin_cos(angle);
    [sin, cos]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::leg::{CurvatureKnot, Leg};
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};
    use vocabulary::wrap;

    /// Where a way of arcs ends, by integrating its curvature.
    fn end_of(from: Pose, path: &DubinsPath) -> Pose {
        let mut pose = from;
        for (turn, length) in path.turns.iter().zip(path.lengths) {
            let knots =
                [0.0, length].map(|way| CurvatureKnot { way, curvature: turn / path.radius, level: 0.0 });
            pose = Leg { start: pose, backwards: false, knots: knots.to_vec() }.end();
        }
        pose
    }

    fn error(a: Pose, b: Pose) -> f64 {
        (a.x - b.x).abs() + (a.y - b.y).abs() + wrap(a.heading - b.heading).abs()
    }

    #[test]
    fn known_lengths() {
        let at = Pose::new;
        for (to, length) in [
            (at(4.0, 0.0, 0.0), 4.0),
            (at(0.0, 2.0, PI), PI),
            (at(1.0, 1.0, FRAC_PI_2), FRAC_PI_2),
            (at(3.0, 1.0, FRAC_PI_2), 2.0 + FRAC_PI_2),
            // Half a turn beside where it began: a turn away and back.
            (at(0.0, 0.0, PI), 2.0 * PI + PI / 3.0),
            (at(2.0, 2.0, 0.0), PI),
            (at(0.0, 4.0, PI), 2.0 + PI),
        ] {
            let found = shortest_dubins(Pose::default(), to, 1.0);
            assert!((found.length() - length).abs() < 1e-9, "{to:?}: {found:?}");
            let wide = shortest_dubins(Pose::default(), at(3.0 * to.x, 3.0 * to.y, to.heading), 3.0);
            assert!((wide.length() - 3.0 * length).abs() < 1e-9, "{to:?}: {wide:?}");
        }
    }

    /// A way that begins with a turn to one side by `first` radii and ends with one to another, about a unit circle there.
    struct Tried {
        /// By how much it misses the last circle.
        misses: f64,
        /// Its length, if it does not.
        length: f64,
    }

    /// A line after the first turn, which has to be a tangent of the last circle in its sense.
    fn with_a_line(first: f64, side: f64, last: f64, to: Pose) -> Tried {
        let heading = side * first;
        let ([sin, cos], [sin_to, cos_to]) = (sin_cos(heading), sin_cos(to.heading));
        let [x, y] = [side * sin, side * (1.0 - cos)];
        let [dx, dy] = [to.x - last * sin_to - x, to.y + last * cos_to - y];
        let [along, across] = [cos * dx + sin * dy, cos * dy - sin * dx];
        let length = first + along + turned(last * (to.heading - heading));
        Tried { misses: across - last, length: if along >= 0.0 { length } else { f64::INFINITY } }
    }

    /// The other turn after the first, whose circle has to touch the last one.
    fn with_a_turn(first: f64, side: f64, to: Pose) -> Tried {
        let heading = side * first;
        let ([sin, cos], [sin_to, cos_to]) = (sin_cos(heading), sin_cos(to.heading));
        let [x, y] = [side * sin, side * (1.0 - cos)];
        let other = [x + side * sin, y - side * cos];
        let [dx, dy] = [to.x - side * sin_to - other[0], to.y + side * cos_to - other[1]];
        let [touches, begins] = [math::atan2(dy, dx), math::atan2(y - other[1], x - other[0])];
        let middle = turned(side * (begins - touches));
        let length = first + middle + turned(side * (to.heading - heading + side * middle));
        Tried { misses: (dx * dx + dy * dy).sqrt() - 2.0, length }
    }

    /// The shortest of all ways by where they touch the last circle, found by signs that change, not by Dubins' formulas.
    fn by_brute_force(to: Pose) -> f64 {
        let kinds: Vec<Box<dyn Fn(f64) -> Tried>> = vec![
            Box::new(move |first| with_a_line(first, 1.0, 1.0, to)),
            Box::new(move |first| with_a_line(first, 1.0, -1.0, to)),
            Box::new(move |first| with_a_line(first, -1.0, 1.0, to)),
            Box::new(move |first| with_a_line(first, -1.0, -1.0, to)),
            Box::new(move |first| with_a_turn(first, 1.0, to)),
            Box::new(move |first| with_a_turn(first, -1.0, to)),
        ];
        let mut least = f64::INFINITY;
        let n = 4000;
        for tried in &kinds {
            for k in 0..n {
                let [mut low, mut high] = [k, k + 1].map(|k| TAU * f64::from(k) / f64::from(n));
                if tried(low).misses.signum() == tried(high).misses.signum() {
                    continue;
                }
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if tried(low).misses.signum() == tried(middle).misses.signum() {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                least = least.min(tried(high).length);
            }
        }
        least
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn every_way_ends_where_it_should_and_the_shortest_is_that_of_brute_force(
            x in -5.0..5.0, y in -5.0..5.0, heading in -3.0..3.0
        ) {
            let to = Pose::new(x, y, heading);
            for path in dubins_paths(Pose::default(), to, 1.0) {
                prop_assert!(error(end_of(Pose::default(), &path), to) < 1e-6, "{path:?}");
            }
            let (found, brute) = (shortest_dubins(Pose::default(), to, 1.0).length(), by_brute_force(to));
            prop_assert!((found - brute).abs() < 1e-6, "{found} {brute}");
        }
    }
}
