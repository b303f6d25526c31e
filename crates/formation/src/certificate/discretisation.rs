//! For which observer constants and periods a sampled loop is stable: the chart over ε and T.
//!
//! Near its set point an edge is, channel by channel, d²e/dt² = w with w = −2k ê₂ − (k² + β slope) e, held over a period;
//! the observer estimates ê₁, ê₂ of e, de/dt. How the observer is carried over the period is what makes the difference.

use crate::matrix_exponential::exponential;
use nalgebra::{Matrix4, SMatrix, Vector4};
use vocabulary::{math, words};

/// One channel of a sampled loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelSensitivity {
    /// k, 1/s.
    pub gain: f64,
    /// What acts on e: k² + β slope, 1/s².
    pub stiffness: f64,
    /// α1.
    pub alpha1: f64,
    /// α2.
    pub alpha2: f64,
}

words! {
    /// How an observer is carried from one sample to the next.
    pub enum Discretisation {
        /// It sees the plant in between: `sampled` runs.
        Exact = "exact",
        /// It takes the measurement as the straight line between samples: `measured` runs.
        Ramp = "ramp",
        /// It takes the measurement as held, and is solved exactly.
        Held = "held",
        /// One step of Runge-Kutta 4, the measurement held.
        RungeKutta = "runge-kutta",
        /// One step of Euler, the measurement held.
        Euler = "euler",
    }
}

/// ê₁, ε ê₂, y, dy/dt, w.
type Augmented = SMatrix<f64, 5, 5>;

impl Discretisation {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Exact, Self::Ramp, Self::Held, Self::RungeKutta, Self::Euler];

    /// A few words for it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Exact => "continuous observer",
            Self::Ramp => "straight line between samples",
            Self::Held => "held measurement",
            Self::RungeKutta => "Runge-Kutta 4",
            Self::Euler => "Euler",
        }
    }

    /// The augmented system after one period.
    fn propagate(self, system: &Augmented, period: f64) -> Augmented {
        let step = system * period;
        let eye = Augmented::identity();
        match self {
            Self::Exact | Self::Ramp | Self::Held => exponential(&step),
            Self::Euler => eye + step,
            Self::RungeKutta => {
                let (two, three) = (step * step, step * step * step);
                eye + step + two / 2.0 + three / 6.0 + two * two / 24.0
            }
        }
    }
}

impl ChannelSensitivity {
    /// The observer with what acts on it: d/dt of [ê₁, ε ê₂, y, dy/dt, w].
    fn observer(&self, epsilon: f64) -> Augmented {
        let mut m = Augmented::zeros();
        m[(0, 0)] = -self.alpha1 / epsilon;
        m[(0, 1)] = 1.0 / epsilon;
        m[(0, 2)] = self.alpha1 / epsilon;
        m[(1, 0)] = -self.alpha2 / epsilon;
        m[(1, 2)] = self.alpha2 / epsilon;
        m[(1, 4)] = epsilon;
        m[(2, 3)] = 1.0;
        m
    }

    /// The loop over one period: [e, ε de/dt, ê₁, ε ê₂] at a sample to the same at the next.
    pub fn period_map(&self, how: Discretisation, epsilon: f64, period: f64) -> Matrix4<f64> {
        let mut map = Matrix4::zeros();
        let mut system = self.observer(epsilon);
        if how == Discretisation::Exact {
            // The measurement is the plant's own: its rate changes with w.
            system[(3, 4)] = 1.0;
        }
        let after = how.propagate(&system, period);
        for column in 0..4 {
            let mut x = Vector4::zeros();
            x[column] = 1.0;
            let (error, rate) = (x[0], x[1] / epsilon);
            let w = -2.0 * self.gain * x[3] / epsilon - self.stiffness * error;
            let next = [error + period * rate + period * period / 2.0 * w, rate + period * w];
            let slope = match how {
                Discretisation::Exact => rate,
                Discretisation::Ramp => (next[0] - error) / period,
                Discretisation::Held | Discretisation::RungeKutta | Discretisation::Euler => 0.0,
            };
            let seen = after * SMatrix::<f64, 5, 1>::new(x[2], x[3], error, slope, w);
            map.set_column(column, &Vector4::new(next[0], epsilon * next[1], seen[0], seen[1]));
        }
        map
    }

    /// By how much the loop's slowest part shrinks, or its fastest grows, per period; stable below one.
    pub fn growth(&self, how: Discretisation, epsilon: f64, period: f64) -> f64 {
        let map = self.period_map(how, epsilon, period);
        if !map.iter().all(|x| x.is_finite()) {
            return f64::INFINITY;
        }
        map.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
    }

