//! Numbers that are drawn from distributions.

use laws::Noise;
use scene::{Distribution, Sampling, Study, Values, value_text};
use statrs::distribution::{ContinuousCDF, Normal};
use vocabulary::math;

/// Draws the numbers of a study.
#[derive(Debug, Clone)]
pub(crate) struct Sampler {
    seed: u64,
    samples: u64,
    sampling: Sampling,
    drawn: Vec<DrawnKey>,
}

/// A key that is drawn.
#[derive(Debug, Clone)]
struct DrawnKey {
    /// Which of the study's keys.
    parameter: usize,
    distribution: Distribution,
    degrees: bool,
    /// Of a Latin hypercube: in which share each sample is.
    shares: Vec<u32>,
}

impl Sampler {
    pub(crate) fn new(study: &Study) -> Self {
        let mut drawn = vec![];
        for (parameter, key) in study.parameters.iter().enumerate() {
            if let Values::Drawn { distribution, degrees } = key.values {
                let shares = match study.sampling {
                    Sampling::LatinHypercube => shuffled(study.samples, study.seed, drawn.len() as u64),
                    _ => vec![],
                };
                drawn.push(DrawnKey { parameter, distribution, degrees, shares });
            }
        }
        Self { seed: study.seed, samples: study.samples, sampling: study.sampling, drawn }
    }

    /// The numbers of a sample of a cell, as overrides have them, each with the key's place in the study.
    pub(crate) fn draw(&self, cell: u64, sample: u64) -> impl Iterator<Item = (usize, String)> {
        self.drawn.iter().enumerate().map(move |(dimension, key)| {
            let share = self.share(dimension as u64, key, cell, sample);
            (key.parameter, value_text(quantile(key.distribution, share), key.degrees))
        })
    }

    /// Below which share of its distribution the number lies.
    fn share(&self, dimension: u64, key: &DrawnKey, cell: u64, sample: u64) -> f64 {
        let own = Noise {
            seed: self.seed,
            robot: dimension,
            sample: cell.wrapping_mul(self.samples).wrapping_add(sample),
        };
        match self.sampling {
            Sampling::Independent => own.uniform(0),
            // All cells have the same samples: they differ by what is varied on purpose alone.
            Sampling::LatinHypercube => {
                let within = Noise { sample, ..own }.uniform(0);
                (f64::from(key.shares[sample as usize]) + within) / self.samples as f64
            }
            Sampling::Sobol => {
                f64::from(sobol_burley::sample(sample as u32, dimension as u32, self.seed as u32))
            }
        }
    }
}

/// The numbers from 0 to `count`, in an order that depends on the seed and the dimension.
fn shuffled(count: u64, seed: u64, dimension: u64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    let noise = Noise { seed, robot: dimension, sample: u64::MAX };
    for last in (1..order.len()).rev() {
        let other = (noise.bits(last as u64) % (last as u64 + 1)) as usize;
        order.swap(last, other);
    }
    order
}

/// The number below which a distribution has this share.
fn quantile(distribution: Distribution, share: f64) -> f64 {
    match distribution {
        Distribution::Uniform([low, high]) => low + share * (high - low),
        Distribution::LogUniform([low, high]) => low * math::exp(share * math::ln(high / low)),
        Distribution::Normal { mean, deviation } => {
            // Neither end of the distribution is a number.
            let share = share.clamp(1e-12, 1.0 - 1e-12);
            Normal::new(mean, deviation).map_or(mean, |normal| normal.inverse_cdf(share))
        }
    }
}
