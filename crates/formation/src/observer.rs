//! The high-gain observer (eqs 31-32), solved so that it is right at every ε.
//!
//! The observer is linear in its own state, with poles near −1/ε: at ε = 0.001 s a step of 10 ms is ten of its time
//! constants, so explicit steps diverge, and an exact solution for a measurement *held* over the period is stable
//! and reports rates of zero. Here the measurement between two instants is a polynomial p(t), and the observer is
//! solved in its deviation from it, d1 = ŝ1 − p and d2 = ŝ2 − dp/dt:
//!
//! ```text
//! dd1/dt = d2 − α1/ε d1
//! dd2/dt = −α2/ε² d1 − g_s d2 + w(t),   w = −g ϖ − g0 − g_s dp/dt − d²p/dt²
//! ```
//!
//! Nothing on the right is of size 1/ε any more but the decay itself. Short stretches are solved by the power series
//! of the solution (g_s varies in it), stiff ones by their polynomial solution plus an exponential that dies out.

mod stretch;

use crate::matrix_exponential::{Cascade, exponential};
use crate::relative::LineOfSight;
use nalgebra::{Matrix2, Vector2, Vector4};
pub(crate) use stretch::input_effect;
use stretch::{DEGREE, Poly, PolynomialPiece, mean, shifted};
use vocabulary::{EdgeSample, Relative, TRACK_NODES, Track, wrap};

/// Parameters of the observer; every pair is [distance, bearing].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    /// ε, s; positive.
    pub epsilon: [f64; 2],
    /// α1, positive.
    pub alpha1: [f64; 2],
    /// α2, positive: then the roots of s² + α1 s + α2 are stable.
    pub alpha2: [f64; 2],
    /// ℓ_min, m: the equations divide by no less.
    pub distance_min: f64,
}

/// State of the observer.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Estimate {
    /// ŝ1, [m, rad]; the bearing may run beyond (−π, π].
    pub output: [f64; 2],
    /// ŝ2, the estimate of ds/dt, [m/s, rad/s].
    pub rates: [f64; 2],
}

impl Estimate {
    /// The start chosen where the paper is silent: ŝ1 = s(0), ŝ2 = 0 (see `docs/laws.md`).
    pub fn at(relative: &Relative) -> Self {
        Self { output: [relative.distance, relative.bearing], rates: [0.0; 2] }
    }

    fn or_restart_at(self, relative: &Relative) -> Self {
        let finite = self.output.iter().chain(&self.rates).all(|x| x.is_finite());
        // Even a measurement that is no number leaves an estimate that is one.
        let number = |x: f64| if x.is_finite() { x } else { 0.0 };
        let restart = Self { output: [number(relative.distance), number(relative.bearing)], rates: [0.0; 2] };
        if finite { self } else { restart }
    }
}

impl Observer {
    /// Right-hand side of eqs 31-32 at an instant: d[ŝ1, ŝ2]/dt. For continuous time.
    pub fn derivative(&self, estimate: &Estimate, sample: &EdgeSample) -> Estimate {
        let line = LineOfSight::new(&sample.relative, self.distance_min);
        let innovation = [
            sample.relative.distance - estimate.output[0],
            wrap(sample.relative.bearing - estimate.output[1]),
        ];
        let input = input_effect(&line, sample) - line.rate_column(sample.own_speed) * estimate.rates[0];
        let mut out = Estimate::default();
        for i in 0..2 {
            out.output[i] = estimate.rates[i] + self.alpha1[i] / self.epsilon[i] * innovation[i];
            out.rates[i] = input[i] + self.alpha2[i] / (self.epsilon[i] * self.epsilon[i]) * innovation[i];
        }
        out
    }

    /// The estimate at the end of a stretch over which the measurement was seen continuously (`sampled` mode).
    pub fn follow(&self, estimate: &Estimate, track: &Track) -> Estimate {
        if track.duration <= 0.0 {
            return *estimate;
        }
        let stretch = PolynomialPiece::of_track(track, self.distance_min);
        self.solve(estimate, &stretch, &track.samples[TRACK_NODES - 1].relative)
    }

