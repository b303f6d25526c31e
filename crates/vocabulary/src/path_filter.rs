//! A filter of a leader's heading along its way, which laws hold bearings against and plans hold places against.
//!
//! With e = θ_i − θ̄ and s the way the leader has gone, H = (1 + (2λ − τ) s)/(1 + λ s)² from θ_i to θ̄ is
//!
//! ```text
//! dθ̄/ds = κ̄ + b e                 b = (2λ − τ)/λ²
//! dκ̄/ds = (1 − τ/λ)² e/λ² − τ κ̄/λ²
//! ```
//!
//! On a circle θ̄ ends τ/R behind θ_i. At τ = 0 this is the loop without lag of Kanayama's kind, at τ = λ the first-order
//! filter dθ̄/ds = e/λ.

use crate::{math, wrap};

/// A filter of the leader's heading along its path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathFilter {
    /// λ, m; positive: a turn of the leader has arrived when it has gone a few of these.
    pub length: f64,
    /// τ, m, from 0 to 2 λ: on a circle of radius R the filtered heading is τ/R behind.
    pub lag: f64,
}

impl PathFilter {
    /// b, 1/m.
    pub fn gain(&self) -> f64 {
        (2.0 * self.length - self.lag) / (self.length * self.length)
    }

    /// dκ̄/ds per e and per −κ̄, [1/m², 1/m].
    pub fn curvature_gains(&self) -> [f64; 2] {
        let square = self.length * self.length;
        let left = 1.0 - self.lag / self.length;
        [left * left / square, self.lag / square]
    }

    /// How far θ̄ ends behind the heading of a leader that drives at `speed` m/s and turns at `turn_rate` rad/s, rad; 0
    /// behind one that stands.
    pub fn steady(&self, speed: f64, turn_rate: f64) -> f64 {
        if speed > 0.0 { wrap(self.lag * turn_rate / speed) } else { 0.0 }
    }

    /// [e, κ̄] after `travelled` m of the leader's way on which its heading is held. Exact: both roots are −1/λ.
    pub fn step(&self, [e, kappa]: [f64; 2], travelled: f64) -> [f64; 2] {
        let (b, [rise, fall], root) = (self.gain(), self.curvature_gains(), 1.0 / self.length);
        let decay = math::exp(-root * travelled);
        // e^(M s) = e^(−s/λ) (I + (M + I/λ) s).
        [
            decay * (e + travelled * ((root - b) * e - kappa)),
            decay * (kappa + travelled * (rise * e + (root - fall) * kappa)),
        ]
    }
}
