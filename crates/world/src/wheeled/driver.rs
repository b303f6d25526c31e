//! The driver: from the command [dv/dt, ω] of a law to the forces at the wheels and the steering angle.
//!
//! Feed-forward by the inverse of the vehicle (mass, rolling and air resistance; the bicycle's tan δ = L ω/v), feedback
//! on the speed that the commanded accelerations add up to and on the turn rate, and demands that lead the actuators by
//! their lags.

use super::actuator::{demand, share};
use super::{Drivetrain, Wheeled};
use vocabulary::{Command, GRAVITY, math};

/// What a driver remembers, and where the actuators stand.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Driver {
    /// Speed that the commands so far add up to, m/s.
    pub target: f64,
    /// It is never below this, m/s: a follower never stands still, since steered wheels that do not roll cannot turn.
    pub slowest: f64,
    /// Force of the motors (or, below zero, of the brakes) together, N.
    pub force: f64,
    /// Angle of a wheel midway between the front wheels, rad; of a differential drive, the difference of the forces of
    /// its sides, right minus left, N.
    pub turn: f64,
    /// Whether the brakes hold the vehicle where it stands, at once; the motors of a differential drive hold like brakes.
    pub parked: bool,
    /// Sine of the slope, nose up, that the driver makes up for: only where it comes to a stand, or stands.
    pub slope: f64,
}

/// What takes effect at the wheels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Of the motors, forward, N, by wheel.
    pub drive: [f64; 4],
    /// Largest force of the brakes, N, by wheel.
    pub brake: [f64; 4],
    /// tan of the steering angle midway between the front wheels.
    pub tan_steering: f64,
}

/// Shares of their way that the actuators of a vehicle go in one physics step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    step: f64,
    drive: f64,
    brake: f64,
    turn: f64,
}

/// Speed below which steering does not grow steeper, m/s.
pub const CRAWL: f64 = 0.1;
/// How far the target may run ahead of the speed, as a share of the largest speed: nothing winds up.
pub const WINDOW: f64 = 0.1;
/// A differential drive closes a turn rate error with this time constant, s; at least its lag.
const TURN_TIME: f64 = 0.08;

impl Pace {
    /// For physics steps of `step` s.
    pub fn new(vehicle: &Wheeled, step: f64) -> Self {
        let turn = match vehicle.drivetrain {
            Drivetrain::Steered { lag, .. } => lag,
            Drivetrain::Differential => vehicle.drive_lag,
        };
        Self {
            step,
            drive: share(step, vehicle.drive_lag),
            brake: share(step, vehicle.brake_lag),
            turn: share(step, turn),
        }
    }

    /// s.
    pub fn step(&self) -> f64 {
        self.step
    }
}

impl Driver {
    /// Drives one physics step by `command` at `speed` in m/s and `turn_rate` in rad/s.
    pub fn drive(
        &mut self,
        vehicle: &Wheeled,
        pace: &Pace,
        command: Command,
        speed: f64,
        turn_rate: f64,
    ) -> Effort {
        if self.parked {
            return self.hold(vehicle, pace);
        }
        self.accelerate(vehicle, pace, command.acceleration, [speed, turn_rate]);
        match vehicle.drivetrain {
            Drivetrain::Steered { angle_max, rate, .. } => {
                self.steer(vehicle, pace, command.turn_rate, [speed, turn_rate], angle_max, rate);
                self.effort(vehicle, self.force.max(0.0), (-self.force).max(0.0))
            }
            Drivetrain::Differential => {
                self.spin(vehicle, pace, command.turn_rate, [speed, turn_rate]);
                self.effort(vehicle, self.force, 0.0)
            }
        }
    }

    /// Brakes hold, motors let go, and wheels stay as they are steered.
    fn hold(&mut self, vehicle: &Wheeled, pace: &Pace) -> Effort {
        self.target = 0.0;
        self.force -= pace.drive * self.force;
        if vehicle.drivetrain == Drivetrain::Differential {
            self.turn -= pace.turn * self.turn;
        }
        self.effort(vehicle, self.force.max(0.0), vehicle.brake_force)
    }

