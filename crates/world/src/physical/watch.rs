//! Notices robots that cannot drive any more.

use super::ground::FAR;
use vocabulary::{Attitude, Condition, Motion, math};

/// Cosine of the tilt beyond which a vehicle lies on its side or roof.
const TILTED: f64 = 0.35;
/// How long it has to lie there, s.
const LYING: f64 = 0.5;
/// A vehicle slower than this does not move, m/s; one that is told to crawl moves at half of what it is told.
const STILL: f64 = 0.03;
/// Share of the speed that a vehicle is told below which it does not move.
const CRAWLS: f64 = 0.5;
/// How far its target speed is then ahead, as a share of how far it can be.
const PULLING: f64 = 0.5;
/// How long it has to pull in vain, s.
const STUCK: f64 = 1.5;
/// Depth under the ground at which a robot has fallen through or off, m.
const DEEP: f64 = 1.0;

/// Since when something is wrong with a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct StuckDetector {
    tilted: Option<f64>,
    pulling: Option<f64>,
}

impl StuckDetector {
    /// The vehicle's condition at `time`, `below` m under its surface; its target speed is `ahead` of its speed by that
    /// share of what it can be, and it is `told` to go at that speed, m/s.
    pub(super) fn look(
        &mut self,
        time: f64,
        [ahead, told]: [f64; 2],
        motion: &Motion,
        attitude: &Attitude,
        below: f64,
    ) -> Condition {
        let lasts = |since: &mut Option<f64>, now: bool, long: f64| {
            *since = if now { Some(since.unwrap_or(time)) } else { None };
            since.is_some_and(|since| time - since >= long)
        };
        let tilted = math::cos(attitude.roll) * math::cos(attitude.pitch) < TILTED;
        let pulling = motion.speed.abs() < STILL.min(CRAWLS * told) && ahead > PULLING;
        let lying = lasts(&mut self.tilted, tilted, LYING);
        let stuck = lasts(&mut self.pulling, pulling, STUCK);
        let away = motion.pose.x.abs().max(motion.pose.y.abs()) > FAR;
        if below > DEEP || away || !below.is_finite() {
            Condition::Fallen
        } else if lying {
            Condition::Overturned
        } else if stuck {
            Condition::Stuck
        } else {
            Condition::Able
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(seconds: f64, roll: f64, speed: f64, [ahead, told]: [f64; 2], below: f64) -> Condition {
        let mut watch = StuckDetector::default();
        let (motion, attitude) =
            (Motion { speed, ..Motion::default() }, Attitude { roll, ..Attitude::default() });
        let mut condition = Condition::Able;
        for k in 0..=(seconds * 100.0) as usize {
            condition = watch.look(k as f64 * 0.01, [ahead, told], &motion, &attitude, below);
        }
        condition
    }

    #[test]
    fn each_condition_is_named_and_takes_its_time() {
        assert_eq!(after(9.0, 0.3, 1.0, [0.0, 1.0], 0.0), Condition::Able);
        assert_eq!(
            (after(0.4, 1.5, 0.0, [0.0, 1.0], 0.0), after(0.6, 1.5, 0.0, [0.0, 1.0], 0.0)),
            (Condition::Able, Condition::Overturned)
        );
        assert_eq!(
            (after(1.4, 0.0, 0.0, [0.9, 1.0], 0.0), after(1.6, 0.0, 0.0, [0.9, 1.0], 0.0)),
            (Condition::Able, Condition::Stuck)
        );
        assert_eq!(after(9.0, 0.0, 0.0, [0.1, 1.0], 0.0), Condition::Able, "who does not pull is not stuck");
        assert_eq!(after(9.0, 0.0, 0.0, [0.9, 0.0], 0.0), Condition::Able, "nor who is to stand");
        assert_eq!(after(9.0, 0.0, 0.01, [0.9, 0.01], 0.0), Condition::Able, "nor who crawls as it is told");
        assert_eq!(after(0.0, 0.0, 1.0, [0.0, 1.0], 1.5), Condition::Fallen);
        assert_eq!(after(0.0, 0.0, 1.0, [0.0, 1.0], f64::NAN), Condition::Fallen);
    }
}
