//! Robots and props among each other, moved by forces in rapier at a physics step of their own.
//!
//! A physics step: what is guided is placed, every vehicle drives, rapier steps, touches are found, the motion is noted.

mod bodies;
mod car;
mod ground;
mod interpolant;
mod watch;

use crate::touch::{BodyContact, Touches};
use crate::{Handling, Unicycle, Unicycles, Wheeled, World, prescribed::prescribed};
use bodies::Bodies;
use car::{Car, Surroundings};
use interpolant::MotionHistory;
use rapier3d_f64::prelude::RigidBodyHandle;
use rayon::prelude::*;
use std::sync::Arc;
use vocabulary::{
    Command, Contact, Mobility, Motion, Placement, Pose, Prop, Snapshot, Solid, StepInterpolant, Terrain,
    Trajectory, math,
};

/// A robot on stage.
#[derive(Debug, Clone)]
pub struct RobotSetup {
    /// Start, limits, body, and the motion of a lead robot.
    pub robot: Unicycle,
    /// The vehicle it is; a unicycle without mass, moved exactly, where there is none.
    pub wheels: Option<Arc<Wheeled>>,
}

/// A prop on stage.
#[derive(Debug, Clone)]
pub struct PropBody {
    /// Name, shape, place.
    pub prop: Prop,
    /// kg, of one that is loose.
    pub mass: f64,
    /// The motion of one that is guided, from its placement.
    pub path: Option<Arc<dyn Trajectory>>,
    /// Coefficient of friction.
    pub friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
}

/// All that is on stage at the start.
#[derive(Debug, Clone)]
pub struct WorldSetup {
    /// Robots.
    pub actors: Vec<RobotSetup>,
    /// Props.
    pub props: Vec<PropBody>,
    /// The lie of the land; flat where there is none.
    pub terrain: Option<Arc<Terrain>>,
    /// Longest physics step, s.
    pub step: f64,
}

/// A world of bodies with mass.
#[derive(Clone)]
pub struct Physical {
    bodies: Bodies,
    cars: Vec<Car>,
    /// Unicycles, and the ideals that lead vehicles chase; nobody looks at those of other robots.
    ideals: Unicycles,
    /// Robots that are unicycles.
    unicycles: Vec<(usize, RigidBodyHandle)>,
    guided: Vec<Guided>,
    surroundings: Surroundings,
    snapshot: Snapshot,
    touches: Touches,
    record: MotionHistory,
    step: f64,
    /// Size of the smallest thing that can be run into, m.
    smallest: f64,
}

/// How far what goes its own way may move in a physics step, as a share of its size and that of what it runs into: half
/// of both, and it would be nearer to the other side.
const STRIDE: f64 = 0.25;
/// Most physics steps in place of one.
const MOST_PARTS: f64 = 100.0;

/// A prop that goes its own way.
#[derive(Debug, Clone)]
struct Guided {
    body: RigidBodyHandle,
    path: Arc<dyn Trajectory>,
    /// At the start of the current advance.
    pose: Pose,
    height: f64,
    /// Smaller side, and farthest point from its middle, m.
    size: [f64; 2],
}

/// Vehicles from which on they are driven on all threads.
const PARALLEL_FROM: usize = 64;

impl Physical {
    /// Robots and props at their starts, at time 0.
    pub fn new(stage: WorldSetup) -> Self {
        let WorldSetup { actors, props, terrain, step } = stage;
        let mut bodies = Bodies::new(terrain.as_deref());
        let ideals = Unicycles::new(actors.iter().map(|actor| actor.robot.clone()).collect());
        let surroundings = Surroundings { terrain, props: !props.is_empty() };
        let mut snapshot = ideals.snapshot().clone();
        let (mut cars, mut unicycles, mut guided) = (Vec::new(), Vec::new(), Vec::new());
        for (index, actor) in actors.iter().enumerate() {
            let motion = snapshot.robots[index].motion;
            let surface = surroundings.surface(motion.pose.x, motion.pose.y);
            if let Some(wheels) = &actor.wheels {
                let body = bodies.add_vehicle(index, wheels, &motion, &surface, step);
                cars.push(Car::new(index, wheels.clone(), body, &actor.robot, motion.speed, step));
            } else {
                unicycles.push((index, bodies.add_unicycle(index, &actor.robot.body, motion.pose, &surface)));
            }
        }
        for (index, prop) in props.iter().enumerate() {
            let body = bodies.add_prop(index, prop);
            snapshot.props.push(prop.prop.placement);
            if let (Some(body), Mobility::Guided, Some(path)) = (body, prop.prop.mobility, &prop.path) {
                let Placement { position: [x, y, height], rotation: [_, _, z, w] } = prop.prop.placement;
                let pose = Pose::new(x, y, 2.0 * math::atan2(z, w));
                let size = [smaller_side(&prop.prop.solid), prop.prop.solid.reach()];
                guided.push(Guided { body, path: path.clone(), pose, height, size });
            }
        }
        let record = MotionHistory::new(&cars, &bodies);
        let movable = props.iter().filter(|prop| prop.prop.mobility == Mobility::Loose);
        let movable = movable.map(|prop| smaller_side(&prop.prop.solid));
        let robots = actors.iter().map(|actor| actor.robot.body.length.min(actor.robot.body.width));
        let smallest = movable.chain(robots).fold(f64::INFINITY, f64::min);
        let mut world = Self {
            bodies,
            cars,
            ideals,
            unicycles,
            guided,
            surroundings,
            snapshot,
            touches: Touches::default(),
            record,
            step,
            smallest,
        };
        world.write_snapshot();
        world
    }

