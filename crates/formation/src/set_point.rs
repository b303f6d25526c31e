//! Set points that move in time, with first and second derivative.

use vocabulary::{ScalarTrajectory, SetPoint, math};

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

/// `set_point` moved by an offset [forward, left] in m along the heading its bearing is counted from; `offset` holds it
/// with its first and second derivative. The distance is no less than `distance_min` m where it divides.
pub(crate) fn displaced(set_point: &SetPoint, offset: &[[f64; 2]; 3], distance_min: f64) -> SetPoint {
    let SetPoint { value: [l, psi], rate: [dl, dpsi], acceleration: [ddl, ddpsi] } = *set_point;
    let (sin, cos) = math::sin_cos(psi);
    let turned = |along: f64, across: f64| [along * cos - across * sin, along * sin + across * cos];
    let add = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
    let c = add(turned(l, 0.0), offset[0]);
    let d = add(turned(dl, l * dpsi), offset[1]);
    let e = add(turned(ddl - l * dpsi * dpsi, 2.0 * dl * dpsi + l * ddpsi), offset[2]);
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let distance = math::hypot(c[0], c[1]).max(distance_min);
    let rate = [dot(c, d) / distance, cross(c, d) / (distance * distance)];
    SetPoint {
        value: [distance, math::atan2(c[1], c[0])],
        rate,
        acceleration: [
            (dot(d, d) + dot(c, e) - rate[0] * rate[0]) / distance,
            (cross(c, e) - 2.0 * distance * rate[0] * rate[1]) / (distance * distance),
        ],
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

    proptest! {
        /// A place that moves, and an offset that moves: the polar derivatives are the differences of the polar values.
        #[test]
        fn a_displaced_set_point_has_the_derivatives_of_its_value(
            value in (1.0..3.0, -3.0..3.0), rate in (-0.5..0.5, -0.5..0.5), bend in (-0.5..0.5, -0.5..0.5),
            offset in (-0.4..0.4, -0.4..0.4), moving in (-0.3..0.3, -0.3..0.3), pushed in (-0.3..0.3, -0.3..0.3)
        ) {
            let run = |x: f64, v: f64, a: f64, t: f64| x + v * t + 0.5 * a * t * t;
            let at = |t: f64| {
                let base = SetPoint {
                    value: [run(value.0, rate.0, bend.0, t), run(value.1, rate.1, bend.1, t)],
                    rate: [rate.0 + bend.0 * t, rate.1 + bend.1 * t],
                    acceleration: [bend.0, bend.1],
                };
                let offset = [
                    [run(offset.0, moving.0, pushed.0, t), run(offset.1, moving.1, pushed.1, t)],
                    [moving.0 + pushed.0 * t, moving.1 + pushed.1 * t],
                    [pushed.0, pushed.1],
                ];
                displaced(&base, &offset, 0.1)
            };
            let h = 1e-4;
            let (before, now, after) = (at(-h), at(0.0), at(h));
            for i in 0..2 {
                let [a, b] = [before.value[i], after.value[i]].map(|x| vocabulary::nearest_turn(x, now.value[i]));
                prop_assert!(((b - a) / (2.0 * h) - now.rate[i]).abs() < 1e-5);
                prop_assert!(((after.rate[i] - before.rate[i]) / (2.0 * h) - now.acceleration[i]).abs() < 1e-5);
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
