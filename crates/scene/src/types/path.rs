//! What a lead robot does.

use serde::Serialize;
use vocabulary::{Pose, math};

/// Motion of a lead robot as plain data; it starts at the robot's pose, way-points at their own start.
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
        /// World coordinates [x, y], m; at least two, neighbours distinct. The first is the robot's position; its
        /// heading is that of the curve there, whatever its pose says.
        points: Vec<[f64; 2]>,
        /// Whether the curve returns to its first point and goes on; then at least three points, the last not the
        /// first again.
        closed: bool,
        /// Speed along the curve.
        speed: SpeedProfile,
    },
    /// Speed and turn rate from a table, smooth in between without overshoot, held after the last row.
    Table {
        /// Rows of [time in s, speed in m/s, turn rate in rad/s], time rising from 0.
        rows: Vec<[f64; 3]>,
    },
    /// To a goal, where it stays: the way is planned for the whole formation.
    Goal {
        /// Where to.
        pose: Goal,
        /// How to go there.
        #[serde(flatten)]
        travel: Travel,
    },
    /// To one goal after the other, planned alike.
    Tour {
        /// Where to, one after the other; at least one.
        goals: Vec<Goal>,
        /// How long it stays at each, s.
        pause: f64,
        /// How often it goes through all of them.
        rounds: u32,
        /// How to go there.
        #[serde(flatten)]
        travel: Travel,
    },
}

/// A place to reach at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// World coordinates [x, y], m.
    pub position: [f64; 2],
    /// rad; `None` for any.
    pub heading: Option<f64>,
}

impl Serialize for Goal {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let [x, y] = self.position;
        match self.heading {
            Some(heading) => [x, y, heading].serialize(serializer),
            None => [x, y].serialize(serializer),
        }
    }
}

/// How a formation goes to its goals.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Travel {
    /// Speed of the lead where nothing slows it, m/s.
    pub speed: f64,
    /// How it gains speed and brakes, m/s².
    pub acceleration: f64,
    /// How far all robots stay off what is known to stand there, m; what their safety filters keep free without it.
    pub clearance: Option<f64>,
    /// Of several formations those of higher priority plan first.
    pub priority: u32,
    /// How long it waits for a way that is not there, s.
    pub patience: f64,
}

/// Speed along a curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SpeedProfile {
    /// Rows of [distance travelled in m, speed in m/s], rising from 0, smooth in between, held after the last.
    Distance(Vec<[f64; 2]>),
    /// Rows of [time in s, speed in m/s], rising from 0, smooth in between, held after the last.
    Time(Vec<[f64; 2]>),
    /// Always this, m/s.
    #[serde(untagged)]
    Constant(f64),
}

impl Path {
    /// Where the path itself says that its robot starts, heading for the second point.
    pub(crate) fn start(&self) -> Option<Pose> {
        let Self::Waypoints { points, .. } = self else { return None };
        let [first, second, ..] = points.as_slice() else { return None };
        Some(Pose::new(first[0], first[1], math::atan2(second[1] - first[1], second[0] - first[0])))
    }

    /// Bounds on |speed| in m/s and |turn rate| in rad/s over all times, where they are known beforehand.
    pub(crate) fn peaks(&self) -> (f64, Option<f64>) {
        let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
        match self {
            Self::Constant { speed, turn_rate } | Self::Circle { speed, turn_rate } => {
                (*speed, Some(turn_rate.abs()))
            }
            Self::Sinusoid { speed, speed_amplitude, turn_rate, turn_rate_amplitude, .. } => {
                (speed + speed_amplitude.abs(), Some(turn_rate.abs() + turn_rate_amplitude.abs()))
            }
            Self::FigureEight { speed, .. }
            | Self::Waypoints { speed: SpeedProfile::Constant(speed), .. } => (*speed, None),
            Self::Waypoints { speed: SpeedProfile::Distance(rows) | SpeedProfile::Time(rows), .. } => {
                (largest(&mut rows.iter().map(|row| row[1])), None)
            }
            Self::Table { rows } => (
                largest(&mut rows.iter().map(|row| row[1])),
                Some(largest(&mut rows.iter().map(|row| row[2]))),
            ),
            Self::Goal { travel, .. } | Self::Tour { travel, .. } => (travel.speed, None),
        }
    }

    /// Whether the way has to be planned first.
    pub fn is_planned(&self) -> bool {
        matches!(self, Self::Goal { .. } | Self::Tour { .. })
    }
}
