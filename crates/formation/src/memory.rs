//! What a follower remembers of its leader from sample to sample, where its law needs a memory of its own.

use crate::law::Law;
use crate::narrowing::NarrowingState;
use crate::path_heading::PathHeading;
use crate::relative::Geometry;
use crate::standing::Standing;
use vocabulary::{Observation, math};

/// What one follower remembers. An edge that is not tracked remembers nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeMemory {
    /// The leader's speed as believed, smoothed, m/s; never negative.
    pub speed: f64,
    /// Its change, smoothed, m/s².
    pub acceleration: f64,
    /// The leader's heading filtered along its path; `None` before the first sample and where the law holds the bearing
    /// against the leader's own heading.
    pub heading: Option<PathHeading>,
    /// Whether the follower stands, and where its set point is for that.
    pub standing: Standing,
    /// How far it has filed in.
    pub narrowing: NarrowingState,
}

/// Time constant of the believed speed, s.
const SPEED_TIME: f64 = 0.045;
/// Time constant of its change, s.
const ACCELERATION_TIME: f64 = 0.06;

impl EdgeMemory {
    /// Takes in a sample `period` s after the last: what is seen of the leader, and the rates of the law's output.
    pub fn advance(&mut self, law: &Law, seen: &Observation, rates: [f64; 2], period: f64) {
        let Some(filter) = law.heading.filter() else { return };
        let leader_heading = seen.own_heading + seen.relative.view_angle - seen.relative.bearing;
        let speed = leader_speed(law, seen, rates);
        let Some(heading) = &mut self.heading else {
            self.speed = speed;
            self.heading = Some(PathHeading::at(leader_heading));
            return;
        };
        let before = self.speed;
        self.speed += share(period, SPEED_TIME) * (speed - before);
        let change = (self.speed - before) / period;
        self.acceleration += share(period, ACCELERATION_TIME) * (change - self.acceleration);
        heading.advance(filter, leader_heading, self.speed * period);
    }
}

impl EdgeMemory {
    /// The leader's speed, while it brakes without the delay of the smoothing, m/s: who brakes late comes too near, and who
    /// starts late only lags.
    pub(crate) fn speed_now(&self) -> f64 {
        (self.speed + (SPEED_TIME + ACCELERATION_TIME) * self.acceleration.min(0.0)).max(0.0)
    }
}

/// Share of its way that a first-order lag goes in a period.
fn share(period: f64, time: f64) -> f64 {
    1.0 - math::exp(-period / time)
}

/// The leader's speed along its heading, from what the follower does and the rates of [ℓ, φ], m/s: eqs 6-7 solved for it.
fn leader_speed(law: &Law, seen: &Observation, [closing, turning]: [f64; 2]) -> f64 {
    let geometry = Geometry::new(&seen.relative, law.distance_min);
    let along = seen.own_speed * geometry.cos_view - closing;
    let across = turning * geometry.distance + seen.own_speed * geometry.sin_view;
    let speed = geometry.cos_bearing * along + geometry.sin_bearing * across;
    if speed.is_finite() { speed.max(0.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vocabulary::{Motion, Pose};

    proptest! {
        /// The true rates of [ℓ, φ] give the leader's speed, however it turns.
        #[test]
        fn rates_tell_the_leaders_speed(
            x in -3.0..3.0, y in -3.0..3.0, headings in (-3.0..3.0, -3.0..3.0), speeds in (0.0..2.0, 0.0..2.0)
        ) {
            prop_assume!(math::hypot(x, y) > 0.3);
            let leader = Motion { pose: Pose::new(x, y, headings.0), speed: speeds.0, ..Motion::default() };
            let follower = Motion { pose: Pose::new(0.0, 0.0, headings.1), speed: speeds.1, ..Motion::default() };
            let law = crate::law::test_law();
            let seen = Observation::true_of([&leader, &follower]);
            let rates = Geometry::new(&seen.relative, 0.1).rates(speeds.1, speeds.0, 0.0);
            prop_assert!((leader_speed(&law, &seen, rates.into()) - speeds.0).abs() < 1e-12);
        }
    }
}
