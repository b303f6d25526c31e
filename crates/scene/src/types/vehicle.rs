//! What a robot is and what it can do.

use serde::Serialize;
use vocabulary::Body;

/// Kind, limits and measures of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Vehicle {
    /// How it moves.
    pub kind: VehicleKind,
    /// Slowest forward speed of a follower, m/s; above 0, since the law is singular at rest.
    pub speed_min: f64,
    /// Fastest forward speed, m/s; above `speed_min`.
    pub speed_max: f64,
    /// Largest |turn rate|, rad/s.
    pub turn_rate_max: f64,
    /// Largest |dv/dt|, m/s²; may be infinite.
    pub acceleration_max: f64,
    /// Bumper to bumper, m.
    pub length: f64,
    /// m.
    pub width: f64,
    /// Between the axles, m.
    pub wheelbase: f64,
    /// Between the wheels of an axle, m.
    pub track: f64,
    /// m.
    pub wheel_radius: f64,
}

/// How a robot moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum VehicleKind {
    /// dx/dt = v cos θ, dy/dt = v sin θ, dθ/dt = ω (eq 1).
    #[default]
    Unicycle,
}

impl Vehicle {
    /// Outer measures, for drawing and clearance.
    pub fn body(&self) -> Body {
        Body {
            length: self.length,
            width: self.width,
            wheelbase: self.wheelbase,
            track: self.track,
            wheel_radius: self.wheel_radius,
        }
    }
}