    /// The estimate after `duration` s between two samples (`measured` mode): the measurement is the straight line
    /// between them, and g, g0, g_s are those of the sample `before`, whose acceleration is the period's mean.
    pub fn follow_samples(
        &self,
        estimate: &Estimate,
        before: &EdgeSample,
        after: &Relative,
        duration: f64,
    ) -> Estimate {
        if duration <= 0.0 {
            return *estimate;
        }
        self.solve(estimate, &PolynomialPiece::of_samples(before, after, duration, self.distance_min), after)
    }

    fn solve(&self, estimate: &Estimate, stretch: &PolynomialPiece, end: &Relative) -> Estimate {
        let start = self.deviation(estimate, stretch);
        let terminal = if self.stiffness() * stretch.duration > STIFF {
            self.exponential(start, stretch)
        } else {
            self.series(start, stretch)
        };
        let (value, slope) = stretch.measurement_at_end();
        let out = Estimate {
            output: [value[0] + terminal[0] * self.epsilon[0], value[1] + terminal[1] * self.epsilon[1]],
            rates: [slope[0] + terminal[2], slope[1] + terminal[3]],
        };
        out.or_restart_at(end)
    }

    /// [d1/ε, d2] at the start, the bearing's innovation wrapped.
    fn deviation(&self, estimate: &Estimate, stretch: &PolynomialPiece) -> Vector4<f64> {
        let slope = stretch.measurement.map(|p| p[1] / stretch.duration);
        Vector4::new(
            (estimate.output[0] - stretch.measurement[0][0]) / self.epsilon[0],
            wrap(estimate.output[1] - stretch.measurement[1][0]) / self.epsilon[1],
            estimate.rates[0] - slope[0],
            estimate.rates[1] - slope[1],
        )
    }

    /// A bound on the observer's fastest rate, 1/s.
    fn stiffness(&self) -> f64 {
        let channel = |i: usize| (self.alpha1[i] + self.alpha2[i] + 1.0) / self.epsilon[i];
        channel(0).max(channel(1))
    }

    /// The deviation at the end by its power series in time, in as many equal steps as keep it convergent.
    fn series(&self, start: Vector4<f64>, stretch: &PolynomialPiece) -> Vector4<f64> {
        let steps = (self.stiffness() * stretch.duration / SERIES_REACH).ceil().max(1.0);
        if steps <= 1.0 {
            return self.series_step(start, stretch.duration, &stretch.rate_column, &stretch.forcing);
        }
        let share = 1.0 / steps;
        let mut x = start;
        for k in 0..steps as usize {
            let from = k as f64 * share;
            let column = stretch.rate_column.map(|p| shifted(&p, from, share));
            let forcing = stretch.forcing.map(|p| shifted(&p, from, share));
            x = self.series_step(x, stretch.duration * share, &column, &forcing);
        }
        x
    }

    /// One step of `h` s; polynomials in t/h.
    fn series_step(&self, x: Vector4<f64>, h: f64, column: &[Poly; 2], forcing: &[Poly; 2]) -> Vector4<f64> {
        // What drives the terms to come: the forcing, less what g_s makes of the distance's rate in those before.
        let mut drive: [[f64; 2]; DEGREE + 1] = std::array::from_fn(|k| [forcing[0][k], forcing[1][k]]);
        let rate = self.epsilon.map(|epsilon| 1.0 / epsilon);
        let (mut term, mut sum) = (x, x);
        for (k, inverse) in INVERSES.iter().enumerate() {
            for (j, drive) in drive.iter_mut().enumerate() {
                *drive = [drive[0] - column[0][j] * term[2], drive[1] - column[1][j] * term[2]];
            }
            let output = |i: usize| (term[2 + i] - self.alpha1[i] * term[i]) * rate[i];
            let rates = |i: usize| drive[0][i] - self.alpha2[i] * rate[i] * term[i];
            term = Vector4::new(output(0), output(1), rates(0), rates(1)) * (h * inverse);
            sum += term;
            drive = std::array::from_fn(|j| if j < DEGREE { drive[j + 1] } else { [0.0; 2] });
            if k > DEGREE && term.amax() <= 1e-17 * sum.amax() {
                break;
            }
        }
        sum
    }

