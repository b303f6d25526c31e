//! Where a robot stands on the plane.

use crate::math;

/// Position in m and heading in rad, in the world frame (x forward, y left).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// m, world frame.
    pub x: f64,
    /// m, world frame.
    pub y: f64,
    /// rad in (−π, π], counter-clockwise from the x axis.
    pub heading: f64,
}

impl Pose {
    /// A pose from position in m and heading in rad.
    pub const fn new(x: f64, y: f64, heading: f64) -> Self {
        Self { x, y, heading }
    }

    /// [forward, left] in m in this pose's body frame of a point given in world coordinates, m.
    pub fn body_from_world(&self, x: f64, y: f64) -> [f64; 2] {
        let (sin, cos) = math::sin_cos(self.heading);
        let (dx, dy) = (x - self.x, y - self.y);
        [cos * dx + sin * dy, cos * dy - sin * dx]
    }

    /// World coordinates in m of a point given in this pose's body frame (`forward`, `left`) in m.
    pub fn world_from_body(&self, forward: f64, left: f64) -> [f64; 2] {
        let (sin, cos) = math::sin_cos(self.heading);
        [self.x + forward * cos - left * sin, self.y + forward * sin + left * cos]
    }

    /// World coordinates in m of a point at a `distance` in m and a `bearing` in rad from this pose.
    pub fn polar(&self, distance: f64, bearing: f64) -> [f64; 2] {
        let (sin, cos) = math::sin_cos(bearing);
        self.world_from_body(distance * cos, distance * sin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_is_left() {
        let east = Pose::new(1.0, 2.0, 0.0);
        assert_eq!(east.world_from_body(1.0, 0.5), [2.0, 2.5]);
        assert_eq!(east.body_from_world(2.0, 2.5), [1.0, 0.5]);
        let north = Pose::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        let [x, y] = north.world_from_body(1.0, 0.5);
        assert!((x + 0.5).abs() < 1e-15 && (y - 1.0).abs() < 1e-15);
        let [x, y] = east.polar(2.0, std::f64::consts::FRAC_PI_2);
        assert!((x - 1.0).abs() < 1e-15 && (y - 4.0).abs() < 1e-15);
    }
}
