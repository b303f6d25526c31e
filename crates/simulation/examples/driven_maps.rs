//! Plans over random maps, driven with law and safety filter: how many are found, how many arrive, how many touch.
//! `cargo run --release --locked -p simulation --example driven_maps [MAPS] [unicycle|car] [OBSTACLES] [scene]`
//! MAPS is a number of maps or a range of them, such as 14..15; with `scene` their scenes are printed instead.

#[path = "../tests/trial_scene/mod.rs"]
mod trial_scene;

use simulation::{BuildError, Simulation, build};
use trial_scene::trial_scene;
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

fn drive(row: &mut Row, seed: u64, count: usize, vehicle: &str) -> Result<(), String> {
    row.maps += 1;
    let read = scene::Scene::parse(&trial_scene(seed, count, vehicle), "map.toml", &[])
        .map_err(|fault| fault.to_string())?;
    let setup = match build(&read.scene) {
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
    let given: Vec<String> = std::env::args().skip(1).collect();
    let maps = given.first().map_or("100", |text| text);
    let (first, last) = maps.split_once("..").unwrap_or(("0", maps));
    let number = |text: &str| text.parse::<u64>().map_err(|_| format!("`{text}` is no number of maps"));
    let (first, last) = (number(first)?, number(last)?);
    let vehicle = given.get(1).map_or("unicycle", |text| text);
    let counts: Vec<u64> =
        given.get(2).map_or(Ok(vec![20, 50, 100]), |text| number(text).map(|count| vec![count]))?;
    if given.get(3).is_some_and(|word| word == "scene") {
        for (seed, count) in (first..last).flat_map(|seed| counts.iter().map(move |count| (seed, *count))) {
            println!("{}", trial_scene(seed, count as usize, vehicle));
        }
        return Ok(());
    }
    for count in counts {
        let count = count as usize;
        let mut row = Row::default();
        for seed in first..last {
            drive(&mut row, seed, count, vehicle)?;
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