    /// One physics step of `h` s that ends `elapsed` s after the advance began.
    fn step(&mut self, h: f64, elapsed: f64) {
        let time = self.snapshot.time + elapsed;
        self.place_guided(elapsed);
        self.drive(h);
        self.bodies.step(h);
        self.find_touches(time);
        self.record.note(&self.cars, &self.bodies, h);
    }

    /// Physics steps in the next `duration` s: more of them where something goes its own way so fast that it would pass
    /// through what is in its way.
    fn steps(&self, duration: f64) -> f64 {
        let time = self.snapshot.time;
        let sizes = |own: f64| STRIDE * (own + self.smallest);
        let unicycles = self.unicycles.iter().map(|(index, _)| {
            // Robots are among the smallest.
            self.snapshot.robots[*index].motion.speed.abs() / sizes(self.smallest)
        });
        let guided = self.guided.iter().map(|prop| {
            let [side, reach] = prop.size;
            let [begin, end] = [time, time + duration].map(|t| {
                let drive = prop.path.at(t);
                drive.speed.abs() + reach * drive.turn_rate.abs()
            });
            begin.max(end) / sizes(side)
        });
        let pace = unicycles.chain(guided).fold(0.0, f64::max);
        let steps = (duration / self.step - 1e-9).ceil().max(1.0);
        (steps * (pace * duration / steps).ceil().clamp(1.0, MOST_PARTS)).min(f64::from(u32::MAX))
    }

    /// What has no mass goes its way.
    fn place_guided(&mut self, elapsed: f64) {
        for (index, body) in &self.unicycles {
            let pose = self.ideals.during(*index, elapsed).pose;
            let surface = self.surroundings.surface(pose.x, pose.y);
            self.bodies.place(*body, bodies::on_surface(pose, &surface));
        }
        for prop in &self.guided {
            let pose = prescribed(prop.path.as_ref(), prop.pose, self.snapshot.time, elapsed).pose;
            self.bodies.place(prop.body, bodies::upright(pose, prop.height));
        }
    }

    /// Every vehicle drives, by itself, so that the order does not matter; what it does to props comes after.
    fn drive(&mut self, h: f64) {
        let (bodies, surroundings) = (&self.bodies, &self.surroundings);
        if self.cars.len() >= PARALLEL_FROM {
            self.cars.par_iter_mut().with_min_len(16).for_each(|car| car.drive(bodies, surroundings, h));
        } else {
            self.cars.iter_mut().for_each(|car| car.drive(bodies, surroundings, h));
        }
        for car in &self.cars {
            self.bodies.push(car.body, car.push.force, car.push.torque);
            car.reactions.iter().for_each(|(body, force, place)| self.bodies.push_at(*body, *force, *place));
        }
    }

    /// The motions of unicycles as they are now.
    fn copy_unicycles(&mut self) {
        for (index, _) in &self.unicycles {
            self.snapshot.robots[*index].motion = self.ideals.snapshot().robots[*index].motion;
        }
    }

    fn find_touches(&mut self, time: f64) {
        let mut found: Vec<BodyContact> = self.bodies.touches();
        found.sort_by_key(|touch| touch.things);
        for touch in &found {
            self.touches.touch(time, touch);
        }
        self.touches.part(time);
    }

