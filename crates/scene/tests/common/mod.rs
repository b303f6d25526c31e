//! What tests of scenes share.

use scene::Scene;

/// A robot that leads and one that follows it.
pub(crate) const START: &str = r#"
schema = 1
title = "t"
[[robots]]
name = "ann"
pose = [0.0, 0.0, 0.0]
path = { kind = "constant" }
[[robots]]
name = "bob"
pose = [-2.0, -1.0, 0.0]
leader = "ann"
distance = 2.0
bearing = "-135 deg"
"#;

/// The scene, which is the same once it has been written.
pub(crate) fn load(text: &str) -> Scene {
    let scene = Scene::parse(text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let written = scene.to_toml();
    let again = Scene::parse(&written, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}\n{written}"));
    assert_eq!(scene, again.scene, "{written}");
    scene
}

/// Why a scene is none.
pub(crate) fn fault(text: &str) -> String {
    Scene::parse(text, "t.toml", &[]).expect_err("a fault").to_string()
}
