//! Bad input: one clear message, the right exit code, nothing half-written.

use crate::common::{echelon, files, scene, told};
use std::fs;
use std::path::Path;

const GOOD: &str = r#"schema = 1
title = "two"
[time]
duration = 1.0
period = 0.01
[[robots]]
name = "ann"
pose = [0, 0, 0]
path = { kind = "constant", speed = 1.0, turn_rate = 0.0 }
[[robots]]
name = "bob"
pose = [-2, -1, 0]
leader = "ann"
distance = 2.0
bearing = "-135 deg"
"#;

/// Runs `text` as a scene and expects exit code 2, every one of `words`, and no file but the scene.
fn refused(text: &[u8], words: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("bad.toml"), text).expect("written");
    for command in ["run", "capture", "film", "check"] {
        let (code, out, err) = told(&echelon(folder.path(), &[command, "bad.toml"]));
        assert_eq!((code, &*out), (2, ""), "{command}: {err}");
        for word in words {
            assert!(err.contains(word), "{command} does not say `{word}`:\n{err}");
        }
        assert!(!err.contains("panicked"), "{err}");
        assert_eq!(files(folder.path()).len(), 1, "{command} left something behind");
    }
}

/// [`GOOD`] with one text replaced.
fn with(from: &str, to: &str) -> Vec<u8> {
    assert!(GOOD.contains(from), "{from}");
    GOOD.replace(from, to).into_bytes()
}

#[test]
fn the_good_scene_is_good() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("good.toml"), GOOD).expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["run", "good.toml", "--no-record"]));
    assert_eq!(code, 0, "{err}");
}

#[test]
fn files_that_are_no_scenes() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, _, err) = told(&echelon(folder.path(), &["run", "nowhere.toml"]));
    assert!(code == 2 && err.contains("nowhere.toml"), "{err}");
    let (code, _, err) = told(&echelon(folder.path(), &["run", "."]));
    assert!(code == 2 && err.contains("is a directory"), "{err}");
    refused(b"", &["empty"]);
    refused(b"schema = 1\ntitle = \"\xff\xfe\"\n", &["UTF-8"]);
    refused(b"schema = = 1\n", &["bad.toml:1:"]);
}

#[test]
fn the_lab_opens_no_empty_window() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, words) in [
        ("circle-tree", &["circle-tree", "did you mean `circle-three`"][..]),
        ("no-such", &["no-such: no such file"]),
        ("no/such.toml", &["no/such.toml"]),
        ("lost.mcap", &["lost.mcap"]),
        ("lost.png", &["lost.png"]),
        ("#circle-tree", &["did you mean `circle-three`"]),
        (".", &["log.mcap"]),
    ] {
        let (code, _, err) = told(&echelon(folder.path(), &["lab", name]));
        assert_eq!(code, 2, "{name}: {err}");
        assert!(words.iter().all(|word| err.contains(word)), "{name}: {err}");
    }
}

#[test]
fn a_file_of_100_mb_is_refused_without_being_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.toml");
    fs::File::create(&path).and_then(|f| f.set_len(100 << 20)).expect("a sparse file");
    let (code, _, err) = told(&echelon(folder.path(), &["run", "large.toml"]));
    assert!(code == 2 && err.contains("10 MB"), "{err}");
}

#[test]
fn values_of_a_wrong_type_or_out_of_range() {
    refused(&with("duration = 1.0", "duration = \"long\""), &["bad.toml:4:", "duration", "number"]);
    refused(&with("duration = 1.0", "duration = nan"), &["bad.toml:4:", "duration"]);
    refused(&with("duration = 1.0", "duration = inf"), &["bad.toml:4:", "duration"]);
    refused(&with("distance = 2.0", "distance = -2.0"), &["bad.toml:14:", "distance"]);
    refused(&with("distance = 2.0", "distance = 0"), &["bad.toml:14:", "distance"]);
    refused(&with("\"-135 deg\"", "\"-200 deg\""), &["bad.toml:15:", "-180 deg to 180 deg"]);
    refused(&with("period = 0.01", "period = 2.0"), &["bad.toml:5:", "period", "duration"]);
    let epsilon = with("[time]", "[observer]\nepsilon = 0.0\n[time]");
    refused(&epsilon, &["bad.toml:4:", "epsilon"]);
    refused(&with("pose = [-2, -1, 0]", "pose = [-2, nan, 0]"), &["bad.toml:12:", "pose"]);
}

#[test]
fn names_that_do_not_fit() {
    refused(
        &with("duration = 1.0", "durration = 1.0"),
        &["bad.toml:4:1", "durration", "did you mean `duration`"],
    );
    refused(&with("leader = \"ann\"", "leader = \"anna\""), &["bad.toml:13:", "anna", "did you mean `ann`"]);
    refused(&with("name = \"bob\"", "name = \"ann\""), &["ann"]);
    refused(&with("leader = \"ann\"", "leader = \"bob\""), &["bob"]);
    let ring = GOOD.replace(
        "path = { kind = \"constant\", speed = 1.0, turn_rate = 0.0 }",
        "leader = \"bob\"\ndistance = 1.0\nbearing = 3.0",
    );
    refused(ring.as_bytes(), &["ann", "bob"]);
    refused(b"schema = 1\ntitle = \"none\"\nrobots = []\n", &["robot"]);
}

