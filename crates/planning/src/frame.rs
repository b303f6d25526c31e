//! A frame whose axes are computed once.

use vocabulary::{Pose, math};

/// A pose as a frame of reference.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FixedFrame {
    origin: Pose,
    sin: f64,
    cos: f64,
}

impl FixedFrame {
    pub(crate) fn new(origin: Pose) -> Self {
        let (sin, cos) = math::sin_cos(origin.heading);
        Self { origin, sin, cos }
    }

    /// [forward, left] of a point of the world, m.
    pub(crate) fn inside(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [dx, dy] = [x - self.origin.x, y - self.origin.y];
        [self.cos * dx + self.sin * dy, self.cos * dy - self.sin * dx]
    }

    /// The point of the world at [forward, left], m.
    pub(crate) fn outside(self, [forward, left]: [f64; 2]) -> [f64; 2] {
        [
            self.origin.x + self.cos * forward - self.sin * left,
            self.origin.y + self.sin * forward + self.cos * left,
        ]
    }

    /// A heading of the world against this one's, rad, not wrapped.
    pub(crate) fn turn(&self, heading: f64) -> f64 {
        heading - self.origin.heading
    }
}
