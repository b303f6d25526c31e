//! Who follows whom, where a follower is, and where it should be.

use crate::math;
use crate::{Pose, wrap};

/// A leader-follower pair; both are indices of robots in a snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Edge {
    /// Index of the robot that is followed (robot i of the paper).
    pub leader: usize,
    /// Index of the robot that follows (robot j of the paper).
    pub follower: usize,
}

/// Where a follower is relative to its leader (eqs 2-4).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Relative {
    /// Distance between the two, m (ℓ).
    pub distance: f64,
    /// Direction to the follower seen from the leader's heading, rad (ψ); positive is to the left.
    pub bearing: f64,
    /// The leader stands at this angle minus π from the follower's heading, rad (γ).
    pub view_angle: f64,
}

impl Relative {
    /// [distance, bearing, view angle], m and rad.
    pub fn coordinates(&self) -> [f64; 3] {
        [self.distance, self.bearing, self.view_angle]
    }

    /// Distance, bearing and view angle of a follower (eqs 2-4).
    ///
    /// Two robots on the same spot have distance 0 and, by choice, the line between them along the x axis.
    pub fn between(leader: Pose, follower: Pose) -> Self {
        let (dx, dy) = (leader.x - follower.x, leader.y - follower.y);
        let from_follower = math::atan2(dy, dx);
        Self {
            distance: (dx * dx + dy * dy).sqrt(),
            bearing: wrap(std::f64::consts::PI + from_follower - leader.heading),
            view_angle: wrap(std::f64::consts::PI + from_follower - follower.heading),
        }
    }
}

/// Wanted [distance in m, bearing in rad] of an edge at an instant, with first and second time derivative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SetPoint {
    /// [m, rad].
    pub value: [f64; 2],
    /// [m/s, rad/s].
    pub rate: [f64; 2],
    /// [m/s², rad/s²].
    pub acceleration: [f64; 2],
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_papers_set_point_is_behind_and_to_the_right() {
        let root = 2.0_f64.sqrt();
        let r = Relative::between(Pose::default(), Pose::new(-root, -root, 0.0));
        assert!((r.distance - 2.0).abs() < 1e-15 && (r.bearing + 0.75 * PI).abs() < 1e-15);
    }

    #[test]
    fn two_robots_on_one_spot_are_defined() {
        let r = Relative::between(Pose::new(1.0, 1.0, 0.3), Pose::new(1.0, 1.0, -0.3));
        assert_eq!(r.distance, 0.0);
        assert!(r.bearing.is_finite() && r.view_angle.is_finite());
    }

    /// From the follower's heading the leader stands at γ − π.
    #[test]
    fn the_view_angle_points_back_at_the_leader() {
        let (leader, follower) = (Pose::new(3.0, 1.0, 0.4), Pose::new(1.0, 0.0, -0.7));
        let r = Relative::between(leader, follower);
        let direction = math::atan2(1.0_f64, 2.0) - follower.heading;
        assert!((wrap(r.view_angle - PI) - wrap(direction)).abs() < 1e-14);
    }
}
