//! Set points that move in time, with first and second derivative.

use vocabulary::{ScalarTrajectory, SetPoint};

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
    use vocabulary::Ramp;

    fn courses() -> [ScalarTrajectory; 3] {
        [
            ScalarTrajectory::Constant(2.0),
            ScalarTrajectory::Sinusoid { mean: 2.0, amplitude: 0.3, rate: 0.7 },
            ScalarTrajectory::Ramps(vec![
                Ramp { from: 2.0, to: 3.0, start: 1.0, over: 2.0 },
                Ramp { from: 3.0, to: 1.0, start: 4.0, over: 1.5 },
            ]),
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
