//! Lead robots that have goals, in the loop.

mod trial_scene;

use scene::{Override, Scene};
use simulation::{BuildError, ParameterSet, Simulation, build, build_change};
use trial_scene::trial_scene;
use vocabulary::{Contact, EntityId, EventKind, EventRecord, StepRecord, TourGoal, math};

fn scene(name: &str, sets: &[&str]) -> Scene {
    let text = scene::shipped(name).expect("a shipped scene").text;
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().expect("an override")).collect();
    Scene::parse(text, "test.toml", &sets).unwrap_or_else(|fault| panic!("{fault}")).scene
}

fn run(name: &str, sets: &[&str]) -> Vec<StepRecord> {
    records_of(&scene(name, sets))
}

fn records_of(scene: &Scene) -> Vec<StepRecord> {
    let mut run = Simulation::new(build(scene).expect("a run"));
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

/// On these maps plans that keep what filters keep, and nothing more, bring a robot to where its filter lets it come only
/// slowly. Then it is late, who follows it is far off its way, and another thing is between that one and its place for good.
#[test]
fn nobody_is_held_up_by_a_filter() {
    for map in [14, 66] {
        let scene = Scene::parse(&trial_scene(map, 20, "unicycle"), "map.toml", &[]).expect("a scene").scene;
        let records = records_of(&scene);
        let off = |record: &StepRecord| {
            record.edges.iter().fold(0.0_f64, |most, edge| most.max(edge.error[0].abs()))
        };
        // Who starts 0.1 m off is in its place by then.
        let worst = records.iter().filter(|record| record.snapshot.time > 5.0).map(off).fold(0.0, f64::max);
        assert!(worst < 0.3, "map {map}: {worst} m off");
    }
}

/// The goal of the formation that yields is on the way of the other, which comes by after it would have arrived.
#[test]
fn who_yields_arrives_when_the_other_has_passed() {
    let records = run("two-formations", &["groups.north.path.pose=[5,0,0]"]);
    assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)));
    let why = why_not("two-formations", &["groups.north.path.pose=[3,0,0]", "groups.north.pose=[3,0,0]"]);
    assert!(why.contains("meets") && why.contains("cannot wait"), "{why}");
}

#[test]
fn a_tour_stops_at_every_goal() {
    let records = run("warehouse-seven", &[]);
    assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)));
    let arrived: Vec<_> = events(&records, EventKind::Arrive).iter().map(|(_, event)| event.goal).collect();
    assert_eq!(arrived, [0, 1, 2].map(|goal| Some(TourGoal { goal, round: None })));
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
    let told = why_not("dead-end", &["groups.robot.count=7"]);
    assert!(told.contains("no way for 7 robots") && told.contains("there is one for 6 of them"), "{told}");
    assert!(told.contains("between `wall-"), "{told}");
    let told = why_not("maze-three", &["props.wall-1.from=[0.5, -2]", "props.wall-1.to=[0.5, 12]"]);
    assert!(told.contains("`robot-1` starts too near to `wall-1`"), "{told}");
}

/// The window checks every drag of a goal so: the run plans once more, from where it is.
#[test]
fn a_change_wants_the_same_and_looks_for_the_first_way_only() {
    let moved = scene("maze-three", &["groups.robot.path.pose=[19, 1, 0]"]);
    let (whole, change) = (build(&moved).expect("a run"), build_change(&moved).expect("a run"));
    assert_eq!(ParameterSet::of(&change).wishes, ParameterSet::of(&whole).wishes);
    let cost = |setup: &simulation::Setup| {
        let (_, motion) = setup.goals.motions().next().expect("a lead with a goal");
        let plan = &motion.parts()[0].plan;
        (plan.smoothed, plan.expansions)
    };
    let ((smoothed, swept), (rough, first)) = (cost(&whole), cost(&change));
    assert!(smoothed && !rough && first < swept, "{first} of {swept}");
    for sets in [["groups.robot.path.pose=[5, 3, 0]"], ["groups.robot.path.pose=[5000, 3, 0]"]] {
        let refused = scene("maze-three", &sets);
        let why = build_change(&refused).map(|_| ()).expect_err("no way").to_string();
        assert_eq!(why, build(&refused).map(|_| ()).expect_err("no way").to_string());
    }
}

/// At a goal near a wall a formation heads for the wall, and has no room to turn: no gap is to blame.
#[test]
fn a_tour_with_a_heading_that_leads_nowhere_is_told_so() {
    let goals = "groups.robot.path={ kind = \"tour\", goals = [[21.5, 0, 0], [0, 0]] }";
    let told = why_not("maze-three", &[goals, "props.wall-3.from=[22.5, -12]", "props.wall-3.to=[22.5, 12]"]);
    assert!(
        told.contains("to goal 2: there is no room to turn from heading 0 deg at the start")
            && told.contains("give goal 1 that heading, or another place")
            && !told.contains("gap"),
        "{told}"
    );
}