#[test]
fn an_observer_too_fast_for_continuous_time_is_refused() {
    let text = with("period = 0.01", "period = 0.01\nmode = \"continuous\"\n[observer]\nepsilon = 1e-9");
    refused(&text, &["bob", "0.00001 s", "sampled"]);
}

#[test]
fn several_mistakes_are_told_at_once() {
    let text = with("duration = 1.0", "durration = 1.0\nduration = -3");
    refused(&text, &["durration", "bad.toml:5:"]);
}

#[test]
fn one_robot_alone_is_a_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "schema = 1\ntitle = \"alone\"\n[time]\nduration = 1.0\n[[robots]]\nname = \"ann\"\npose = [0, 0, 0]\n\
        path = { kind = \"constant\", speed = 1.0, turn_rate = 0.2 }\n[expect]\nno_contact = true\n";
    fs::write(folder.path().join("alone.toml"), text).expect("written");
    let (code, out, err) = told(&echelon(folder.path(), &["run", "alone.toml", "--no-record"]));
    assert_eq!(code, 0, "{out}{err}");
    let (code, _, err) = told(&echelon(folder.path(), &["capture", "alone.toml", "--size", "64x48"]));
    assert_eq!(code, 0, "{err}");
}

/// Runs a command that draws, and expects `code`, `words`, and nothing left in the folder.
fn drawing_refused(args: &[&str], code: i32, words: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder");
    let (found, _, err) = told(&echelon(folder.path(), args));
    assert_eq!(found, code, "{args:?}: {err}");
    for word in words {
        assert!(err.contains(word), "{args:?} does not say `{word}`: {err}");
    }
    assert!(files(folder.path()).is_empty(), "{args:?} left {:?}", files(folder.path()));
}

#[test]
fn pictures_that_cannot_be() {
    let scene = scene("circle-three");
    for size in ["0x0", "100000x100000", "1x1"] {
        drawing_refused(&["capture", &scene, "--size", size], 2, &["pixels"]);
    }
    drawing_refused(&["capture", &scene, "--size", "wide"], 2, &["1280x720"]);
    drawing_refused(&["film", &scene, "--size", "321x240"], 2, &["even", "320"]);
    drawing_refused(&["film", &scene, "--fps", "0"], 2, &["1 to 240"]);
    drawing_refused(&["capture", &scene, "--at", "99"], 2, &["0 to 15"]);
    drawing_refused(&["capture", &scene, "--at=-1"], 2, &["0 to 15"]);
    drawing_refused(&["capture", &scene, "--at", "nan"], 2, &["0 to 15"]);
    drawing_refused(&["capture", &scene, "--view", "snak"], 2, &["snak", "did you mean", "snake-eye"]);
    drawing_refused(&["capture", &scene, "--view", "top+top+top+top+top"], 2, &["at most four"]);
    drawing_refused(&["capture", &scene, "--at", "-1"], 2, &["0 to 15"]);
    drawing_refused(&["capture", &scene, "--view", "follow:bob"], 2, &["bob"]);
    drawing_refused(&["capture", &scene, "--without", "lables"], 2, &["did you mean \"labels\""]);
    drawing_refused(&["capture", &scene, "--samples", "3"], 2, &["4"]);
    drawing_refused(&["capture", &scene, "--adapter", "voodoo"], 3, &["voodoo", "this machine has"]);
    drawing_refused(&["film", &scene, "--adapter", "voodoo", "-o", "film.mp4"], 3, &["voodoo"]);
}

#[test]
fn overrides_that_lead_nowhere() {
    let scene = scene("circle-three");
    drawing_refused(&["run", &scene, "--set", "time.duration"], 2, &["path.to.key=value"]);
    drawing_refused(
        &["run", &scene, "--set", "time.duratoin=3"],
        2,
        &["duratoin", "did you mean `duration`"],
    );
    drawing_refused(&["run", &scene, "--set", "law.k=-3"], 2, &["law.k=-3", "k"]);
}

/// 1e-320 was told with all its zeros.
#[test]
fn numbers_in_messages_can_be_read() {
    let scene = scene("line-three");
    drawing_refused(&["film", &scene, "--fps", "1e-320"], 2, &["error: 1e-320 frames a second"]);
    drawing_refused(&["capture", &scene, "--at", "1e300"], 2, &["error: 1e300 s is not within the run"]);
    drawing_refused(&["run", &scene, "--set", "time.duration=1e-320"], 2, &["`duration` of 1e-320 s"]);
    drawing_refused(&["check", &scene, "--set", "robots.1.distance=1e-320"], 2, &["falls to 1e-320 m"]);
    let args = [
        "run",
        &scene,
        "--no-record",
        "-q",
        "--set",
        "time.duration=1",
        "--set",
        "expect={final_distance_error=1e-320}",
    ];
    drawing_refused(&args, 1, &["≤ 1e-320 m"]);
}

#[cfg(target_os = "linux")]
#[test]
fn places_that_cannot_be_written() {
    let scene = scene("line-three");
    for args in [
        ["run", &scene, "-o", "/proc/nowhere/run"],
        ["capture", &scene, "-o", "/proc/nowhere/pictures"],
        ["film", &scene, "-o", "/proc/nowhere/film.mp4"],
    ] {
        drawing_refused(&args, 3, &["/proc/nowhere"]);
    }
    assert!(!Path::new("/proc/nowhere").exists());
}
