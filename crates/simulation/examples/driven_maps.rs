//! Plans over random maps, driven with law and safety filter: how many are found, how many arrive, how many touch.
//! `cargo run --release --locked -p simulation --example driven_maps [MAPS] [unicycle|car]`

use planning::{Convex, trial};
use simulation::{BuildError, Simulation, build};
use std::fmt::Write;
use vocabulary::{Contact, math};

/// What became of the maps of one kind.
#[derive(Default)]
struct Row {
    maps: u64,
    plans: u64,
    arrived: u64,
    touched: Vec<u64>,
    late: Vec<u64>,
}

/// The scene of a map: seven in a V from one corner to the other.
fn scene(seed: u64, count: usize, vehicle: &str) -> String {
    let map = trial::map(seed, count);
    let mut text = format!(
        r#"schema = 1
title = "Map {seed}"
seed = {seed}
[time]
duration = 160.0
[vehicle]
kind = "{vehicle}"
acceleration_max = 3.0
turn_rate_max = 3.0
[law]
heading = "path"
standing = true
[proximity]
range = 8.0
[safety]
filter = true
[narrowing]
narrows = true
[[groups]]
name = "robot"
shape = "v"
count = 7
pose = [8.0, 8.0, "45 deg"]
distance = 2.0
scatter = 0.1
path = {{ kind = "goal", pose = [33, 33, "45 deg"] }}
"#
    );
    for (number, obstacle) in map.obstacles().iter().enumerate() {
        // Writing to a text cannot fail.
        let _ = writeln!(text, "[[props]]\nname = \"thing-{number}\"\n{}", solid(obstacle));
    }
    text
}

fn solid(obstacle: &Convex) -> String {
    let [x, y] = obstacle.centre();
    let corners: Vec<[f64; 2]> = obstacle.corners().collect();
    let [a, b, c, ..] = corners.as_slice() else {
        return format!(
            "shape = \"cylinder\"\npose = [{x}, {y}, 0]\nradius = {}\nheight = 1.0",
            obstacle.radius()
        );
    };
    let side = |p: &[f64; 2], q: &[f64; 2]| math::hypot(q[0] - p[0], q[1] - p[1]);
    let heading = math::atan2(b[1] - a[1], b[0] - a[0]);
    format!("shape = \"block\"\npose = [{x}, {y}, {heading}]\nsize = [{}, {}, 1.0]", side(a, b), side(b, c))
}

fn drive(row: &mut Row, seed: u64, count: usize, vehicle: &str) -> Result<(), String> {
    row.maps += 1;
    let scene = scene::Scene::parse(&scene(seed, count, vehicle), "map.toml", &[])
        .map_err(|fault| fault.to_string())?;
    let setup = match build(&scene.scene) {
        Ok(setup) => setup,
        Err(BuildError::Plan { why, .. }) => {
            println!("    map {seed}: {why}");
            return Ok(());
        }
        Err(other) => return Err(other.to_string()),
    };
    row.plans += 1;
    let mut run = Simulation::new(setup);
    let mut touches = false;
    let mut last = vec![];
    let mut rests = false;
    while let Some(record) = run.next_record() {
        touches |= record.contacts.iter().any(Contact::of_robot);
        last = record.snapshot.robots.iter().map(|robot| robot.motion).collect();
        rests = record.edges.iter().all(|edge| edge.error[0].abs() < 0.3);
    }
    let away = last.first().map_or(f64::INFINITY, |lead| math::hypot(lead.pose.x - 33.0, lead.pose.y - 33.0));
    if touches {
        row.touched.push(seed);
    }
    if away < 0.5 && rests && last.iter().all(|motion| motion.speed.abs() < 0.05) {
        row.arrived += 1;
    } else {
        row.late.push(seed);
        println!(
            "    map {seed}: the lead is {away:.2} m away; errors {:.2?}, speeds {:.2?}",
            run.record().edges.iter().map(|edge| (edge.error[0], edge.narrowing)).collect::<Vec<_>>(),
            last.iter().map(|motion| motion.speed).collect::<Vec<_>>()
        );
    }
    Ok(())
}

fn main() -> Result<(), String> {
    let maps = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(100);
    let vehicle = std::env::args().nth(2).unwrap_or_else(|| "unicycle".into());
    for count in [20, 50, 100] {
        let mut row = Row::default();
        for seed in 0..maps {
            drive(&mut row, seed, count, &vehicle)?;
        }
        println!(
            "{vehicle}, {count} obstacles: {} of {} planned, {} arrived, {} without contact; contact on {:?}, not there on {:?}",
            row.plans,
            row.maps,
            row.arrived,
            row.plans - row.touched.len() as u64,
            row.touched,
            row.late
        );
    }
    Ok(())
}
