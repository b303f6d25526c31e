//! The exponential of a small matrix, the same on every machine: scaling, a Padé approximant of degree 13, squaring
//! (Higham, *The scaling and squaring method for the matrix exponential revisited*, 2005).

use nalgebra::{Matrix2, SMatrix, Vector2};
use std::ops::{Add, Mul, Sub};

/// What an exponential can be taken of.
pub(crate) trait Exponent:
    Copy + Mul<Output = Self> + Mul<f64, Output = Self> + Add<Output = Self> + Sub<Output = Self>
{
    /// The matrix that changes nothing.
    fn one() -> Self;

    /// The largest sum of absolute values of a column.
    fn norm(&self) -> f64;

    /// X of `self` X = `right`.
    fn solve(self, right: Self) -> Self;
}

/// The matrix of two systems of two states each, the first of which drives the second:
///
/// ```text
/// [first     0     ]
/// [coupling  second]
/// ```
///
/// Such matrices stay so where they are added, multiplied and inverted, which takes half of what 4×4 matrices take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cascade {
    pub(crate) first: Matrix2<f64>,
    pub(crate) coupling: Matrix2<f64>,
    pub(crate) second: Matrix2<f64>,
}

impl Cascade {
    /// Its product with the states of both systems.
    pub(crate) fn apply(&self, [first, second]: [Vector2<f64>; 2]) -> [Vector2<f64>; 2] {
        [self.first * first, self.coupling * first + self.second * second]
    }
}

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
pub(crate) fn exponential<M: Exponent>(matrix: &M) -> M {
    let (mut a, mut norm, mut halvings) = (*matrix, matrix.norm(), 0);
    while norm > REACH && halvings < HALVINGS {
        norm *= 0.5;
        a = a * 0.5;
        halvings += 1;
    }
    let (b, one) = (PADE, M::one());
    let a2 = a * a;
    let a4 = a2 * a2;
    let a6 = a4 * a2;
    let odd = a6 * (a6 * b[13] + a4 * b[11] + a2 * b[9]) + a6 * b[7] + a4 * b[5] + a2 * b[3] + one * b[1];
    let odd = a * odd;
    let even = a6 * (a6 * b[12] + a4 * b[10] + a2 * b[8]) + a6 * b[6] + a4 * b[4] + a2 * b[2] + one * b[0];
    let mut out = (even - odd).solve(even + odd);
    for _ in 0..halvings {
        out = out * out;
    }
    out
}

impl<const N: usize> Exponent for SMatrix<f64, N, N> {
    fn one() -> Self {
        Self::identity()
    }

    fn norm(&self) -> f64 {
        let sums = self.column_iter().map(|column| column.iter().map(|x| x.abs()).sum::<f64>());
        sums.fold(0.0, f64::max)
    }

    /// By elimination with row exchanges.
    fn solve(self, right: Self) -> Self {
        let (mut a, mut b) = (self, right);
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
}

impl Exponent for Cascade {
    fn one() -> Self {
        let one = Matrix2::identity();
        Self { first: one, coupling: Matrix2::zeros(), second: one }
    }

    fn norm(&self) -> f64 {
        let column = |m: &Matrix2<f64>, k: usize| m[(0, k)].abs() + m[(1, k)].abs();
        [0, 1].into_iter().fold(0.0, |norm: f64, k| {
            norm.max(column(&self.first, k) + column(&self.coupling, k)).max(column(&self.second, k))
        })
    }

    /// By the inverses of both diagonal blocks.
    fn solve(self, right: Self) -> Self {
        let (first, second) = (inverse(&self.first), inverse(&self.second));
        let top = first * right.first;
        Self {
            first: top,
            coupling: second * (right.coupling - self.coupling * top),
            second: second * right.second,
        }
    }
}

impl Mul for Cascade {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            first: self.first * other.first,
            coupling: self.coupling * other.first + self.second * other.coupling,
            second: self.second * other.second,
        }
    }
}

impl Mul<f64> for Cascade {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { first: self.first * factor, coupling: self.coupling * factor, second: self.second * factor }
    }
}

impl Add for Cascade {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            first: self.first + other.first,
            coupling: self.coupling + other.coupling,
            second: self.second + other.second,
        }
    }
}

impl Sub for Cascade {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

/// Not finite where there is none.
fn inverse(m: &Matrix2<f64>) -> Matrix2<f64> {
    Matrix2::new(m.m22, -m.m12, -m.m21, m.m11) * (1.0 / m.determinant())
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
        /// Two systems in a row are one of four states.
        #[test]
        fn a_cascade_is_a_matrix(entries in proptest::collection::vec(-8.0..8.0, 12)) {
            let block = |k: usize| Matrix2::from_iterator(entries[4 * k..4 * k + 4].iter().copied());
            let cascade = Cascade { first: block(0), coupling: block(1), second: block(2) };
            let whole = |of: &Cascade| {
                let mut whole = Matrix4::zeros();
                whole.fixed_view_mut::<2, 2>(0, 0).copy_from(&of.first);
                whole.fixed_view_mut::<2, 2>(2, 0).copy_from(&of.coupling);
                whole.fixed_view_mut::<2, 2>(2, 2).copy_from(&of.second);
                whole
            };
            let (ours, theirs) = (whole(&exponential(&cascade)), exponential(&whole(&cascade)));
            prop_assert!((ours - theirs).amax() < 1e-12 * theirs.amax(), "{ours} {theirs}");
        }

        /// Against another implementation.
        #[test]
        fn agrees_with_nalgebra(entries in proptest::collection::vec(-30.0..30.0, 16)) {
            let matrix = Matrix4::from_iterator(entries);
            let (ours, theirs) = (exponential(&matrix), matrix.exp());
            prop_assert!((ours - theirs).amax() < 1e-8 * theirs.amax());
        }
    }
}
