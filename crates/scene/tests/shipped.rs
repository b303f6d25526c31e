//! The scenes that are shipped: each loads, goes through text and back unchanged, and fits the schema.

use scene::{Override, Path, Role, Scene, schema};
use serde_json::Value as Json;
use std::{f64::consts::PI, path::PathBuf};
use vocabulary::ScalarTrajectory;

fn scenes() -> Vec<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<_> = entries.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    scenes.sort();
    scenes
}

fn load(name: &str) -> Scene {
    let path = scenes().into_iter().find(|path| path.file_stem().is_some_and(|stem| stem == name)).unwrap();
    Scene::load(path, &[]).unwrap_or_else(|fault| panic!("{fault}")).scene
}

/// TOML as JSON; what JSON cannot say is left to the largest number.
fn json(text: &str) -> Json {
    fn convert(value: toml::Value) -> Json {
        match value {
            toml::Value::Float(number) if number.is_infinite() => Json::from(f64::MAX.copysign(number)),
            toml::Value::Array(items) => items.into_iter().map(convert).collect(),
            toml::Value::Table(table) => {
                table.into_iter().map(|(key, value)| (key, convert(value))).collect()
            }
            other => serde_json::to_value(other).unwrap(),
        }
    }
    convert(toml::Value::Table(text.parse().unwrap()))
}

#[test]
fn every_scene_survives_being_written_and_read() {
    assert!(scenes().len() >= 7);
    for path in scenes() {
        let scene = Scene::load(&path, &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
        let text = scene.to_toml();
        let again = Scene::parse(&text, &path, &[]).unwrap_or_else(|fault| panic!("{fault}\n{text}")).scene;
        assert_eq!(scene, again, "{}", path.display());
        assert_eq!(text, again.to_toml(), "{}", path.display());
    }
}

#[test]
fn every_scene_fits_the_schema_and_so_does_what_is_written_of_it() {
    let validator = jsonschema::validator_for(&schema()).unwrap();
    for path in scenes() {
        let text = std::fs::read_to_string(&path).unwrap();
        for text in [Scene::load(&path, &[]).unwrap().scene.to_toml(), text] {
            let faults: Vec<_> = validator.iter_errors(&json(&text)).map(|fault| fault.to_string()).collect();
            assert!(faults.is_empty(), "{}: {faults:?}", path.display());
        }
    }
}

#[test]
fn the_schema_refuses_what_the_reader_refuses() {
    let validator = jsonschema::validator_for(&schema()).unwrap();
    let good =
        "schema = 1\ntitle = \"t\"\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\npath.kind = \"constant\"\n";
    assert!(validator.is_valid(&json(good)) && Scene::parse(good, "a.toml", &[]).is_ok());
    for (right, wrong) in [
        ("title", "titel"),
        ("pose = [0, 0, 0]", "pose = [0, 0]"),
        ("pose = [0, 0, 0]", "pose = [0, 0, \"3 furlongs\"]"),
        ("constant", "straight"),
        ("path.kind = \"constant\"", "path.kind = \"constant\"\npath.radius = 1"),
        ("path.kind = \"constant\"", "path.kind = \"constant\"\nlaw.epsilon = 1"),
        ("path.kind = \"constant\"", "path.kind = \"constant\"\n[time]\nduration = -1"),
        ("path.kind = \"constant\"", "path.kind = \"constant\"\n[film]\nfps = 0.5"),
        ("schema = 1", "schema = 2"),
        ("name = \"a\"\n", ""),
    ] {
        let bad = good.replace(right, wrong);
        assert!(!validator.is_valid(&json(&bad)), "the schema takes\n{bad}");
        assert!(Scene::parse(&bad, "a.toml", &[]).is_err(), "the reader takes\n{bad}");
    }
}

#[test]
fn every_key_of_the_schema_is_described() {
    fn check(schema: &Json, at: &str) {
        if let Some(properties) = schema["properties"].as_object() {
            for (key, property) in properties.iter().filter(|(key, _)| *key != "kind") {
                let about = property["description"].as_str().unwrap_or("");
                assert!(about.len() > 5, "{at}.{key} is not described");
            }
        }
        match schema {
            Json::Object(map) => map.iter().for_each(|(key, value)| check(value, &format!("{at}.{key}"))),
            Json::Array(items) => items.iter().for_each(|value| check(value, at)),
            _ => {}
        }
    }
    check(&schema(), "");
}

#[test]
fn a_small_scene_has_the_papers_values() {
    let scene = load("circle-three");
    assert_eq!((scene.time.period, scene.robots.len()), (0.01, 3));
    let Role::Lead { path: Path::Circle { speed: 1.0, turn_rate: 0.3 } } = scene.robots[0].role else {
        panic!("the leader is to drive the paper's circle");
    };
    let Role::Follow(follow) = &scene.robots[1].role else { panic!("robot 1 is to follow") };
    assert_eq!(
        (follow.speed, &follow.leaders.first.distance),
        (0.01, &Some(ScalarTrajectory::Constant(2.0)))
    );
    assert_eq!(follow.leaders.first.bearing, Some(ScalarTrajectory::Constant(-0.75 * PI)));
    assert_eq!((follow.law.k, follow.law.beta, follow.law.slope), ([5.0; 2], [5.0; 2], [24.53; 2]));
    assert_eq!((follow.observer.epsilon, follow.observer.alpha1), ([0.001; 2], [2.0; 2]));
    let limits = scene.robots[1].vehicle.limits();
    assert_eq!((limits.speed_min, limits.speed_max, limits.turn_rate_max), (0.01, 1.6, 11.5));
    assert!(limits.acceleration_max.is_infinite());
}

#[test]
fn groups_become_robots_near_their_places() {
    let scene = load("figure-eight-seven");
    let names: Vec<_> = scene.robots.iter().map(|robot| robot.name.as_str()).collect();
    assert_eq!(names, ["robot-1", "robot-2", "robot-3", "robot-4", "robot-5", "robot-6", "robot-7"]);
    let leaders: Vec<_> = scene
        .robots
        .iter()
        .filter_map(|robot| match &robot.role {
            Role::Follow(follow) => {
                Some((follow.leaders.first.name.as_str(), follow.leaders.first.bearing.clone()))
            }
            Role::Lead { .. } => None,
        })
        .collect();
    let wing = |leader, side: f64| (leader, Some(ScalarTrajectory::Constant(side * 0.75 * PI)));
    assert_eq!(
        leaders,
        [
            wing("robot-1", -1.0),
            wing("robot-1", 1.0),
            wing("robot-2", -1.0),
            wing("robot-3", 1.0),
            wing("robot-4", -1.0),
            wing("robot-5", 1.0),
        ]
    );
    let step = 2.0f64.sqrt();
    for (robot, [x, y]) in
        scene.robots.iter().zip([[0.0, 0.0], [-step, -step], [-step, step], [-2.0 * step, -2.0 * step]])
    {
        let off = [robot.pose.x - x, robot.pose.y - y].map(f64::abs);
        assert!(off[0] <= 0.25 && off[1] <= 0.25, "{} starts {off:?} off", robot.name);
    }
    assert_eq!(load("hundred").robots.len(), 100);
}

#[test]
fn scatter_depends_on_the_seed_alone() {
    let path = scenes().into_iter().find(|path| path.ends_with("hundred.toml")).unwrap();
    let with =
        |change: &str| Scene::load(&path, &[change.parse::<Override>().unwrap()]).unwrap().scene.robots;
    assert_eq!(with("seed=5"), with("seed=5"));
    assert_ne!(with("seed=5"), with("seed=6"));
}
