//! Vehicles and worlds for the checks.

pub(crate) use crate::truck::truck;
use std::sync::Arc;
use vocabulary::{Body, Command, Limits, Motion, Pose, Snapshot};
use world::{Drivetrain, Physical, RobotSetup, Unicycle, Wheeled, World, WorldSetup};

/// A robot with two driven wheels.
pub(crate) fn differential() -> Wheeled {
    let body =
        Body { length: 0.42, width: 0.40, height: 0.25, wheelbase: 0.2, track: 0.34, wheel_radius: 0.0825 };
    let limits = Limits { curvature_max: f64::INFINITY, ..truck().limits };
    Wheeled {
        body,
        limits,
        drivetrain: Drivetrain::Differential,
        mass: 8.0,
        mass_height: 0.09,
        spring: 3000.0,
        damping: 150.0,
        ..truck()
    }
}

/// A vehicle at a pose with a speed.
pub(crate) fn actor(vehicle: &Wheeled, pose: Pose, speed: f64) -> RobotSetup {
    let robot = Unicycle { pose, speed, limits: vehicle.limits, body: vehicle.body, lead: None };
    RobotSetup { robot, wheels: Some(Arc::new(vehicle.clone())) }
}

/// A unicycle at a pose with a speed.
pub(crate) fn unicycle(pose: Pose, speed: f64) -> RobotSetup {
    let truck = truck();
    let robot = Unicycle { pose, speed, limits: truck.limits, body: truck.body, lead: None };
    RobotSetup { robot, wheels: None }
}

/// A flat world with these robots.
pub(crate) fn flat(actors: Vec<RobotSetup>) -> WorldSetup {
    WorldSetup { actors, props: vec![], terrain: None, step: 0.005 }
}

/// A run of one world, sample by sample.
pub(crate) struct Run {
    pub(crate) world: Physical,
}

impl Run {
    pub(crate) fn new(stage: WorldSetup) -> Self {
        Self { world: Physical::new(stage) }
    }

    /// Applies the same command to all for `time` s, every 10 ms, and looks on.
    pub(crate) fn hold(&mut self, command: Command, time: f64, mut look: impl FnMut(&Snapshot)) {
        let commands = vec![command; self.world.snapshot().robots.len()];
        for _ in 0..(time * 100.0).round() as usize {
            self.world.apply(&commands);
            self.world.advance(0.01);
            look(self.world.snapshot());
        }
    }

    pub(crate) fn motion(&self) -> Motion {
        self.world.snapshot().robots[0].motion
    }
}
