//! Well-known shapes: who follows whom, where, for any number of places.

use crate::document::Shape;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use vocabulary::{Word, wrap};

/// A place behind another one; both count from 0, place 0 being the leader's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ShapeStep {
    /// Place that is followed.
    pub(crate) leader: usize,
    /// Bearing from there, rad in (−π, π].
    pub(crate) bearing: f64,
}

impl Shape {
    /// What is wrong with `count` places in this shape.
    pub(crate) fn refuses(self, count: usize) -> Option<String> {
        let needs = match self {
            Self::Diamond if !count.is_multiple_of(4) => "a multiple of 4 places",
            Self::Circle if count < 3 => "at least 3 places",
            _ => return None,
        };
        Some(format!("shape `{}` needs {needs}, not {count}", self.word()))
    }

    /// Who place `place` ≥ 1 of `count` follows, and at which bearing; `angle` in rad is that of the wings.
    pub(crate) fn step(self, place: usize, count: usize, angle: f64) -> ShapeStep {
        if self == Self::Column {
            return ShapeStep { leader: place - 1, bearing: PI };
        }
        // Wings take turns: odd places stand on the right, where bearings are negative.
        let side = if place % 2 == 1 { -1.0 } else { 1.0 };
        let along_wing = place.div_ceil(2);
        let bearing = match self {
            Self::V | Self::Column => angle,
            Self::Abreast => FRAC_PI_2,
            Self::Diamond => {
                if along_wing <= count / 4 {
                    angle
                } else {
                    -angle
                }
            }
            // A chord of the circle points half a step further round than the one before it ended.
            Self::Circle => FRAC_PI_2 + TAU / count as f64 * (along_wing as f64 - 0.5),
        };
        ShapeStep { leader: place.saturating_sub(2), bearing: wrap(side * bearing) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::math;

    /// Places in the leader's body frame for neighbours 1 m apart.
    fn places(shape: Shape, count: usize) -> Vec<[f64; 2]> {
        let mut places = vec![[0.0, 0.0]];
        for place in 1..count {
            let step = shape.step(place, count, 0.75 * PI);
            let [x, y] = places[step.leader];
            places.push([x + math::cos(step.bearing), y + math::sin(step.bearing)]);
        }
        places
    }

    fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
        math::hypot(a[0] - b[0], a[1] - b[1])
    }

    #[test]
    fn a_v_of_seven_has_the_right_wing_on_odd_places() {
        let steps: Vec<_> = (1..7).map(|place| Shape::V.step(place, 7, 0.75 * PI)).collect();
        let leaders: Vec<_> = steps.iter().map(|step| step.leader).collect();
        assert_eq!(leaders, [0, 0, 1, 2, 3, 4]);
        for (index, step) in steps.iter().enumerate() {
            assert_eq!(step.bearing, if index % 2 == 0 { -0.75 * PI } else { 0.75 * PI });
        }
    }

    #[test]
    fn a_line_abreast_and_a_column_are_lines() {
        assert!(places(Shape::Abreast, 7).iter().all(|place| place[0].abs() < 1e-12));
        assert!(places(Shape::Column, 7).iter().all(|place| place[1].abs() < 1e-12));
        assert!((places(Shape::Abreast, 4)[3][1] + 2.0).abs() < 1e-12);
        assert!((places(Shape::Column, 4)[3][0] + 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_diamond_and_a_circle_close() {
        for (shape, count) in
            [(Shape::Diamond, 4), (Shape::Diamond, 12), (Shape::Circle, 5), (Shape::Circle, 12)]
        {
            let places = places(shape, count);
            // The two ends of the wings are neighbours too.
            let gap = apart(places[count - 1], places[count - 2]);
            assert!((gap - 1.0).abs() < 1e-9, "{shape:?} of {count} closes with a gap of {gap}");
        }
    }

    #[test]
    fn a_circle_is_round() {
        let places = places(Shape::Circle, 9);
        let radius = 0.5 / math::sin(PI / 9.0);
        assert!(places.iter().all(|place| (apart(*place, [-radius, 0.0]) - radius).abs() < 1e-9));
    }

    #[test]
    fn a_diamond_has_a_corner_behind() {
        let behind = places(Shape::Diamond, 8)[7];
        assert!((behind[0] + 4.0 * 0.5f64.sqrt()).abs() < 1e-12 && behind[1].abs() < 1e-12);
        assert!(Shape::Diamond.refuses(6).is_some() && Shape::Diamond.refuses(8).is_none());
    }
}
