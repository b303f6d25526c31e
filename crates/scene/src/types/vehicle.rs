//! What a robot is and what it can do.

use crate::text::words::word;
use crate::text::{angle_within, form::Number, number, settings};
use vocabulary::{Body, GRAVITY, Limits, math, words};

/// A measure of a body.
const MEASURE: Number = number("m").above(0.0).up_to(100.0);
/// Time constant of an actuator; 0 acts at once.
const LAG: Number = number("s").from(0.0).up_to(10.0);
/// What wheels push or hold the vehicle with.
const FORCE: Number = number("N").above(0.0).up_to(1e7);
/// rad.
const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// Share of what its tyres hold that a vehicle is driven up to sideways.
const GRIP_USED: f64 = 0.8;

settings! {
    /// What a robot is and what it can do. `kind` picks a ready-made vehicle, a complete set of values; what else is
    /// written replaces its values one by one. A robot of another kind than the scene's `vehicle` starts from its own
    /// kind's values and takes nothing from the scene's `vehicle`. The word alone stands for `{ kind = … }`.
    #[derive(Copy)]
    pub struct Vehicle from VehiclePart {
        /// How it moves, and which values it has where nothing else is said.
        pub kind: VehicleKind = VehicleKind::Unicycle, word::<VehicleKind>();
        /// Slowest forward speed of a follower, m/s; above 0, since the law is singular at rest.
        pub speed_min: f64 = Limits::PAPER.speed_min, number("m/s").above(0.0).up_to(100.0), Live;
        /// Fastest forward speed, m/s; above `speed_min`.
        pub speed_max: f64 = Limits::PAPER.speed_max, number("m/s").above(0.0).up_to(100.0), Live;
        /// Largest |turn rate|, rad/s.
        pub turn_rate_max: f64 = Limits::PAPER.turn_rate_max, number("rad/s").above(0.0).up_to(1000.0), Live;
        /// Largest |dv/dt|, m/s²; `inf` for unbounded.
        pub acceleration_max: f64 = Limits::PAPER.acceleration_max, number("m/s²").above(0.0).or_infinite(), Live;
        /// Bumper to bumper, m.
        pub length: f64 = Body::default().length, MEASURE;
        /// Side to side, m.
        pub width: f64 = Body::default().width, MEASURE;
        /// Ground to roof, m.
        pub height: f64 = Body::default().height, MEASURE;
        /// Between the axles, m.
        pub wheelbase: f64 = Body::default().wheelbase, MEASURE;
        /// Between the wheels of an axle, m.
        pub track: f64 = Body::default().track, MEASURE;
        /// Of every wheel, m.
        pub wheel_radius: f64 = Body::default().wheel_radius, MEASURE;
        /// All-up mass, kg.
        pub mass: f64 = 5.01, number("kg").above(0.0), Wheels;
        /// Height of the centre of mass over the ground at rest, m.
        pub mass_height: f64 = 0.11, MEASURE, Wheels;
        /// Where the centre of mass is between the rear axle, 0, and the front axle, 1.
        pub mass_forward: f64 = 0.5, number("").from(0.0).up_to(1.0), Wheels;
        /// Factor on the moments of inertia of a box of the body's measures and mass.
        pub inertia_scale: f64 = 1.0, number("").from(0.2).up_to(5.0), Wheels;
        /// Ground to the floor of the body at rest, m; what is lower passes under it.
        pub clearance: f64 = 0.075, number("m").from(0.0).up_to(100.0), Wheels;
        /// Stiffness of each wheel's spring, N/m.
        pub spring: f64 = 700.0, number("N/m").above(0.0).up_to(1e8), Wheels;
        /// Of each wheel's damper, N s/m.
        pub damping: f64 = 40.0, number("N s/m").from(0.0).up_to(1e7), Wheels;
        /// Largest compression of a spring from rest, m.
        pub travel: f64 = 0.04, MEASURE, Wheels;
        /// Coefficient of friction of the tyres.
        pub friction: f64 = 0.9, number("").above(0.0).up_to(5.0), Wheels;
        /// Cornering stiffness of the tyres: lateral force per load and per slip angle, 1/rad.
        pub cornering: f64 = 12.0, number("1/rad").above(0.0).up_to(100.0), Wheels;
        /// Relaxation length of the tyres, m: the way over which a lateral force builds up.
        pub relaxation: f64 = 0.06, MEASURE, Wheels;
        /// Coefficient of rolling resistance.
        pub rolling: f64 = 0.03, number("").from(0.0).up_to(1.0), Wheels;
        /// Air drag per speed squared, N s²/m².
        pub drag: f64 = 0.02, number("N s²/m²").from(0.0).up_to(1000.0), Wheels;
        /// Largest |steering angle| of the front wheels, from 1 deg to 85 deg.
        pub steering_max: f64 = 28.0 * DEGREE, angle_within(DEGREE, 85.0 * DEGREE), Steered, Live;
        /// Largest |rate| of the steering angle, rad/s.
        pub steering_rate: f64 = 5.0, number("rad/s").above(0.0).up_to(1000.0), Steered, Live;
        /// Time constant of the steering, s.
        pub steering_lag: f64 = 0.08, LAG, Steered, Live;
        /// Largest force of the drive, all wheels together, N.
        pub drive_force: f64 = 30.0, FORCE, Wheels, Live;
        /// Time constant of the drive, s.
        pub drive_lag: f64 = 0.1, LAG, Wheels, Live;
        /// Largest force of the brakes, all wheels together, N.
        pub brake_force: f64 = 35.0, FORCE, Wheels, Live;
        /// Time constant of the brakes, s.
        pub brake_lag: f64 = 0.05, LAG, Wheels, Live;
        /// What is done about the actuators' lags.
        pub compensation: Compensation = Compensation::Lead, word::<Compensation>(), Wheels, Live;
        /// Feedback on the speed, 1/s: acceleration asked for per error of speed.
        pub speed_gain: f64 = 4.0, number("1/s").from(0.0).up_to(1000.0), Wheels, Live;
        /// Feedback on the turn rate: share of its error that is added to what is asked for.
        pub turn_gain: f64 = 0.0, number("").from(0.0).up_to(100.0), Wheels, Live;
    }
}

