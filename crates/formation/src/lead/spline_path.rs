//! A smooth curve through way-points, driven at a speed given over time or over the distance travelled.
//!
//! The curve is the interpolating cubic spline over chord length: its curvature is continuous, so the turn rate is.

use super::{Bend, SpeedSchedule, bend::sharpest, tridiagonal::Tridiagonal};
use kurbo::{CubicBez, ParamCurve, ParamCurveArclen, ParamCurveDeriv, Point, Vec2};
use thiserror::Error;
use vocabulary::{MotionInput, Pose, Trajectory, math};

/// Why points make no curve.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SplinePathError {
    /// Fewer points than a curve needs.
    #[error("a way needs at least {needed} different points, this one has {given}")]
    TooFew {
        /// 2, or 3 for a closed way.
        needed: usize,
        /// How many there were.
        given: usize,
    },
    /// Two points in a row on one spot, counted from 1.
    #[error("way-points {0} and {next} are the same", next = .0 + 1)]
    Repeated(usize),
}

/// A curve and how fast it is driven.
#[derive(Debug, Clone)]
pub struct SplinePath {
    pieces: Vec<CubicBez>,
    /// Arc length from the start to the start of each piece, and the whole length at the end, m.
    lengths: Vec<f64>,
    closed: bool,
    pace: SpeedSchedule,
}

/// Rounds of a closed way that are looked at while its speed changes.
const MOST_LAPS: u32 = 1000;
/// Accuracy of arc lengths, m.
const ACCURACY: f64 = 1e-10;
/// As a share of a length: no closer than numbers are to each other.
const RELATIVE_ACCURACY: f64 = 1e-12;

impl SplinePath {
    /// Through `points` in m (back to the first if `closed`).
    ///
    /// # Errors
    /// [`SplinePathError`] for too few or repeated points.
    pub fn new(points: &[[f64; 2]], closed: bool, pace: SpeedSchedule) -> Result<Self, SplinePathError> {
        let needed = if closed { 3 } else { 2 };
        if points.len() < needed {
            return Err(SplinePathError::TooFew { needed, given: points.len() });
        }
        let pieces = spline(points, closed)?;
        let mut lengths = vec![0.0];
        for piece in &pieces {
            lengths.push(lengths[lengths.len() - 1] + piece.arclen(accuracy(piece)));
        }
        Ok(Self { pieces, lengths, closed, pace })
    }

    /// Length of the curve, m.
    pub fn length(&self) -> f64 {
        self.lengths[self.pieces.len()]
    }

    /// Where the curve begins and how it points there: the robot should start here.
    pub fn start(&self) -> Pose {
        let (point, tangent) = (self.pieces[0].p0, self.pieces[0].p1 - self.pieces[0].p0);
        Pose::new(point.x, point.y, math::atan2(tangent.y, tangent.x))
    }

    /// The sharpest bend of every piece, each time that it is passed before `until` s while the speed still changes, and
    /// once after.
    pub fn bends(&self, until: f64) -> Vec<Bend> {
        let mut bends = Vec::new();
        for (k, piece) in self.pieces.iter().enumerate() {
            let (u, curvature) = sharpest(piece);
            let near = if u < 0.5 { k } else { k + 1 };
            let from = if u < 0.5 { piece.p0 } else { piece.p3 };
            let along = self.lengths[k] + piece.subsegment(0.0..u).arclen(accuracy(piece));
            for lap in 0..if self.closed { MOST_LAPS } else { 1 } {
                let travelled = along + f64::from(lap) * self.length();
                let Some(time) = self.pace.when(travelled).filter(|time| *time <= until) else { break };
                let speed = self.pace.at(time)[1];
                let point = if self.closed { near % self.pieces.len() } else { near } + 1;
                bends.push(Bend { point, place: [from.x, from.y], curvature, time, speed });
                if self.pace.is_steady_from(time) {
                    break;
                }
            }
        }
        bends
    }

