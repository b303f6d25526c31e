//! A half-plane of commands, and what it stands for.

use vocabulary::Constraint;

/// The commands u = [dv/dt in m/s², ω in rad/s] with normal · u ≥ bound.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HalfPlane {
    /// A row of the barriers; need not be a unit vector.
    pub normal: [f64; 2],
    /// Right-hand side.
    pub bound: f64,
    /// What it keeps the robot from.
    pub constraint: Constraint,
    /// The barrier function h, m or rad.
    pub value: f64,
    /// Direction from the robot to what it is about, rad in the world's frame.
    pub direction: f64,
}

impl HalfPlane {
    /// normal · u − bound: below zero where `u` is not allowed.
    pub fn slack(&self, u: [f64; 2]) -> f64 {
        dot(self.normal, u) - self.bound
    }

    /// Whether all four corners of a box [[a from, a to], [ω from, ω to]] are allowed.
    pub(crate) fn holds_in(&self, limits: [[f64; 2]; 2]) -> bool {
        let least = |k: usize| {
            let [from, to] = limits[k];
            (self.normal[k] * from).min(self.normal[k] * to)
        };
        least(0) + least(1) >= self.bound
    }
}

pub(crate) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The third component of a × b.
pub(crate) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