words! {
    /// How a robot moves.
    pub enum VehicleKind {
        /// dx/dt = v cos θ, dy/dt = v sin θ, dθ/dt = ω (eq 1): no mass, no slip, whatever the ground.
        Unicycle = "unicycle",
        /// Four wheels, the front ones steered: a 1/10 truck of the class of the Tamiya TXT-1.
        Car = "car",
        /// Four wheels, the front ones steered: a passenger car.
        FullSizeCar = "full-size-car",
        /// Two driven wheels behind and castors in front: it turns by driving its sides at different speeds.
        Differential = "differential",
    }
}

words! {
    /// What is done about the lags of steering, drive and brakes.
    pub enum Compensation {
        /// Nothing: actuators get what the law asks for.
        None = "none",
        /// Actuators get what makes their lagging answer come out as what the law asks for, within their limits.
        Lead = "lead",
    }
}

impl VehicleKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Unicycle, Self::Car, Self::FullSizeCar, Self::Differential];

    /// Whether it stands on wheels, with mass, springs and tyres.
    pub fn has_wheels(self) -> bool {
        self != Self::Unicycle
    }

    /// Whether its front wheels are steered.
    pub fn steers(self) -> bool {
        matches!(self, Self::Car | Self::FullSizeCar)
    }
}

impl Vehicle {
    /// The ready-made vehicle of a kind.
    pub fn ready_made(kind: VehicleKind) -> Self {
        match kind {
            VehicleKind::Unicycle => Self::default(),
            VehicleKind::Car => Self {
                kind,
                // Steered wheels that do not roll cannot turn.
                speed_min: 0.2,
                speed_max: 4.0,
                turn_rate_max: 8.0,
                acceleration_max: 4.0,
                length: 0.49,
                width: 0.39,
                height: 0.32,
                wheelbase: 0.30,
                track: 0.285,
                wheel_radius: 0.0825,
                ..Self::default()
            },
            VehicleKind::FullSizeCar => Self {
                kind,
                speed_min: 0.5,
                speed_max: 25.0,
                turn_rate_max: 1.0,
                acceleration_max: 5.0,
                length: 4.5,
                width: 1.8,
                height: 1.45,
                wheelbase: 2.7,
                track: 1.55,
                wheel_radius: 0.32,
                mass: 1500.0,
                mass_height: 0.55,
                clearance: 0.16,
                spring: 30_000.0,
                damping: 3000.0,
                travel: 0.12,
                friction: 0.95,
                cornering: 14.0,
                relaxation: 0.35,
                rolling: 0.012,
                drag: 0.4,
                steering_max: 35.0 * DEGREE,
                steering_rate: 0.7,
                steering_lag: 0.12,
                drive_force: 6000.0,
                drive_lag: 0.2,
                brake_force: 12_000.0,
                brake_lag: 0.1,
                ..Self::default()
            },
            VehicleKind::Differential => Self {
                kind,
                speed_max: 2.0,
                turn_rate_max: 6.0,
                acceleration_max: 3.0,
                length: 0.42,
                width: 0.40,
                height: 0.25,
                wheelbase: 0.2,
                track: 0.34,
                wheel_radius: 0.0825,
                mass: 8.0,
                mass_height: 0.09,
                mass_forward: 0.2,
                clearance: 0.05,
                spring: 3000.0,
                damping: 150.0,
                travel: 0.02,
                friction: 0.8,
                relaxation: 0.05,
                rolling: 0.02,
                drag: 0.0,
                drive_force: 25.0,
                drive_lag: 0.06,
                brake_force: 25.0,
                turn_gain: 0.5,
                ..Self::default()
            },
        }
    }

    /// Bounds on speed, turn rate and acceleration.
    pub fn limits(&self) -> Limits {
        let bound_where = |bound: f64, applies: bool| if applies { bound } else { f64::INFINITY };
        let Self { speed_min, speed_max, turn_rate_max, acceleration_max, kind, .. } = *self;
        let curvature_max = bound_where(math::tan(self.steering_max) / self.wheelbase, kind.steers());
        let lateral_acceleration_max = bound_where(GRIP_USED * self.friction * GRAVITY, kind.has_wheels());
        Limits {
            speed_min,
            speed_max,
            turn_rate_max,
            acceleration_max,
            curvature_max,
            lateral_acceleration_max,
        }
    }

    /// Outer measures, for drawing and clearance.
    pub fn body(&self) -> Body {
        let Self { length, width, height, wheelbase, track, wheel_radius, .. } = *self;
        Body { length, width, height, wheelbase, track, wheel_radius }
    }
}
