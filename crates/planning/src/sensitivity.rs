//! How the places of all robots change with the curvatures of a leg: analytic derivatives of the lead's way, and of the
//! equations by which followers trail it.
//!
//! Column 0 is the relative change of all lengths, column k + 1 the curvature at knot k. With u = (cos θ, sin θ) and ν = (−sin θ,
//! cos θ) for the lead,
//!
//! ```text
//! ∂θ/∂κ_k = ∫ φ_k ds     ∂p/∂κ_k = ∫ ν ∂θ/∂κ_k ds     φ_k the hat function of knot k
//! ```
//!
//! For followers the steps of [`trailing`](crate::trailing) are differentiated as they stand there. What has not been passed
//! changes nothing: columns beyond the next knot are 0.

use crate::leg::{CurvatureKnot, Leg, Piece};
use crate::trailing::{Convoy, Trailing};
use vocabulary::math;

/// A leg's walk with derivatives.
#[derive(Debug)]
pub(crate) struct Sensitivity<'a> {
    trailing: &'a Trailing,
    knots: &'a [CurvatureKnot],
    start_heading: f64,
    /// Number of the knot that was passed last.
    knot: usize,
    /// ∂θ at that knot.
    base: Vec<f64>,
    /// ∂x and ∂y of every robot.
    positions: Vec<[Vec<f64>; 2]>,
    /// ∂θ̄ and that of its memory for every held heading.
    held: Vec<[Vec<f64>; 2]>,
    /// ∂θ of the lead at the end of the last piece.
    heading: Vec<f64>,
}

/// How a robot's last step changes.
struct StepChange {
    /// Of its direction, rad.
    course: Vec<f64>,
    /// Of its length, m.
    length: Vec<f64>,
}

impl<'a> Sensitivity<'a> {
    pub(crate) fn new(trailing: &'a Trailing, leg: &'a Leg) -> Self {
        let zero = vec![0.0; leg.knots.len() + 1];
        let pair = [zero.clone(), zero.clone()];
        Self {
            trailing,
            knots: &leg.knots,
            start_heading: leg.start.heading,
            knot: 0,
            base: zero.clone(),
            positions: vec![pair.clone(); trailing.robots()],
            held: vec![pair; trailing.frames()],
            heading: zero,
        }
    }

    /// Columns that may differ from 0, from the first.
    pub(crate) fn active(&self) -> usize {
        self.knot + 3
    }

    /// ∂x and ∂y of a robot.
    pub(crate) fn position(&self, robot: usize) -> [&[f64]; 2] {
        let [x, y] = &self.positions[robot];
        [x, y]
    }

    /// ∂θ of the lead.
    pub(crate) fn heading(&self) -> &[f64] {
        &self.heading
    }

    /// Moves the convoy over a piece, and the derivatives with it.
    pub(crate) fn piece(&mut self, convoy: &mut Convoy, piece: &Piece) {
        let knots = self.knots;
        let from = piece.way - piece.length;
        while self.knot + 2 < knots.len() && knots[self.knot + 1].way <= from + 1e-9 {
            self.base = self.heading_at(knots[self.knot + 1].way, self.heading[0]);
            self.knot += 1;
        }
        let swept = piece.middle - self.start_heading;
        let middle = self.heading_at(from + 0.5 * piece.length, swept);
        self.heading = self.heading_at(piece.way, piece.end.heading - self.start_heading);
        for robot in 0..self.trailing.robots() {
            let (old, held) = (convoy.positions[robot], self.trailing.held_of(convoy, robot));
            self.trailing.step(convoy, robot, piece);
            let change =
                if robot == 0 { self.lead(&middle, piece) } else { self.follower(convoy, robot, old) };
            let course = if robot == 0 { piece.middle } else { convoy.courses[robot] };
            self.filters(convoy, robot, &change, &held, course);
        }
    }

    /// ∂θ at a way within the present segment, where the heading has changed by `swept` rad since the start.
    fn heading_at(&self, way: f64, swept: f64) -> Vec<f64> {
        let [a, b] = [self.knots[self.knot], self.knots[self.knot + 1]];
        let (u, span) = (way - a.way, b.way - a.way);
        let rises = if span > 0.0 { 0.5 * u * u / span } else { 0.0 };
        let mut row = self.base.clone();
        row[0] = swept;
        row[self.knot + 1] += u - rises;
        row[self.knot + 2] += rises;
        row
    }

    fn lead(&mut self, middle: &[f64], piece: &Piece) -> StepChange {
        let (sin, cos) = math::sin_cos(piece.middle);
        let length = piece.length;
        let n = self.active();
        let [x, y] = &mut self.positions[0];
        for k in 0..n {
            x[k] -= length * sin * middle[k];
            y[k] += length * cos * middle[k];
        }
        x[0] += length * cos;
        y[0] += length * sin;
        let mut change = StepChange { course: middle.to_vec(), length: vec![0.0; middle.len()] };
        change.length[0] = length;
        change
    }

