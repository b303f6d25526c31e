//! A vehicle on four wheels: its parameters, and the files that follow the data from a command to forces.
//!
//! [`driver`] turns a command [dv/dt, ω] into throttle and steering, [`actuator`] lets them take effect with lag, rate
//! and range, [`wheel`] stands each wheel on the ground and takes its spring and its [`tyre`] together. The page
//! `docs/vehicles.md` has the equations.

pub mod actuator;
pub mod driver;
pub mod tyre;
pub mod wheel;

pub use driver::{Driver, Effort};

use vocabulary::{Body, GRAVITY, Limits};

/// Parameters of a wheeled vehicle. Masses, lengths, lags and stiffnesses are positive.
///
/// The body frame has its origin on the ground under the middle of the rear axle when the vehicle stands still on flat
/// ground; x forward, y left, z up.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheeled {
    /// Outer measures.
    pub body: Body,
    /// What commands are held within.
    pub limits: Limits,
    /// kg.
    pub mass: f64,
    /// Of the centre of mass over the ground at rest, m.
    pub mass_height: f64,
    /// Of the centre of mass ahead of the rear axle, as a share of the wheelbase.
    pub mass_forward: f64,
    /// Multiplies the moments of inertia of a box as large as the body.
    pub inertia_scale: f64,
    /// Ground to floor at rest, m.
    pub clearance: f64,
    /// Of one wheel, N/m.
    pub spring: f64,
    /// Of one wheel, N s/m.
    pub damping: f64,
    /// Compression from rest at which the bump stop sets in, m.
    pub travel: f64,
    /// Of the tyres.
    pub tyre: tyre::Tyre,
    /// Force of the air over v², N s²/m².
    pub drag: f64,
    /// How it is driven and turned.
    pub drivetrain: Drivetrain,
    /// Largest force of the motor at the wheels, N.
    pub drive_force: f64,
    /// Of the motor, first order, s.
    pub drive_lag: f64,
    /// Largest force of the brakes at the wheels, N.
    pub brake_force: f64,
    /// Of the brakes, first order, s.
    pub brake_lag: f64,
    /// Whether the driver leads the actuators by their measured lags.
    pub compensation: bool,
    /// Feedback on speed, 1/s.
    pub speed_gain: f64,
    /// Feedback on turn rate: share of the turn rate that is missing that is asked for on top.
    pub turn_gain: f64,
}

/// How a vehicle is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drivetrain {
    /// Four driven wheels, the front ones steered by Ackermann's rule.
    Steered {
        /// Largest angle of a wheel midway between the front wheels, rad below π/2.
        angle_max: f64,
        /// Largest rate of that angle, rad/s.
        rate: f64,
        /// First order, s.
        lag: f64,
    },
    /// Two driven wheels on the rear axle, each with its own motor, and castors in front.
    Differential,
}

impl Wheeled {
    /// The centre of mass in the body frame, m.
    pub fn mass_centre(&self) -> [f64; 3] {
        [self.mass_forward * self.body.wheelbase, 0.0, self.mass_height]
    }

    /// Moments of inertia about x, y, z through the centre of mass, kg m²: a box as large as the body, scaled.
    pub fn inertia(&self) -> [f64; 3] {
        let Body { length, width, height, .. } = self.body;
        let box_of = |a: f64, b: f64| self.inertia_scale * self.mass / 12.0 * (a * a + b * b);
        let tall = height - self.clearance;
        [box_of(width, tall), box_of(length, tall), box_of(length, width)]
    }

    /// Where the wheels stand, in the body frame, m: front left, front right, rear left, rear right.
    pub fn wheel_places(&self) -> [[f64; 2]; 4] {
        let (l, t) = (self.body.wheelbase, self.body.track / 2.0);
        [[l, t], [l, -t], [0.0, t], [0.0, -t]]
    }

    /// Load of each wheel at rest on flat ground, N.
    pub fn rest_loads(&self) -> [f64; 4] {
        let half = 0.5 * self.mass * GRAVITY;
        let (front, rear) = (half * self.mass_forward, half * (1.0 - self.mass_forward));
        [front, front, rear, rear]
    }
}
