//! Safety filters and proximity sensors: who has them, and what they need.

mod common;

use common::{START, fault, load};
use scene::{Override, Safety, Scene, VehicleKind};

#[test]
fn a_scene_says_it_for_all_and_a_robot_for_itself() {
    let own = "safety = { margin = 0.2 }\nproximity = { range = 3.0, rate = 20.0 }\n";
    let scene = load(&format!("safety = {{ filter = true }}\nproximity = {{ range = 5.0 }}\n{START}{own}"));
    let [ann, bob] = [&scene.robots[0], &scene.robots[1]];
    assert!(ann.safety.filter && !ann.safety.acts(true) && bob.safety.acts(false));
    assert_eq!((ann.proximity.range, bob.proximity.range), (Some(5.0), Some(3.0)));
    assert_eq!((ann.safety.margin, bob.safety.margin), (None, Some(0.2)));
    assert_eq!(bob.proximity.rate, Some(20.0));
    let plain = load(START);
    assert_eq!(plain.robots[1].safety, Safety::default());
    assert!(!plain.to_toml().contains("safety"), "what nobody asked for is not written");
}

#[test]
fn groups_hand_it_to_their_members_and_to_their_leader() {
    let scene = load(
        r#"
schema = 1
title = "t"
[[groups]]
shape = "v"
count = 3
path = { kind = "constant" }
proximity = { range = 3.0 }
safety = { filter = true, leads = true }
members.robot-3.safety = { filter = false }
members.robot-1.safety = { margin = 0.1 }
"#,
    );
    let acts: Vec<bool> =
        scene.robots.iter().map(|robot| robot.safety.acts(robot.role.follow().is_none())).collect();
    assert_eq!(acts, [true, true, false]);
    assert_eq!(scene.robots[0].safety.margin, Some(0.1));
}

#[test]
fn defaults_fit_the_vehicle() {
    let safety = Safety::default();
    assert_eq!((safety.margin_of(0.42), safety.gain), (0.05, 2.0));
    assert_eq!(safety.point_ahead_of(VehicleKind::Differential, 0.42), 0.1);
    assert_eq!(safety.point_ahead_of(VehicleKind::Car, 0.42), 0.3);
    assert!((safety.point_ahead_of(VehicleKind::FullSizeCar, 4.2) - 3.0).abs() < 1e-12);
}

#[test]
fn what_a_filter_needs_is_asked_for() {
    let with = |keys: &str| fault(&format!("{keys}\n{START}"));
    for (keys, words) in [
        ("safety = { filter = true }", "`bob` has a safety filter, but senses nothing near it"),
        (
            "safety = { filter = true }\nproximity = { range = 0.3 }",
            "within which its safety filter can no longer stop it",
        ),
        (
            "safety = { filter = true, view_distance = 6.0 }\nproximity = { range = 4.0 }",
            "beyond its `proximity`, whose `range` is 4 m",
        ),
        (
            "safety = { filter = true }\nproximity = { range = 4.0 }\ntime = { mode = \"continuous\" }",
            "mode `continuous` has no control samples",
        ),
        (
            "safety = { filter = true, arena = [-3, -3, -2.5, 3] }\nproximity = { range = 4.0 }",
            "is 0.5 m across",
        ),
        (
            "safety = { filter = true, arena = [0, 0, 5, 5] }\nproximity = { range = 4.0 }",
            "`bob` starts at [-2, -1], outside its `arena`",
        ),
        (
            "safety = { filter = true, margin = 2.0 }\nproximity = { range = 4.0 }",
            "`bob` and `ann` start nearer to each other than the safety filter of `bob` keeps them",
        ),
        ("safety = { gain = 0.0 }", "above 0"),
        ("proximity = { range = -1.0 }", "above 0"),
    ] {
        let found = with(keys);
        assert!(found.contains(words), "{keys}: {found}");
    }
    // A leader that keeps to its path needs nothing.
    load(&format!(
        "safety = {{ filter = true }}\n{START}proximity = {{ range = 4.0 }}\n[time]\nmode = \"sampled\"\n"
    ));
}

#[test]
fn a_filter_may_change_during_a_run_but_not_that_of_a_lead() {
    let text = format!("proximity = {{ range = 4.0 }}\n{START}");
    let before = load(&text);
    let after = |set: &str| {
        let set: Override = set.parse().expect("an override");
        Scene::parse(&text, "t.toml", &[set]).expect("a scene").scene
    };
    assert_eq!(
        before.sets_to(&after("safety.filter=true")).expect("no lead is filtered"),
        ["robots.ann.safety.filter=true", "robots.bob.safety.filter=true"]
    );
    let lead = ["safety.filter=true", "safety.leads=true"].map(|set| set.parse().expect("an override"));
    let lead = Scene::parse(&text, "t.toml", &lead).expect("a scene").scene;
    let why = before.sets_to(&lead).expect_err("a lead that chases its path is driven otherwise");
    assert!(why.iter().any(|line| line.contains("robots.ann.safety.filter")), "{why:?}");
    let sets = before.sets_to(&after("robots.bob.safety.filter=true")).expect("a change");
    assert_eq!(sets, ["robots.bob.safety.filter=true"]);
    let changed = format!(
        "{text}\n[[changes]]\nat = 3.0\nset = [\"robots.bob.safety.filter=true\", \"robots.bob.safety.gain=3.0\"]\n"
    );
    let change = &load(&changed).changes[0];
    assert!(change.then.robots[1].safety.filter);
    let wrong = format!("{START}\n[[changes]]\nat = 3.0\nset = [\"robots.bob.safety.filter=true\"]\n");
    assert!(fault(&wrong).contains("senses nothing near it"));
}
