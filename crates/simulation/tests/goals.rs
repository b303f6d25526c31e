//! Lead robots that have goals, in the loop.

use scene::{Override, Scene};
use simulation::{BuildError, Simulation, build};
use vocabulary::{Contact, StepRecord, math};

fn scene(name: &str, sets: &[&str]) -> Scene {
    let text = scene::shipped(name).expect("a shipped scene").text;
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().expect("an override")).collect();
    Scene::parse(text, "test.toml", &sets).unwrap_or_else(|fault| panic!("{fault}")).scene
}

fn run(name: &str, sets: &[&str]) -> Vec<StepRecord> {
    let mut run = Simulation::new(build(&scene(name, sets)).expect("a run"));
    let mut records = vec![];
    while let Some(record) = run.next_record() {
        records.push(record.clone());
    }
    records
}

fn why_not(name: &str, sets: &[&str]) -> String {
    match build(&scene(name, sets)) {
        Err(error @ BuildError::Plan { .. }) => error.to_string(),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("a way"),
    }
}

/// How far the lead is from [x, y] in m.
fn away(record: &StepRecord, [x, y]: [f64; 2]) -> f64 {
    let pose = record.snapshot.robots[0].motion.pose;
    math::hypot(pose.x - x, pose.y - y)
}

#[test]
fn three_get_through_a_maze_and_stop_at_the_goal() {
    for kind in ["unicycle", "car"] {
        let records = run("maze-three", &[&format!("vehicle.kind={kind}")]);
        assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)), "{kind}");
        let last = records.last().expect("a record");
        assert!(away(last, [20.0, 0.0]) < 0.3, "{kind}: {} m away", away(last, [20.0, 0.0]));
        assert!(last.snapshot.robots.iter().all(|robot| robot.motion.speed.abs() < 0.02), "{kind}");
        assert!(last.edges.iter().all(|edge| edge.error[0].abs() < 0.15), "{kind}: {:?}", last.edges);
    }
}

#[test]
fn a_tour_stops_at_every_goal() {
    let records = run("warehouse-seven", &[]);
    assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)));
    for goal in [[26.0, 0.0], [26.0, 18.0], [0.0, 18.0]] {
        let rests = |record: &&StepRecord| {
            away(record, goal) < 0.3 && record.snapshot.robots[0].motion.speed.abs() < 1e-3
        };
        let rest = records.iter().filter(rests).count();
        assert!(rest >= 150, "at {goal:?} it rests for {rest} samples");
    }
}

#[test]
fn what_has_no_way_is_told_by_the_names_of_the_scene() {
    let told = why_not("maze-three", &["groups.robot.path.pose=[5, 3, 0]"]);
    assert!(told.contains("`robot-1`") && told.contains("`wall-1`"), "{told}");
    let told = why_not("maze-three", &["props.wall-1.from=[5, -11.5]"]);
    assert!(told.contains("no way") && told.contains("gap"), "{told}");
}
