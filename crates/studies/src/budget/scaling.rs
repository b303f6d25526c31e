//! How errors grow with the noise of corners, and which noise an error stands for.

use serde::Serialize;
use vocabulary::math;

/// err² = floor² + (slope · px)².
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Growth {
    /// Error without noise.
    pub floor: f64,
    /// Error for every pixel of noise.
    pub slope: f64,
}

impl Growth {
    /// Through [pixels, error], each counted by its relative deviation; `None` where two levels of noise are missing.
    pub fn fit(points: &[[f64; 2]]) -> Option<Self> {
        let mut sums = [0.0; 5];
        let mut levels = vec![];
        for [pixels, error] in points.iter().filter(|p| p[0].is_finite() && p[1].is_finite() && p[1] > 0.0) {
            let (x, y) = (pixels * pixels, error * error);
            let weight = 1.0 / (y * y);
            for (sum, term) in sums.iter_mut().zip([1.0, x, y, x * x, x * y]) {
                *sum += weight * term;
            }
            if !levels.contains(pixels) {
                levels.push(*pixels);
            }
        }
        let [n, x, y, xx, xy] = sums;
        let determinant = n * xx - x * x;
        if levels.len() < 2 || determinant.is_nan() || determinant <= 0.0 {
            return None;
        }
        let slope = (n * xy - x * y) / determinant;
        let floor = (xx * y - x * xy) / determinant;
        // A negative share has no meaning; the other one then carries everything.
        let [floor, slope] = match (floor < 0.0, slope < 0.0) {
            (true, _) => [0.0, xy / xx],
            (_, true) => [y / n, 0.0],
            _ => [floor, slope],
        };
        Some(Self { floor: floor.max(0.0).sqrt(), slope: slope.max(0.0).sqrt() })
    }
}

/// The noise at which `points` ([pixels, error], by pixels) reach `error`, interpolated in squares; `None` outside them.
pub fn noise_of(points: &[[f64; 2]], error: f64) -> Option<f64> {
    points.windows(2).find_map(|pair| {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]].map(|p| p.map(|v| v * v));
        let share = (error * error - y0) / (y1 - y0);
        (y1 > y0 && (0.0..=1.0).contains(&share)).then(|| (x0 + share * (x1 - x0)).sqrt())
    })
}

/// The noise that fits several errors at once: in the middle of those they give one by one, on a logarithmic scale.
pub fn geometric_mean(noises: &[Option<f64>]) -> Option<f64> {
    let some: Vec<f64> = noises.iter().flatten().copied().filter(|n| *n > 0.0).map(math::ln).collect();
    (!some.is_empty()).then(|| math::exp(some.iter().sum::<f64>() / some.len() as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_and_slope_are_found_again() {
        let points: Vec<[f64; 2]> =
            [0.0, 0.1, 0.5, 1.0_f64].iter().map(|x| [*x, (0.04 + 9.0 * x * x).sqrt()]).collect();
        let growth = Growth::fit(&points).expect("a fit");
        assert!((growth.floor - 0.2).abs() < 1e-9 && (growth.slope - 3.0).abs() < 1e-9, "{growth:?}");
        assert_eq!(Growth::fit(&points[..1]), None);
        let falling = Growth::fit(&[[0.0, 2.0], [1.0, 1.0]]).expect("a fit");
        assert_eq!(falling.slope, 0.0);
    }

    #[test]
    fn an_error_stands_for_a_noise_between_two_levels() {
        let points = [[0.0, 0.1], [0.1, 0.2], [0.2, 0.4]];
        let noise = noise_of(&points, 0.3).expect("between");
        assert!((0.1..0.2).contains(&noise), "{noise}");
        assert_eq!((noise_of(&points, 0.05), noise_of(&points, 1.0)), (None, None));
        assert_eq!(geometric_mean(&[None, Some(0.04), Some(0.01)]).map(|n| (n * 1e9).round()), Some(2e7));
    }
}
