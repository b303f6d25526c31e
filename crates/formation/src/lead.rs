//! What lead robots do: every kind gives v, dv/dt, ω and dω/dt at any time.

mod bend;
mod hermite;
mod speed_schedule;
mod spline_path;
mod tridiagonal;

pub use bend::Bend;
pub use hermite::Hermite;
pub use speed_schedule::SpeedSchedule;
pub use spline_path::{SplinePath, SplinePathError};

use std::sync::Arc;
use vocabulary::{MotionInput, ScalarTrajectory, Trajectory};

/// Speed and turn rate as functions of time: constant, circle, sinusoids, figure eight.
#[derive(Debug, Clone)]
pub struct AnalyticTrajectory {
    /// m/s.
    pub speed: ScalarTrajectory,
    /// rad/s.
    pub turn_rate: ScalarTrajectory,
}

impl AnalyticTrajectory {
    /// Constant `speed` in m/s and `turn_rate` in rad/s: a straight line or a circle.
    pub fn constant(speed: f64, turn_rate: f64) -> Self {
        Self { speed: ScalarTrajectory::Constant(speed), turn_rate: ScalarTrajectory::Constant(turn_rate) }
    }

    /// A figure eight driven at constant `speed` in m/s in `period` s per whole eight, starting at its crossing,
    /// into the left lobe first.
    ///
    /// It is the sine-generated curve: the heading swings as A cos(2π t/period). The curve closes where
    /// ∮ cos(A sin φ) dφ = 2π J0(A) = 0; its first zero gives the eight.
    pub fn figure_eight(speed: f64, period: f64) -> Self {
        let rate = std::f64::consts::TAU / period;
        let turn_rate = ScalarTrajectory::Sinusoid { mean: 0.0, amplitude: FIRST_ZERO_OF_J0 * rate, rate };
        Self { speed: ScalarTrajectory::Constant(speed), turn_rate }
    }
}

/// First zero of the Bessel function J0.
const FIRST_ZERO_OF_J0: f64 = 2.404_825_557_695_773;

impl Trajectory for AnalyticTrajectory {
    fn at(&self, time: f64) -> MotionInput {
        let ([speed, acceleration, _], [turn_rate, turn_acceleration, _]) =
            (self.speed.at(time), self.turn_rate.at(time));
        MotionInput { speed, acceleration, turn_rate, turn_acceleration }
    }

    fn steady(&self) -> Option<MotionInput> {
        let constant = |what: &ScalarTrajectory| matches!(what, ScalarTrajectory::Constant(_));
        (constant(&self.speed) && constant(&self.turn_rate)).then(|| self.at(0.0))
    }

    fn ranges(&self) -> Option<[[f64; 2]; 2]> {
        Some([self.speed.range(), self.turn_rate.range()])
    }
}

/// A motion that begins at another time.
#[derive(Debug, Clone)]
pub struct Delayed {
    /// The motion.
    pub motion: Arc<dyn Trajectory>,
    /// By how much later it begins, s.
    pub by: f64,
}

impl Trajectory for Delayed {
    fn at(&self, time: f64) -> MotionInput {
        self.motion.at(time - self.by)
    }

    fn steady(&self) -> Option<MotionInput> {
        self.motion.steady()
    }

    fn ranges(&self) -> Option<[[f64; 2]; 2]> {
        self.motion.ranges()
    }
}

/// Speed and turn rate read from a table, smooth between its rows and constant outside them.
#[derive(Debug, Clone)]
pub struct TabulatedTrajectory {
    speed: Hermite,
    turn_rate: Hermite,
}

impl TabulatedTrajectory {
    /// From rows of [time s, speed m/s, turn rate rad/s] with strictly growing times; `None` without rows.
    pub fn new(rows: &[[f64; 3]]) -> Option<Self> {
        let channel = |i: usize| Hermite::new(rows.iter().map(|r| [r[0], r[i]]).collect());
        Some(Self { speed: channel(1)?, turn_rate: channel(2)? })
    }
}

impl Trajectory for TabulatedTrajectory {
    fn at(&self, time: f64) -> MotionInput {
        let ([speed, acceleration], [turn_rate, turn_acceleration]) =
            (self.speed.at(time), self.turn_rate.at(time));
        MotionInput { speed, acceleration, turn_rate, turn_acceleration }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::math;

    /// Position and heading after driving `trajectory` for `duration` s, by a fine midpoint rule.
    fn drive(trajectory: &dyn Trajectory, duration: f64) -> [f64; 3] {
        let steps = 200_000;
        let h = duration / f64::from(steps);
        let (mut x, mut y, mut heading) = (0.0, 0.0, 0.0_f64);
        for k in 0..steps {
            let d = trajectory.at((f64::from(k) + 0.5) * h);
            let middle = heading + d.turn_rate * h / 2.0;
            x += d.speed * math::cos(middle) * h;
            y += d.speed * math::sin(middle) * h;
            heading += d.turn_rate * h;
        }
        [x, y, heading]
    }

    #[test]
    fn a_figure_eight_closes_and_crosses_itself() {
        let eight = AnalyticTrajectory::figure_eight(0.8, 40.0);
        for (time, name) in [(40.0, "end"), (20.0, "crossing")] {
            let [x, y, _] = drive(&eight, time);
            assert!(math::hypot(x, y) < 1e-3, "{name}: {x} {y}");
        }
        assert!(drive(&eight, 40.0)[2].abs() < 1e-6);
        assert_eq!(eight.at(0.0).turn_rate, 0.0);
    }

    #[test]
    fn table_rows_are_met_and_derivatives_match() {
        let table =
            TabulatedTrajectory::new(&[[0.0, 1.0, 0.0], [2.0, 1.5, 0.3], [3.0, 1.5, -0.2]]).expect("rows");
        assert_eq!(table.at(2.0).speed, 1.5);
        assert_eq!(table.at(9.0), MotionInput { speed: 1.5, turn_rate: -0.2, ..MotionInput::default() });
        let h = 1e-6;
        for t in [0.3, 1.1, 2.6] {
            let slope = (table.at(t + h).turn_rate - table.at(t - h).turn_rate) / (2.0 * h);
            assert!((slope - table.at(t).turn_acceleration).abs() < 1e-8);
        }
    }
}
