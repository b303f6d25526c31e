//! What a robot is and what it can do.

use crate::text::{form::Number, number, settings, words};
use vocabulary::{Body, Limits};

/// A measure of a body.
const MEASURE: Number = number("m").above(0.0).up_to(100.0);

settings! {
    /// Kind, limits and measures of a robot; the limits are those of the paper's simulations.
    #[derive(Copy)]
    pub struct Vehicle from VehiclePart {
        /// How it moves.
        pub kind: VehicleKind = VehicleKind::Unicycle, VehicleKind::form();
        /// Slowest forward speed of a follower, m/s; above 0, since the law is singular at rest.
        pub speed_min: f64 = 0.01, number("m/s").above(0.0).up_to(100.0);
        /// Fastest forward speed, m/s; above `speed_min`.
        pub speed_max: f64 = 1.6, number("m/s").above(0.0).up_to(100.0);
        /// Largest |turn rate|, rad/s.
        pub turn_rate_max: f64 = 11.5, number("rad/s").above(0.0).up_to(1000.0);
        /// Largest |dv/dt|, m/s²; `inf` for unbounded.
        pub acceleration_max: f64 = f64::INFINITY, number("m/s²").above(0.0).or_infinite();
        /// Bumper to bumper, m.
        pub length: f64 = Body::default().length, MEASURE;
        /// Side to side, m.
        pub width: f64 = Body::default().width, MEASURE;
        /// Between the axles, m.
        pub wheelbase: f64 = Body::default().wheelbase, MEASURE;
        /// Between the wheels of an axle, m.
        pub track: f64 = Body::default().track, MEASURE;
        /// Of every wheel, m.
        pub wheel_radius: f64 = Body::default().wheel_radius, MEASURE;
    }
}

words! {
    /// How a robot moves.
    pub enum VehicleKind {
        /// dx/dt = v cos θ, dy/dt = v sin θ, dθ/dt = ω (eq 1).
        Unicycle = "unicycle",
    }
}

impl Vehicle {
    /// Bounds on speed, turn rate and acceleration.
    pub fn limits(&self) -> Limits {
        Limits {
            speed_min: self.speed_min,
            speed_max: self.speed_max,
            turn_rate_max: self.turn_rate_max,
            acceleration_max: self.acceleration_max,
            curvature_max: f64::INFINITY,
            lateral_acceleration_max: f64::INFINITY,
        }
    }

    /// Outer measures, for drawing and clearance.
    pub fn body(&self) -> Body {
        Body {
            length: self.length,
            width: self.width,
            height: Body::default().height,
            wheelbase: self.wheelbase,
            track: self.track,
            wheel_radius: self.wheel_radius,
        }
    }
}
