//! Lead vehicles that stand, and that come to a stand, on slopes.

use crate::common::{actor, differential, flat, truck};
use std::sync::Arc;
use vocabulary::math;
use vocabulary::{Command, Condition, Motion, MotionInput, Pose, RobotState, Terrain, Trajectory};
use world::{Physical, RobotSetup, Wheeled, World, WorldSetup};

/// At this speed in m/s until a time in s, then evenly down to rest within a second.
#[derive(Debug)]
struct Stop(f64, f64);

impl Stop {
    /// m.
    fn length(&self) -> f64 {
        self.0 * (self.1 + 0.5)
    }
}

impl Trajectory for Stop {
    fn at(&self, time: f64) -> MotionInput {
        let Self(speed, until) = *self;
        let left = (1.0 - (time - until)).clamp(0.0, 1.0);
        let slows = left > 0.0 && left < 1.0;
        MotionInput {
            speed: speed * left,
            acceleration: if slows { -speed } else { 0.0 },
            ..MotionInput::default()
        }
    }
}

/// A slope that rises along x.
fn slope(rise: f64) -> Arc<Terrain> {
    let high = 200.0 * rise;
    Arc::new(Terrain {
        origin: [-100.0, -100.0],
        cell: 200.0,
        columns: 2,
        rows: 2,
        heights: vec![0.0, high, 0.0, high],
        grip: vec![],
    })
}

/// A run of `time` s of a vehicle that leads along `path`.
fn lead(
    vehicle: &Wheeled,
    heading: f64,
    path: Stop,
    rise: f64,
    time: f64,
    look: impl Fn(&RobotState),
) -> Motion {
    let RobotSetup { mut robot, wheels } = actor(vehicle, Pose::new(0.0, 0.0, heading), 0.0);
    let path = Arc::new(path);
    robot.lead = Some(path.clone());
    let stage = WorldSetup { terrain: Some(slope(rise)), ..flat(vec![RobotSetup { robot, wheels }]) };
    let mut world = Physical::new(stage);
    for k in 0..(time * 100.0) as u32 {
        let MotionInput { acceleration, turn_rate, .. } = path.at(f64::from(k) * 0.01);
        world.apply(&[Command { acceleration, turn_rate }]);
        world.advance(0.01);
        look(&world.snapshot().robots[0]);
    }
    world.snapshot().robots[0].motion
}

#[test]
fn who_is_parked_stays_where_it_is_from_the_first_step_on() {
    for (name, vehicle) in [("truck", truck()), ("differential", differential())] {
        for rise in [0.05, 0.1, 0.2] {
            for heading in [0.0, std::f64::consts::FRAC_PI_2, std::f64::consts::PI] {
                let motion = lead(&vehicle, heading, Stop(0.0, 0.0), rise, 5.0, |robot| {
                    let pose = robot.motion.pose;
                    let off = math::hypot(pose.x, pose.y);
                    // Springs settle by as much.
                    assert!(off < 0.005, "{name} at {heading:.1} rad on {rise}: {off} m");
                    assert_eq!(robot.condition, Condition::Able);
                });
                assert!(motion.speed.abs() < 1e-4, "{name} creeps at {} m/s", motion.speed);
            }
        }
    }
}

#[test]
fn who_stops_uphill_stands_at_its_place_and_is_able() {
    for (name, vehicle) in [("truck", truck()), ("differential", differential())] {
        for rise in [0.0, 0.05, 0.1, 0.2] {
            let path = Stop(1.0, 3.0);
            let length = path.length();
            let motion = lead(&vehicle, 0.0, path, rise, 15.0, |robot| {
                assert_eq!(robot.condition, Condition::Able, "{name} on {rise}");
            });
            assert!((motion.pose.x - length).abs() < 0.005, "{name} on {rise}: {} m", motion.pose.x);
            assert!(motion.speed.abs() < 1e-4, "{name} on {rise}: {} m/s", motion.speed);
        }
    }
}
