//! Speeds along a way: bounds at every point, then a pass forwards for what it can gain and one backwards for what it can brake.
//!
//! ```text
//! v ≤ v_max    |κ| v² ≤ a_lat    |dκ/ds| v ≤ κ̇_max    r_j v ≤ v_outer    v T ≤ D
//! |dχ_j/ds| v ≤ ω_max    |dr_j/ds| v² ≤ a_j
//! v_{k+1}² ≤ v_k² + 2 a Δs      v_k² ≤ v_{k+1}² + 2 b Δs
//! ```
//!
//! r_j is the speed of follower j per speed of the lead, χ_j the direction in which it drives, and T = Δ/r + r/a the time in which a place moves by Δ, for which the
//! lead drives D. Each bound holds at both ends of a piece: v² is linear in between.

use crate::formation_model::FormationModel;
use crate::leg::CurvatureKnot;
use crate::limits::TravelLimits;

/// What bounds the speed over a piece of a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PieceBound {
    /// m.
    pub length: f64,
    /// Largest |κ|, 1/m.
    pub curvature: f64,
    /// |dκ/ds|, 1/m².
    pub sharpness: f64,
    /// Largest speed of a follower per speed of the lead.
    pub ratio: f64,
    /// By how much a follower turns per way of the lead, rad/m: the most.
    pub turn: f64,
    /// By how much `ratio` changes per way of the lead for any follower, 1/m: the most.
    pub change: f64,
    /// Speed in which places can follow, m/s.
    pub places: f64,
}

impl PieceBound {
    fn speed(&self, limits: &TravelLimits) -> f64 {
        let mut speed = limits.speed.min(self.places).min(limits.outer / self.ratio.max(1e-9));
        if self.curvature > 0.0 {
            speed = speed.min((limits.lateral / self.curvature).sqrt());
        }
        if self.sharpness > 0.0 {
            speed = speed.min(limits.steering / self.sharpness);
        }
        if let Some(turn_rate) = limits.follower_turn_rate.filter(|_| self.turn > 0.0) {
            speed = speed.min(turn_rate / self.turn);
        }
        if let Some(acceleration) = limits.follower_acceleration.filter(|_| self.change > 0.0) {
            speed = speed.min((acceleration / self.change).sqrt());
        }
        speed
    }
}

/// Speeds at all ends of pieces, m/s, one more than there are pieces. The last is 0; the first is `start`, or less where that
/// could not be braked in time.
pub(crate) fn speeds(pieces: &[PieceBound], limits: &TravelLimits, start: f64) -> Vec<f64> {
    let n = pieces.len();
    let bounds: Vec<f64> = pieces.iter().map(|piece| piece.speed(limits)).collect();
    let mut speeds = vec![0.0; n + 1];
    for k in 0..n {
        let bound = if k == 0 { bounds[0] } else { bounds[k - 1].min(bounds[k]) };
        speeds[k] = bound;
    }
    if n > 0 {
        speeds[0] = speeds[0].min(start);
    }
    for k in 0..n {
        let gained = speeds[k] * speeds[k] + 2.0 * limits.acceleration * pieces[k].length;
        speeds[k + 1] = speeds[k + 1].min(gained.sqrt());
    }
    for k in (0..n).rev() {
        let braked = speeds[k + 1] * speeds[k + 1] + 2.0 * limits.braking * pieces[k].length;
        speeds[k] = speeds[k].min(braked.sqrt());
    }
    speeds
}

/// For every way at which levels begin or end to change: until where, and the speed in which places can follow, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LevelRamp {
    pub from: f64,
    pub to: f64,
    pub speed: f64,
}

/// Ramps of the levels of a leg: knots over which the level goes on in one direction are one.
pub(crate) fn level_ramps(
    knots: &[CurvatureKnot],
    model: &FormationModel,
    limits: &TravelLimits,
) -> Vec<LevelRamp> {
    let mut ramps = vec![];
    let mut k = 0;
    while k + 1 < knots.len() {
        let side = |k: usize| (knots[k + 1].level - knots[k].level).partial_cmp(&0.0);
        let mut end = k + 1;
        if knots[k + 1].level != knots[k].level {
            while end + 1 < knots.len() && side(end) == side(k) {
                end += 1;
            }
            let [from, to] = [knots[k], knots[end]];
            let way = moves(model, from.level, to.level);
            let (rate, acceleration) = (limits.place_rate, limits.place_acceleration);
            let settles = rate * rate / acceleration;
            let time = if way >= settles {
                way / rate + rate / acceleration
            } else {
                2.0 * (way / acceleration).sqrt()
            };
            let speed = if time > 0.0 { (to.way - from.way) / time } else { f64::INFINITY };
            ramps.push(LevelRamp { from: from.way, to: to.way, speed });
        }
        k = end;
    }
    ramps
}

/// The farthest that a place moves between two levels, against its leader, m.
fn moves(model: &FormationModel, from: f64, to: f64) -> f64 {
    let last = model.levels() - 1;
    let at = |places: &[[f64; 2]], level: f64| {
        let below = (level.max(0.0) as usize).min(last);
        let [a, b] = [places[below], places[(below + 1).min(last)]];
        [0, 1].map(|k| a[k] + (level - below as f64) * (b[k] - a[k]))
    };
    let moved =
        model.followers().iter().map(|f| crate::convex::apart(at(&f.places, from), at(&f.places, to)));
    moved.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(curvature: f64, sharpness: f64, ratio: f64) -> PieceBound {
        PieceBound { length: 0.1, curvature, sharpness, ratio, turn: 0.0, change: 0.0, places: f64::INFINITY }
    }

    #[test]
    fn a_straight_way_is_gained_held_and_braked() {
        let limits = TravelLimits::default();
        let pieces = [piece(0.0, 0.0, 1.0); 100];
        let found = speeds(&pieces, &limits, 0.0);
        for (k, speed) in found.iter().enumerate() {
            let s = 0.1 * k as f64;
            let expected = (0.6 * s).sqrt().min(0.8).min((0.6 * (10.0 - s).max(0.0)).sqrt());
            assert!((speed - expected).abs() < 1e-6, "{k} {speed} {expected}");
        }
        assert_eq!(found[100], 0.0);
    }

    #[test]
    fn each_bound_is_held() {
        let limits = TravelLimits {
            lateral: 0.2,
            steering: 0.1,
            acceleration: 9.0,
            braking: 9.0,
            follower_turn_rate: Some(0.5),
            follower_acceleration: Some(0.1),
            ..TravelLimits::default()
        };
        let slow = |piece: PieceBound| speeds(&[piece; 60], &limits, 0.3)[30];
        assert!((slow(piece(0.8, 0.0, 1.0)) - 0.5).abs() < 1e-12);
        assert!((slow(piece(0.0, 0.4, 1.0)) - 0.25).abs() < 1e-12);
        assert!((slow(piece(0.0, 0.0, 4.0)) - 0.4).abs() < 1e-12);
        assert!((slow(PieceBound { places: 0.1, ..piece(0.0, 0.0, 1.0) }) - 0.1).abs() < 1e-12);
        assert!((slow(PieceBound { turn: 2.0, ..piece(0.0, 0.0, 1.0) }) - 0.25).abs() < 1e-12);
        assert!((slow(PieceBound { change: 2.5, ..piece(0.0, 0.0, 1.0) }) - 0.2).abs() < 1e-12);
        assert!((slow(piece(0.0, 0.0, 1.0)) - 0.8).abs() < 1e-12);
    }
}
