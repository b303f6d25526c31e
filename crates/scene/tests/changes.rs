//! Changes while a run goes, and robots of a group that differ from the others.

use scene::{Diagnostic, Follow, Override, Robot, Role, Scene, VehicleKind};
use vocabulary::{LawKind, ScalarTrajectory};

const START: &str = "\
schema = 1
title = \"t\"
[[robots]]
name = \"leader\"
pose = [0.0, 0.0, 0.0]
path = { kind = \"circle\", turn_rate = 0.3 }
[[robots]]
name = \"follower-1\"
pose = [-2.0, -1.0, 0.0]
speed = 0.5
leader = \"leader\"
distance = 2.0
bearing = \"-135 deg\"
";

const GROUP: &str = "\
schema = 1
title = \"t\"
[[groups]]
shape = \"v\"
count = 7
path = { kind = \"circle\", radius = 20 }
";

fn load(text: &str) -> Scene {
    let scene = Scene::parse(text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let written = scene.to_toml();
    let again = Scene::parse(&written, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}\n{written}"));
    assert_eq!(scene, again.scene, "{written}");
    scene
}

fn follow(robot: &Robot) -> &Follow {
    let Role::Follow(follow) = &robot.role else { panic!("{} follows", robot.name) };
    follow
}

/// The wanted distance to the one leader.
fn distance(follow: &Follow) -> &ScalarTrajectory {
    follow.leaders.first.distance.as_ref().expect("a wanted distance")
}

/// The wanted bearing from the one leader.
fn bearing(follow: &Follow) -> &ScalarTrajectory {
    follow.leaders.first.bearing.as_ref().expect("a wanted bearing")
}

fn change(at: &str, set: &str) -> String {
    format!("[[changes]]\nat = {at}\nset = [{set}]\n")
}

#[track_caller]
fn fault(text: &str) -> Diagnostic {
    let diagnostics = Scene::parse(text, "t.toml", &[]).unwrap_err();
    let [fault] = diagnostics.all() else { panic!("one fault expected: {diagnostics}") };
    fault.clone()
}

#[test]
fn changes_are_cumulative_and_in_the_order_of_time() {
    let later = change("8", "\"law.k=3\"");
    let sooner = change("2.5", "\"robots.follower-1.distance=1.5\", 'robots.1.law.kind=full-state'");
    let scene = load(&format!("{START}{later}{sooner}"));
    let [first, second] = scene.changes.as_slice() else { panic!("two changes") };
    assert_eq!((first.at, second.at), (2.5, 8.0));
    assert_eq!(first.set, ["robots.follower-1.distance=1.5", "robots.follower-1.law.kind=full-state"]);
    assert_eq!(second.set, ["robots.follower-1.law.k=[3.0, 3.0]"]);
    let (first, second) = (follow(&first.then.robots[1]), follow(&second.then.robots[1]));
    assert_eq!((distance(first), first.law.kind), (&ScalarTrajectory::Constant(1.5), LawKind::FullState));
    assert_eq!(
        (distance(second), second.law.k, second.speed),
        (&ScalarTrajectory::Constant(1.5), [3.0; 2], 0.5)
    );
}

#[test]
fn every_kind_of_change_is_written_and_read_again() {
    let set = "'robots.follower-1.distance=[{ from = 2, to = 3, start = 4, over = 2 }, { to = 1, start = 8, over = 1 }]', \
               \"robots.follower-1.bearing=\\\"100 deg\\\"\", 'observer.epsilon=0.01', 'law={ beta = [1, 2], switching = \"sign\" }', \
               'vehicle.speed_min=0.6', 'vehicle.acceleration_max=inf', 'vehicle.turn_rate_max=3'";
    let scene = load(&format!("{START}{}", change("4", set)));
    let then = &scene.changes[0].then;
    assert_eq!(*bearing(follow(&then.robots[1])), ScalarTrajectory::Constant(100f64.to_radians()));
    // The start is past: its speed may lie outside the limits of now.
    assert_eq!((follow(&then.robots[1]).speed, then.robots[1].vehicle.speed_min), (0.5, 0.6));
    assert!(!follow(&then.robots[1]).observer.adaptive);
}

#[test]
fn faults_point_into_the_string_of_the_change() {
    for (set, column, words) in [
        ("\"robots.follower-1.distanse=1\"", 27, "did you mean `distance`?"),
        ("\"robots.folower-1.distance=1\"", 16, "did you mean `follower-1`?"),
        ("\"law.k=-1\"", 15, "`k` must be"),
        ("\"law.k=3\", 'law.k'", 19, "path.to.key=value"),
        ("\"time.duration=3\"", 8, "`time.duration` cannot change while a run goes"),
        (
            "\"robots.follower-1.pose=[0, 0, 0]\"",
            8,
            "`robots.follower-1.pose` cannot change while a run goes",
        ),
        ("\"robots.follower-1.leader=leader\"", 8, "cannot change"),
        ("'law.k=3', \"vehicle.length=1\"", 19, "`robots.leader.vehicle.length` cannot change"),
        ("\"robots.follower-1={}\"", 8, "cannot change"),
        ("\"robots.follower-1.observer.start={ offset = [0.1, 0] }\"", 8, "observer.start` cannot change"),
        ("\"law.distance_min=4\"", 7, "below the law's `distance_min` of 4 m, by the change at 5 s"),
        ("\"vehicle.speed_max=0.5\"", 7, "above the vehicle's `speed_max` of 0.5 m/s, by the change at 5 s"),
        ("\"law.k=\\u0033x\"", 8, "`k` must be"),
    ] {
        let fault = fault(&format!("{START}{}", change("5", set)));
        assert_eq!((fault.line, fault.column), (16, column), "{fault}");
        assert!(fault.message.contains(words), "{fault}");
    }
    assert_eq!(fault(&format!("{START}{}", change("-1", ""))).line, 15);
}

#[test]
fn scenes_lead_to_each_other_by_what_can_change() {
    let start = load(START);
    let with = |sets: &[&str]| {
        let sets: Vec<Override> = sets.iter().map(|set| set.parse().unwrap()).collect();
        Scene::parse(START, "t.toml", &sets).unwrap_or_else(|fault| panic!("{fault}")).scene
    };
    assert_eq!(start.sets_to(&start), Ok(vec![]));
    let other = with(&["law.k=3", "robots.follower-1.distance=1.5", "vehicle.speed_max=2"]);
    let sets = start.sets_to(&other).unwrap();
    assert_eq!(
        sets,
        [
            "robots.leader.vehicle.speed_max=2.0",
            "robots.follower-1.vehicle.speed_max=2.0",
            "robots.follower-1.distance=1.5",
            "robots.follower-1.law.k=[3.0, 3.0]"
        ]
    );
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    assert_eq!(with(&sets), other);
    let obstacles = start.sets_to(&with(&["time.duration=5", "robots.1.sensing.kind=noise"])).unwrap_err();
    assert_eq!(obstacles.len(), 2);
    assert!(obstacles[0].starts_with("`time` cannot change") && obstacles[1].contains("sensing.kind"));
}

#[test]
fn one_robot_of_a_group_may_differ() {
    let scene = load(&format!(
        "{GROUP}vehicle = {{ kind = \"car\", mass = 6.0 }}\nlaw = {{ k = 2.0, beta = 1.0 }}\n\
         [groups.members.robot-3]\ndistance = 1.5\nlaw.k = 4.0\nvehicle = {{ friction = 0.7 }}\n\
         [groups.members.robot-4]\nvehicle = \"differential\"\nbearing = \"170 deg\"\n\
         [groups.members.robot-1]\nvehicle = {{ mass = 7.0 }}\n"
    ));
    let [first, _, third, fourth, fifth, ..] = scene.robots.as_slice() else { panic!("robots") };
    assert_eq!((first.vehicle.kind, first.vehicle.mass), (VehicleKind::Car, 7.0));
    assert_eq!((third.vehicle.friction, third.vehicle.mass), (0.7, 6.0));
    assert_eq!((follow(third).law.k, follow(third).law.beta), ([4.0; 2], [1.0; 2]));
    assert_eq!(*distance(follow(third)), ScalarTrajectory::Constant(1.5));
    assert_eq!((fourth.vehicle.kind, fourth.vehicle.mass), (VehicleKind::Differential, 8.0));
    assert_eq!(*bearing(follow(fourth)), ScalarTrajectory::Constant(170f64.to_radians()));
    assert_eq!((follow(fifth).law.k, distance(follow(fifth))), ([2.0; 2], &ScalarTrajectory::Constant(2.0)));
    let plain = load(&format!("{GROUP}vehicle = {{ kind = \"car\", mass = 6.0 }}\n"));
    assert!(scene.robots.iter().zip(&plain.robots).all(|(a, b)| a.pose == b.pose), "starts are the group's");
}

#[test]
fn members_that_a_group_does_not_have_are_told() {
    for (lines, words) in [
        ("[groups.members.robot-8]\ndistance = 1.0\n", "did you mean `robot-"),
        ("[groups.members.robot-2]\ndistanse = 1.0\n", "did you mean `distance`?"),
        ("[groups.members.robot-1]\ndistance = 1.0\n", "but `robot-1` leads"),
        ("[groups.members.robot-2]\ndistance = 0.01\n", "`distance` falls to 0.01 m"),
        ("[groups.members.robot-2]\nvehicle.spring = 1.0\n", "has no effect"),
    ] {
        let fault = fault(&format!("{GROUP}{lines}"));
        assert!(fault.line >= 7 && fault.message.contains(words), "{fault}");
    }
}

#[test]
fn overrides_and_changes_reach_robots_of_groups() {
    let set: Override = "robots.robot-3.distance=1.5".parse().unwrap();
    let scene = Scene::parse(GROUP, "t.toml", &[set]).unwrap().scene;
    assert_eq!(*distance(follow(&scene.robots[2])), ScalarTrajectory::Constant(1.5));
    let text = format!(
        "{GROUP}{}{}",
        change("1", "\"robots.robot-3.law.k=3\""),
        change("2", "\"groups.0.distance=3\", \"groups.0.angle=2\"")
    );
    let scene = load(&text);
    assert_eq!(scene.changes[0].set, ["robots.robot-3.law.k=[3.0, 3.0]"]);
    let then = &scene.changes[1].then;
    assert_eq!(then.robots[6].pose, scene.robots[6].pose);
    assert_eq!(*distance(follow(&then.robots[6])), ScalarTrajectory::Constant(3.0));
    let set: Override = "robots.robot-33.distance=1.5".parse().unwrap();
    let fault = Scene::parse(GROUP, "t.toml", &[set]).unwrap_err().to_string();
    assert!(fault.contains("did you mean `robot-3`?"), "{fault}");
}

/// A session of an evening at the sliders.
#[test]
fn hundreds_of_changes_are_read_in_no_time() {
    let changes: String = (0..300)
        .map(|k| {
            change(
                &k.to_string(),
                &format!("\"robots.robot-{}.distance={}\"", 2 + k % 6, 2.0 + 0.001 * f64::from(k)),
            )
        })
        .collect();
    assert_eq!(load(&format!("{GROUP}{changes}")).changes.len(), 300);
}

#[test]
fn one_robot_of_a_group_may_follow_another() {
    let scene =
        load(&format!("{GROUP}[groups.members.robot-5]\nleader = \"robot-1\"\nbearing = \"180 deg\"\n"));
    assert_eq!(follow(&scene.robots[4]).leaders.first.name, "robot-1");
    assert_eq!(follow(&scene.robots[6]).leaders.first.name, "robot-5");
    let unknown = fault(&format!("{GROUP}[groups.members.robot-5]\nleader = \"robot-l\"\n"));
    assert!(unknown.to_string().contains("there is no robot called `robot-l`"), "{unknown}");
}

/// Every change of every robot is kept, so that there is a bound.
#[test]
fn very_many_changes_of_very_many_robots_are_refused() {
    let text = |changes: usize| {
        let robots = "[[groups]]\nshape = \"column\"\ncount = 10000\npath = { kind = \"constant\" }\n";
        let change = |k: usize| format!("[[changes]]\nat = {k}\nset = [\"law.k={}\"]\n", 1 + k % 5);
        let changes: Vec<String> = (0..changes).map(change).collect();
        format!("schema = 1\ntitle = \"t\"\n{robots}{}", changes.concat())
    };
    let refused = Scene::parse(&text(21), "t.toml", &[]).expect_err("too many").to_string();
    assert!(refused.contains("21 changes of 10000 robots are too many: at most 200000"), "{refused}");
}
