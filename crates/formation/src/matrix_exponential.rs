//! The exponential of a small matrix, the same on every machine: scaling, a Padé approximant of degree 13, squaring
//! (Higham, *The scaling and squaring method for the matrix exponential revisited*, 2005).

use nalgebra::SMatrix;

/// Up to this norm the approximant is exact to rounding.
const REACH: f64 = 5.371_920_351_148_152;
/// How often a matrix is halved at most: an exponential of a larger one has no finite entries or none but zeros.
const HALVINGS: u32 = 1100;
/// Coefficients of the numerator, from the constant on; the denominator has every second one negated.
const PADE: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];

/// e^`matrix`; not finite where an entry of `matrix` is not.
pub(crate) fn exponential<const N: usize>(matrix: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let norm = matrix.column_iter().map(|column| column.iter().map(|x| x.abs()).sum::<f64>());
    let mut norm = norm.fold(0.0, f64::max);
    let (mut a, mut halvings) = (*matrix, 0);
    while norm > REACH && halvings < HALVINGS {
        norm *= 0.5;
        a *= 0.5;
        halvings += 1;
    }
    let (b, one) = (PADE, SMatrix::identity());
    let a2 = a * a;
    let a4 = a2 * a2;
    let a6 = a4 * a2;
    let odd = a6 * (a6 * b[13] + a4 * b[11] + a2 * b[9]) + a6 * b[7] + a4 * b[5] + a2 * b[3] + one * b[1];
    let odd = a * odd;
    let even = a6 * (a6 * b[12] + a4 * b[10] + a2 * b[8]) + a6 * b[6] + a4 * b[4] + a2 * b[2] + one * b[0];
    let mut out = solve(even - odd, even + odd);
    for _ in 0..halvings {
        out *= out;
    }
    out
}

/// X of `a` X = `b` by elimination with row exchanges.
fn solve<const N: usize>(mut a: SMatrix<f64, N, N>, mut b: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    for k in 0..N {
        let pivot =
            (k..N).fold(k, |best, row| if a[(row, k)].abs() > a[(best, k)].abs() { row } else { best });
        a.swap_rows(k, pivot);
        b.swap_rows(k, pivot);
        for row in k + 1..N {
            let factor = a[(row, k)] / a[(k, k)];
            for column in k + 1..N {
                a[(row, column)] -= factor * a[(k, column)];
            }
            for column in 0..N {
                b[(row, column)] -= factor * b[(k, column)];
            }
        }
    }
    for column in 0..N {
        for row in (0..N).rev() {
            let known: f64 = (row + 1..N).map(|k| a[(row, k)] * b[(k, column)]).sum();
            b[(row, column)] = (b[(row, column)] - known) / a[(row, row)];
        }
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Matrix4};
    use proptest::prelude::*;
    use vocabulary::math;

    #[test]
    fn a_turn_and_a_decay_are_exact() {
        for angle in [1e-3, 1.0, 40.0] {
            let (sin, cos) = math::sin_cos(angle);
            let turned = exponential(&Matrix2::new(0.0, -angle, angle, 0.0));
            assert!((turned - Matrix2::new(cos, -sin, sin, cos)).amax() < 1e-13, "{angle}");
        }
        let decayed = exponential(&Matrix2::new(-700.0, 0.0, 0.0, 2.0));
        // Eight squarings, each of which doubles what rounding did.
        assert!((decayed[(1, 1)] - math::exp(2.0)).abs() < 1e-12 && decayed[(0, 0)].abs() < 1e-250);
        assert!(!exponential(&Matrix2::new(f64::NAN, 0.0, 0.0, 0.0))[(0, 0)].is_finite());
    }

    proptest! {
        /// Against another implementation.
        #[test]
        fn agrees_with_nalgebra(entries in proptest::collection::vec(-30.0..30.0, 16)) {
            let matrix = Matrix4::from_iterator(entries);
            let (ours, theirs) = (exponential(&matrix), matrix.exp());
            prop_assert!((ours - theirs).amax() < 1e-8 * theirs.amax());
        }
    }
}
