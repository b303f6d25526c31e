//! Which set points a follower can hold while its leader drives as it does: rigid motion against limits.
//!
//! A follower that keeps its place in the leader's frame moves like a point of a rigid body. With the leader at v and ω,
//! the place [x, y] moves at (v − ω y, ω x) in the leader's frame and turns with ω.

use vocabulary::{Limits, MotionInput, math};

/// Why a place cannot be held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Infeasible {
    /// It is nearer than the law allows.
    TooClose,
    /// It would have to drive slower than it can.
    TooSlow,
    /// It would have to drive faster than it can.
    TooFast,
    /// It would have to turn tighter than it can.
    TooTight,
    /// It would have to speed up or brake harder than it can.
    TooHard,
}

/// What stands against a follower with `limits` at `place`, [forward, left] in m of a leader that moves as `leader`;
/// `distance_min` m is the law's.
pub fn infeasible(
    place: [f64; 2],
    leader: &MotionInput,
    limits: &Limits,
    distance_min: f64,
) -> Option<Infeasible> {
    let [x, y] = place;
    if math::hypot(x, y) < distance_min {
        return Some(Infeasible::TooClose);
    }
    let (needed, moving) = (held(place, leader), leader.speed > limits.speed_min);
    // A leader at rest is followed at rest, as near as the limits allow; followers drive forward only, and where the
    // place moves backwards they would have to turn round.
    if moving && (needed.speed < limits.speed_min || leader.speed - leader.turn_rate * y < 0.0) {
        return Some(Infeasible::TooSlow);
    }
    if needed.speed > limits.speed_max {
        return Some(Infeasible::TooFast);
    }
    if needed.turn_rate.abs() > limits.turn_rate_at(needed.speed.max(limits.speed_min)) {
        return Some(Infeasible::TooTight);
    }
    (needed.acceleration.abs() > limits.acceleration_max).then_some(Infeasible::TooHard)
}

/// How a follower moves that keeps its `place`, [forward, left] of its leader in m. The change of its turn rate is the
/// leader's: exact while the leader turns steadily.
pub fn held(place: [f64; 2], leader: &MotionInput) -> MotionInput {
    let [x, y] = place;
    let (ahead, aside) = (leader.speed - leader.turn_rate * y, leader.turn_rate * x);
    let speed = math::hypot(ahead, aside);
    if speed <= f64::EPSILON {
        return MotionInput { speed, acceleration: 0.0, ..*leader };
    }
    let slope = [leader.acceleration - leader.turn_acceleration * y, leader.turn_acceleration * x];
    MotionInput {
        speed,
        acceleration: (ahead * slope[0] + aside * slope[1]) / speed,
        // The place's direction turns in the leader's frame, too.
        turn_rate: leader.turn_rate + (ahead * slope[1] - aside * slope[0]) / (speed * speed),
        turn_acceleration: leader.turn_acceleration,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steady(speed: f64, turn_rate: f64) -> MotionInput {
        MotionInput { speed, turn_rate, ..MotionInput::default() }
    }

    #[test]
    fn on_a_straight_line_every_place_can_be_held() {
        for place in [[-2.0, 0.0], [1.0, 5.0], [0.0, -30.0]] {
            assert_eq!(infeasible(place, &steady(1.0, 0.0), &Limits::PAPER, 0.1), None);
        }
        assert_eq!(
            infeasible([0.05, 0.0], &steady(1.0, 0.0), &Limits::PAPER, 0.1),
            Some(Infeasible::TooClose)
        );
    }

    #[test]
    fn a_bend_is_too_fast_outside_and_too_slow_inside() {
        // The paper's circle: 1.1 m/s and 0.3 rad/s; the outer follower needs 1.486 m/s of 1.6.
        let place =
            |distance: f64, bearing: f64| [distance * math::cos(bearing), distance * math::sin(bearing)];
        let at = |d, b: f64| infeasible(place(d, b.to_radians()), &steady(1.0, 0.3), &Limits::PAPER, 0.1);
        assert_eq!(at(2.0, -135.0), None);
        assert_eq!(at(3.0, -90.0), Some(Infeasible::TooFast));
        assert_eq!(at(3.4, 90.0), Some(Infeasible::TooSlow));
    }

    #[test]
    fn steered_wheels_cannot_turn_tightly() {
        let car = Limits { curvature_max: 1.0 / 0.6, ..Limits::PAPER };
        assert_eq!(infeasible([-0.3, 2.5], &steady(1.0, 0.35), &car, 0.1), Some(Infeasible::TooTight));
        assert_eq!(infeasible([-0.3, -1.0], &steady(1.0, 0.35), &car, 0.1), None);
    }

    /// Speed, turn rate and acceleration of a place, by finite differences of where it is.
    #[test]
    fn a_place_behind_a_leader_that_changes_its_mind_moves_as_it_is_said_to() {
        let place = [-1.2, 0.8];
        let leader = MotionInput { speed: 1.0, acceleration: 0.4, turn_rate: 0.3, turn_acceleration: -0.5 };
        // The leader's pose by the same midpoint rule as a fine integration.
        let at = |t: f64| {
            let steps = 2000;
            let h = t / f64::from(steps);
            let (mut x, mut y) = (0.0, 0.0);
            let heading = |s: f64| leader.turn_rate * s + leader.turn_acceleration * s * s / 2.0;
            for k in 0..steps {
                let s = (f64::from(k) + 0.5) * h;
                let v = leader.speed + leader.acceleration * s;
                (x, y) = (x + v * math::cos(heading(s)) * h, y + v * math::sin(heading(s)) * h);
            }
            let (sin, cos) = math::sin_cos(heading(t));
            [x + place[0] * cos - place[1] * sin, y + place[0] * sin + place[1] * cos]
        };
        let h = 1e-3;
        let velocity = |t: f64| {
            let (a, b) = (at(t - h), at(t + h));
            [(b[0] - a[0]) / (2.0 * h), (b[1] - a[1]) / (2.0 * h)]
        };
        let polar = |t: f64| {
            let [x, y] = velocity(t);
            [math::hypot(x, y), math::atan2(y, x)]
        };
        let (before, now, after) = (polar(-h), polar(0.0), polar(h));
        let [speed, acceleration, turn_rate] =
            [now[0], (after[0] - before[0]) / (2.0 * h), (after[1] - before[1]) / (2.0 * h)];
        let just = |share: f64| Limits {
            speed_max: 9.0,
            acceleration_max: share * acceleration.abs(),
            turn_rate_max: 11.5,
            ..Limits::PAPER
        };
        let judge = |limits: Limits| infeasible(place, &leader, &limits, 0.1);
        assert_eq!(judge(just(1.001)), None);
        assert_eq!(judge(just(0.999)), Some(Infeasible::TooHard));
        let tight = |share: f64| Limits { turn_rate_max: share * turn_rate.abs(), ..just(2.0) };
        assert_eq!((judge(tight(1.001)), judge(tight(0.999))), (None, Some(Infeasible::TooTight)));
        let fast = |share: f64| Limits { speed_max: share * speed, ..just(2.0) };
        assert_eq!((judge(fast(1.001)), judge(fast(0.999))), (None, Some(Infeasible::TooFast)));
    }
}
