//! What a follower remembers of its leader from sample to sample, where its law needs a memory of its own.

use crate::hand_over::HandOver;
use crate::law::Law;
use crate::narrowing::NarrowingState;
use crate::path_heading::PathHeading;
use crate::relative::{Geometry, LineOfSight};
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
    /// Its way to its place, where it has changed its leader.
    pub hand_over: Option<HandOver>,
    /// How fast a formation turned whose robots change their leaders, rad/s: the path of the new one turns alike at first.
    pub turn_rate: f64,
    /// How far it has filed in.
    pub narrowing: NarrowingState,
}

/// A leader slower than this has no path that turns, m/s.
const DRIVES: f64 = 0.1;
/// Time constant of the believed speed, s.
const SPEED_TIME: f64 = 0.045;
/// Time constant of its change, s.
const ACCELERATION_TIME: f64 = 0.06;

impl EdgeMemory {
    /// What is left of it when the leader is out of sight.
    pub(crate) fn forget(&mut self) {
        let mut hand_over = self.hand_over;
        hand_over.iter_mut().for_each(HandOver::forget);
        // Where one has filed in one stays.
        *self = Self { hand_over, narrowing: self.narrowing, ..Self::default() };
    }

    /// How far the place that the follower is driven to is from its set point, m.
    pub(crate) fn displacement(&self) -> f64 {
        let hand_over = self.hand_over.map_or([0.0; 2], |hand_over| hand_over.offset().value);
        let offsets = [hand_over, self.standing.offset().value, self.narrowing.offset().value];
        let [x, y] = [0, 1].map(|k| offsets.iter().map(|offset| offset[k]).sum::<f64>());
        math::hypot(x, y)
    }

    /// How fast the leader's path turns as it is believed, rad/s.
    pub fn path_turn_rate(&self, law: &Law) -> Option<f64> {
        let (filter, heading) = law.heading.filter().zip(self.heading.as_ref())?;
        Some(heading.rate(filter, self.speed))
    }

    /// What is left of it when another robot leads from now on.
    pub(crate) fn change_leader(&mut self, law: &Law, hand_over: HandOver, own_turn_rate: f64) {
        let turn_rate = self.path_turn_rate(law).unwrap_or(own_turn_rate);
        let (standing, narrowing) = (self.standing.kept(), self.narrowing);
        *self = Self { standing, narrowing, hand_over: Some(hand_over), turn_rate, ..Self::default() };
    }

    /// Takes in a sample `period` s after the last: what is seen of the leader, and the rates of the law's output.
    pub fn advance(&mut self, law: &Law, seen: &Observation, rates: [f64; 2], period: f64) {
        let Some(filter) = law.heading.filter() else { return };
        let leader_heading = seen.own_heading + seen.relative.view_angle - seen.relative.bearing;
        let speed = leader_speed(law, seen, rates);
        let Some(heading) = &mut self.heading else {
            self.speed = speed;
            let curvature = if speed > DRIVES { self.turn_rate / speed } else { 0.0 };
            self.heading = Some(PathHeading::steady(filter, leader_heading, curvature));
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
    let LineOfSight { distance, sin_view, cos_view } = geometry.line;
    let along = seen.own_speed * cos_view - closing;
    let across = turning * distance + seen.own_speed * sin_view;
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
