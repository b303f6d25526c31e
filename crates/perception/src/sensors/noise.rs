//! The truth with errors.

use crate::imaging::NoiseStream;
use vocabulary::{Measurement, Relative, math, wrap};

/// Errors that are added to the truth, each of [distance in m, bearing in rad, view angle in rad].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseModel {
    /// Standard deviation.
    pub deviation: [f64; 3],
    /// The same in every measurement.
    pub bias: [f64; 3],
    /// Time over which errors are alike, s; 0 where each measurement has its own.
    pub correlation: f64,
}

/// Slowly changing errors, in standard deviations.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Drift {
    now: Option<[f64; 3]>,
}

impl NoiseModel {
    /// A measurement `interval` s after the last one. Correlated errors are a first-order Gauss-Markov process, so that
    /// their standard deviation stays what it is.
    pub(super) fn measurement(
        &self,
        stamp: f64,
        truth: &Relative,
        interval: f64,
        drift: &mut Drift,
        random: &mut NoiseStream,
    ) -> Measurement {
        let fresh = [0, 1, 2].map(|_| f64::from(random.normal()));
        let keep = if self.correlation > 0.0 { math::exp(-interval / self.correlation) } else { 0.0 };
        let now = drift
            .now
            .map_or(fresh, |last| [0, 1, 2].map(|k| keep * last[k] + (1.0 - keep * keep).sqrt() * fresh[k]));
        drift.now = Some(now);
        let error = |k: usize| self.bias[k] + self.deviation[k] * now[k];
        Measurement {
            stamp,
            relative: Relative {
                distance: (truth.distance + error(0)).max(0.0),
                bearing: wrap(truth.bearing + error(1)),
                view_angle: wrap(truth.view_angle + error(2)),
            },
            // A sensor without errors is still one of finite precision.
            deviation: self.deviation.map(|d| d.max(1e-5)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::imaging::{Purpose, noise_stream};

    #[test]
    fn errors_have_the_size_bias_and_memory_they_should() {
        let model = NoiseModel { deviation: [0.1, 0.02, 0.01], bias: [0.5, 0.0, -0.1], correlation: 0.2 };
        let (mut drift, mut random) = (Drift::default(), noise_stream(5, 0, 0, Purpose::Errors));
        let truth = Relative { distance: 3.0, bearing: 3.1, view_angle: 0.0 };
        let count = 20_000;
        let errors: Vec<[f64; 3]> = (0..count)
            .map(|k| {
                let r = model.measurement(f64::from(k) * 0.1, &truth, 0.1, &mut drift, &mut random).relative;
                [r.distance - 3.0, wrap(r.bearing - 3.1), r.view_angle]
            })
            .collect();
        let mean = |f: &dyn Fn(usize) -> f64, n: usize| (0..n).map(f).sum::<f64>() / n as f64;
        let n = errors.len();
        for (k, deviation) in model.deviation.into_iter().enumerate() {
            let centre = mean(&|i| errors[i][k], n);
            let spread = mean(&|i| math::powi(errors[i][k] - centre, 2), n);
            let next = mean(&|i| (errors[i][k] - centre) * (errors[i + 1][k] - centre), n - 1);
            assert!((centre - model.bias[k]).abs() < 0.05 * deviation, "{k}: {centre}");
            assert!((spread.sqrt() / deviation - 1.0).abs() < 0.05, "{k}: {spread}");
            assert!((next / spread - math::exp(-0.5_f64)).abs() < 0.05, "{k}: {}", next / spread);
        }
    }
}
