//! Which set points a follower can hold while its leader drives as it does: rigid motion against limits.
//!
//! A follower that keeps its place in the leader's frame moves like a point of a rigid body. With the leader at v and ω,
//! the place [x, y] moves at (v − ω y, ω x) in the leader's frame and turns with ω.

use vocabulary::Limits;

/// Why a place cannot be held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unholdable {
    /// It is nearer than the law allows.
    TooClose,
    /// It would have to drive slower than it can.
    TooSlow,
    /// It would have to drive faster than it can.
    TooFast,
    /// It would have to turn tighter than it can.
    TooTight,
}

/// What stands against a follower with `limits` at `place`, [forward, left] of its leader in m, which drives at `speed`
/// m/s and turns at `turn_rate` rad/s; `distance_min` m is the law's. Margins are shares of the limits.
pub fn unholdable(
    place: [f64; 2],
    (speed, turn_rate): (f64, f64),
    limits: &Limits,
    distance_min: f64,
) -> Option<Unholdable> {
    let [x, y] = place;
    if x.hypot(y) < distance_min {
        return Some(Unholdable::TooClose);
    }
    let ahead = speed - turn_rate * y;
    let needed = ahead.hypot(turn_rate * x);
    // A leader at rest is followed at rest, as near as the limits allow.
    if needed < limits.speed_min && speed > limits.speed_min {
        return Some(Unholdable::TooSlow);
    }
    // Followers drive forward only: where the place moves backwards they would have to turn round.
    if ahead < 0.0 && speed > limits.speed_min {
        return Some(Unholdable::TooSlow);
    }
    if needed > limits.speed_max {
        return Some(Unholdable::TooFast);
    }
    (turn_rate.abs() > limits.turn_rate_at(needed.max(limits.speed_min))).then_some(Unholdable::TooTight)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_straight_line_every_place_can_be_held() {
        for place in [[-2.0, 0.0], [1.0, 5.0], [0.0, -30.0]] {
            assert_eq!(unholdable(place, (1.0, 0.0), &Limits::PAPER, 0.1), None);
        }
        assert_eq!(unholdable([0.05, 0.0], (1.0, 0.0), &Limits::PAPER, 0.1), Some(Unholdable::TooClose));
    }

    #[test]
    fn a_bend_is_too_fast_outside_and_too_slow_inside() {
        // The paper's circle: 1.1 m/s and 0.3 rad/s; the outer follower needs 1.486 m/s of 1.6.
        let place = |distance: f64, bearing: f64| [distance * bearing.cos(), distance * bearing.sin()];
        let at = |d, b: f64| unholdable(place(d, b.to_radians()), (1.0, 0.3), &Limits::PAPER, 0.1);
        assert_eq!(at(2.0, -135.0), None);
        assert_eq!(at(3.0, -90.0), Some(Unholdable::TooFast));
        assert_eq!(at(3.4, 90.0), Some(Unholdable::TooSlow));
    }

    #[test]
    fn steered_wheels_cannot_turn_tightly() {
        let car = Limits { curvature_max: 1.0 / 0.6, ..Limits::PAPER };
        assert_eq!(unholdable([-0.3, 2.5], (1.0, 0.35), &car, 0.1), Some(Unholdable::TooTight));
        assert_eq!(unholdable([-0.3, -1.0], (1.0, 0.35), &car, 0.1), None);
    }
}