    fn write_snapshot(&mut self) {
        for (index, _) in &self.unicycles {
            self.snapshot.robots[*index] = self.ideals.snapshot().robots[*index];
            let robot = &mut self.snapshot.robots[*index];
            let pose = robot.motion.pose;
            robot.attitude = bodies::attitude_on(pose.heading, &self.surroundings.surface(pose.x, pose.y));
        }
        for (slot, car) in self.cars.iter_mut().enumerate() {
            let (motion, attitude) = (self.record.last(slot), self.bodies.attitude(car.body));
            let below = self.surroundings.surface(motion.pose.x, motion.pose.y).height - attitude.height;
            let robot = &mut self.snapshot.robots[car.index];
            let seen = car.watch.look(self.snapshot.time, car.pull(motion.speed), &motion, &attitude, below);
            robot.condition = car.fate.unwrap_or(seen);
            (robot.motion, robot.attitude, robot.wheels) = (motion, attitude, car.wheels);
        }
        for (index, placement) in self.snapshot.props.iter_mut().enumerate() {
            if let Some(now) = self.bodies.placement(index) {
                *placement = now;
            }
        }
    }
}

/// The smaller side of what a solid covers of the ground, m.
fn smaller_side(solid: &Solid) -> f64 {
    let [length, width, _] = solid.extent();
    length.min(width)
}

impl World for Physical {
    fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    fn apply_parameters(&mut self, handling: &[Handling]) {
        self.ideals.apply_parameters(handling);
        self.copy_unicycles();
        for car in &mut self.cars {
            let Some(Handling { limits, wheels: Some(vehicle) }) = handling.get(car.index) else { continue };
            car.apply_parameters(*limits, vehicle.clone());
            self.bodies.sweep(car.body, vehicle, self.step);
        }
    }

    fn apply(&mut self, commands: &[Command]) {
        self.ideals.apply(commands);
        self.copy_unicycles();
        for car in &mut self.cars {
            let ideal = &self.ideals.snapshot().robots[car.index].motion;
            car.take(commands[car.index], ideal, &self.snapshot.robots[car.index].motion);
        }
    }

    fn advance(&mut self, duration: f64) {
        let steps = self.steps(duration);
        let h = duration / steps;
        self.touches.forget_ended();
        self.ideals.move_on(duration);
        self.record.begin(h);
        for k in 1..=steps as u32 {
            self.step(h, f64::from(k) * h);
        }
        for prop in &mut self.guided {
            prop.pose = prescribed(prop.path.as_ref(), prop.pose, self.snapshot.time, duration).pose;
        }
        self.snapshot.time += duration;
        self.write_snapshot();
    }

    fn release(&mut self, robot: usize) {
        self.ideals.release(robot);
        match self.cars.binary_search_by_key(&robot, |car| car.index) {
            Ok(slot) => self.cars[slot].release(),
            Err(_) => self.copy_unicycles(),
        }
    }

    fn fail(&mut self, robot: usize, removed: bool) {
        self.release(robot);
        self.ideals.fail(robot, removed);
        self.snapshot.robots[robot].condition = self.ideals.snapshot().robots[robot].condition;
        if let Ok(slot) = self.cars.binary_search_by_key(&robot, |car| car.index) {
            let car = &mut self.cars[slot];
            car.fate = Some(self.snapshot.robots[robot].condition);
            if removed {
                self.bodies.take_away(car.body);
            }
        } else if removed {
            self.unicycles
                .iter()
                .filter(|(index, _)| *index == robot)
                .for_each(|(_, body)| self.bodies.take_away(*body));
            self.copy_unicycles();
        }
    }

    fn contacts(&self) -> &[Contact] {
        self.touches.contacts()
    }

    fn save(&self) -> Box<dyn World> {
        Box::new(self.clone())
    }
}

impl StepInterpolant for Physical {
    fn duration(&self) -> f64 {
        self.ideals.duration()
    }

    fn during(&self, robot: usize, elapsed: f64) -> Motion {
        match self.cars.binary_search_by_key(&robot, |car| car.index) {
            Ok(slot) => self.record.during(slot, elapsed),
            Err(_) => self.ideals.during(robot, elapsed),
        }
    }

    fn saturation_time(&self, robot: usize) -> Option<f64> {
        match self.cars.binary_search_by_key(&robot, |car| car.index) {
            Ok(_) => None,
            Err(_) => self.ideals.saturation_time(robot),
        }
    }
}
