//! Changes from the command line.

use scene::{Diagnostics, Override, Path, Role, Scene, Vehicle, VehicleKind};
use vocabulary::{LawKind, ScalarTrajectory};

const SCENE: &str = "\
schema = 1
title = \"t\"
[[robots]]
name = \"leader\"
pose = [0.0, 0.0, 0.0]
path = { kind = \"circle\", turn_rate = 0.3 }
[[robots]]
name = \"follower-1\"
pose = [-2.0, -1.0, 0.0]
leader = \"leader\"
distance = 2.0
bearing = \"-135 deg\"
";

fn with(changes: &[&str]) -> Result<Scene, Diagnostics> {
    let changes: Vec<Override> = changes.iter().map(|change| change.parse().unwrap()).collect();
    Scene::parse(SCENE, "test.toml", &changes).map(|loaded| loaded.scene)
}

#[test]
fn values_are_put_where_the_path_says() {
    let scene = with(&[
        "time.duration=5",
        "title=Another title",
        "robots.follower-1.distance=1.5",
        "robots.1.law.kind=full-state",
        "robots.leader.path.turn_rate = -0.2",
        "robots.follower-1.bearing={ mean = 2.0, amplitude = 0.1, rate = 1 }",
        "law.k=[4, 6]",
        "seed=9",
    ])
    .unwrap();
    assert_eq!((scene.time.duration, scene.seed, scene.title.as_str()), (5.0, 9, "Another title"));
    let Role::Follow(follow) = &scene.robots[1].role else { panic!("robot 1 follows") };
    assert_eq!(
        (&follow.leaders.first.distance, follow.law.k),
        (&Some(ScalarTrajectory::Constant(1.5)), [4.0, 6.0])
    );
    assert_eq!(follow.law.kind, LawKind::FullState);
    assert_eq!(
        follow.leaders.first.bearing,
        Some(ScalarTrajectory::Sinusoid { mean: 2.0, amplitude: 0.1, rate: 1.0 })
    );
    assert_eq!(scene.robots[0].role, Role::Lead { path: Path::Circle { speed: 1.0, turn_rate: -0.2 } });
}

#[test]
fn a_vehicle_named_by_a_word_can_be_changed() {
    let scene = with(&["vehicle=car", "vehicle.mass=6", "robots.leader.vehicle=differential"]).unwrap();
    assert_eq!(scene.robots[1].vehicle, Vehicle { mass: 6.0, ..Vehicle::ready_made(VehicleKind::Car) });
    assert_eq!(scene.robots[0].vehicle, Vehicle::ready_made(VehicleKind::Differential));
}

#[test]
fn the_last_of_several_holds() {
    assert_eq!(with(&["time.duration=5", "time.duration=6"]).unwrap().time.duration, 6.0);
}

#[test]
fn faults_point_into_the_override() {
    for (change, column, words) in [
        ("time.durration=5", 6, "did you mean `duration`?"),
        ("tme.duration=5", 1, "did you mean `time`?"),
        ("time.duration=-5", 15, "`duration` must be"),
        ("time.duration= soon", 16, "the text \"soon\""),
        ("robots.folower-1.distance=1", 8, "did you mean `follower-1`?"),
        ("robots.2.distance=1", 8, "counted from 0"),
        ("title.colour=1", 7, "plain value"),
        ("robots.1.leader=leda", 17, "did you mean `leader`?"),
    ] {
        let diagnostics = with(&[change]).unwrap_err();
        let [fault] = diagnostics.all() else { panic!("one fault expected: {diagnostics}") };
        assert_eq!((fault.origin.as_str(), fault.line, fault.column), ("--set", 1, column), "{fault}");
        assert!(fault.message.contains(words), "{fault}");
        assert_eq!(fault.excerpt, change);
    }
}

#[test]
fn what_is_no_override_is_told() {
    for text in ["time.duration", "=5", "time..duration=5", ""] {
        let fault = text.parse::<Override>().unwrap_err().to_string();
        assert!(fault.contains("path.to.key=value"), "{fault}");
    }
}

/// What looks alike is alike, however its accents are written.
#[test]
fn names_may_be_written_with_combining_marks() {
    let (apart, together) = ("Ame\u{301}lie", "Am\u{e9}lie");
    let text = SCENE.replace("name = \"leader\"", &format!("name = \"{apart}\""));
    let text = text.replace("leader = \"leader\"", &format!("leader = \"{together}\""));
    let change = format!("robots.{apart}.path.turn_rate=0.1").parse::<Override>().unwrap();
    let scene = Scene::parse(&text, "test.toml", &[change]).unwrap_or_else(|faults| panic!("{faults}")).scene;
    assert_eq!(scene.robots[0].name, together);
    let Role::Lead { path: Path::Circle { turn_rate, .. } } = scene.robots[0].role else {
        panic!("it leads")
    };
    assert_eq!(turn_rate, 0.1);
    let group = "schema = 1\ntitle = \"t\"\n[[groups]]\nname = \"ame\u{301}\"\nshape = \"column\"\ncount = 3\n\
                 path = { kind = \"constant\" }\n[groups.members.\"am\u{e9}-2\"]\ndistance = 1.5\n";
    let scene = Scene::parse(group, "test.toml", &[]).unwrap_or_else(|faults| panic!("{faults}")).scene;
    let Role::Follow(follow) = &scene.robots[1].role else { panic!("it follows") };
    assert_eq!(follow.leaders.first.distance, Some(ScalarTrajectory::Constant(1.5)));
    // A mark alone is no letter that anything else would take.
    assert!(Scene::parse(&SCENE.replace("name = \"leader\"", "name = \"a b\""), "test.toml", &[]).is_err());
}

#[test]
fn the_papers_words_for_its_laws_are_read() {
    for (word, kind) in
        [("fsfb", LawKind::FullState), ("rsfb", LawKind::RobustState), ("ofb", LawKind::OutputFeedback)]
    {
        let scene = with(&[&format!("law.kind={word}")]).unwrap();
        let Role::Follow(follow) = &scene.robots[1].role else { panic!("robot 1 follows") };
        assert_eq!(follow.law.kind, kind);
        assert!(!scene.to_toml().contains(word), "it is written in full");
    }
    let fault = with(&["law.kind=osfb"]).unwrap_err().to_string();
    assert!(fault.contains("`ofb`") && fault.contains("did you mean `"), "{fault}");
}

#[test]
fn a_frame_rate_may_be_broken() {
    assert_eq!(with(&["film.fps=29.97"]).unwrap().film.fps, 29.97);
    assert_eq!(with(&["film.fps=25"]).unwrap().film.fps, 25.0);
    assert!(with(&["film.fps=0.5"]).is_err());
}

/// A shorter run is no mistake: what it does not come to is told, and not judged.
#[test]
fn what_comes_after_the_end_is_told() {
    let more = "[expect]\nsettled_after = 6.0\nsettled_error_at_most = [0.1, 0.1]\n[[changes]]\nat = 5.0\n\
                set = [\"law.k=4\"]\n";
    let late = |set: &[&str]| {
        let set: Vec<Override> = set.iter().map(|change| change.parse().unwrap()).collect();
        Scene::parse(&format!("{SCENE}{more}"), "test.toml", &set)
            .unwrap_or_else(|f| panic!("{f}"))
            .scene
            .late()
    };
    assert_eq!(late(&[]), Vec::<String>::new());
    let told = late(&["time.duration=3"]);
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("the change at 5 s") && told[1].contains("`settled_after` of 6 s"), "{told:?}");
}

#[test]
fn a_name_that_is_not_there_is_told_those_that_are() {
    for (change, message) in [
        ("robots.zoe.distance=1", "is called `zoe` (known here: `leader`, `follower-1`)"),
        ("robots.folower-1.distance=1", "did you mean `follower-1`? (known here: `leader`, `follower-1`)"),
        ("robots.follower-1.leader=zoe", "no robot called `zoe` (known here: `leader`, `follower-1`)"),
    ] {
        let errors = with(&[change]).expect_err(change).to_string();
        assert!(errors.contains(message), "{errors}");
    }
}
