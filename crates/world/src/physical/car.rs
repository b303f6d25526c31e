//! One wheeled vehicle in the physical world: its driver, its four wheels, and what stands under them.

use super::bodies::Bodies;
use super::watch::StuckDetector;
use crate::guide::{chase, stands, waits, wanted_speed};
use crate::wheeled::driver::{CRAWL, Driver, Effort, Pace, WINDOW};
use crate::wheeled::tyre::Brush;
use crate::wheeled::wheel::{Carriage, Footing, Mounting, Pull, Push};
use crate::{Unicycle, Wheeled};
use rapier3d_f64::prelude::{RigidBodyHandle, Vector};
use std::sync::Arc;
use vocabulary::{Command, Condition, Limits, Motion, Surface, Terrain, Wheel, math};

/// A follower that is slower, m/s, and asked for less acceleration, m/s², is held by its brakes on a slope.
const STANDS: f64 = 0.02;
const STARTS: f64 = 0.2;

/// What vehicles drive on and among.
#[derive(Debug, Clone)]
pub(super) struct Surroundings {
    pub(super) terrain: Option<Arc<Terrain>>,
    /// Whether there are any props that a wheel could climb.
    pub(super) props: bool,
}

impl Surroundings {
    pub(super) fn surface(&self, x: f64, y: f64) -> Surface {
        self.terrain.as_ref().map_or(Surface::FLAT, |terrain| terrain.at(x, y))
    }
}

/// Parameters and state of a vehicle.
#[derive(Debug, Clone)]
pub(super) struct Car {
    /// Of the robot.
    pub(super) index: usize,
    pub(super) body: RigidBodyHandle,
    vehicle: Arc<Wheeled>,
    limits: Limits,
    leads: bool,
    /// What has become of it, if it has failed.
    pub(super) fate: Option<Condition>,
    /// Whether it comes to a stand, or stands.
    waits: bool,
    /// Speed at which it is told to go, m/s.
    told: f64,
    /// Whether what it stood on in the last physics step may slope: uneven ground, or a prop.
    uneven: bool,
    mountings: [Mounting; 4],
    pace: Pace,
    command: Command,
    pub(super) driver: Driver,
    brushes: [Brush; 4],
    pub(super) wheels: [Wheel; 4],
    pub(super) watch: StuckDetector,
    /// Of all wheels and the air in this physics step.
    pub(super) push: Push,
    /// What the wheels do to the loose props they stand on: body, force, place.
    pub(super) reactions: Vec<(RigidBodyHandle, Vector, Vector)>,
}

impl Car {
    pub(super) fn new(
        index: usize,
        vehicle: Arc<Wheeled>,
        body: RigidBodyHandle,
        robot: &Unicycle,
        speed: f64,
        step: f64,
    ) -> Self {
        let slowest = if robot.lead.is_some() { 0.0 } else { robot.limits.speed_min };
        Self {
            index,
            body,
            limits: robot.limits,
            leads: robot.lead.is_some(),
            fate: None,
            waits: false,
            told: slowest,
            uneven: false,
            mountings: Mounting::of(&vehicle),
            pace: Pace::new(&vehicle, step),
            command: Command::default(),
            driver: Driver { target: speed, slowest, ..Driver::default() },
            brushes: [Brush::default(); 4],
            wheels: [Wheel::default(); 4],
            watch: StuckDetector::default(),
            push: Push::default(),
            reactions: Vec::new(),
            vehicle,
        }
    }

    /// Goes on with other limits and another driver; body, springs and tyres stay.
    pub(super) fn apply_parameters(&mut self, limits: Limits, vehicle: Arc<Wheeled>) {
        self.driver.slowest = if self.leads { 0.0 } else { limits.speed_min };
        if !self.leads {
            self.told = limits.speed_min;
        }
        self.pace = Pace::new(&vehicle, self.pace.step());
        (self.limits, self.vehicle) = (limits, vehicle);
    }

    /// Goes by its commands from now on.
    pub(super) fn release(&mut self) {
        (self.leads, self.waits, self.driver.parked) = (false, false, false);
        (self.driver.slowest, self.told) = (self.limits.speed_min, self.limits.speed_min);
    }

    /// Takes the command for the time to come; a lead robot chases its ideal.
    pub(super) fn take(&mut self, command: Command, ideal: &Motion, now: &Motion) {
        self.command = if self.leads {
            let wheelbase = self.vehicle.body.wheelbase;
            self.driver.parked = stands(ideal, now, wheelbase, self.driver.parked);
            (self.waits, self.told) = (waits(ideal), wanted_speed(ideal, now));
            chase(ideal, now, wheelbase, &self.limits)
        } else {
            let Command { acceleration, turn_rate } = self.limits.saturate(command, now.speed);
            let acceleration = self.limits.admissible(acceleration, now.speed);
            self.driver.parked = self.holds() && now.speed.abs() < STANDS && acceleration.abs() < STARTS;
            Command { acceleration, turn_rate }
        };
    }

    /// How far the driver's target is ahead of `speed`, as a share of how far it can be, and the speed at which it is
    /// told to go, m/s.
    pub(super) fn pull(&self, speed: f64) -> [f64; 2] {
        [(self.driver.target - speed) / (WINDOW * self.limits.speed_max), self.told]
    }

