//! A smooth curve through points that never overshoots them (Fritsch and Carlson, SIAM Journal on Numerical Analysis 17, 1980).

/// A monotone cubic Hermite interpolant; constant outside its points.
#[derive(Debug, Clone, PartialEq)]
pub struct Hermite {
    points: Vec<[f64; 2]>,
    slopes: Vec<f64>,
    /// Integral from the first point to each point.
    integrals: Vec<f64>,
}

impl Hermite {
    /// Through `points` of [time, value] with strictly growing times; `None` if there is none.
    pub fn new(points: Vec<[f64; 2]>) -> Option<Self> {
        if points.is_empty() {
            return None;
        }
        let slopes = slopes(&points);
        let mut curve = Self { integrals: vec![0.0], points, slopes };
        for k in 0..curve.points.len() - 1 {
            let area = curve.integrals[k] + curve.area(k, 1.0);
            curve.integrals.push(area);
        }
        Some(curve)
    }

    /// The same `value` at all times.
    pub fn constant(value: f64) -> Self {
        Self { points: vec![[0.0, value]], slopes: vec![0.0], integrals: vec![0.0] }
    }

    /// Value and slope at `t`.
    pub fn at(&self, t: f64) -> [f64; 2] {
        match self.place(t) {
            Interval::Before => [self.points[0][1], 0.0],
            Interval::After => [self.points[self.points.len() - 1][1], 0.0],
            Interval::Within(k, u) => {
                let [a, b, c, d] = self.cubic(k);
                let h = self.points[k + 1][0] - self.points[k][0];
                [a + u * (b + u * (c + u * d)), (b + u * (2.0 * c + u * 3.0 * d)) / h]
            }
        }
    }

    /// Times of the points.
    pub(super) fn times(&self) -> impl Iterator<Item = f64> + '_ {
        self.points.iter().map(|p| p[0])
    }

    /// Integral from time 0 to `t`.
    pub fn integral(&self, t: f64) -> f64 {
        self.integral_from_first(t) - self.integral_from_first(0.0)
    }

    fn integral_from_first(&self, t: f64) -> f64 {
        let last = self.points.len() - 1;
        match self.place(t) {
            Interval::Before => (t - self.points[0][0]) * self.points[0][1],
            Interval::After => self.integrals[last] + (t - self.points[last][0]) * self.points[last][1],
            Interval::Within(k, u) => self.integrals[k] + self.area(k, u),
        }
    }

    fn place(&self, t: f64) -> Interval {
        let after = self.points.partition_point(|p| p[0] <= t);
        if after == 0 {
            return Interval::Before;
        }
        if after == self.points.len() {
            return Interval::After;
        }
        let (a, b) = (self.points[after - 1][0], self.points[after][0]);
        Interval::Within(after - 1, (t - a) / (b - a))
    }

    /// Coefficients of 1, u, u², u³ on interval `k`, u from 0 to 1.
    fn cubic(&self, k: usize) -> [f64; 4] {
        let ([t0, a], [t1, b]) = (self.points[k], self.points[k + 1]);
        let (m0, m1) = (self.slopes[k] * (t1 - t0), self.slopes[k + 1] * (t1 - t0));
        [a, m0, 3.0 * (b - a) - 2.0 * m0 - m1, 2.0 * (a - b) + m0 + m1]
    }

    fn area(&self, k: usize, u: f64) -> f64 {
        let [a, b, c, d] = self.cubic(k);
        u * (a + u * (b / 2.0 + u * (c / 3.0 + u * d / 4.0))) * (self.points[k + 1][0] - self.points[k][0])
    }
}

enum Interval {
    Before,
    Within(usize, f64),
    After,
}

/// Flat at the ends, so that the constant outside joins smoothly; weighted harmonic means of the secants inside.
fn slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let mut out = vec![0.0; points.len()];
    for k in 1..points.len().saturating_sub(1) {
        let (h0, h1) = (points[k][0] - points[k - 1][0], points[k + 1][0] - points[k][0]);
        let (s0, s1) = ((points[k][1] - points[k - 1][1]) / h0, (points[k + 1][1] - points[k][1]) / h1);
        if s0 * s1 > 0.0 {
            let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
            out[k] = (w0 + w1) / (w0 / s0 + w1 / s1);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn stays_between_its_points_and_integrates(values in proptest::collection::vec(-2.0..2.0, 1..8), t in -1.0..9.0) {
            let points: Vec<[f64; 2]> = values.iter().enumerate().map(|(k, v)| [k as f64, *v]).collect();
            let curve = Hermite::new(points).expect("points");
            let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
            let [value, _] = curve.at(t);
            prop_assert!(value >= low - 1e-12 && value <= high + 1e-12);
            let h = 1e-5;
            let slope = (curve.integral(t + h) - curve.integral(t - h)) / (2.0 * h);
            prop_assert!((slope - value).abs() < 1e-4);
        }
    }
}
