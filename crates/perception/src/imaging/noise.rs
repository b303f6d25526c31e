//! Random numbers for sensors: a stream of its own for every robot, frame and purpose, so that what one of them sees
//! depends on nothing but the seed.

use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};
use std::sync::LazyLock;
use vocabulary::math;

/// What a sensor's random numbers are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Purpose {
    /// Noise of pixels.
    Pixels,
    /// Errors of a sensor that is modelled without pictures.
    Errors,
    /// Whether a frame gets lost.
    Dropouts,
    /// Anything about a run that does not depend on the frame.
    Setup,
    /// Errors of a proximity sensor.
    Proximity,
}

/// A stream of random numbers.
#[derive(Debug, Clone)]
pub struct NoiseStream {
    source: ChaCha8Rng,
}

/// The stream that belongs to a seed, a robot, a frame and a purpose.
pub fn noise_stream(seed: u64, robot: usize, frame: u64, purpose: Purpose) -> NoiseStream {
    let mut key = [0; 32];
    let words = [seed, robot as u64, frame, purpose as u64 + 1];
    for (bytes, word) in key.chunks_exact_mut(8).zip(words) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    NoiseStream { source: ChaCha8Rng::from_seed(key) }
}

/// Steps of the table of the normal distribution.
const STEPS: usize = 4096;

/// The normal distribution's quantiles at k/4096, scaled so that drawing from the table has a variance of 1.
static QUANTILES: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let at = |k: usize| quantile((k as f64 / STEPS as f64).clamp(2e-5, 1.0 - 2e-5));
    let nodes: Vec<f64> = (0..=STEPS).map(at).collect();
    // The mean square along the chord between two nodes.
    let square = nodes.windows(2).map(|w| (w[0] * w[0] + w[0] * w[1] + w[1] * w[1]) / 3.0);
    let deviation = (square.sum::<f64>() / STEPS as f64).sqrt();
    nodes.iter().map(|x| (x / deviation) as f32).collect()
});

impl NoiseStream {
    /// Evenly from [0, 1).
    pub fn uniform(&mut self) -> f64 {
        (self.source.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// One number of mean 0 and variance 1, normally distributed out to four standard deviations.
    pub fn normal(&mut self) -> f32 {
        drawn(&QUANTILES, self.source.next_u64())
    }

    /// Fills a slice with such numbers, four to each draw.
    pub fn normals(&mut self, out: &mut [f32]) {
        let table: &[f32] = &QUANTILES;
        for four in out.chunks_mut(4) {
            let bits = self.source.next_u64();
            for (k, value) in four.iter_mut().enumerate() {
                *value = drawn(table, bits >> (16 * k));
            }
        }
    }
}

/// The quantile that the lowest 16 bits stand for.
fn drawn(table: &[f32], bits: u64) -> f32 {
    let index = (bits >> 4) as usize & (STEPS - 1);
    let share = ((bits & 15) as f32 + 0.5) / 16.0;
    match table.get(index..index + 2) {
        Some([a, b]) => a + share * (b - a),
        _ => 0.0,
    }
}

/// Where the normal distribution reaches the share `p` (P. J. Acklam's approximation, to nine digits).
fn quantile(p: f64) -> f64 {
    const A: [f64; 6] = [
        -39.696_830_286_653_76,
        220.946_098_424_520_5,
        -275.928_510_446_968_7,
        138.357_751_867_269,
        -30.664_798_066_147_16,
        2.506_628_277_459_239,
    ];
    const B: [f64; 6] = [
        -54.476_098_798_224_06,
        161.585_836_858_040_9,
        -155.698_979_859_886_6,
        66.801_311_887_719_72,
        -13.280_681_552_885_72,
        1.0,
    ];
    const C: [f64; 6] = [
        -0.007_784_894_002_430_293,
        -0.322_396_458_041_136_5,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 5] = [
        0.007_784_695_709_041_462,
        0.322_467_129_070_039_8,
        2.445_134_137_142_996,
        3.754_408_661_907_416,
        1.0,
    ];
    let horner = |c: &[f64], x: f64| c.iter().fold(0.0, |sum, c| sum * x + c);
    let tail = |p: f64| {
        let q = (-2.0 * math::ln(p)).sqrt();
        horner(&C, q) / horner(&D, q)
    };
    if p < 0.02425 {
        tail(p)
    } else if p > 1.0 - 0.02425 {
        -tail(1.0 - p)
    } else {
        let q = p - 0.5;
        q * horner(&A, q * q) / horner(&B, q * q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_normally_distributed() {
        let mut values = vec![0.0; 400_000];
        noise_stream(7, 1, 2, Purpose::Pixels).normals(&mut values);
        let n = values.len() as f64;
        let record = |k: i32| values.iter().map(|x| math::powi(f64::from(*x), k)).sum::<f64>() / n;
        assert!(record(1).abs() < 0.006 && record(3).abs() < 0.02, "{} {}", record(1), record(3));
        assert!((record(2) - 1.0).abs() < 0.01 && (record(4) - 3.0).abs() < 0.08, "{}", record(4));
        let beyond = |x: f32| values.iter().filter(|v| v.abs() > x).count() as f64 / n;
        assert!((beyond(1.0) - 0.3173).abs() < 0.003 && (beyond(2.0) - 0.0455).abs() < 0.001);
    }

    #[test]
    fn every_frame_has_its_own_stream() {
        let first = |seed, robot, frame, purpose| noise_stream(seed, robot, frame, purpose).uniform();
        let one = first(1, 2, 3, Purpose::Pixels);
        assert_eq!(one, first(1, 2, 3, Purpose::Pixels));
        assert!(one != first(1, 3, 2, Purpose::Pixels) && one != first(1, 2, 3, Purpose::Dropouts));
        assert!(one != first(2, 2, 3, Purpose::Pixels) && one != first(1, 2, 4, Purpose::Pixels));
    }
}