    /// Drives for one physics step of `h` s: from the command to the push of all wheels.
    pub(super) fn drive(&mut self, bodies: &Bodies, surroundings: &Surroundings, h: f64) {
        if self.pace.step() != h {
            self.pace = Pace::new(&self.vehicle, h);
        }
        let (carriage, origin) = bodies.carriage(self.body);
        let [ahead, ..] = carriage.axes;
        let level = Vector::new(ahead.x, ahead.y, 0.0).normalize_or(Vector::X);
        let arm = origin - carriage.centre;
        let speed = (carriage.velocity + carriage.spin.cross(arm)).dot(level);
        self.driver.slope = if self.waits {
            ahead.z
        } else if self.holds() {
            (2.0 - speed / CRAWL).clamp(0.0, 1.0) * ahead.z
        } else {
            0.0
        };
        let effort = self.driver.drive(&self.vehicle, &self.pace, self.command, speed, carriage.spin.z);
        self.reactions.clear();
        let air = carriage.velocity * (-self.vehicle.drag * carriage.velocity.length());
        self.push = Push { force: air, ..Push::default() };
        let radius = self.vehicle.body.wheel_radius;
        let climbs = surroundings.props && bodies.props_near(self.body, radius);
        let ride = Ride { carriage, origin, bodies, surroundings, climbs, step: h };
        let headings = headings(&self.vehicle, effort.tan_steering);
        self.uneven = surroundings.terrain.is_some();
        for (k, heading) in headings.into_iter().enumerate() {
            let pull = Pull { heading, drive: effort.drive[k], brake: effort.brake[k] };
            self.turn_wheel(k, &ride, &pull);
        }
        self.note_steering(&effort, &headings);
    }

    /// Whether it is a follower that may stand, where it would roll away.
    fn holds(&self) -> bool {
        self.uneven && !self.leads && self.limits.speed_min == 0.0
    }

    fn turn_wheel(&mut self, k: usize, ride: &Ride<'_>, pull: &Pull) {
        let mounting = self.mountings[k];
        let [ahead, left, up] = ride.carriage.axes;
        let hub = ride.origin + ahead * mounting.place.x + left * mounting.place.y;
        let radius = self.vehicle.body.wheel_radius;
        let ground = stand(&mounting, hub, up, ride.surroundings);
        let below = |(compression, ..): &(f64, Footing, Option<RigidBodyHandle>)| {
            *compression > ground.map_or(mounting.droop, |(compression, _)| compression)
        };
        let prop = ride.climbs.then(|| ride.bodies.prop_under(hub, up, 2.0 * radius, -mounting.droop));
        let (footing, bearer) = match prop.flatten().filter(below) {
            Some((compression, footing, body)) => {
                self.uneven = true;
                (Some((compression, footing)), body)
            }
            None => (ground, None),
        };
        let wheel = &mut self.wheels[k];
        let Some((compression, footing)) = footing else {
            // In the air it goes on rolling as it did.
            wheel.compression = mounting.droop;
            self.brushes[k] = Brush::default();
            return;
        };
        let push =
            mounting.push(&ride.carriage, &footing, compression, pull, &mut self.brushes[k], ride.step);
        wheel.compression = compression.min(radius);
        wheel.rotation += push.rolling * ride.step / radius;
        self.push.force += push.force;
        self.push.torque += push.torque;
        if let Some(body) = bearer {
            self.reactions.push((body, -push.force, footing.place));
        }
    }

    fn note_steering(&mut self, effort: &Effort, headings: &[[f64; 2]; 4]) {
        // Straight ahead needs no arc tangent.
        let steered = effort.tan_steering != 0.0;
        for (wheel, [cos, sin]) in self.wheels.iter_mut().zip(headings).take(2) {
            wheel.steering = if steered { math::atan2(*sin, *cos) } else { 0.0 };
        }
    }
}

/// What the wheels of a vehicle share in a physics step.
struct Ride<'a> {
    carriage: Carriage,
    /// Of the body frame.
    origin: Vector,
    bodies: &'a Bodies,
    surroundings: &'a Surroundings,
    /// Whether a prop is near enough to be climbed.
    climbs: bool,
    step: f64,
}

/// Where a wheel stands on the ground, and its compression; `None` in the air.
fn stand(
    mounting: &Mounting,
    hub: Vector,
    up: Vector,
    surroundings: &Surroundings,
) -> Option<(f64, Footing)> {
    let footing = |at: Vector| {
        let surface = surroundings.surface(at.x, at.y);
        let place = Vector::new(at.x, at.y, surface.height);
        Footing { place, normal: Vector::from(surface.normal), velocity: Vector::ZERO, grip: surface.grip }
    };
    let first = footing(hub);
    let mut compression = mounting.compression(hub, up, first.place, first.normal)?;
    let mut found = first;
    if surroundings.terrain.is_some() {
        // The wheel's axis leans: what it meets lies a little beside what is straight below.
        found = footing(hub + up * compression);
        compression = mounting.compression(hub, up, found.place, found.normal)?;
    }
    Some((compression, Footing { place: hub + up * compression, ..found }))
}

/// [cos, sin] of the angle of each wheel: the front ones both point across the same turning centre (Ackermann).
fn headings(vehicle: &Wheeled, tan: f64) -> [[f64; 2]; 4] {
    let straight = [1.0, 0.0];
    if tan == 0.0 {
        return [straight; 4];
    }
    let curvature = tan / vehicle.body.wheelbase;
    let aside = curvature * vehicle.body.track / 2.0;
    let towards = |cos: f64| {
        let norm = math::hypot(cos, tan);
        [cos / norm, tan / norm]
    };
    [towards(1.0 - aside), towards(1.0 + aside), straight, straight]
}
