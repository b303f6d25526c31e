//! A value prescribed over time, with its first and second derivative.

use crate::math;
use serde::Serialize;

/// A smooth change of a value: quintic, so that value, rate and acceleration are continuous.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ramp {
    /// Value before it, in the unit of the value; a bearing may lie up to a whole turn from 0, to go round behind.
    pub from: f64,
    /// Value after it.
    pub to: f64,
    /// When it starts, s, not below 0.
    pub start: f64,
    /// How long it takes, s, above 0.
    pub over: f64,
}

/// A value over time: a wanted distance in m, a wanted bearing in rad, a speed in m/s, a turn rate in rad/s.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ScalarTrajectory {
    /// Always the same.
    Constant(f64),
    /// `mean + amplitude · sin(rate · t)`.
    Sinusoid {
        /// In the unit of the value.
        mean: f64,
        /// In the unit of the value.
        amplitude: f64,
        /// rad/s.
        rate: f64,
    },
    /// Ramps in the order of time, never overlapping, each from where the one before ended; at least one.
    Ramps(Vec<Ramp>),
}

impl ScalarTrajectory {
    /// Value, first and second derivative at `t` s.
    pub fn at(&self, t: f64) -> [f64; 3] {
        match self {
            Self::Constant(value) => [*value, 0.0, 0.0],
            Self::Sinusoid { mean, amplitude, rate } => wave(*mean, *amplitude, *rate, t),
            Self::Ramps(ramps) => {
                let mut out = [ramps.first().map_or(0.0, |ramp| ramp.from), 0.0, 0.0];
                for ramp in ramps.iter().take_while(|r| r.start <= t) {
                    out = ramp.at(out[0], t);
                }
                out
            }
        }
    }

    /// The least and the largest value at any time.
    pub fn range(&self) -> [f64; 2] {
        let of = |values: &[f64]| {
            [
                values.iter().fold(f64::INFINITY, |a, b| a.min(*b)),
                values.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)),
            ]
        };
        match self {
            Self::Constant(value) => [*value; 2],
            Self::Sinusoid { mean, amplitude, .. } => of(&[mean - amplitude, mean + amplitude]),
            Self::Ramps(ramps) => of(&ramps.iter().flat_map(|r| [r.from, r.to]).collect::<Vec<_>>()),
        }
    }
}

/// Value, first and second derivative of `mean + amplitude · sin(rate · t)`.
fn wave(mean: f64, amplitude: f64, rate: f64, t: f64) -> [f64; 3] {
    let (sin, cos) = math::sin_cos(rate * t);
    [mean + amplitude * sin, amplitude * rate * cos, -amplitude * rate * rate * sin]
}

impl Ramp {
    /// Value, rate and acceleration at `t` s of a ramp that begins at `from`, where the one before ended.
    fn at(&self, from: f64, t: f64) -> [f64; 3] {
        let u = ((t - self.start) / self.over).clamp(0.0, 1.0);
        let rise = self.to - from;
        let value = u * u * u * (10.0 + u * (6.0 * u - 15.0));
        let rate = 30.0 * u * u * (1.0 - u) * (1.0 - u);
        let acceleration = 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u);
        [from + rise * value, rise * rate / self.over, rise * acceleration / (self.over * self.over)]
    }
}
