//! Formations that file in where there is no room, in the loop.

use scene::{Override, Scene};
use simulation::{Simulation, build, gates, narrowest};
use vocabulary::{Contact, StepRecord, math};

fn scene(text: &str, sets: &[&str]) -> Scene {
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().expect("an override")).collect();
    Scene::parse(text, "test.toml", &sets).unwrap_or_else(|fault| panic!("{fault}")).scene
}

fn simulation(text: &str, sets: &[&str]) -> Simulation {
    Simulation::new(build(&scene(text, sets)).expect("a run"))
}

/// All records of a run.
fn run(text: &str, sets: &[&str]) -> Vec<StepRecord> {
    let mut run = simulation(text, sets);
    let mut records = vec![];
    while let Some(record) = run.next_record() {
        records.push(record.clone());
    }
    records
}

fn shipped(name: &str) -> &'static str {
    scene::shipped(name).expect("a shipped scene").text
}

fn touches(records: &[StepRecord]) -> bool {
    records.iter().any(|record| record.contacts.iter().any(Contact::of_robot))
}

fn largest(records: &[StepRecord]) -> f64 {
    records.iter().flat_map(|record| &record.edges).map(|edge| edge.narrowing).fold(0.0, f64::max)
}

#[test]
fn a_v_goes_through_a_gate_and_is_a_v_again() {
    for name in ["gate-2", "cars-gate-1.5"] {
        let records = run(shipped(name), &[]);
        assert!(!touches(&records), "{name}");
        assert!(largest(&records) > 0.99, "{name}");
        let last = records.last().expect("a record");
        assert!(last.edges.iter().all(|edge| edge.narrowing < 1e-3), "{name}");
        let through = last.snapshot.robots.iter().all(|robot| robot.motion.pose.x > 12.0);
        assert!(through, "{name}");
        // Errors are those of the place that is driven to, which moves.
        let middle = &records[records.len() / 3];
        assert!(middle.edges.iter().any(|edge| edge.set_point[0] < 1.5), "{name}");
        let off = records[800..].iter().flat_map(|record| &record.edges).map(|edge| edge.error[0].abs());
        assert!(off.fold(0.0, f64::max) < 0.25, "{name}");
    }
    let stays = run(shipped("gate-2"), &["narrowing.narrows=false"]);
    let last = stays.last().expect("a record");
    assert!(
        last.edges.iter().any(|edge| edge.error[0].abs() > 1.0),
        "the filter alone leaves nobody in its place"
    );
}

/// A gate on a bend: strips follow the leader's curve.
#[test]
fn a_v_goes_through_a_gate_on_a_bend() {
    let (radius, turn) = (10.0, 1.2);
    let wall = |side: f64| {
        let at = |out: f64| {
            let (sin, cos) = math::sin_cos(turn);
            [(radius - side * out) * sin, radius - (radius - side * out) * cos]
        };
        format!(
            "{{ name = \"wall{side}\", shape = \"wall\", from = {:?}, to = {:?}, height = 1.0 }}",
            at(0.75),
            at(6.0)
        )
    };
    let text = shipped("gate-2");
    let from = text.find("[[props]]").expect("props");
    let to = text.find("[expect]").expect("an end");
    let text = text[..from]
        .replace("kind = \"constant\", speed = 0.8", "kind = \"circle\", speed = 0.8, turn_rate = 0.08")
        + &text[to..];
    let text = text.replace("schema = 1", &format!("schema = 1\nprops = [{}, {}]", wall(1.0), wall(-1.0)));
    let records = run(&text, &[]);
    assert!(!touches(&records) && largest(&records) > 0.99);
    let last = records.last().expect("a record");
    assert!(last.edges.iter().all(|edge| edge.narrowing < 1e-3 && edge.error[0].abs() < 0.05));
    let told = gates(&simulation(&text, &[]), 40.0).join("\n");
    assert!(told.contains("a gate of 1.50 m at (9.3, 6.4)"), "{told}");
}

