//! Ten thousand trucks with random commands for ten seconds, close enough to collide: nothing may break, nobody sinks.
//!
//! `cargo run --release -p world --example ten_thousand`

use std::sync::Arc;
use std::time::Instant;
use vocabulary::{Command, Pose, Word};
use world::{Physical, RobotSetup, Unicycle, World, WorldSetup};

#[path = "../tests/vehicles/truck.rs"]
mod truck;
use truck::truck;

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

fn main() {
    let vehicle = Arc::new(truck());
    let actor = |k: usize| {
        let pose = Pose::new((k % 100) as f64 * 1.2, (k / 100) as f64 * 1.2, 3.0 * chance(k, 1));
        let speed = 2.0 + 2.0 * chance(k, 2);
        let robot = Unicycle { pose, speed, limits: vehicle.limits, body: vehicle.body, lead: None };
        RobotSetup { robot, wheels: Some(vehicle.clone()) }
    };
    let actors = (0..COUNT).map(actor).collect();
    let mut world = Physical::new(WorldSetup { actors, props: vec![], terrain: None, step: 0.005 });
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
    let unable = world.snapshot().robots.iter().filter(|r| r.condition.word() != "able").count();
    let steps = (COUNT * SECONDS * 200) as f64;
    println!("{COUNT} trucks, {SECONDS} s in {wall:.1} s, {:.0} vehicle-steps a second", steps / wall);
    println!(
        "all numbers finite, lowest ground point {lowest:.4} m, {contacts} contacts, {unable} overturned or stuck"
    );
}
