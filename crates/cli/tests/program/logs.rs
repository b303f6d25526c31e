//! Logs through the program: pictures of what was recorded, and `echelon diff`.

use crate::common::{echelon, files, scene, told};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Records two seconds of a scene as `folder`/`run`.
fn record(folder: &Path, run: &str, name: &str, more: &[&str]) {
    let scene = scene(name);
    let mut args = vec!["run", &*scene, "-q", "-o", run, "--set", "time.duration=2", "--set", "expect={}"];
    args.extend(more);
    let (code, _, err) = told(&echelon(folder, &args));
    assert_eq!(code, 0, "{err}");
}

/// What is drawn in a PNG file, without the words about it.
fn drawn(path: &Path) -> Vec<u8> {
    let bytes = fs::read(path).expect("a picture");
    let (mut at, mut data) = (8, vec![]);
    while let Some(head) = bytes.get(at..at + 8) {
        let length = u32::from_be_bytes(head[..4].try_into().expect("four bytes")) as usize;
        if matches!(&head[4..], b"IHDR" | b"IDAT") {
            data.extend_from_slice(&bytes[at + 8..at + 8 + length]);
        }
        at += 12 + length;
    }
    assert!(data.len() > 1000);
    data
}

/// Cars that sway and crates that fall: pictures of the log are those of the simulation, of the log alone too.
#[test]
fn pictures_of_a_log_are_those_of_the_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |path: &str| folder.path().join(path);
    let set = ["--set", "time.duration=2", "--set", "expect={}"];
    let look = ["--size", "320x180", "-q"];
    record(folder.path(), "run", "cars-yard", &[]);
    fs::rename(at("run/log.mcap"), at("alone.mcap")).expect("moved");
    let scene = scene("cars-yard");
    let capture = [&["capture", &*scene, "--at", "0.123,2", "-o", "made"], &set[..], &look[..]].concat();
    let replay = [&["replay", "alone.mcap", "--capture", "0.123,2", "-o", "told"], &look[..]].concat();
    for args in [capture, replay] {
        let (code, _, err) = told(&echelon(folder.path(), &args));
        assert_eq!(code, 0, "{err}");
    }
    for time in ["000.123", "002.000"] {
        let made = drawn(&at(&format!("made/cars-yard-{time}.png")));
        assert!(made == drawn(&at(&format!("told/alone-{time}.png"))), "at {time} s");
    }
    let (code, out, err) = told(&echelon(folder.path(), &["replay", "alone.mcap"]));
    assert!(code == 0 && out.contains("same: bit for bit"), "{out}{err}");
}

/// Of a run that was cut off, what there is.
#[test]
fn a_film_of_a_log_that_was_cut_off_ends_where_the_log_does() {
    let folder = tempfile::tempdir().expect("a folder");
    record(folder.path(), "run", "circle-three", &["--set", "time.duration=5"]);
    let bytes = fs::read(folder.path().join("run/log.mcap")).expect("a log");
    fs::write(folder.path().join("cut.mcap"), &bytes[..bytes.len() * 6 / 10]).expect("written");
    let args = ["replay", "cut.mcap", "--film", "film.mp4", "--size", "160x90", "--fps", "10", "--json"];
    let (code, out, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    let report: Value = serde_json::from_str(&out).expect("JSON");
    let frames = report["frames"].as_u64().expect("a number");
    assert!((10..45).contains(&frames), "{frames} frames");
    assert!(folder.path().join("film.mp4").exists());
    let (code, out, err) = told(&echelon(folder.path(), &["replay", "cut.mcap"]));
    assert!(code == 0 && out.contains("cut off") && out.contains("same"), "{out}{err}");
}

#[test]
fn runs_that_differ_are_told_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    record(folder.path(), "a", "circle-three", &[]);
    record(folder.path(), "b", "circle-three", &[]);
    record(folder.path(), "c", "circle-three", &["--set", "robots.follower-1.distance=2.5"]);
    record(folder.path(), "d", "seven-v", &[]);
    record(folder.path(), "e", "circle-three", &["--no-log"]);
    let diff = |args: &[&str]| told(&echelon(folder.path(), &[&["diff"], args].concat()));
    let (code, out, err) = diff(&["a", "b/log.mcap"]);
    assert!(code == 0 && out.contains("same: bit for bit, 201 samples"), "{out}{err}");
    let (code, out, _) = diff(&["a", "c"]);
    assert_eq!(code, 1);
    for words in [
        "robots.follower-1",
        "distance: 2.0 | 2.5",
        "first at 0.000 s, sample 0: set distance of edge leader → follower-1",
        "edge leader → follower-1",
    ] {
        assert!(out.contains(words), "`{words}` is missing:\n{out}");
    }
    assert!(!out.contains("follower-2"), "it goes its way:\n{out}");
    let (code, out, _) = diff(&["a", "c", "--json"]);
    let report: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(
        (code, &report["same"], &report["records"]["first"]["unit"]),
        (1, &Value::Bool(false), &"m".into())
    );
    record(folder.path(), "f", "circle-three", &["--set", "robots.follower-1.distance=2.0000000001"]);
    let (code, _, _) = diff(&["a", "f", "-q"]);
    assert_eq!(code, 1);
    let (code, out, _) = diff(&["a", "f", "--tolerance", "0.001"]);
    assert_eq!(code, 0, "{out}");
    let (code, out, _) = diff(&["a", "d"]);
    assert!(code == 1 && out.contains("other robots or edges"), "{out}");
    let (code, out, _) = diff(&["a", "e"]);
    assert!(code == 0 && out.contains("by their digests"), "{out}");
    let (code, out, _) = diff(&["c", "e"]);
    assert!(code == 1 && out.contains("not two logs"), "{out}");
    let (code, out, err) = diff(&["a", "nowhere"]);
    assert!(code == 2 && out.is_empty() && err.contains("is neither a run folder nor a log"), "{err}");
    let (code, _, err) = diff(&["a", "c", "--tolerance", "-1"]);
    assert_eq!(code, 2, "{err}");
}