    /// Curvature in 1/m and its change along the curve in 1/m² after `travelled` m; straight on beyond an open end.
    fn curvature(&self, travelled: f64) -> [f64; 2] {
        let length = self.length();
        if !self.closed && !(0.0..length).contains(&travelled) {
            return [0.0, 0.0];
        }
        let along = travelled.rem_euclid(length);
        let k = self.lengths.partition_point(|l| *l <= along).clamp(1, self.pieces.len()) - 1;
        let piece = &self.pieces[k];
        let u = piece.inv_arclen(along - self.lengths[k], accuracy(piece));
        let first = piece.deriv();
        let second = first.deriv();
        let third = second.deriv().eval(u).to_vec2();
        let (d1, d2) = (first.eval(u).to_vec2(), second.eval(u).to_vec2());
        let speed = d1.hypot();
        let turn = d1.cross(d2);
        let curvature = turn / math::powi(speed, 3);
        let change = d1.cross(third) / math::powi(speed, 3) - 3.0 * turn * d1.dot(d2) / math::powi(speed, 5);
        [curvature, change / speed]
    }
}

impl Trajectory for SplinePath {
    fn at(&self, time: f64) -> MotionInput {
        let [travelled, speed, acceleration] = self.pace.at(time);
        let [curvature, change] = self.curvature(travelled);
        MotionInput {
            speed,
            acceleration,
            turn_rate: speed * curvature,
            turn_acceleration: acceleration * curvature + speed * speed * change,
        }
    }
}

/// Of the arc length of a piece, m.
fn accuracy(piece: &CubicBez) -> f64 {
    let [a, b, c, d] = [piece.p0, piece.p1, piece.p2, piece.p3];
    ACCURACY.max(RELATIVE_ACCURACY * (a.distance(b) + b.distance(c) + c.distance(d)))
}

/// The interpolating C² cubic spline as Bézier pieces: periodic if closed, natural if open.
fn spline(points: &[[f64; 2]], closed: bool) -> Result<Vec<CubicBez>, SplinePathError> {
    let mut knots: Vec<Point> = points.iter().map(|p| Point::new(p[0], p[1])).collect();
    if closed {
        knots.push(knots[0]);
    }
    let chords: Vec<f64> = knots.windows(2).map(|w| w[0].distance(w[1])).collect();
    if let Some(k) = chords.iter().position(|c| *c < 1e-9) {
        return Err(SplinePathError::Repeated(k + 1));
    }
    let tangents = tangents(&knots, &chords, closed);
    let piece = |k: usize| {
        let (a, b, third) = (knots[k], knots[k + 1], chords[k] / 3.0);
        CubicBez::new(a, a + third * tangents[k], b - third * tangents[k + 1], b)
    };
    Ok((0..chords.len()).map(piece).collect())
}

