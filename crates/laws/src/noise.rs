//! Random numbers that depend on nothing but who asks, when, and for which.

use vocabulary::math;

/// Where a law's random numbers come from: a function of seed, robot and sample, so there is no state to save.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Noise {
    /// Seed of the scene.
    pub seed: u64,
    /// Index of the follower.
    pub robot: u64,
    /// Number of the control sample.
    pub sample: u64,
}

impl Noise {
    /// Number `index` of this robot and sample: normally distributed, mean 0, variance 1.
    pub fn normal(&self, index: u64) -> f64 {
        // Box and Muller, from two counted draws; the first is never 0.
        let [a, b] = [0, 1].map(|half| self.uniform(index.wrapping_mul(2).wrapping_add(half)));
        (-2.0 * math::ln(a)).sqrt() * math::cos(2.0 * std::f64::consts::PI * b)
    }

    /// Number `index` of this robot and sample: uniformly distributed, above 0 and at most 1.
    pub fn uniform(&self, index: u64) -> f64 {
        ((self.bits(index) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Number `index` of this robot and sample: 64 random bits.
    pub fn bits(&self, index: u64) -> u64 {
        [self.robot, self.sample, index]
            .into_iter()
            .fold(scrambled(self.seed), |key, word| scrambled(key ^ word))
    }
}

/// One step of SplitMix64 (Steele, Lea and Flood, 2014), which turns a counter into bits that look random.
fn scrambled(counter: u64) -> u64 {
    let z = counter.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a million numbers mean, variance and fourth moment are those of the normal distribution within five deviations.
    #[test]
    fn numbers_are_normal_and_those_of_two_samples_have_nothing_in_common() {
        let count = 1_000_000;
        let draw = |k: u64| Noise { seed: 7, robot: k % 7, sample: k / 7 }.normal(3);
        let all: Vec<f64> = (0..count).map(draw).collect();
        let mean = |power: i32| all.iter().map(|x| math::powi(*x, power)).sum::<f64>() / count as f64;
        assert!(mean(1).abs() < 5e-3 && (mean(2) - 1.0).abs() < 7.1e-3 && (mean(4) - 3.0).abs() < 0.05);
        let both = all.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / count as f64;
        assert!(both.abs() < 5e-3, "{both}");
    }

    #[test]
    fn a_number_depends_on_seed_robot_sample_and_index() {
        let noise = Noise { seed: 1, robot: 2, sample: 3 };
        let others = [
            Noise { seed: 2, ..noise }.normal(0),
            Noise { robot: 3, ..noise }.normal(0),
            Noise { sample: 4, ..noise }.normal(0),
            noise.normal(1),
        ];
        assert!(others.iter().all(|other| *other != noise.normal(0)));
        assert_eq!(noise.normal(0).to_bits(), Noise { ..noise }.normal(0).to_bits());
    }
}
