//! The camera on its mast: it turns towards the leader, and searches when it has lost it.

use super::{CameraSettings, LeaderPrediction};
use vocabulary::{Pose, Relative, TrackingState, math, wrap};

/// Where a camera points over the period that has passed, and how it searches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pan {
    /// At the start of the period, rad from the heading.
    from: f64,
    /// At its end.
    to: f64,
    /// Which way it would sweep: the way it turned last, for that way the leader went.
    sweep: f64,
}

/// Fastest sweep of a search, rad/s: a few pictures of every direction.
const SWEEP: f64 = 2.5;

impl Pan {
    pub(super) fn at(direction: f64, camera: &CameraSettings) -> Self {
        let held = direction.clamp(-camera.pan_max, camera.pan_max);
        Self { from: held, to: held, sweep: 1.0 }
    }

    /// Direction at `share` of the period.
    pub(super) fn between(&self, share: f64) -> f64 {
        self.from + (self.to - self.from) * share
    }

    /// How fast it turns in a period of `period` s, rad/s.
    pub(super) fn rate(&self, period: f64) -> f64 {
        if period > 0.0 { (self.to - self.from) / period } else { 0.0 }
    }

    /// Turns for a period of `period` s, no faster and no farther than it can.
    pub(super) fn turn(
        &mut self,
        belief: &LeaderPrediction,
        forward: f64,
        camera: &CameraSettings,
        period: f64,
    ) {
        let most = camera.pan_rate * period;
        self.from = self.to;
        let wanted = match (belief.relative, belief.sight) {
            // One that has not been seen yet is where it was told to be.
            (
                Some(relative),
                TrackingState::Truth
                | TrackingState::Tracking
                | TrackingState::Coasting
                | TrackingState::Waiting,
            ) => towards(&relative, forward),
            // Nothing has been seen yet: the camera stays where it was pointed.
            (_, TrackingState::Waiting) => self.from,
            _ => {
                if self.from * self.sweep >= camera.pan_max - 1e-9 {
                    self.sweep = -self.sweep;
                }
                self.from + self.sweep * SWEEP.min(camera.pan_rate) * period
            }
        };
        let wanted = wanted.clamp(-camera.pan_max, camera.pan_max);
        self.to = self.from + (wanted - self.from).clamp(-most, most);
        if (self.to - self.from).abs() > 1e-9 {
            self.sweep = (self.to - self.from).signum();
        }
    }
}

/// The leader in its follower's frame.
pub(super) fn leader_pose(relative: &Relative) -> Pose {
    let direction = wrap(relative.view_angle - std::f64::consts::PI);
    let (sin, cos) = math::sin_cos(direction);
    Pose::new(relative.distance * cos, relative.distance * sin, wrap(relative.view_angle - relative.bearing))
}

/// Direction from a camera `forward` m ahead of its robot's reference point to the leader, rad from the heading.
pub(super) fn towards(relative: &Relative, forward: f64) -> f64 {
    let leader = leader_pose(relative);
    math::atan2(leader.y, leader.x - forward)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_leader_is_where_the_relative_position_says() {
        let follower = Pose::new(0.4, -0.3, 0.7);
        let leader = Pose::new(2.0, 1.0, -0.4);
        let seen = leader_pose(&Relative::between(leader, follower));
        let [x, y] = follower.world_from_body(seen.x, seen.y);
        assert!((x - 2.0).abs() < 1e-12 && (y - 1.0).abs() < 1e-12);
        assert!(wrap(seen.heading + follower.heading - leader.heading).abs() < 1e-12);
    }

    #[test]
    fn a_camera_turns_no_faster_than_it_can_and_searches_from_side_to_side() {
        let camera = CameraSettings { pan_rate: 1.0, pan_max: 1.0, ..CameraSettings::default() };
        let mut pan = Pan::at(0.0, &camera);
        let ahead = Relative { distance: 2.0, bearing: -2.0, view_angle: std::f64::consts::PI - 0.5 };
        pan.turn(
            &LeaderPrediction { relative: Some(ahead), sight: TrackingState::Tracking },
            0.0,
            &camera,
            0.1,
        );
        assert!((pan.between(1.0) + 0.1).abs() < 1e-12, "{pan:?}");
        let mut seen = [0.0_f64; 2];
        for _ in 0..100 {
            pan.turn(
                &LeaderPrediction { relative: Some(ahead), sight: TrackingState::Lost },
                0.0,
                &camera,
                0.1,
            );
            assert!((pan.between(1.0) - pan.between(0.0)).abs() < 0.1 + 1e-12);
            seen = [seen[0].min(pan.between(1.0)), seen[1].max(pan.between(1.0))];
        }
        assert!((seen[0] + 1.0).abs() < 1e-9 && (seen[1] - 1.0).abs() < 1e-9, "{seen:?}");
    }
}