    /// The deviation at the end where the observer is much faster than the stretch: its polynomial solution, plus
    /// what is left of the transient with g_s frozen at its mean.
    fn exponential(&self, start: Vector4<f64>, stretch: &PolynomialPiece) -> Vector4<f64> {
        let column = stretch.rate_column.map(|p| mean(&p));
        let particular = self.polynomial_solution(stretch, &column);
        let at_end: Vector4<f64> = particular.iter().sum();
        let x = start - particular[0];
        let transient = exponential(&(self.matrix(&column) * stretch.duration));
        let [distance, bearing] = transient.apply([Vector2::new(x[0], x[2]), Vector2::new(x[1], x[3])]);
        at_end + Vector4::new(distance.x, bearing.x, distance.y, bearing.y)
    }

    /// The system matrix of [d1/ε, d2], for the distance first, with a constant first column of g_s, 1/s.
    fn matrix(&self, column: &[f64; 2]) -> Cascade {
        let channel = |i: usize, own: f64| {
            let [alpha1, alpha2] = [self.alpha1[i], self.alpha2[i]].map(|alpha| alpha / self.epsilon[i]);
            Matrix2::new(-alpha1, 1.0 / self.epsilon[i], -alpha2, -own)
        };
        let coupling = Matrix2::new(0.0, 0.0, 0.0, -column[1]);
        Cascade { first: channel(0, column[0]), coupling, second: channel(1, 0.0) }
    }

    /// Coefficients q_k of the polynomial that solves the system: (k + 1) q_(k+1)/h = M q_k + b_k, from the top down.
    fn polynomial_solution(
        &self,
        stretch: &PolynomialPiece,
        column: &[f64; 2],
    ) -> [Vector4<f64>; DEGREE + 1] {
        let mut q = [Vector4::zeros(); DEGREE + 1];
        let mut above = Vector4::zeros();
        // M⁻¹ in closed form.
        let (e, a1, a2) = (&self.epsilon, &self.alpha1, &self.alpha2);
        let inverse = [e[0] / (a2[0] + column[0] * e[0] * a1[0]), e[1] / a2[1]];
        for k in (0..=DEGREE).rev() {
            let rhs = above - Vector4::new(0.0, 0.0, stretch.forcing[0][k], stretch.forcing[1][k]);
            let d1 = -(rhs[2] + column[0] * e[0] * rhs[0]) * inverse[0];
            let d2 = e[0] * rhs[0] + a1[0] * d1;
            let p1 = -(rhs[3] + column[1] * d2) * inverse[1];
            q[k] = Vector4::new(d1, p1, d2, e[1] * rhs[1] + a1[1] * p1);
            above = q[k] * (k as f64 / stretch.duration);
        }
        q
    }
}

