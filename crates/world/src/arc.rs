//! The path of a unicycle that holds its acceleration and turn rate, in closed form (eq 1).
//!
//! With v = v0 + a t and θ = θ0 + ω t the position moves by
//! ∫ v e^(iθ) dt = e^(iθ0) (v0 t f0(ωt) + a t² f1(ωt)), where
//! f0(u) = ∫₀¹ e^(iuσ) dσ and f1(u) = ∫₀¹ σ e^(iuσ) dσ.

use vocabulary::{Motion, Pose, math, wrap};

/// Where `start` is after `t` s at its own speed, acceleration and turn rate; no bounds are looked at.
pub fn after(start: &Motion, t: f64) -> Motion {
    let (sin, cos) = math::sin_cos(start.pose.heading);
    after_with(start, sin, cos, t)
}

/// As [`after`], with sine and cosine of the first heading at hand.
pub(crate) fn after_with(start: &Motion, sin: f64, cos: f64, t: f64) -> Motion {
    let ([c0, s0], [c1, s1]) = records(start.turn_rate * t);
    let (p, q) = (start.speed * t, start.acceleration * t * t);
    let (forward, left) = (p * c0 + q * c1, p * s0 + q * s1);
    let pose = Pose {
        x: start.pose.x + forward * cos - left * sin,
        y: start.pose.y + forward * sin + left * cos,
        heading: wrap(start.pose.heading + start.turn_rate * t),
    };
    Motion { pose, speed: start.speed + start.acceleration * t, ..*start }
}

/// [real, imaginary] of f0 and f1 at `u`.
fn records(u: f64) -> ([f64; 2], [f64; 2]) {
    if u.abs() < 0.5 {
        return moments_by_series(u);
    }
    let (sin, cos) = math::sin_cos(u);
    let f0 = [sin / u, (1.0 - cos) / u];
    ([f0[0], f0[1]], [(sin - f0[1]) / u, (f0[0] - cos) / u])
}

/// The power series: the closed form loses digits near zero. Seven terms leave 1e-18 at |u| = 1/2, and
/// fewer do nearer to zero.
fn moments_by_series(u: f64) -> ([f64; 2], [f64; 2]) {
    let square = u * u;
    let (mut even, mut odd) = (1.0, u);
    let (mut f0, mut f1) = ([0.0; 2], [0.0; 2]);
    for [n0, n1, n2, step0, step1] in SERIES {
        f0[0] += even * n0;
        f0[1] += odd * n1;
        f1[0] += even * n1;
        f1[1] += odd * n2;
        even *= square * step0;
        odd *= square * step1;
        if even.abs() < 1e-17 {
            break;
        }
    }
    (f0, f1)
}

/// For k = 0, 1, …: 1/(2k+1), 1/(2k+2), 1/(2k+3) and the factors from u^2k/(2k)! and u^(2k+1)/(2k+1)! to the next.
const SERIES: [[f64; 5]; 7] = {
    let mut rows = [[0.0; 5]; 7];
    let mut k = 0;
    while k < 7 {
        let n = 2.0 * k as f64;
        rows[k] = [
            1.0 / (n + 1.0),
            1.0 / (n + 2.0),
            1.0 / (n + 3.0),
            -1.0 / ((n + 1.0) * (n + 2.0)),
            -1.0 / ((n + 2.0) * (n + 3.0)),
        ];
        k += 1;
    }
    rows
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn simpson(start: &Motion, t: f64) -> [f64; 2] {
        let n = 4000;
        let (mut x, mut y) = (start.pose.x, start.pose.y);
        for k in 0..=n {
            let s = t * f64::from(k) / f64::from(n);
            let weight = if k == 0 || k == n { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            let (sin, cos) = math::sin_cos(start.pose.heading + start.turn_rate * s);
            let share = weight * (start.speed + start.acceleration * s) * t / f64::from(n) / 3.0;
            x += share * cos;
            y += share * sin;
        }
        [x, y]
    }

    proptest! {
        #[test]
        fn agrees_with_quadrature(h in -3.0..3.0, v in -2.0..2.0, a in -20.0..20.0, w in -11.5..11.5, t in 0.0..1.0) {
            let start = Motion { pose: Pose::new(1.0, -2.0, h), speed: v, acceleration: a, turn_rate: w };
            let end = after(&start, t);
            let [x, y] = simpson(&start, t);
            prop_assert!((end.pose.x - x).abs() < 1e-9 && (end.pose.y - y).abs() < 1e-9);
            prop_assert!((end.speed - (v + a * t)).abs() < 1e-12);
        }

        #[test]
        fn series_and_closed_form_meet(u in 0.3..0.5) {
            let (sin, cos) = math::sin_cos(u);
            let ([c0, s0], [c1, s1]) = moments_by_series(u);
            prop_assert!((c0 - sin / u).abs() < 1e-15 && (s0 - (1.0 - cos) / u).abs() < 1e-15);
            prop_assert!((c1 - (u * sin + cos - 1.0) / (u * u)).abs() < 1e-14);
            prop_assert!((s1 - (sin - u * cos) / (u * u)).abs() < 1e-14);
        }
    }

    #[test]
    fn a_full_circle_returns() {
        let start = Motion { speed: 1.0, turn_rate: 2.0, ..Motion::default() };
        let end = after(&start, std::f64::consts::PI);
        assert!(math::hypot(end.pose.x, end.pose.y) < 1e-14 && end.pose.heading.abs() < 1e-14);
    }
}
