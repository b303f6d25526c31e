//! Whatever a file holds, it is read or refused, never a crash, and what is read is sound.

use proptest::prelude::*;
use scene::{Override, Role, Scene};

fn shipped() -> Vec<String> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let everything = include_str!("everything.toml").to_owned();
    paths.iter().filter_map(|path| std::fs::read_to_string(path).ok()).chain([everything]).collect()
}

/// The scene that a number stands for: every other time the one that uses everything.
fn scene(which: usize) -> String {
    let scenes = shipped();
    scenes[if which.is_multiple_of(2) { scenes.len() - 1 } else { (which / 2) % scenes.len() }].clone()
}

/// Reads `text`; what is accepted has to hold what [`Scene`] promises, and what is refused has to be printable.
fn try_out(text: &str, changes: &[Override]) {
    match Scene::parse(text, "t.toml", changes) {
        Ok(loaded) => assert_sound(&loaded.scene),
        Err(diagnostics) => {
            assert!(!diagnostics.all().is_empty());
            assert!(!diagnostics.to_string().is_empty());
        }
    }
}

fn assert_sound(scene: &Scene) {
    let again = Scene::parse(&scene.to_toml(), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}"));
    assert_eq!(*scene, again.scene);
    assert!(scene.time.period <= scene.time.duration && !scene.robots.is_empty());
    if let Some(terrain) = &scene.ground.terrain {
        assert!(terrain.columns >= 2 && terrain.rows >= 2 && terrain.cell > 0.0);
        assert_eq!(terrain.heights.len(), terrain.columns * terrain.rows);
        assert!(terrain.grip.is_empty() || terrain.grip.len() == terrain.heights.len());
        assert!(terrain.heights.iter().chain(&terrain.grip).all(|value| value.is_finite()));
    }
    for prop in &scene.props {
        assert!(prop.solid.extent().iter().all(|side| *side > 0.0) && prop.elevation.is_finite());
        assert!(scene.index_of(&prop.name).is_none());
    }
    for robot in &scene.robots {
        assert!(robot.vehicle.speed_min < robot.vehicle.speed_max);
        if let Role::Follow(follow) = &robot.role {
            for leader in follow.leaders.iter() {
                assert!(scene.index_of(&leader.name).is_some());
                assert!(leader.distance.as_ref().is_none_or(|d| d.range()[0] >= follow.law.distance_min));
                assert!(leader.distance.is_some() || leader.bearing.is_some());
            }
        }
    }
}

/// Pieces that are likely to hit something.
const PIECES: [&str; 24] = [
    "nan",
    "-inf",
    "1e999",
    "-1",
    "0",
    "\"\"",
    "[",
    "]",
    "{",
    "}",
    "=",
    "\n",
    "\"",
    "[[robots]]",
    "leader = \"leader\"",
    "\u{1F697}",
    "\u{0}",
    "name",
    ".",
    "1979-05-27",
    "'''",
    "0x7fffffffffffffff",
    "999999999999999999999",
    "ä",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_text(text in "\\PC{0,200}") {
        try_out(&text, &[]);
    }

    #[test]
    fn shipped_scenes_with_pieces_replaced(
        which in 0usize..100,
        edits in prop::collection::vec((0.0f64..1.0, 0usize..12, 0usize..PIECES.len()), 1..4),
    ) {
        let mut text = scene(which);
        for (share, length, piece) in edits {
            let boundary = |at: usize| (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
            let start = boundary((share * text.len() as f64) as usize);
            let end = boundary(start + length).max(start);
            text.replace_range(start..end, PIECES[piece]);
        }
        try_out(&text, &[]);
    }

    #[test]
    fn any_override(
        which in 0usize..100,
        path in "(time|law|robots|groups|observer|ground|props|patterns|vehicle|physics|[a-z]{1,5})\
                (\\.(0|1|leader|follower-1|k|path|distance|kind|cell|region|mass|step|count|prop|size|spring|[a-z]{1,4})){0,3}",
        value in "(nan|inf|-1|0|1e9|0.001|3|rough|car|cone|\\[0,0,9,9\\]|\\[\\]|\\{\\}|\\[1,2\\]|\\PC{0,12})",
    ) {
        if let Ok(change) = format!("{path}={value}").parse() {
            try_out(&scene(which), &[change]);
        }
    }
}

#[test]
fn deep_nesting_and_many_faults() {
    try_out(&format!("a = {}", "[".repeat(10_000)), &[]);
    try_out(&format!("a = {}{}", "[".repeat(200), "]".repeat(200)), &[]);
    try_out(&(0..10_000).map(|n| format!("key{n} = 1")).collect::<Vec<_>>().join("\n"), &[]);
    try_out(&"[[robots]]\nname = \"a\"\n".repeat(5_000), &[]);
    let robot = |n| format!("[[robots]]\nname = \"r{n}\"\npose = [0, 0, 0]\nleader = \"q{n}\"\n");
    try_out(&(0..5_000).map(robot).collect::<Vec<_>>().concat(), &[]);
}

/// A path that goes down for ever would take the stack with it.
#[test]
fn endless_paths_are_refused() {
    let endless = format!("{}b=1", "a.".repeat(60_000));
    let fault = endless.parse::<scene::Override>().unwrap_err().to_string();
    assert!(fault.contains("60001 parts"), "{fault}");
    let mut text = scene::SceneText::parse("schema = 1\n").unwrap();
    assert!(text.set(&"a.".repeat(60_000), "1").is_err());
    assert!(text.set(&format!("{}b", "a.".repeat(60_000)), "1").is_err());
}
