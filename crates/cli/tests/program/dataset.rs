//! `echelon dataset` and `echelon accuracy`: what they write, and what they refuse.

use crate::common::{echelon, files, scene, told};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn read(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).expect("a file")).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().expect("a number")],
    }
}

#[test]
fn a_data_set_holds_pictures_truth_and_what_was_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("circle-three");
    let args = ["dataset", &scene, "-o", "set", "--every", "4", "--json"];
    let (code, out, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    let report: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!((&report["status"], &report["summary"]["pictures"]), (&"complete".into(), &8.into()));
    let set = folder.path().join("set");
    assert_eq!(files(&set.join("pictures")).len(), 8);
    assert_eq!(files(&set).len(), 10, "{:?}", files(&set));
    let data = read(&set.join("dataset.json"));
    assert_eq!(data["cameras"].as_array().map(Vec::len), Some(2));
    let mut located = 0;
    for picture in data["pictures"].as_array().expect("pictures") {
        let bytes = fs::read(set.join(picture["file"].as_str().expect("a name"))).expect("a picture");
        // Width and height, eight bits, grey.
        assert_eq!(&bytes[16..26], [0, 0, 2, 128, 0, 0, 1, 224, 8, 0]);
        assert!(picture["tags"].as_array().is_some_and(|tags| tags.len() >= 2), "{picture}");
        for found in picture["detected"].as_array().expect("a list") {
            let truth =
                picture["tags"].as_array().and_then(|tags| tags.iter().find(|t| t["id"] == found["id"]));
            let (a, b) = (numbers(&found["corners"]), numbers(&truth.expect("it is there")["corners"]));
            // Corners that could not be measured anew are the detector's, and say so.
            let most = if found["deviation"].as_f64().is_some_and(|d| d < 0.2) { 1.0 } else { 6.0 };
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < most), "{a:?} {b:?}");
        }
        let estimate = &picture["leader"]["estimate"];
        if estimate.is_object() {
            located += 1;
            assert!(estimate["errors"]["range"].as_f64().is_some_and(|e| e.abs() < 0.02), "{estimate}");
        }
    }
    assert!(located >= 7, "{located} of 8");
    let coco = read(&set.join("coco.json"));
    assert_eq!(coco["images"].as_array().map(Vec::len), Some(8));
    let notes = coco["annotations"].as_array().expect("annotations");
    assert_eq!(notes.len() as u64, report["summary"]["tags"].as_u64().expect("a count"));
    assert!(notes.iter().all(|note| note["keypoints"].as_array().map(Vec::len) == Some(12)));
}

#[test]
fn the_same_data_set_twice_is_the_same_and_another_seed_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("circle-three");
    let picture = |out: &str, more: &[&str]| {
        let args = ["dataset", &scene, "-o", out, "--every", "10", "--edges", "follower-2", "-q", "--whole"];
        let (code, _, err) = told(&echelon(folder.path(), &[&args[..], more].concat()));
        assert_eq!(code, 0, "{err}");
        let found = files(&folder.path().join(out).join("pictures"));
        assert_eq!(found.len(), 2);
        fs::read(&found[1]).expect("a picture")
    };
    let first = picture("a", &[]);
    assert!(first == picture("b", &[]));
    assert!(first != picture("c", &["--seed", "99"]));
}

#[test]
fn other_files_and_earlier_data_sets_are_not_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("circle-three");
    let args = ["dataset", &scene, "-o", "set", "--every", "20", "-q"];
    let set = folder.path().join("set");
    fs::create_dir(&set).expect("made");
    fs::write(set.join("thesis.tex"), "years").expect("written");
    for more in [&[][..], &["--force"]] {
        let (code, _, err) = told(&echelon(folder.path(), &[&args[..], more].concat()));
        assert!(code == 2 && err.contains("other files"), "{code}: {err}");
    }
    assert_eq!(files(&set).len(), 1);
    fs::remove_file(set.join("thesis.tex")).expect("removed");
    assert_eq!(told(&echelon(folder.path(), &args)).0, 0);
    let (code, _, err) = told(&echelon(folder.path(), &args));
    assert!(code == 2 && err.contains("--force") && err.contains("data set"), "{code}: {err}");
    assert_eq!(told(&echelon(folder.path(), &[&args[..], &["--force"]].concat())).0, 0);
    fs::write(folder.path().join("file"), "").expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["dataset", &scene, "-o", "file"]));
    assert!(code == 2 && err.contains("is a file"), "{code}: {err}");
}

#[test]
fn data_sets_that_cannot_be() {
    let folder = tempfile::tempdir().expect("a folder");
    let alone = "schema = 1\ntitle = \"alone\"\n[time]\nduration = 1.0\n[[robots]]\nname = \"ann\"\npose = [0, 0, 0]\n\
        path = { kind = \"constant\", speed = 1.0, turn_rate = 0.2 }\n";
    fs::write(folder.path().join("alone.toml"), alone).expect("written");
    let scene = scene("circle-three");
    let refused = |args: &[&str], code: i32, words: &[&str]| {
        let (found, _, err) = told(&echelon(folder.path(), args));
        assert_eq!(found, code, "{args:?}: {err}");
        for word in words {
            assert!(err.contains(word), "{args:?} does not say `{word}`: {err}");
        }
        assert!(!err.contains("panicked") && files(folder.path()).len() == 1, "{err}");
    };
    for every in ["0", "nan", "inf", "1e-9", "often"] {
        refused(&["dataset", &scene, "-o", "set", "--every", every], 2, &["--every", "0.001"]);
    }
    refused(&["dataset", &scene, "-o", "set", "--every=-1"], 2, &["0.001"]);
    refused(&["dataset", &scene], 2, &["--out"]);
    let words = ["--edges leader", "follower-1, follower-2"];
    refused(&["dataset", &scene, "-o", "set", "--edges", "follower-1,leader"], 2, &words);
    refused(&["dataset", "alone.toml", "-o", "set"], 2, &["no followers"]);
    refused(&["dataset", "nowhere.toml", "-o", "set"], 2, &["nowhere.toml"]);
    refused(&["dataset", &scene, "-o", "set", "--adapter", "voodoo"], 3, &["voodoo"]);
    refused(&["accuracy", "--poses", "0"], 2, &["--poses"]);
    refused(&["accuracy", "--poses", "6", "--adapter", "voodoo"], 3, &["voodoo"]);
    if cfg!(target_os = "linux") {
        refused(&["dataset", &scene, "-o", "/proc/nowhere/set"], 3, &["/proc/nowhere"]);
    }
}

#[test]
fn accuracy_tells_every_bin_and_does_not_depend_on_chance() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = || {
        let (code, out, err) = told(&echelon(folder.path(), &["accuracy", "--poses", "48", "--json"]));
        assert_eq!(code, 0, "{err}");
        serde_json::from_str::<Value>(&out).expect("JSON")
    };
    let value = run();
    let bins = value["bins"].as_array().expect("bins");
    assert!(bins.len() == 6 && bins.iter().all(|bin| bin["poses"] == 8), "{value:#}");
    assert!(bins.iter().all(|bin| bin["wrong"] == 0), "{value:#}");
    assert!(bins[1]["refined"]["views"].as_u64().is_some_and(|n| n > 0), "{value:#}");
    assert_eq!(value["bins"], run()["bins"]);
    let (code, out, err) = told(&echelon(folder.path(), &["accuracy", "--poses", "6", "--seed", "2"]));
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("POSIT alone") && out.contains("5–6 m") && out.contains("median ms"), "{out}");
}