#[test]
fn what_cannot_be_drawn_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    record(folder.path(), "run", "circle-three", &["--no-log"]);
    let before = files(folder.path());
    let refused = |args: &[&str], why: &str| {
        let (code, out, err) = told(&echelon(folder.path(), &[&["replay", "run", "-q"], args].concat()));
        assert!(code == 2 && out.is_empty() && err.contains(why), "{err}");
    };
    refused(&["--film", "x.mp4"], "has no log.mcap");
    fs::write(folder.path().join("run/log.mcap"), "notes").expect("written");
    refused(&["--film", "x.mp4"], "does not begin as MCAP files do");
    refused(&["--capture", "-1"], "does not begin as MCAP files do");
    assert_eq!(files(folder.path()).len(), before.len() + 1);
    fs::remove_file(folder.path().join("run/log.mcap")).expect("removed");
    record(folder.path(), "other", "circle-three", &[]);
    fs::copy(folder.path().join("other/log.mcap"), folder.path().join("run/log.mcap")).expect("copied");
    refused(&["--capture", "3"], "times are from 0 to 2 s");
    refused(&["--capture", "1", "--film", "x.mp4"], "cannot be used with");
    // A folder that holds a run is not written over.
    let scene = scene("line-three");
    let (code, _, err) = told(&echelon(folder.path(), &["run", &scene, "-o", "run"]));
    assert!(code == 2 && err.contains("--force"), "{err}");
}

/// A log that another program wrote may hold no scene: it was said to differ.
#[test]
fn a_log_without_a_scene_is_compared_by_its_moments() {
    let folder = tempfile::tempdir().expect("a folder");
    record(folder.path(), "run", "circle-three", &[]);
    let mut bytes = fs::read(folder.path().join("run/log.mcap")).expect("a log");
    // The library's name stands in the header, and says whose it is.
    let name_at = bytes.windows(8).position(|name| name == b"echelon ").expect("a header");
    bytes[name_at..name_at + 7].copy_from_slice(b"another");
    // Before its name an attachment (9) has its length, two times and the length of the name; 0x90 is nobody's record.
    let names: Vec<usize> = (29..bytes.len()).filter(|at| bytes[*at..].starts_with(b"scene.toml")).collect();
    let attachments: Vec<usize> = names.into_iter().map(|at| at - 29).filter(|at| bytes[*at] == 9).collect();
    assert_eq!(attachments.len(), 1);
    bytes[attachments[0]] = 0x90;
    fs::write(folder.path().join("bare.mcap"), bytes).expect("written");
    for args in [["diff", "run", "bare.mcap"], ["diff", "bare.mcap", "run"]] {
        let (code, out, err) = told(&echelon(folder.path(), &args));
        assert!(code == 0 && out.contains("bare.mcap: the log has no scene to compare"), "{out}{err}");
        assert!(!out.contains("differ") && out.contains("same: bit for bit, 201 samples"), "{out}");
        let (_, out, _) = told(&echelon(folder.path(), &[&args[..], &["--json"]].concat()));
        let report: Value = serde_json::from_str(&out).expect("JSON");
        assert_eq!((&report["scene"], &report["same"]), (&Value::Null, &Value::Bool(true)));
    }
}