/// A leader that stops in the gate: everyone waits where it is, and goes on and back to the V later.
#[test]
fn who_waits_in_a_gate_stays_filed_in() {
    let stops =
        "path={ kind = \"table\", rows = [[0, 0.8, 0], [13, 0.8, 0], [14, 0, 0], [18, 0, 0], [19, 0.8, 0]] }";
    let sets = [&format!("groups.robot.{stops}"), "law.standing=true", "time.duration=48.0"];
    let records = run(shipped("gate-1.5"), &sets);
    assert!(!touches(&records));
    let at = |time: f64| &records[(time * 100.0) as usize];
    let [begin, end] = [at(17.3), at(17.9)];
    for (a, b) in begin.edges.iter().zip(&end.edges) {
        assert!(
            (a.narrowing - b.narrowing).abs() < 1e-6 && a.narrowing > 0.5,
            "{} {}",
            a.narrowing,
            b.narrowing
        );
    }
    for robot in &end.snapshot.robots {
        assert!(robot.motion.speed < 0.01 && robot.motion.turn_rate.abs() < 0.1);
    }
    let last = records.last().expect("a record");
    assert!(last.edges.iter().all(|edge| edge.narrowing < 1e-3 && edge.error[0].abs() < 0.05));
}

const DEAD: &str = r#"
schema = 1
title = "One that stands in the way"
[time]
duration = 30.0
[vehicle]
acceleration_max = 3.0
turn_rate_max = 3.0
[law]
heading = "path"
[proximity]
range = 8.0
[safety]
filter = true
[narrowing]
narrows = true
[[robots]]
name = "dead"
pose = [9.0, 1.4, 1.0]
path = { kind = "constant", speed = 0.0 }
[[groups]]
name = "robot"
shape = "v"
count = 3
path = { kind = "constant", speed = 0.8 }
speed = 0.8
"#;

#[test]
fn a_robot_that_stands_in_the_way_is_an_obstacle_and_one_that_drives_is_none() {
    let records = run(DEAD, &[]);
    assert!(!touches(&records));
    // robot-3 is on the left, where the dead one stands.
    let of = |index: usize| records.iter().map(|record| record.edges[index].narrowing).fold(0.0, f64::max);
    assert!(of(0) == 0.0 && of(1) > 0.3, "{} {}", of(0), of(1));
    assert!(records.last().expect("a record").edges[1].narrowing < 1e-3);
    let drives = run(DEAD, &["robots.dead.pose=[6.0, 1.4, 0.0]", "robots.dead.path.speed=0.8"]);
    assert_eq!(largest(&drives), 0.0);
}

#[test]
fn what_is_beyond_the_range_is_not_known() {
    let begin = |range: &str| {
        let records = run(shipped("gate-4"), &[range]);
        records
            .iter()
            .find(|record| record.edges.iter().any(|edge| edge.narrowing > 0.0))
            .map(|r| r.snapshot.time)
    };
    let [near, far] = ["proximity.range=3.0", "proximity.range=8.0"].map(begin);
    assert!(near.expect("it narrows") > far.expect("it narrows") + 2.0, "{near:?} {far:?}");
}

/// Every shape that groups have, whoever is followed: filed in, and on the way there, bodies are apart.
#[test]
fn places_of_every_shape_are_apart_all_the_way_into_the_column() {
    let text = shipped("gate-2");
    for shape in ["v", "column", "abreast", "diamond", "circle"] {
        for (count, follows) in [
            (4, "neighbour"),
            (7, "neighbour"),
            (8, "neighbour"),
            (8, "leader"),
            (16, "neighbour"),
            (16, "leader"),
        ] {
            if shape == "diamond" && count % 4 != 0 {
                continue;
            }
            let sets =
                [("shape", shape.to_owned()), ("count", count.to_string()), ("follows", follows.to_owned())]
                    .map(|(key, value)| format!("groups.robot.{key}={value}"));
            let mut sets: Vec<&str> = sets.iter().map(|set| &**set).collect();
            sets.extend(["groups.robot.scatter=0.0", "safety.filter=false"]);
            let run = simulation(text, &sets);
            for level in 0..=formation::Narrowing::FILE {
                let places = places(&run, level);
                for (k, a) in places.iter().enumerate() {
                    for b in &places[..k] {
                        let gap = math::hypot(a[0] - b[0], a[1] - b[1]);
                        assert!(gap > 0.5, "{shape} {count} {follows} at {level}: {gap}");
                        let filed = level >= formation::Narrowing::COLUMN;
                        assert!(!filed || gap > 0.999, "{shape} {count} {follows} at {level}: {gap}");
                    }
                }
            }
        }
    }
}