/// Derivatives at the knots with respect to chord length, from continuity of the second derivative.
fn tangents(knots: &[Point], chords: &[f64], closed: bool) -> Vec<Vec2> {
    let n = if closed { knots.len() - 1 } else { knots.len() };
    let secant = |k: usize| (knots[k + 1] - knots[k]) / chords[k];
    let mut matrix = Tridiagonal { lower: vec![0.0; n - 1], diagonal: vec![0.0; n], upper: vec![0.0; n - 1] };
    let mut corners = [0.0; 2];
    let mut right = vec![[0.0; 2]; n];
    for k in 0..n {
        let row = if closed || (k > 0 && k < n - 1) {
            let before = (k + chords.len() - 1) % chords.len();
            let (h0, h1) = (chords[before], chords[k]);
            matrix.diagonal[k] = 2.0 * (h0 + h1);
            *if k == 0 { &mut corners[0] } else { &mut matrix.lower[k - 1] } = h1;
            *if k == n - 1 { &mut corners[1] } else { &mut matrix.upper[k] } = h0;
            3.0 * (h1 * secant(before) + h0 * secant(k))
        } else {
            let (other, piece) =
                if k == 0 { (&mut matrix.upper[0], 0) } else { (&mut matrix.lower[n - 2], n - 2) };
            matrix.diagonal[k] = 2.0;
            *other = 1.0;
            3.0 * secant(piece)
        };
        right[k] = [row.x, row.y];
    }
    // The matrix is strictly diagonally dominant, so the solution exists.
    if closed {
        matrix.solve_cyclic(corners, &mut right);
    } else {
        matrix.solve(&mut right);
    }
    (0..knots.len()).map(|k| Vec2::new(right[k % n][0], right[k % n][1])).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Hermite;
    use super::*;

    fn pace(rows: Vec<[f64; 2]>) -> SpeedSchedule {
        SpeedSchedule::over_time(Hermite::new(rows).expect("rows"))
    }

    fn oval() -> SplinePath {
        let points = [[0.0, 0.0], [4.0, -1.0], [8.0, 0.0], [8.0, 4.0], [4.0, 5.0], [0.0, 4.0]];
        SplinePath::new(&points, true, pace(vec![[0.0, 0.5], [5.0, 1.2]])).expect("an oval")
    }

    /// Driving the profile from the start of the curve must stay on the curve.
    #[test]
    fn the_profile_drives_the_curve() {
        let way = oval();
        let start = way.start();
        let (mut x, mut y, mut heading) = (start.x, start.y, start.heading);
        let h = 1e-4;
        let mut travelled = 0.0;
        while travelled < way.length() {
            let d = way.at((travelled_time(&way, travelled)) + h / 2.0);
            let middle = heading + d.turn_rate * h / 2.0;
            x += d.speed * math::cos(middle) * h;
            y += d.speed * math::sin(middle) * h;
            heading += d.turn_rate * h;
            travelled += d.speed * h;
        }
        assert!(math::hypot(x - start.x, y - start.y) < 1e-3, "{x} {y}");
    }

    fn travelled_time(way: &SplinePath, travelled: f64) -> f64 {
        let (mut low, mut high) = (0.0, 100.0);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if way.pace.at(middle)[0] < travelled { low = middle } else { high = middle }
        }
        low
    }

    #[test]
    fn derivatives_match_differences_away_from_knots() {
        let way = oval();
        let h = 1e-5;
        for t in [0.7, 2.3, 6.1, 11.0, 14.2] {
            let d = way.at(t);
            let slope = (way.at(t + h).turn_rate - way.at(t - h).turn_rate) / (2.0 * h);
            assert!((slope - d.turn_acceleration).abs() < 1e-4, "at {t}: {slope} {}", d.turn_acceleration);
        }
    }

    #[test]
    fn the_turn_rate_is_continuous_over_knots_and_zero_beyond_an_open_end() {
        let way = SplinePath::new(
            &[[0.0, 0.0], [2.0, 1.0], [4.0, -1.0], [6.0, 0.0]],
            false,
            pace(vec![[0.0, 1.0]]),
        )
        .expect("a way");
        for length in &way.lengths {
            let (a, b) = (way.at(length - 1e-7).turn_rate, way.at(length + 1e-7).turn_rate);
            assert!((a - b).abs() < 1e-5, "{a} {b} at {length}");
        }
        assert_eq!(way.at(way.length() + 1.0).turn_rate, 0.0);
    }

    #[test]
    fn bad_points_are_named() {
        let too_few = SplinePath::new(&[[0.0, 0.0]], false, pace(vec![[0.0, 1.0]])).expect_err("one point");
        assert_eq!(too_few, SplinePathError::TooFew { needed: 2, given: 1 });
        let repeated = SplinePath::new(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]], false, pace(vec![[0.0, 1.0]]));
        assert_eq!(repeated.expect_err("a repeated point").to_string(), "way-points 2 and 3 are the same");
    }
}
