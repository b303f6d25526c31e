//! How sure a share is.

/// Of a normal distribution 95 % lies within so many deviations.
const DEVIATIONS: f64 = 1.959_963_984_540_054;

/// The 95 % interval of a share of which `met` of `runs` were seen (Wilson, 1927).
pub(crate) fn wilson(met: u64, runs: u64) -> [f64; 2] {
    if runs == 0 {
        return [0.0, 1.0];
    }
    let (n, z) = (runs as f64, DEVIATIONS);
    let share = met as f64 / n;
    let middle = share + z * z / (2.0 * n);
    let half = z * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z * z / n;
    // A share that was seen lies in its interval, whatever rounding says.
    [((middle - half) / scale).clamp(0.0, share), ((middle + half) / scale).clamp(share, 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As statsmodels 0.15 has them: `proportion_confint(k, n, method="wilson")`.
    #[test]
    fn intervals_are_those_of_other_programs() {
        for (met, runs, wanted) in [
            (0, 10, [0.0, 0.277_532_799_862_889]),
            (10, 10, [0.722_467_200_137_111, 1.0]),
            (8, 10, [0.490_162_471_536_642, 0.943_317_848_545_625]),
            (9990, 10_000, [0.998_160_055_612_562, 0.999_456_714_013_503]),
        ] {
            let found = wilson(met, runs);
            for (a, b) in found.into_iter().zip(wanted) {
                assert!((a - b).abs() < 1e-9, "{met} of {runs}: {found:?}");
            }
        }
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
    }
}