    fn follower(&mut self, convoy: &Convoy, robot: usize, old: [f64; 2]) -> StepChange {
        let [leader, frame] = self.trailing.follows(robot);
        let n = self.active();
        let [dx, dy] = [0, 1].map(|k| convoy.positions[robot][k] - convoy.positions[leader][k]);
        let [x, y] = [0, 1].map(|k| convoy.positions[robot][k] - old[k]);
        let length = (x * x + y * y).sqrt().max(1e-9);
        let (cos, sin) = (x / length, y / length);
        let mut change =
            StepChange { course: vec![0.0; self.base.len()], length: vec![0.0; self.base.len()] };
        for k in 0..n {
            let turned = self.held[frame][0][k];
            let new =
                [self.positions[leader][0][k] - dy * turned, self.positions[leader][1][k] + dx * turned];
            let [ex, ey] = [0, 1].map(|i| new[i] - self.positions[robot][i][k]);
            change.length[k] = cos * ex + sin * ey;
            change.course[k] = (cos * ey - sin * ex) / length;
            self.positions[robot][0][k] = new[0];
            self.positions[robot][1][k] = new[1];
        }
        change
    }

    /// The headings that are held against a robot, after its step; `held` are those before.
    fn filters(
        &mut self,
        convoy: &Convoy,
        robot: usize,
        change: &StepChange,
        held: &[[f64; 2]],
        course: f64,
    ) {
        let n = self.active();
        for (frame, before) in self.trailing.frames_of(robot).zip(held) {
            let slopes = self.trailing.filter_slopes(frame, *before, course, convoy.moved[robot]);
            for k in 0..n {
                let [heading, memory] = [0, 1].map(|i| self.held[frame][i][k]);
                let (turned, longer) = (change.course[k], change.length[k]);
                let next = match slopes {
                    Some(slopes) => slopes.map(|[of_course, of_held, of_memory, of_length]| {
                        of_course * turned + of_held * heading + of_memory * memory + of_length * longer
                    }),
                    None if robot == 0 => [self.heading[k]; 2],
                    None => [1.5 * turned - 0.5 * memory, turned],
                };
                for (row, value) in self.held[frame].iter_mut().zip(next) {
                    row[k] = value;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::TravelLimits;
    use crate::trial;
    use vocabulary::Pose;

    fn ends(trailing: &Trailing, leg: &Leg, scale: f64) -> Vec<[f64; 2]> {
        let mut leg = leg.clone();
        for knot in &mut leg.knots {
            knot.way *= scale;
        }
        let mut convoy = trailing.steady(leg.start, 0.0, leg.knots[0].level);
        // The same pieces whatever the scale.
        for piece in leg.pieces(0.26 * scale) {
            for robot in 0..trailing.robots() {
                trailing.step(&mut convoy, robot, &piece);
            }
        }
        convoy.positions
    }

    /// Against differences of walks, for followers with filtered headings and with their leaders' own.
    #[test]
    fn derivatives_are_those_of_finite_differences() {
        let filtered = trial::vee();
        for model in [filtered.clone(), trial::without_filters(&filtered)] {
            let trailing = Trailing::new(&model, &TravelLimits::default());
            let curvatures = [0.0, 0.1, -0.15, 0.2, 0.3, -0.1, 0.0, 0.1];
            let knots = curvatures.iter().enumerate().map(|(k, curvature)| CurvatureKnot {
                way: k as f64,
                curvature: *curvature,
                level: 0.4 * k as f64,
            });
            let leg = Leg { start: Pose::new(1.0, 2.0, 0.4), backwards: false, knots: knots.collect() };
            let mut convoy = trailing.steady(leg.start, 0.0, 0.0);
            let mut sensitivity = Sensitivity::new(&trailing, &leg);
            for piece in leg.pieces(0.26) {
                sensitivity.piece(&mut convoy, &piece);
            }
            let small = 1e-5;
            for column in 0..=leg.knots.len() {
                let moved = |by: f64| {
                    let mut leg = leg.clone();
                    if column > 0 {
                        leg.knots[column - 1].curvature += by;
                    }
                    ends(&trailing, &leg, if column == 0 { 1.0 + by } else { 1.0 })
                };
                let [high, low] = [moved(small), moved(-small)];
                for robot in 0..trailing.robots() {
                    for i in 0..2 {
                        let expected = (high[robot][i] - low[robot][i]) / (2.0 * small);
                        let found = sensitivity.position(robot)[i][column];
                        // The lead's way is integrated to a higher order than its derivative.
                        let scale = 1.0 + expected.abs();
                        assert!(
                            (found - expected).abs() < 0.01 * scale,
                            "{column} {robot} {i}: {found} {expected}"
                        );
                    }
                }
            }
        }
    }
}