    /// The forces of drive and brakes, all wheels together, N, shared among the wheels.
    fn effort(&self, vehicle: &Wheeled, drive: f64, brake: f64) -> Effort {
        match vehicle.drivetrain {
            Drivetrain::Steered { .. } => Effort {
                drive: [drive / 4.0; 4],
                brake: [brake / 4.0; 4],
                tan_steering: math::tan(self.turn),
            },
            Drivetrain::Differential => {
                let (left, right, brake) =
                    (0.5 * (drive - self.turn), 0.5 * (drive + self.turn), brake / 2.0);
                Effort { drive: [0.0, 0.0, left, right], brake: [0.0, 0.0, brake, brake], tan_steering: 0.0 }
            }
        }
    }

    fn accelerate(
        &mut self,
        vehicle: &Wheeled,
        pace: &Pace,
        acceleration: f64,
        [speed, turn_rate]: [f64; 2],
    ) {
        let window = WINDOW * vehicle.limits.speed_max;
        let held = (self.target + pace.step * acceleration).clamp(speed - window, speed + window);
        self.target = held.clamp(self.slowest, vehicle.limits.speed_max);
        let weight = vehicle.mass * GRAVITY;
        let resistance = resistance(vehicle, speed, turn_rate) + weight * self.slope;
        let missing = self.target - speed;
        let wanted = vehicle.mass * (acceleration + vehicle.speed_gain * missing) + resistance;
        let range = |force: f64| force.clamp(-vehicle.brake_force, vehicle.drive_force);
        let share = if self.force >= 0.0 { pace.drive } else { pace.brake };
        let asked = range(demand(self.force, range(wanted), share, vehicle.compensation));
        self.force += share * (asked - self.force);
    }

    fn steer(&mut self, vehicle: &Wheeled, pace: &Pace, wanted: f64, now: [f64; 2], most: f64, rate: f64) {
        let [speed, turn_rate] = now;
        let turn = wanted + vehicle.turn_gain * (wanted - turn_rate);
        let angle = math::atan(vehicle.body.wheelbase * turn / speed.abs().max(CRAWL)).clamp(-most, most);
        let asked = demand(self.turn, angle, pace.turn, vehicle.compensation).clamp(-most, most);
        let reach = rate * pace.step;
        self.turn += (pace.turn * (asked - self.turn)).clamp(-reach, reach);
    }

    /// Two sides that pull against each other turn the body: I dω/dt + m x v ω = (right − left) × track / 2, with the
    /// centre of mass x ahead of the axle.
    fn spin(&mut self, vehicle: &Wheeled, pace: &Pace, wanted: f64, [speed, turn_rate]: [f64; 2]) {
        let arm = 0.5 * vehicle.body.track;
        let [ahead, ..] = vehicle.mass_centre();
        let inertia = vehicle.inertia()[2] + vehicle.mass * ahead * ahead;
        let time = TURN_TIME.max(vehicle.drive_lag) / (1.0 + vehicle.turn_gain);
        let swing = vehicle.mass * ahead * speed * turn_rate;
        let wanted = (inertia * (wanted - turn_rate) / time + swing) / arm;
        let range = |force: f64| force.clamp(-vehicle.drive_force, vehicle.drive_force);
        let asked = range(demand(self.turn, range(wanted), pace.turn, vehicle.compensation));
        self.turn += pace.turn * (asked - self.turn);
    }
}

/// What holds the vehicle back at a speed and turn rate, N: tyres and air. A differential drive turns about its rear
/// axle, and its centre of mass ahead of it is flung forward; on steered wheels the side force of the front axle holds it.
fn resistance(vehicle: &Wheeled, speed: f64, turn_rate: f64) -> f64 {
    let weight = vehicle.mass * GRAVITY;
    let [ahead, ..] = vehicle.mass_centre();
    let (load, flung) = match vehicle.drivetrain {
        Drivetrain::Steered { .. } => (weight, 0.0),
        Drivetrain::Differential => {
            (weight * (1.0 - vehicle.mass_forward), vehicle.mass * ahead * turn_rate * turn_rate)
        }
    };
    vehicle.tyre.rolling * load * (speed / CRAWL).clamp(-1.0, 1.0) + vehicle.drag * speed * speed.abs()
        - flung
}