/// A room with a wall across it that nobody knows of.
const CLOSED_ROOM: &str = r#"
schema = 1
title = "A closed room"
[time]
duration = 60.0
[vehicle]
acceleration_max = 3.0
turn_rate_max = 3.0
[law]
heading = "path"
standing = true
[proximity]
range = 6.0
[safety]
filter = true
[narrowing]
narrows = true
[[groups]]
name = "robot"
shape = "v"
count = 3
distance = 1.2
pose = [0, 0, 0]
path = { kind = "goal", pose = [20, 0, 0], patience = 8 }
[[props]]
name = "wall-1"
shape = "wall"
from = [-6, 6]
to = [26, 6]
[[props]]
name = "wall-2"
shape = "wall"
from = [-6, -6]
to = [26, -6]
[[props]]
name = "wall-3"
shape = "wall"
from = [-6, -6]
to = [-6, 6]
[[props]]
name = "wall-4"
shape = "wall"
from = [26, -6]
to = [26, 6]
[[props]]
name = "surprise"
shape = "wall"
from = [12, -6]
to = [12, 6]
known = false
"#;

fn events(records: &[StepRecord], kind: EventKind) -> Vec<(f64, EventRecord)> {
    let all =
        records.iter().flat_map(|record| record.events.iter().map(|event| (record.snapshot.time, *event)));
    all.filter(|(_, event)| event.kind == kind).collect()
}

#[test]
fn what_nobody_knew_of_is_driven_around() {
    for kind in ["unicycle", "car"] {
        let records = run("moving-obstacle", &[&format!("vehicle.kind={kind}")]);
        assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)), "{kind}");
        let last = records.last().expect("a record");
        assert!(away(last, [34.0, 0.0]) < 0.3, "{kind}: {} m away", away(last, [34.0, 0.0]));
        let other_ways = events(&records, EventKind::Reroute);
        assert!(!other_ways.is_empty(), "{kind}");
        assert!(other_ways.iter().all(|(_, event)| matches!(event.obstacle, Some(EntityId::Prop(1 | 2)))));
        let arrived = events(&records, EventKind::Arrive);
        assert_eq!(arrived.iter().map(|(_, event)| event.goal).collect::<Vec<_>>(), [None]);
        // Every new plan is told, the first at the start.
        let plans = records.iter().map(|record| record.plans.len()).sum::<usize>();
        assert_eq!(plans, 1 + other_ways.len());
        assert_eq!(records[0].plans.len(), 1);
    }
}

#[test]
fn a_cart_that_nobody_knew_of_is_let_by_when_it_is_sensed() {
    // So slow that it is in the way of the plan.
    let cart = ["props.cart.known=false", "props.cart.path.speed=0.75"];
    let records = run("moving-obstacle", &cart);
    assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)));
    assert!(away(records.last().expect("a record"), [34.0, 0.0]) < 0.3);
    let of_cart = |(_, event): &(f64, EventRecord)| event.obstacle == Some(EntityId::Prop(0));
    assert!(
        events(&records, EventKind::Reroute).iter().any(of_cart),
        "{:?}",
        events(&records, EventKind::Reroute)
    );
}

#[test]
fn where_there_is_no_way_any_more_a_formation_stops_waits_and_gives_up() {
    let scene = Scene::parse(CLOSED_ROOM, "test.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let records = records_of(&scene);
    assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)));
    let (halts, gives_up) = (events(&records, EventKind::Halt), events(&records, EventKind::GiveUp));
    assert_eq!((halts.len(), gives_up.len()), (1, 1), "{halts:?} {gives_up:?}");
    let waited = gives_up[0].0 - halts[0].0;
    assert!((8.0..10.5).contains(&waited), "{waited} s");
    assert_eq!(halts[0].1.obstacle, Some(EntityId::Prop(4)));
    let last = records.last().expect("a record");
    assert!(last.snapshot.robots.iter().all(|robot| robot.motion.speed.abs() < 0.02));
}

#[test]
fn who_has_lost_a_robot_plans_for_those_who_are_left() {
    let fails = "events=[{ at = 12.0, robot = \"robot-2\", fails = \"stop\", recovery = \"graft\" }]";
    let records = run("moving-obstacle", &[fails]);
    let last = records.last().expect("a record");
    assert!(away(last, [34.0, 0.0]) < 0.3, "{} m away", away(last, [34.0, 0.0]));
    assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)));
}

#[test]
fn the_formation_of_less_priority_yields() {
    let records = run("two-formations", &[]);
    assert!(!records.iter().any(|record| record.contacts.iter().any(Contact::of_robot)));
    let at_rest = |lead: usize, [x, y]: [f64; 2]| {
        records.iter().position(|record| {
            let motion = record.snapshot.robots[lead].motion;
            math::hypot(motion.pose.x - x, motion.pose.y - y) < 0.3 && motion.speed < 1e-3
        })
    };
    let (first, second) = (at_rest(0, [12.0, 0.0]).expect("there"), at_rest(3, [0.0, 12.0]).expect("there"));
    assert!(second > first + 100, "{second} {first}");
    // The other way round.
    let sets = ["groups.east.path.priority=0", "groups.north.path.priority=1"];
    let turned = run("two-formations", &sets);
    assert!(!turned.iter().any(|record| record.contacts.iter().any(Contact::of_robot)));
    let first = turned[0].plans.first().and_then(|plan| plan.lead());
    assert_eq!(first, Some(3));
}
