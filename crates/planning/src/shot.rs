//! Shots: ways straight to the goal, as Dubins' with clothoids where its turns begin and end.
//!
//! A turn by δ goes up to a curvature at the largest sharpness, holds it, and goes down again: its chord, of length c(|δ|), is
//! turned by δ/2. Between pose (p, θ) and goal (q, φ) with turns by δ and ε = φ − θ − δ and a line of length L,
//!
//! ```text
//! q − p = c(δ) u(θ + δ/2) + L u(θ + δ) + c(ε) u(φ − ε/2)
//! ```
//!
//! Across the line that is one equation for δ, solved by secants from Dubins' turn; along it follows L.
//! After T. Fraichard and A. Scheuer, *From Reeds and Shepp's to continuous-curvature paths*, IEEE Transactions on Robotics 20
//! (2004), whose turns these are.

use crate::dubins::{DubinsPath, dubins_paths};
use crate::leg::{Clothoid, KnotList, Leg};
use vocabulary::{Pose, math};

/// A turn with clothoids at its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BlendedTurn {
    /// By how much the heading changes, rad.
    deflection: f64,
    /// Largest curvature, 1/m, without its sign.
    peak: f64,
    /// Length of a clothoid, and of the arc between, m.
    ramp: f64,
    hold: f64,
    sharpness: f64,
}

/// How a formation may turn in a shot.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turning {
    /// 1/m.
    pub curvature: f64,
    /// 1/m².
    pub sharpness: f64,
}

/// Turns by less than this, rad, are none.
const NO_TURN: f64 = 1e-9;
/// Pieces in which a clothoid is integrated turn by this much at most, rad.
const PIECE: f64 = 0.25;

impl BlendedTurn {
    pub(crate) fn new(deflection: f64, turning: Turning) -> Self {
        let Turning { curvature, sharpness } = turning;
        let size = if deflection.abs() < NO_TURN { 0.0 } else { deflection.abs() };
        let ramps = curvature * curvature / sharpness;
        let (peak, hold) = if size <= ramps {
            ((size * sharpness).sqrt(), 0.0)
        } else {
            (curvature, (size - ramps) / curvature)
        };
        Self { deflection, peak, ramp: peak / sharpness, hold, sharpness }
    }

    fn length(&self) -> f64 {
        2.0 * self.ramp + self.hold
    }

    /// From its beginning to its end, m: twice the part of its first half along the chord.
    fn chord(&self) -> f64 {
        if self.peak <= 0.0 {
            return 0.0;
        }
        let half = 0.5 * self.deflection.abs();
        let ramped = 0.5 * self.peak * self.ramp;
        let clothoid = Clothoid { curvature: 0.0, sharpness: self.sharpness, direction: 1.0 };
        let pieces = (ramped / PIECE).ceil().max(1.0);
        let step = self.ramp / pieces;
        let mut pose = Pose::new(0.0, 0.0, -half);
        for k in 0..pieces as usize {
            pose = clothoid.advance(pose, k as f64 * step, step);
        }
        2.0 * (pose.x + math::sin(half - ramped) / self.peak)
    }

    fn push(&self, list: &mut KnotList, level: f64) {
        let peak = self.peak.copysign(self.deflection);
        list.push(self.ramp, peak, level);
        list.push(self.hold, peak, level);
        list.push(self.ramp, 0.0, level);
    }
}

/// A way from a pose with curvature 0 to another.
#[derive(Debug, Clone, Copy)]
struct Blended {
    first: BlendedTurn,
    straight: f64,
    last: BlendedTurn,
}

impl Blended {
    fn length(&self) -> f64 {
        self.first.length() + self.straight + self.last.length()
    }
}

/// Where a shot begins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShotStart {
    pub pose: Pose,
    /// 1/m.
    pub curvature: f64,
}

/// The shortest shot from a start to a pose, as knots of level 0, if there is one. It begins by going straight, and ends so.
pub(crate) fn shot(start: ShotStart, goal: Pose, turning: Turning) -> Option<KnotList> {
    let mut list = KnotList::starting(start.curvature, 0.0);
    list.push(start.curvature.abs() / turning.sharpness, 0.0, 0.0);
    let from = Leg { start: start.pose, backwards: false, knots: list.0.clone() }.end();
    let best = shortest_blended(from, goal, turning)?;
    best.first.push(&mut list, 0.0);
    list.push(best.straight, 0.0, 0.0);
    best.last.push(&mut list, 0.0);
    Some(list)
}

