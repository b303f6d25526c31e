//! Followers that file in: who does, and what that needs.

mod common;

use common::{START, fault, load};
use scene::{Narrowing, Override, Scene};

fn rule(scene: &Scene, robot: usize) -> Narrowing {
    scene.robots[robot].role.follow().expect("a follower").narrowing
}

const NEEDS: &str = "law = { heading = \"path\" }\nproximity = { range = 8.0 }\n";

#[test]
fn a_scene_says_it_for_all_and_a_robot_for_itself() {
    let scene = load(&format!(
        "{NEEDS}narrowing = {{ narrows = true, spacing = 1.5 }}\n{START}narrowing = {{ spacing = 0.8 }}\n"
    ));
    let own = rule(&scene, 1);
    assert!(own.narrows && own.spacing == Some(0.8));
    let plain = load(START);
    assert_eq!(rule(&plain, 1), Narrowing::default());
    assert!(!plain.to_toml().contains("narrowing"), "what nobody asked for is not written");
    let text =
        START.replace("path = { kind = \"constant\" }", "path = { kind = \"constant\" }\nnarrowing = {}");
    assert!(fault(&text).contains("`narrowing` is for robots that follow, but `ann` leads"));
}

#[test]
fn groups_hand_it_to_their_followers() {
    let scene = load(
        r#"
schema = 1
title = "t"
[[groups]]
shape = "v"
count = 3
path = { kind = "constant" }
law = { heading = "path" }
proximity = { range = 8.0 }
narrowing = { narrows = true, stagger = 0.2 }
members.robot-3.narrowing = { narrows = false }
"#,
    );
    assert!(rule(&scene, 1).narrows && !rule(&scene, 2).narrows);
    assert_eq!(rule(&scene, 2).stagger, Some(0.2));
}

#[test]
fn defaults_grow_with_the_body() {
    let usual = Narrowing::default();
    assert_eq!((usual.spacing_of(0.42), usual.stagger_of(0.42), usual.room_of(0.42)), (1.0, 0.3, 0.08));
    assert_eq!((usual.rate_of(0.42), usual.acceleration_of(0.42)), (0.25, 0.4));
    assert!((usual.spacing_of(4.2) - 10.0).abs() < 1e-12 && (usual.rate_of(4.2) - 2.5).abs() < 1e-12);
    let own = Narrowing { spacing: Some(2.0), rate: Some(0.1), ..usual };
    assert_eq!((own.spacing_of(4.2), own.rate_of(4.2)), (2.0, 0.1));
}

#[test]
fn what_it_needs_is_asked_for() {
    for (keys, words) in [
        (
            "narrowing = { narrows = true }\nlaw = { heading = \"path\" }",
            "`bob` narrows, but senses nothing near it",
        ),
        ("narrowing = { narrows = true }\nproximity = { range = 8.0 }", "which needs `heading = \"path\"`"),
        (
            "narrowing = { narrows = true, spacing = 0.5 }\nlaw = { heading = \"path\" }\nproximity = { range = 8.0 }",
            "`spacing` of 0.5 m in the column is too little for `bob`: its body and the margin of its filter take 0.534 m",
        ),
        ("narrowing = { rate = 0.0 }", "above 0"),
        ("narrowing = { stagger = -0.1 }", "0"),
    ] {
        let found = fault(&format!("{keys}\n{START}"));
        assert!(found.contains(words), "{keys}: {found}");
    }
}

#[test]
fn it_may_change_during_a_run() {
    let text = format!("{NEEDS}{START}");
    let set: Override = "narrowing.narrows=true".parse().expect("an override");
    let after = Scene::parse(&text, "t.toml", &[set]).expect("a scene").scene;
    assert_eq!(load(&text).sets_to(&after).expect("a change"), ["robots.bob.narrowing.narrows=true"]);
    let changed = format!("{text}\n[[changes]]\nat = 3.0\nset = [\"narrowing.narrows=true\"]\n");
    let change = &load(&changed).changes[0];
    assert!(rule(&change.then, 1).narrows);
}

#[test]
fn an_expectation_after_the_end_of_the_run_is_told() {
    let scene = load(&format!("{START}\n[time]\nduration = 20.0\n[expect]\nwide_again_by = 30.0\n"));
    assert!(scene.late().iter().any(|line| line.contains("`wide_again_by` of 30 s is after the end")));
    let events = "\n[time]\nduration = 20.0\n[[events]]\nat = 25.0\nrobot = \"bob\"\nfails = \"stop\"\n";
    let late = load(&format!("{START}{events}")).late();
    assert_eq!(late, ["`events.0` at 25 s comes after the end of the run at 20 s"]);
}
