//! What a lead robot does.

use serde::Serialize;

/// Motion of a lead robot as plain data; it starts at the robot's pose.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Path {
    /// Straight on or round and round.
    Constant {
        /// m/s.
        speed: f64,
        /// rad/s, left positive.
        turn_rate: f64,
    },
    /// value(t) = mean + amplitude · sin(rate · t) for speed and turn rate.
    Sinusoid {
        /// Mean speed, m/s.
        speed: f64,
        /// Amplitude of the speed, m/s; the speed never falls below 0.
        speed_amplitude: f64,
        /// rad/s.
        speed_rate: f64,
        /// Mean turn rate, rad/s.
        turn_rate: f64,
        /// Amplitude of the turn rate, rad/s.
        turn_rate_amplitude: f64,
        /// rad/s.
        turn_rate_rate: f64,
    },
    /// A circle.
    Circle {
        /// m/s.
        speed: f64,
        /// rad/s, left positive, not 0.
        turn_rate: f64,
    },
    /// Figure eights, over and over.
    FigureEight {
        /// m/s.
        speed: f64,
        /// Length of one whole eight, m.
        length: f64,
    },
    /// A smooth curve through points.
    Waypoints {
        /// World coordinates [x, y], m; at least two, neighbours distinct. The robot starts at its first.
        points: Vec<[f64; 2]>,
        /// Whether the curve returns to its first point and goes on.
        closed: bool,
        /// Speed along the curve.
        speed: SpeedProfile,
    },
    /// Speed and turn rate from a table, linear in between, held after the last row.
    Table {
        /// Rows of [time in s, speed in m/s, turn rate in rad/s], time rising from 0.
        rows: Vec<[f64; 3]>,
    },
}

/// Speed along a curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SpeedProfile {
    /// Rows of [distance travelled in m, speed in m/s], rising from 0, smooth in between.
    Distance(Vec<[f64; 2]>),
    /// Rows of [time in s, speed in m/s], rising from 0, smooth in between.
    Time(Vec<[f64; 2]>),
    /// Always this, m/s.
    #[serde(untagged)]
    Constant(f64),
}
