//! Ten thousand trucks with random commands for ten seconds, close enough to collide: nothing may break, nobody sinks.
//!
//! `cargo run --release -p world --example ten_thousand`

use std::sync::Arc;
use std::time::Instant;
use vocabulary::{Body, Command, Limits, Pose};
use world::wheeled::tyre::Tyre;
use world::{Actor, Drivetrain, Physical, Stage, Unicycle, Wheeled, World};

const COUNT: usize = 10_000;
const SECONDS: usize = 10;
const PERIOD: f64 = 0.01;

/// Numbers from −1 to 1 that look like chance (`SplitMix64`).
fn chance(k: usize, salt: u64) -> f64 {
    let mut z = (k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(salt);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

fn truck() -> Wheeled {
    let body =
        Body { length: 0.49, width: 0.39, height: 0.32, wheelbase: 0.30, track: 0.285, wheel_radius: 0.0825 };
    let limits = Limits {
        speed_min: 0.01,
        speed_max: 4.0,
        turn_rate_max: 8.0,
        acceleration_max: 4.0,
        curvature_max: 1.77,
        lateral_acceleration_max: 7.0,
    };
    Wheeled {
        body,
        limits,
        mass: 5.01,
        mass_height: 0.11,
        mass_forward: 0.5,
        inertia_scale: 1.0,
        clearance: 0.075,
        spring: 700.0,
        damping: 40.0,
        travel: 0.04,
        tyre: Tyre { friction: 0.9, cornering: 12.0, relaxation: 0.06, rolling: 0.03 },
        drag: 0.02,
        drivetrain: Drivetrain::Steered { angle_max: 0.49, rate: 5.0, lag: 0.08 },
        drive_force: 30.0,
        drive_lag: 0.1,
        brake_force: 35.0,
        brake_lag: 0.05,
        compensation: true,
        speed_gain: 4.0,
        turn_gain: 0.0,
    }
}

fn main() {
    let vehicle = Arc::new(truck());
    let actor = |k: usize| {
        let pose = Pose::new((k % 100) as f64 * 1.2, (k / 100) as f64 * 1.2, 3.0 * chance(k, 1));
        let speed = 2.0 + 2.0 * chance(k, 2);
        let robot = Unicycle { pose, speed, limits: vehicle.limits, body: vehicle.body, lead: None };
        Actor { robot, wheels: Some(vehicle.clone()) }
    };
    let actors = (0..COUNT).map(actor).collect();
    let mut world = Physical::new(Stage { actors, props: vec![], terrain: None, step: 0.005 });
    let began = Instant::now();
    let (mut contacts, mut lowest) = (0, 0.0_f64);
    for step in 0..SECONDS * 100 {
        let salt = (step / 25) as u64 + 10;
        let command = |k: usize| Command {
            acceleration: 10.0 * chance(k, salt),
            turn_rate: 10.0 * chance(k, salt << 20),
        };
        world.apply(&(0..COUNT).map(command).collect::<Vec<_>>());
        world.advance(PERIOD);
        for robot in &world.snapshot().robots {
            let (motion, attitude) = (&robot.motion, &robot.attitude);
            let numbers = [motion.pose.x, motion.pose.y, motion.speed, motion.turn_rate, attitude.height];
            assert!(numbers.iter().all(|x| x.is_finite()), "{robot:?}");
            // An overturned truck's ground point is above the ground; a pushed one's springs give way.
            lowest = lowest.min(attitude.height);
        }
        contacts = contacts.max(world.contacts().iter().map(|c| c.number + 1).max().unwrap_or(0));
        if step % 100 == 99 {
            println!("{} s, {contacts} contacts", (step + 1) / 100);
        }
    }
    assert!(lowest > -0.075, "a truck sank {lowest} m, deeper than its floor is over the ground");
    let wall = began.elapsed().as_secs_f64();
    let unable = world.snapshot().robots.iter().filter(|r| r.condition.name() != "able").count();
    let steps = (COUNT * SECONDS * 200) as f64;
    println!("{COUNT} trucks, {SECONDS} s in {wall:.1} s, {:.0} vehicle-steps a second", steps / wall);
    println!("all numbers finite, lowest ground point {lowest:.4} m, {contacts} contacts, {unable} overturned or stuck");
}