/// Where all robots are, [forward, left] of their lead, at place number `level`.
fn places(run: &Simulation, level: u8) -> Vec<[f64; 2]> {
    let formation = run.formation();
    let mut places = vec![[0.0; 2]; formation.graph().robots()];
    for &index in formation.graph().evaluation_order() {
        let (edge, law) = (formation.edges()[index], &formation.laws()[index]);
        let wide = formation::column::cartesian(law.set_point.at(0.0).value);
        let place = law.narrowing.expect("it narrows").place(wide, level);
        places[edge.follower] = [0, 1].map(|k| places[edge.leader][k] + place[k]);
    }
    places
}

#[test]
fn gates_are_told_with_what_formations_take() {
    let told = |name: &str, sets: &[&str]| gates(&simulation(shipped(name), sets), 40.0).join("\n");
    for (name, sets, words) in [
        ("gate-2", &[][..], "a gate of 2.00 m at (9.0, 0.0) on the path of `robot-1`"),
        (
            "gate-2",
            &[],
            "its 6 followers take 9.43 m, margins included, and do not fit; as a column they take 1.54 m and do",
        ),
        ("gate-1.2", &[], "in single file they take 0.94 m and do"),
        (
            "gate-1.2",
            &["groups.robot.pose=[0.0,0.16,0.0]"],
            "in single file they take 0.94 m, 0.78 m at the least: it is close",
        ),
        ("gate-1.2", &["vehicle.kind=car"], "a filter's `point_ahead` of 0.35 m takes 0.35 m on each side"),
        ("gate-2", &["narrowing.narrows=false"], "3.63 m too much on one side; with `narrowing"),
        (
            "gate-2",
            &["groups.robot.pose=[0.0, 0.8, 0.0]"],
            "nor in single file: 0.78 m, 0.19 m too much on one side",
        ),
        ("gate-2", &["groups.robot.count=2"], "it and its follower take"),
        ("gate-4", &["groups.robot.count=3"], "take 3.77 m, margins included, and fit"),
        ("gate-2", &["proximity.range=4.0"], "senses 4 m, and at 0.8 m/s it has to see"),
    ] {
        let found = told(name, sets);
        assert!(found.contains(words), "{name} {sets:?}: {found}");
    }
    assert_eq!(told("gate-2", &["groups.robot.pose=[20.0, 0.0, 0.0]"]), "");
    // Robots that follow later count as what they are at the start, even where they will follow one that follows them now.
    let later = "events=[{at=1,robot='robot-2',path={kind='constant',speed=0.5}},{at=2,robot='robot-1',leader='robot-2'}]";
    assert!(told("gate-2", &[later]).contains("its 6 followers take 9.43 m"), "{}", told("gate-2", &[later]));
    assert_eq!(told("pillar", &[]), "");
}

#[test]
fn the_narrowest_of_two_gates_counts() {
    let run = simulation(
        r#"
schema = 1
title = "t"
props = [
    { name = "a", shape = "wall", from = [4, 1.5], to = [4, 9] },
    { name = "b", shape = "wall", from = [4, -1], to = [4, -9] },
    { name = "c", shape = "cylinder", radius = 0.5, height = 1.0, pose = [8, 1.5, 0] },
    { name = "d", shape = "cylinder", radius = 0.5, height = 1.0, pose = [8, -1.25, 0] },
    { name = "low", shape = "block", size = [1.0, 1.0, 0.02], pose = [2, 0, 0] },
]
[[robots]]
name = "ann"
pose = [0.0, 0.0, 0.0]
path = { kind = "constant", speed = 1.0 }
"#,
        &[],
    );
    let (_, path) = &run.formation().leads()[0];
    let found = |reach: f64| {
        let start = run.record().snapshot.robots[0].motion.pose;
        narrowest(&**path, start, 12.0, &run.fleet().props, [reach; 2], 0.11)
    };
    let gate = found(5.0).expect("a gate");
    assert!((gate.width() - 1.75).abs() < 2e-3 && (gate.at[0] - 8.0).abs() < 0.06, "{gate:?}");
    assert!((gate.room([0.5, 0.5]) - 0.25).abs() < 2e-3);
    assert_eq!(found(0.9), None);
}
