//! What the observer meets over a stretch of time, as polynomials.

use crate::relative::LineOfSight;
use nalgebra::{SMatrix, Vector2};
use std::sync::LazyLock;
use vocabulary::{EdgeSample, Relative, TRACK_NODES, Track, math, nearest_turn};

/// Polynomials of the stretch have this degree, one less than the nodes of a track.
pub(super) const DEGREE: usize = TRACK_NODES - 1;
/// Coefficients of 1, τ, τ², … with τ from 0 to 1 over the stretch.
pub(super) type Poly = [f64; DEGREE + 1];

/// What the observer meets over a stretch of time, as polynomials.
pub(super) struct PolynomialPiece {
    pub(super) duration: f64,
    /// p, [m, rad].
    pub(super) measurement: [Poly; 2],
    /// First column of g_s.
    pub(super) rate_column: [Poly; 2],
    /// w.
    pub(super) forcing: [Poly; 2],
}

impl PolynomialPiece {
    pub(super) fn of_track(track: &Track, distance_min: f64) -> Self {
        let h = track.duration;
        let origin = track.samples[0].relative;
        let mut values = [[0.0; TRACK_NODES]; 6];
        for (k, sample) in track.samples.iter().enumerate() {
            let line = LineOfSight::new(&sample.relative, distance_min);
            let (column, input) = (line.rate_column(sample.own_speed), input_effect(&line, sample));
            values[0][k] = sample.relative.distance - origin.distance;
            values[1][k] = sample.relative.bearing - origin.bearing;
            (values[2][k], values[3][k]) = (column.x, column.y);
            (values[4][k], values[5][k]) = (input.x, input.y);
        }
        let [mut distance, mut bearing, column_d, column_b, input_d, input_b] = fit(&values);
        // Values were taken relative to the first to keep digits in the derivatives.
        distance[0] += origin.distance;
        bearing[0] += origin.bearing;
        let (rate_column, measurement) = ([column_d, column_b], [distance, bearing]);
        let forcing = [
            residue(&input_d, &column_d, &distance, &distance, h),
            residue(&input_b, &column_b, &distance, &bearing, h),
        ];
        Self { duration: h, measurement, rate_column, forcing }
    }

    pub(super) fn of_samples(
        before: &EdgeSample,
        after: &Relative,
        duration: f64,
        distance_min: f64,
    ) -> Self {
        let line = LineOfSight::new(&before.relative, distance_min);
        let (column, input) = (line.rate_column(before.own_speed), input_effect(&line, before));
        let start = [before.relative.distance, before.relative.bearing];
        let end = [after.distance, nearest_turn(after.bearing, start[1])];
        let line = [0, 1].map(|i| polynomial(&[start[i], end[i] - start[i]]));
        let slope = line[0][1] / duration;
        Self {
            duration,
            measurement: line,
            rate_column: [polynomial(&[column.x]), polynomial(&[column.y])],
            forcing: [polynomial(&[input.x - column.x * slope]), polynomial(&[input.y - column.y * slope])],
        }
    }

    /// Value and slope of the measurement at the end, [m, rad] and [m/s, rad/s].
    pub(super) fn measurement_at_end(&self) -> ([f64; 2], [f64; 2]) {
        let value = self.measurement.map(|p| p.iter().sum());
        let slope =
            self.measurement.map(|p| (1..=DEGREE).map(|k| k as f64 * p[k]).sum::<f64>() / self.duration);
        (value, slope)
    }
}

/// −g ϖ − g0, [m/s², rad/s²]: what the follower's own input does to d²s/dt².
pub(crate) fn input_effect(line: &LineOfSight, sample: &EdgeSample) -> Vector2<f64> {
    let command = Vector2::new(sample.acceleration, sample.turn_rate);
    -(line.input_matrix(sample.own_speed) * command + line.drift(sample.own_speed))
}

/// w = input − column · dℓ/dt − d²p/dt², as a polynomial cut at the common degree.
fn residue(input: &Poly, column: &Poly, distance: &Poly, measurement: &Poly, h: f64) -> Poly {
    let (mut out, rate) = (*input, 1.0 / h);
    for k in 0..DEGREE {
        let slope = (k + 1) as f64 * distance[k + 1] * rate;
        for j in 0..=DEGREE - k {
            out[k + j] -= column[j] * slope;
        }
    }
    for k in 0..=DEGREE - 2 {
        out[k] -= ((k + 1) * (k + 2)) as f64 * measurement[k + 2] * (rate * rate);
    }
    out
}

fn polynomial(low: &[f64]) -> Poly {
    let mut out = [0.0; DEGREE + 1];
    out[..low.len()].copy_from_slice(low);
    out
}

/// Mean over the stretch.
pub(super) fn mean(p: &Poly) -> f64 {
    p.iter().zip(super::INVERSES).map(|(c, inverse)| c * inverse).sum()
}

/// p(from + share · τ) as a polynomial in τ: Horner's scheme, repeated.
pub(super) fn shifted(p: &Poly, from: f64, share: f64) -> Poly {
    let mut out = *p;
    for k in 0..DEGREE {
        for j in (k..DEGREE).rev() {
            out[j] += from * out[j + 1];
        }
    }
    let mut scale = 1.0;
    for c in &mut out {
        *c *= scale;
        scale *= share;
    }
    out
}

/// The polynomials through values at the nodes of a track.
fn fit<const N: usize>(values: &[[f64; TRACK_NODES]; N]) -> [Poly; N] {
    let (bases, mut out) = (&*BASES, [[0.0; DEGREE + 1]; N]);
    for (polynomial, values) in out.iter_mut().zip(values) {
        for (basis, value) in bases.iter().zip(values) {
            for (c, share) in polynomial.iter_mut().zip(basis) {
                *c += share * value;
            }
        }
    }
    out
}

/// For each node of a track the polynomial that is 1 there and 0 at all others.
static BASES: LazyLock<[Poly; TRACK_NODES]> = LazyLock::new(|| {
    let vandermonde = SMatrix::<f64, TRACK_NODES, TRACK_NODES>::from_fn(|row, column| {
        math::powi(Track::NODES[row], column as i32)
    });
    vandermonde.try_inverse().unwrap_or_else(SMatrix::identity).into()
});