/// Above this many time constants (stiffness × duration) the exponential form takes over.
const STIFF: f64 = 30.0;
/// Time constants one power series may span: its largest term stays near 10, so 15 digits survive.
const SERIES_REACH: f64 = 4.0;
/// At reach 4 the last of these is below 1e-19 of the first.
const SERIES_TERMS: usize = 40;
/// 1, 1/2, 1/3, …
const INVERSES: [f64; SERIES_TERMS] = {
    let mut inverses = [0.0; SERIES_TERMS];
    let mut k = 0;
    while k < SERIES_TERMS {
        inverses[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    inverses
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vocabulary::{Pose, math, nearest_turn};

    /// A leader on a gentle curve and a follower that holds `acceleration` and `turn_rate`, at time t.
    fn sample(t: f64, acceleration: f64, turn_rate: f64) -> EdgeSample {
        let arc = |v: f64, a: f64, w: f64, h0: f64| {
            // Fine Simpson sums stand in for a closed form.
            let n = 64;
            let (mut x, mut y) = (0.0, 0.0);
            for k in 0..=n {
                let s = t * f64::from(k) / f64::from(n);
                let weight = if k == 0 || k == n { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
                let (sin, cos) = math::sin_cos(h0 + w * s);
                x += weight * (v + a * s) * cos;
                y += weight * (v + a * s) * sin;
            }
            let scale = t / f64::from(n) / 3.0;
            (x * scale, y * scale, h0 + w * t)
        };
        let (lx, ly, lh) = arc(1.0, 0.0, 0.3, 0.2);
        let (fx, fy, fh) = arc(0.8, acceleration, turn_rate, -0.1);
        let mut r = Relative::between(Pose::new(lx, ly, lh), Pose::new(fx - 1.6, fy - 1.2, fh));
        r.bearing = nearest_turn(r.bearing, -2.4);
        EdgeSample { relative: r, own_speed: 0.8 + acceleration * t, acceleration, turn_rate }
    }

    fn track(h: f64) -> Track {
        Track { duration: h, samples: Track::NODES.map(|n| sample(n * h, 3.0, -2.0)) }
    }

    fn observer(epsilon: f64) -> Observer {
        Observer { epsilon: [epsilon; 2], alpha1: [2.0; 2], alpha2: [1.0; 2], distance_min: 0.1 }
    }

    /// Eqs 31-32 by RK4 with steps far below ε: the independent answer.
    fn brute(observer: &Observer, start: Estimate, h: f64) -> Estimate {
        let epsilon = observer.epsilon[0].min(observer.epsilon[1]);
        let steps = (h / epsilon * 200.0).ceil().max(400.0) as usize;
        let dt = h / steps as f64;
        let add = |x: &Estimate, d: &Estimate, s: f64| Estimate {
            output: [x.output[0] + s * d.output[0], x.output[1] + s * d.output[1]],
            rates: [x.rates[0] + s * d.rates[0], x.rates[1] + s * d.rates[1]],
        };
        let mut x = start;
        for k in 0..steps {
            let t = k as f64 * dt;
            let [a, b, c] = [t, t + dt / 2.0, t + dt].map(|t| sample(t, 3.0, -2.0));
            let k1 = observer.derivative(&x, &a);
            let k2 = observer.derivative(&add(&x, &k1, dt / 2.0), &b);
            let k3 = observer.derivative(&add(&x, &k2, dt / 2.0), &b);
            let k4 = observer.derivative(&add(&x, &k3, dt), &c);
            for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
                x = add(&x, &k, dt / 6.0 * weight);
            }
        }
        x
    }

    #[test]
    fn follows_a_continuous_measurement_at_every_epsilon() {
        let h = 0.01;
        for ratio in [0.001, 0.01, 0.05, 0.1, 0.2, 0.5, 1.0, 3.0, 10.0, 100.0] {
            let observer = observer(ratio * h);
            let first = sample(0.0, 3.0, -2.0).relative;
            let start = Estimate { output: [first.distance + 0.02, first.bearing - 0.03], rates: [0.0, 0.5] };
            let (ours, truth) = (observer.follow(&start, &track(h)), brute(&observer, start, h));
            for i in 0..2 {
                assert!((ours.output[i] - truth.output[i]).abs() < 1e-8, "ε/T {ratio}: {ours:?} {truth:?}");
                let scale = 1.0 + truth.rates[i].abs();
                assert!(
                    (ours.rates[i] - truth.rates[i]).abs() < 1e-6 * scale,
                    "ε/T {ratio}: {ours:?} {truth:?}"
                );
            }
        }
    }

    #[test]
    fn unequal_channels_and_oscillating_gains_are_solved_too() {
        let h = 0.01;
        let first = sample(0.0, 3.0, -2.0).relative;
        for (epsilon, alpha1, alpha2) in
            [([0.001, 0.02], [2.0, 3.0], [1.0, 2.0]), ([0.004, 0.0005], [0.4, 2.0], [1.0, 5.0])]
        {
            let observer = Observer { epsilon, alpha1, alpha2, distance_min: 0.1 };
            let start = Estimate { output: [first.distance, first.bearing], rates: [0.3, -0.3] };
            let (ours, truth) = (observer.follow(&start, &track(h)), brute(&observer, start, h));
            for i in 0..2 {
                let scale = 1.0 + truth.rates[i].abs();
                assert!((ours.rates[i] - truth.rates[i]).abs() < 1e-6 * scale, "{ours:?} {truth:?}");
            }
        }
    }

    /// The two forms meet: a stretch just stiff enough for one is solved alike by the other.
    #[test]
    fn series_and_exponential_agree() {
        let h = 0.01;
        let observer = observer(4.0 * h / 35.0);
        let first = sample(0.0, 3.0, -2.0).relative;
        let start = Estimate { output: [first.distance, first.bearing], rates: [0.1, 0.2] };
        let stretch = PolynomialPiece::of_track(&track(h), 0.1);
        let x = observer.deviation(&start, &stretch);
        let apart = observer.series(x, &stretch) - observer.exponential(x, &stretch);
        assert!(apart.amax() < 1e-6, "{apart}");
    }

    /// A held measurement would report a rate of zero; the line through the samples reports the ramp's slope.
    #[test]
    fn a_ramp_seen_in_samples_is_reported_with_its_slope() {
        for ratio in [0.001, 0.1, 1.0] {
            let (h, slope) = (0.01, 0.4);
            // A follower at rest far away: g, g0 and g_s vanish and only the measurement is left.
            let at = |k: f64| Relative { distance: 50.0 + slope * h * k, bearing: 0.5, view_angle: 0.0 };
            let observer = observer(ratio * h);
            let mut estimate = Estimate::at(&at(0.0));
            for k in 0..4000 {
                let before = EdgeSample { relative: at(f64::from(k)), ..EdgeSample::default() };
                estimate = observer.follow_samples(&estimate, &before, &at(f64::from(k + 1)), h);
            }
            assert!((estimate.rates[0] - slope).abs() < 1e-9, "ε/T {ratio}: {estimate:?}");
        }
    }

    #[test]
    fn the_innovation_takes_the_short_way_round() {
        let relative = Relative { distance: 2.0, bearing: 3.1, view_angle: 0.0 };
        let before = EdgeSample { relative, ..EdgeSample::default() };
        let after = Relative { bearing: -3.1, ..relative };
        let start = Estimate { output: [2.0, -3.1], rates: [0.0; 2] };
        let estimate = observer(0.01).follow_samples(&start, &before, &after, 0.01);
        // 0.083 rad in 10 ms is 8.3 rad/s; the long way round would be hundreds.
        assert!(estimate.rates[1].abs() < 20.0, "{estimate:?}");
        assert!(wrap(estimate.output[1] - after.bearing).abs() < 0.2);
    }

    fn any_f64() -> impl Strategy<Value = f64> {
        let odd = [0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE];
        prop_oneof![3 => -1e3..1e3, 2 => proptest::sample::select(odd.to_vec())]
    }

    proptest! {
        /// No input may produce NaN.
        #[test]
        fn estimates_are_finite_for_any_input(
            n in proptest::collection::vec(any_f64(), 12), epsilon in prop_oneof![Just(1e-9), Just(1e-3), Just(0.1), Just(50.0)],
        ) {
            let relative = |k: usize| Relative { distance: n[k], bearing: n[k + 1], view_angle: n[k + 2] };
            let sample = |k: usize| EdgeSample {
                relative: relative(k),
                own_speed: n[k + 3],
                acceleration: n[k + 4],
                turn_rate: n[k + 5],
            };
            let track = Track { duration: 0.01, samples: [0, 1, 2, 3, 4, 5].map(|k| sample(k % 4)) };
            let start = Estimate { output: [n[10], n[11]], rates: [n[9], n[8]] };
            let observer = observer(epsilon);
            for estimate in [observer.follow(&start, &track), observer.follow_samples(&start, &sample(0), &relative(6), 0.01)] {
                prop_assert!(estimate.output.iter().chain(&estimate.rates).all(|x| x.is_finite()), "{estimate:?}");
            }
        }
    }

    #[test]
    fn an_estimate_that_breaks_starts_again_from_the_measurement() {
        let bad = Estimate { output: [f64::NAN, 0.0], rates: [f64::INFINITY, 0.0] };
        for epsilon in [1e-5, 1e-3, 1.0] {
            let track = track(0.01);
            let end = track.samples[TRACK_NODES - 1].relative;
            assert_eq!(observer(epsilon).follow(&bad, &track), Estimate::at(&end));
        }
    }
}
