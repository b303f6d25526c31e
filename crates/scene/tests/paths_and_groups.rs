//! Ways of lead robots, tables beside the scene, and groups.

use scene::{Path, Role, Scene, SpeedProfile};
use std::{f64::consts::PI, fs};
use vocabulary::ScalarTrajectory;
use vocabulary::math;

fn lead(path: &str) -> String {
    format!("schema = 1\ntitle = \"t\"\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\npath = {path}\n")
}

#[track_caller]
fn path(text: &str) -> Path {
    let scene = Scene::parse(&lead(text), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let again = Scene::parse(&scene.to_toml(), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    assert_eq!(scene, again);
    match &scene.robots[0].role {
        Role::Lead { path } => path.clone(),
        Role::Follow(_) => panic!("robot 0 leads"),
    }
}

#[track_caller]
fn fault(text: &str) -> String {
    let diagnostics = Scene::parse(&lead(text), "t.toml", &[]).unwrap_err();
    let [fault] = diagnostics.all() else { panic!("one fault expected: {diagnostics}") };
    assert_eq!(fault.line, 6);
    fault.message.clone()
}

#[test]
fn every_kind_of_path() {
    assert_eq!(path("{ kind = \"constant\" }"), Path::Constant { speed: 1.0, turn_rate: 0.0 });
    assert_eq!(
        path("{ kind = \"circle\", radius = 4, direction = \"right\" }"),
        Path::Circle { speed: 1.0, turn_rate: -0.25 }
    );
    assert_eq!(
        path("{ kind = \"figure-eight\", speed = 0.5, period = 60 }"),
        Path::FigureEight { speed: 0.5, length: 30.0 }
    );
    assert_eq!(
        path("{ kind = \"table\", rows = [[0, 1, 0], [5, 1, 0.3]] }"),
        Path::Table { rows: vec![[0.0, 1.0, 0.0], [5.0, 1.0, 0.3]] }
    );
    let points = vec![[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]];
    assert_eq!(
        path(
            "{ kind = \"waypoints\", points = [[0, 0], [5, 0], [5, 5]], closed = true, speed = { time = [[0, 0], [2, 1]] } }"
        ),
        Path::Waypoints { points, closed: true, speed: SpeedProfile::Time(vec![[0.0, 0.0], [2.0, 1.0]]) }
    );
    let Path::Sinusoid { turn_rate_amplitude: 0.4, speed: 1.0, .. } =
        path("{ kind = \"sinusoid\", turn_rate_amplitude = 0.4, turn_rate_rate = 0.2 }")
    else {
        panic!("a sinusoid of the turn rate");
    };
}

#[test]
fn paths_that_cannot_be_driven() {
    for (path, words) in [
        ("{ kind = \"circle\" }", "either `radius` or `turn_rate`"),
        ("{ kind = \"circle\", radius = 1, turn_rate = 1 }", "either `radius` or `turn_rate`"),
        ("{ kind = \"circle\", turn_rate = 0 }", "other than 0"),
        ("{ kind = \"circle\", turn_rate = 0.1, direction = \"left\" }", "sign of `turn_rate`"),
        ("{ kind = \"circle\", radius = 0.01 }", "above `turn_rate_max`"),
        ("{ kind = \"sinusoid\", speed = 0.5, speed_amplitude = 0.6 }", "speeds must not be negative"),
        ("{ kind = \"waypoints\", points = [[0, 0], [0, 0]] }", "0.001 m apart"),
        ("{ kind = \"waypoints\", points = [[0, 0], [1, 0]], closed = true }", "three points"),
        (
            "{ kind = \"waypoints\", points = [[0, 0], [1, 0]], speed = { distance = [[0, 0]] } }",
            "never leave",
        ),
        ("{ kind = \"table\", rows = [[0, 1, 0], [0, 1, 0]] }", "rows must rise"),
        ("{ kind = \"table\", rows = [[1, 1, 0]] }", "first row must be at 0"),
        ("{ kind = \"table\", file = \"none.csv\" }", "none.csv: no such file"),
        ("{ speed = 1 }", "`kind` is missing"),
    ] {
        let message = fault(path);
        assert!(message.contains(words), "`{words}` is not in: {message}");
    }
}

#[test]
fn a_curve_says_where_its_robot_starts() {
    let text = lead("{ kind = \"waypoints\", points = [[1, 0], [1, 2]] }").replace("pose = [0, 0, 0]\n", "");
    let scene = Scene::parse(&text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    assert_eq!(scene.robots[0].pose, vocabulary::Pose::new(1.0, 0.0, PI / 2.0));
}

#[test]
fn a_robot_starts_where_its_curve_does() {
    let text = lead("{ kind = \"waypoints\", points = [[1, 0], [2, 0]] }");
    let diagnostics = Scene::parse(&text, "t.toml", &[]).unwrap_err();
    assert_eq!((diagnostics.all()[0].line, diagnostics.all()[0].column), (5, 8));
}

#[test]
fn tables_stand_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, table) = (folder.path().join("a.toml"), folder.path().join("drive.csv"));
    fs::write(&scene, lead("{ kind = \"table\", file = \"drive.csv\" }")).unwrap();
    fs::write(&table, "# a comment\nomega, t, v\n0.0, 0.0, 1.0\n0.3, 2.5, 1.0\n").unwrap();
    let loaded = Scene::load(&scene, &[]).unwrap_or_else(|fault| panic!("{fault}"));
    let Role::Lead { path: Path::Table { rows } } = &loaded.scene.robots[0].role else { panic!("a table") };
    assert_eq!(rows, &[[0.0, 1.0, 0.0], [2.5, 1.0, 0.3]]);
    assert_eq!(loaded.files, [scene.clone(), table.clone()]);

    for (text, line, words) in [
        ("t,v,omega\n0,1,0\n1,nan,0\n2,fast,0\n", 3, "`v` must be a number in m/s"),
        ("t,v,omega\n0,1,0\n0,1,0\n", 3, "rows must rise"),
        ("t,v,omega\n0,1\n", 2, "not a row of the table: it has 2 values, and the header 3"),
        ("t;v;omega\n0;1;0\n", 1, "not t;v;omega; the file is separated by `;`: use commas"),
        ("t\tv\tomega\n0\t1\t0\n", 1, "separated by tabs: use commas"),
        ("t,v,omega\n0;1;0,1,0\n", 2, "not \"0;1;0\"; the file is separated by `;`"),
        ("t,v,w\n0,1,0\n", 1, "columns must be t, v, omega"),
        ("t,v,omega\n", 1, "1 to 100000 rows"),
        ("", 1, "columns must be"),
    ] {
        fs::write(&table, text).unwrap();
        let diagnostics = Scene::load(&scene, &[]).unwrap_err();
        let fault = &diagnostics.all()[0];
        assert_eq!((fault.origin.as_str(), fault.line), (table.to_str().unwrap(), line), "{fault}");
        assert!(fault.message.contains(words), "{fault}");
        // The place says the line, and the message not once more.
        assert!(!fault.message.contains("line") && !fault.message.contains("byte"), "{fault}");
    }
}

fn group(keys: &str) -> String {
    format!("schema = 1\ntitle = \"t\"\n[[groups]]\npath = {{ kind = \"constant\" }}\n{keys}\n")
}

#[test]
fn groups_without_scatter_start_in_formation() {
    let shapes = ["v", "column", "abreast", "diamond", "circle"];
    for (shape, follows) in shapes.into_iter().flat_map(|s| [(s, "neighbour"), (s, "leader")]) {
        let text = group(&format!(
            "shape = \"{shape}\"\ncount = 8\nscatter = 0\nscatter_heading = 0\npose = [3, 4, 1]\nfollows = \"{follows}\""
        ));
        let scene = Scene::parse(&text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
        assert_eq!(scene.robots.len(), 8);
        for robot in &scene.robots {
            let Role::Follow(follow) = &robot.role else { continue };
            let leader = &scene.robots[scene.index_of(&follow.leaders.first.name).unwrap()];
            let (dx, dy) = (robot.pose.x - leader.pose.x, robot.pose.y - leader.pose.y);
            let bearing = vocabulary::wrap(math::atan2(dy, dx) - leader.pose.heading);
            let Some(ScalarTrajectory::Constant(wanted)) = follow.leaders.first.bearing else {
                panic!("a constant bearing")
            };
            let Some(ScalarTrajectory::Constant(distance)) = follow.leaders.first.distance else {
                panic!("a constant distance")
            };
            assert!((math::hypot(dx, dy) - distance).abs() < 1e-9, "{shape}: {}", robot.name);
            assert!(if follows == "leader" {
                follow.leaders.first.name == "robot-1"
            } else {
                distance == 2.0
            });
            assert!(vocabulary::wrap(bearing - wanted).abs() < 1e-9, "{shape}: {}", robot.name);
        }
    }
}

#[test]
fn a_group_can_follow_a_robot_and_differ_from_the_scene() {
    let text = lead("{ kind = \"constant\" }").replace("0, 0]", "0, \"90 deg\"]")
        + "[[groups]]\nname = \"tail\"\nshape = \"column\"\ncount = 3\nleader = \"a\"\nlaw.k = 2\nscatter = 0\n";
    let scene = Scene::parse(&text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let followers: Vec<_> = scene.robots[1..]
        .iter()
        .map(|robot| match &robot.role {
            Role::Follow(follow) => (robot.name.as_str(), follow.leaders.first.name.as_str(), follow.law.k),
            Role::Lead { .. } => panic!("{} follows", robot.name),
        })
        .collect();
    assert_eq!(followers, [("tail-2", "a", [2.0; 2]), ("tail-3", "tail-2", [2.0; 2])]);
    assert!((scene.robots[2].pose.y + 4.0).abs() < 1e-9, "behind a robot that looks left");
    assert!((scene.robots[2].pose.heading - PI / 2.0).abs() <= 10f64.to_radians());
}

#[test]
fn groups_that_cannot_be() {
    for (keys, line, words) in [
        ("shape = \"w\"\ncount = 3", 5, "one of `v`"),
        ("shape = \"diamond\"\ncount = 7", 6, "`diamond` needs a multiple of 4"),
        ("shape = \"v\"\ncount = 1", 6, "from 2 to 10000"),
        ("shape = \"v\"\ncount = 3\nangle = \"80 deg\"", 7, "90 deg to 180 deg"),
        ("shape = \"v\"\ncount = 3\nleader = \"b\"", 3, "either a `path`"),
        (
            "shape = \"v\"\ncount = 3\n[[groups]]\nshape = \"v\"\ncount = 3\nleader = \"robt-1\"",
            10,
            "`robot-1`?",
        ),
        (
            "shape = \"v\"\ncount = 3\n[[robots]]\nname = \"robot-2\"\npose = [0, 0, 0]\nleader = \"robot-1\"\ndistance = 1\nbearing = 1",
            8,
            "two robots",
        ),
        (
            "shape = \"v\"\ncount = 9000\n[[groups]]\nname=\"b\"\nshape = \"v\"\ncount = 9000\npath.kind = \"constant\"",
            10,
            "more than 10000",
        ),
        ("shape = \"column\"\ncount = 3\ndistance = 0.05", 7, "`distance_min`"),
    ] {
        let diagnostics = Scene::parse(&group(keys), "t.toml", &[]).unwrap_err();
        let fault = &diagnostics.all()[0];
        assert_eq!(fault.line, line, "{diagnostics}");
        assert!(fault.message.contains(words), "{diagnostics}");
    }
}

/// A robot of a group may have a name of its own, and a place may stay empty; the others stay as they are.
#[test]
fn members_have_names_of_their_own_and_places_stay_empty() {
    let group =
        "schema = 1\ntitle = \"t\"\n[[groups]]\nshape = \"v\"\ncount = 5\npath = { kind = \"constant\" }\n";
    let read = |more: &str| Scene::parse(&format!("{group}{more}"), "t.toml", &[]);
    let whole = read("").unwrap().scene;
    let own = read("[groups.members.robot-3]\nname = \"left\"\n[groups.members.robot-4]\nabsent = true\n");
    let scene = own.unwrap_or_else(|faults| panic!("{faults}")).scene;
    let names: Vec<&str> = scene.robots.iter().map(|robot| robot.name.as_str()).collect();
    assert_eq!(names, ["robot-1", "robot-2", "left", "robot-5"]);
    assert_eq!(scene.robots[3].pose, whole.robots[4].pose);
    let Role::Follow(follow) = &scene.robots[3].role else { panic!("robot-5 follows") };
    assert_eq!(follow.leaders.first.name, "left");
    let set = ["robots.left.distance=1.5".parse().unwrap(), "robots.robot-4.absent=false".parse().unwrap()];
    let text = format!(
        "{group}[groups.members.robot-3]\nname = \"left\"\n[groups.members.robot-4]\nabsent = true\n"
    );
    assert_eq!(Scene::parse(&text, "t.toml", &set).unwrap().scene.robots.len(), 5);
    let fault = |more: &str| read(more).unwrap_err().to_string();
    let told = fault("[groups.members.robot-3]\nabsent = true\n");
    assert!(told.contains("`robot-3` cannot be absent: `robot-5` follows it"), "{told}");
    assert!(fault("[groups.members.robot-1]\nabsent = true\n").contains("`robot-1` leads"));
    assert!(fault("[groups.members.robot-2]\nname = \"robot-3\"\n").contains("two robots called `robot-3`"));
}
