//! What one channel of a set point does in time.

use serde::Serialize;

/// Wanted distance in m, or wanted bearing in rad, as a function of time.
///
/// A wanted distance is above 0 at every instant.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Channel {
    /// Always this.
    Constant(f64),
    /// mean + amplitude · sin(rate · t).
    Sinusoid {
        /// m or rad.
        mean: f64,
        /// m or rad.
        amplitude: f64,
        /// rad/s.
        rate: f64,
    },
    /// Smooth passages from value to value, in the order of time, never overlapping, each from where the last one
    /// ended; at least one.
    Ramps(Vec<Ramp>),
}

/// A smooth passage between two values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ramp {
    /// Value before the passage, m or rad.
    pub from: f64,
    /// Value after it, m or rad.
    pub to: f64,
    /// When it starts, s, not below 0.
    pub start: f64,
    /// How long it takes, s, above 0.
    pub over: f64,
}
