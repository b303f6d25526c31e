//! Set points that move in time, with first and second derivative.

use vocabulary::SetPoint;

/// A smooth change of a value: quintic, so that value, rate and acceleration are continuous.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ramp {
    /// When it begins, s.
    pub start: f64,
    /// How long it takes, s; positive.
    pub over: f64,
    /// The value it ends at.
    pub to: f64,
}

/// A value over time.
#[derive(Debug, Clone, PartialEq)]
pub enum ScalarTrajectory {
    /// Always the same.
    Constant(f64),
    /// `mean + amplitude · sin(rate · t)`.
    Sinusoid {
        /// In the unit of the value.
        mean: f64,
        /// In the unit of the value.
        amplitude: f64,
        /// rad/s.
        rate: f64,
    },
    /// A first value and ramps from it, in the order of their start.
    Ramps {
        /// Before the first ramp.
        from: f64,
        /// In the order of time.
        ramps: Vec<Ramp>,
    },
}

impl ScalarTrajectory {
    /// Value, first and second derivative at `t` s.
    pub fn at(&self, t: f64) -> [f64; 3] {
        match self {
            Self::Constant(value) => [*value, 0.0, 0.0],
            Self::Sinusoid { mean, amplitude, rate } => wave(*mean, *amplitude, *rate, t),
            Self::Ramps { from, ramps } => {
                let mut out = [*from, 0.0, 0.0];
                for ramp in ramps.iter().take_while(|r| r.start <= t) {
                    out = ramp.at(out[0], t);
                }
                out
            }
        }
    }
}

/// Value, first and second derivative of `mean + amplitude · sin(rate · t)`.
pub(crate) fn wave(mean: f64, amplitude: f64, rate: f64, t: f64) -> [f64; 3] {
    let (sin, cos) = (rate * t).sin_cos();
    [mean + amplitude * sin, amplitude * rate * cos, -amplitude * rate * rate * sin]
}

impl Ramp {
    fn at(&self, from: f64, t: f64) -> [f64; 3] {
        let u = ((t - self.start) / self.over).clamp(0.0, 1.0);
        let rise = self.to - from;
        let value = u * u * u * (10.0 + u * (6.0 * u - 15.0));
        let rate = 30.0 * u * u * (1.0 - u) * (1.0 - u);
        let acceleration = 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u);
        [from + rise * value, rise * rate / self.over, rise * acceleration / (self.over * self.over)]
    }
}

/// The set point of an edge over time.
#[derive(Debug, Clone, PartialEq)]
pub struct SetPointTrajectory {
    /// m.
    pub distance: ScalarTrajectory,
    /// rad.
    pub bearing: ScalarTrajectory,
}

impl SetPointTrajectory {
    /// A set point that stays, m and rad.
    pub fn constant(distance: f64, bearing: f64) -> Self {
        Self { distance: ScalarTrajectory::Constant(distance), bearing: ScalarTrajectory::Constant(bearing) }
    }

    /// s^d and its derivatives at `t` s.
    pub fn at(&self, t: f64) -> SetPoint {
        let (d, b) = (self.distance.at(t), self.bearing.at(t));
        SetPoint { value: [d[0], b[0]], rate: [d[1], b[1]], acceleration: [d[2], b[2]] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn courses() -> [ScalarTrajectory; 3] {
        [
            ScalarTrajectory::Constant(2.0),
            ScalarTrajectory::Sinusoid { mean: 2.0, amplitude: 0.3, rate: 0.7 },
            ScalarTrajectory::Ramps {
                from: 2.0,
                ramps: vec![Ramp { start: 1.0, over: 2.0, to: 3.0 }, Ramp { start: 4.0, over: 1.5, to: 1.0 }],
            },
        ]
    }

    proptest! {
        #[test]
        fn derivatives_are_the_differences_of_the_values(t in 0.0..8.0) {
            let h = 1e-4;
            for course in courses() {
                let [_, rate, acceleration] = course.at(t);
                let (before, after) = (course.at(t - h), course.at(t + h));
                prop_assert!(((after[0] - before[0]) / (2.0 * h) - rate).abs() < 1e-6);
                prop_assert!(((after[1] - before[1]) / (2.0 * h) - acceleration).abs() < 5e-3);
            }
        }
    }

    #[test]
    fn ramps_start_and_end_where_they_say() {
        let course = &courses()[2];
        for (t, value) in [(0.0, 2.0), (1.0, 2.0), (3.0, 3.0), (3.9, 3.0), (5.5, 1.0), (99.0, 1.0)] {
            assert!((course.at(t)[0] - value).abs() < 1e-12, "at {t}");
        }
    }
}