    /// The share of a constant rate that the observer reports at samples once it has settled; `None` where it does not
    /// settle.
    pub fn reported_rate(&self, how: Discretisation, epsilon: f64, period: f64) -> Option<f64> {
        let after = how.propagate(&self.observer(epsilon), period);
        // y = t: the observer's lag repeats from period to period, ê₁ = lag + t, ê₂ = rate.
        let a = after.fixed_view::<2, 2>(0, 0).into_owned();
        let slope = if matches!(how, Discretisation::Exact | Discretisation::Ramp) { 1.0 } else { 0.0 };
        let driven = after.fixed_view::<2, 1>(0, 3) * slope - nalgebra::Vector2::new(period, 0.0);
        let growth = a.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max);
        let settled = (nalgebra::Matrix2::identity() - a).lu().solve(&driven)?;
        (growth < 1.0).then_some(settled[1] / epsilon)
    }

    /// The longest period, s, up to which the loop is stable from the shortest on; within `span`, to a thousandth.
    /// `None` where it is stable over all of it or nowhere.
    pub fn longest_period(&self, how: Discretisation, epsilon: f64, span: [f64; 2]) -> LongestPeriod {
        const STEPS: u32 = 400;
        let at = |k: u32| span[0] * math::powf(span[1] / span[0], f64::from(k) / f64::from(STEPS));
        let stable = |period: f64| self.growth(how, epsilon, period) < 1.0;
        let Some(first) = (0..=STEPS).find(|k| !stable(at(*k))) else { return LongestPeriod::Beyond };
        if first == 0 {
            return LongestPeriod::Below;
        }
        let (mut low, mut high) = (at(first - 1), at(first));
        while high / low > 1.001 {
            let middle = (low * high).sqrt();
            if stable(middle) { low = middle } else { high = middle }
        }
        LongestPeriod::At(low)
    }
}

/// Where stability ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LongestPeriod {
    /// Unstable at the shortest period looked at.
    Below,
    /// Here, s.
    At(f64),
    /// Stable up to the longest period looked at.
    Beyond,
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: ChannelSensitivity =
        ChannelSensitivity { gain: 5.0, stiffness: 25.0 + 5.0 * 24.53, alpha1: 2.0, alpha2: 1.0 };

    /// The trap of ε = 1 ms at 10 ms: −1000/s over 10 ms grows ninefold by Euler, 291-fold by Runge-Kutta.
    #[test]
    fn explicit_steps_diverge_where_they_are_known_to() {
        for (how, wanted) in [(Discretisation::Euler, 9.0), (Discretisation::RungeKutta, 291.0)] {
            let observer = PAPER.observer(1e-3);
            let after = how.propagate(&observer, 0.01);
            let block = after.fixed_view::<2, 2>(0, 0).into_owned();
            let growth = block.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max);
            assert!((growth - wanted).abs() < 1e-4 * wanted, "{how:?}: {growth}");
            assert!(PAPER.growth(how, 1e-3, 0.01) > 1.0);
        }
    }

    #[test]
    fn a_held_measurement_reports_no_rate_and_a_straight_line_reports_all_of_it() {
        let share = |how| PAPER.reported_rate(how, 1e-3, 0.01).expect("it settles");
        assert!(share(Discretisation::Held).abs() < 0.01);
        assert!((share(Discretisation::Ramp) - 1.0).abs() < 1e-9);
        assert!((share(Discretisation::Exact) - 1.0).abs() < 1e-9);
        // Far below ε the hold does no harm: what it reports has the mean of a rate of one.
        let slow = PAPER.reported_rate(Discretisation::Held, 0.1, 1e-4).expect("it settles");
        assert!((slow - 1.0).abs() < 2e-3, "{slow}");
    }

    /// With a period far below everything else all of them are the continuous loop.
    #[test]
    fn short_periods_agree() {
        let (epsilon, period) = (0.05, 1e-4);
        let exact = PAPER.growth(Discretisation::Exact, epsilon, period);
        assert!(exact < 1.0);
        for how in Discretisation::ALL {
            let other = PAPER.growth(how, epsilon, period);
            assert!((other - exact).abs() < 0.1 * (1.0 - exact), "{how:?}: {other} against {exact}");
        }
    }

    /// The augmented solution against the loop stepped finely.
    #[test]
    fn the_exact_map_is_the_fine_integration() {
        let (epsilon, period) = (0.02, 0.05);
        let map = PAPER.period_map(Discretisation::Exact, epsilon, period);
        let start = Vector4::new(0.3, -0.01, 0.2, 0.004);
        let wanted = map * start;
        let (mut e, mut rate, mut e1, mut e2) = (start[0], start[1] / epsilon, start[2], start[3] / epsilon);
        let w = -2.0 * PAPER.gain * e2 - PAPER.stiffness * e;
        let steps = 400_000;
        let h = period / f64::from(steps);
        for _ in 0..steps {
            let middle = e + rate * h / 2.0;
            let mut d = [
                e2 + PAPER.alpha1 / epsilon * (e - e1),
                w + PAPER.alpha2 / math::powi(epsilon, 2) * (e - e1),
            ];
            let (m1, m2) = (e1 + d[0] * h / 2.0, e2 + d[1] * h / 2.0);
            d = [
                m2 + PAPER.alpha1 / epsilon * (middle - m1),
                w + PAPER.alpha2 / math::powi(epsilon, 2) * (middle - m1),
            ];
            (e1, e2) = (e1 + d[0] * h, e2 + d[1] * h);
            e += rate * h + w * h * h / 2.0;
            rate += w * h;
        }
        let found = Vector4::new(e, epsilon * rate, e1, epsilon * e2);
        assert!((found - wanted).norm() < 1e-8, "{found} against {wanted}");
    }

    #[test]
    fn where_stability_ends_both_sides_are_right() {
        let span = [1e-3, 1.0];
        let LongestPeriod::At(period) = PAPER.longest_period(Discretisation::Euler, 0.01, span) else {
            panic!("Euler ends somewhere");
        };
        assert!(PAPER.growth(Discretisation::Euler, 0.01, period) < 1.0);
        assert!(PAPER.growth(Discretisation::Euler, 0.01, 1.01 * period) >= 1.0);
        assert_eq!(PAPER.longest_period(Discretisation::Euler, 1e-4, span), LongestPeriod::Below);
    }
}