fn shortest_blended(from: Pose, goal: Pose, turning: Turning) -> Option<Blended> {
    if turning.curvature <= 0.0 {
        return None;
    }
    let with_line = |path: &DubinsPath| path.turns[1] == 0.0;
    let solved = dubins_paths(from, goal, 1.0 / turning.curvature)
        .filter(with_line)
        .filter_map(|path| blended(from, goal, turning, &path));
    solved.fold(None, |best: Option<Blended>, found| match best {
        Some(best) if best.length() <= found.length() => Some(best),
        _ => Some(found),
    })
}

/// Secants until the way misses its goal by less than this, m.
const MISSES: f64 = 1e-10;
const SECANTS: usize = 16;

/// Dubins' way with blended turns, if they meet.
fn blended(from: Pose, goal: Pose, turning: Turning, path: &DubinsPath) -> Option<Blended> {
    let turned = [0, 2].map(|k| path.turns[k] * path.lengths[k] / path.radius);
    let total = turned[0] + turned[1];
    let across = |deflection: f64| Missed::of(from, goal, turning, [deflection, total - deflection]);
    let (mut a, mut b) = (turned[0], turned[0] + 1e-3);
    let (mut missed_a, mut missed) = (across(a), across(b));
    for _ in 0..SECANTS {
        if missed.across.abs() < MISSES {
            break;
        }
        let slope = (missed.across - missed_a.across) / (b - a);
        let next = b - (missed.across / slope).clamp(-0.5, 0.5);
        if !next.is_finite() {
            return None;
        }
        (a, missed_a) = (b, missed);
        (b, missed) = (next, across(next));
    }
    let turns = [b, total - b];
    let turns_on =
        (0..2).all(|k| turns[k] * path.turns[2 * k] >= -1e-9 && turns[k].abs() < std::f64::consts::TAU);
    let meets = missed.across.abs() < MISSES && missed.along >= 0.0 && turns_on;
    meets.then(|| Blended { first: missed.turns[0], straight: missed.along, last: missed.turns[1] })
}

/// By how much the line between two turns misses the goal.
struct Missed {
    across: f64,
    along: f64,
    turns: [BlendedTurn; 2],
}

impl Missed {
    fn of(from: Pose, goal: Pose, turning: Turning, deflections: [f64; 2]) -> Self {
        let turns = deflections.map(|deflection| BlendedTurn::new(deflection, turning));
        let line = from.heading + deflections[0];
        let (sin, cos) = math::sin_cos(line);
        // The goal's heading by the turns, which is its own up to whole turns.
        let chord = |turn: &BlendedTurn, heading: f64| {
            let (sin, cos) = math::sin_cos(heading);
            [turn.chord() * cos, turn.chord() * sin]
        };
        let first = chord(&turns[0], from.heading + 0.5 * deflections[0]);
        let last = chord(&turns[1], line + 0.5 * deflections[1]);
        let [x, y] = [goal.x - from.x - first[0] - last[0], goal.y - from.y - first[1] - last[1]];
        Self { across: cos * y - sin * x, along: cos * x + sin * y, turns }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dubins::shortest_dubins;
    use proptest::prelude::*;
    use vocabulary::wrap;

    const TURNING: Turning = Turning { curvature: 0.8, sharpness: 0.5 };

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]
        #[test]
        fn a_shot_hits_its_goal_within_its_limits(
            x in -15.0..15.0, y in -15.0..15.0, heading in -3.1..3.1, curvature in -0.8..0.8
        ) {
            let (goal, pose) = (Pose::new(x, y, heading), Pose::new(0.3, -0.2, 0.7));
            let found = shot(ShotStart { pose, curvature }, goal, TURNING);
            let far = x * x + y * y > 144.0;
            prop_assert!(found.is_some() || !far);
            if let Some(list) = found {
                let knots = list.0;
                let sharpest = knots.windows(2).map(|k| (k[1].curvature - k[0].curvature).abs() / (k[1].way - k[0].way));
                prop_assert!(sharpest.fold(0.0, f64::max) <= 0.5 + 1e-9);
                prop_assert!(knots.iter().all(|knot| knot.curvature.abs() <= 0.8 + 1e-12));
                prop_assert!(knots[0].curvature == curvature && knots[knots.len() - 1].curvature == 0.0);
                let leg = Leg { start: pose, backwards: false, knots };
                let end = leg.end();
                let error = (end.x - x).abs() + (end.y - y).abs() + wrap(end.heading - heading).abs();
                prop_assert!(error < 1e-6, "{end:?} {goal:?}");
                let least = shortest_dubins(pose, goal, 1.25).length();
                prop_assert!(curvature != 0.0 || leg.length() >= least - 1e-9);
            }
        }
    }
}
