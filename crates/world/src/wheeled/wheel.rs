//! A wheel on the ground: how far its spring is compressed, how hard it presses, how its tyre holds.

use super::Wheeled;
use super::tyre::{Brush, Rolling, Tyre};
use rapier3d_f64::math::Vector;
use vocabulary::GRAVITY;

/// Stiffness of the bump stop over that of the spring.
const BUMP_STOP: f64 = 4.0;
/// Largest load over the load at rest: a hard landing does not tear the vehicle apart.
const LOAD_MAX: f64 = 20.0;
/// Smallest cosine between a wheel's axis of travel and the ground's normal at which it still stands.
const TIPPED: f64 = 0.25;

/// The ground under a wheel.
#[derive(Debug, Clone, Copy)]
pub struct Footing {
    /// Where the wheel touches, m, world.
    pub place: Vector,
    /// Out of the ground.
    pub normal: Vector,
    /// Its velocity there, m/s: ground that moves.
    pub velocity: Vector,
    /// Multiplies the tyre's friction.
    pub grip: f64,
}

/// What does not change about one wheel.
#[derive(Debug, Clone, Copy)]
pub struct Mounting {
    /// Where it stands in the body frame at rest, m.
    pub place: Vector,
    /// Load at rest, N.
    pub load: f64,
    /// Compression from rest at which it leaves the ground, m; negative.
    pub droop: f64,
    spring: f64,
    damping: f64,
    travel: f64,
    tyre: Tyre,
}

/// How the body moves.
#[derive(Debug, Clone, Copy)]
pub struct Carriage {
    /// Unit vectors of the body frame in the world.
    pub axes: [Vector; 3],
    /// Centre of mass, m.
    pub centre: Vector,
    /// Of the centre of mass, m/s.
    pub velocity: Vector,
    /// rad/s.
    pub spin: Vector,
}

/// What a wheel does to the body.
#[derive(Debug, Clone, Copy, Default)]
pub struct Push {
    /// N, world.
    pub force: Vector,
    /// About the centre of mass, N m.
    pub torque: Vector,
    /// Of the contact patch along the rolling direction, m/s.
    pub rolling: f64,
}

/// What drives a wheel at an instant.
#[derive(Debug, Clone, Copy)]
pub struct Pull {
    /// [cos, sin] of its steering angle.
    pub heading: [f64; 2],
    /// Of the motor, N.
    pub drive: f64,
    /// Largest force of the brake, N.
    pub brake: f64,
}

impl Mounting {
    /// The four wheels of a vehicle: front left, front right, rear left, rear right.
    pub fn of(vehicle: &Wheeled) -> [Self; 4] {
        let (places, loads) = (vehicle.wheel_places(), vehicle.rest_loads());
        let castors = matches!(vehicle.drivetrain, super::Drivetrain::Differential);
        [0, 1, 2, 3].map(|k| {
            // A castor turns wherever it is pushed: it carries, and holds nothing.
            let free = Tyre { cornering: 0.0, rolling: 0.0, ..vehicle.tyre };
            Self {
                place: Vector::new(places[k][0], places[k][1], 0.0),
                load: loads[k],
                droop: -loads[k] / vehicle.spring,
                spring: vehicle.spring,
                damping: vehicle.damping,
                travel: vehicle.travel,
                tyre: if castors && k < 2 { free } else { vehicle.tyre },
            }
        })
    }

    /// The push of a wheel that is compressed by `compression` m on its footing; nothing where it does not stand.
    pub fn push(
        &self,
        carriage: &Carriage,
        footing: &Footing,
        compression: f64,
        pull: &Pull,
        brush: &mut Brush,
        step: f64,
    ) -> Push {
        let [ahead, left, up] = carriage.axes;
        let (normal, arm) = (footing.normal, footing.place - carriage.centre);
        let velocity = carriage.velocity + carriage.spin.cross(arm) - footing.velocity;
        let sink = velocity.dot(normal);
        let load = self.load_at(compression, -sink / up.dot(normal));
        let heading = ahead * pull.heading[0] + left * pull.heading[1];
        let flat = heading - normal * heading.dot(normal);
        let length = flat.length();
        if load <= 0.0 || length < TIPPED {
            *brush = Brush::default();
            return Push { rolling: velocity.dot(heading), ..Push::default() };
        }
        let forward = flat / length;
        let side = normal.cross(forward);
        let along = velocity.dot(forward);
        let rolling = Rolling {
            velocity: [along, velocity.dot(side)],
            load,
            grip: footing.grip,
            drive: pull.drive,
            brake: pull.brake,
            mass: self.load / GRAVITY,
        };
        let (grip, bent) = self.tyre.force(&rolling, *brush, step);
        *brush = bent;
        let force = normal * load + forward * grip[0] + side * grip[1];
        Push { force, torque: arm.cross(force), rolling: along }
    }

    /// Load at a compression (m) and its rate (m/s), N.
    fn load_at(&self, compression: f64, rate: f64) -> f64 {
        let stop = BUMP_STOP * self.spring * (compression - self.travel).max(0.0);
        let load = self.load + self.spring * compression + stop + self.damping * rate;
        load.clamp(0.0, LOAD_MAX * self.load)
    }

    /// How far the spring is compressed from rest where `up` is its axis and `surface` and `normal` are those of the
    /// ground's plane, m; `None` where it does not reach the ground.
    pub fn compression(
        &self,
        camera_mount: Vector,
        up: Vector,
        surface: Vector,
        normal: Vector,
    ) -> Option<f64> {
        let slant = up.dot(normal);
        if slant < TIPPED {
            return None;
        }
        let compression = (surface - camera_mount).dot(normal) / slant;
        (compression > self.droop).then_some(compression)
    }
}
