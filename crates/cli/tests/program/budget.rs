//! `echelon budget`: what it prints and writes, and what it refuses.

use crate::common::{echelon, files, scene, told};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A short run by corners of tags.
fn short<'a>(scene: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let args =
        ["budget", scene, "--no-camera", "--set", "time.duration=4", "--set", "expect.settled_after=2"];
    [&args[..], more].concat()
}

fn json(args: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, err) = told(&echelon(folder.path(), args));
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).expect("JSON only on standard output")
}

/// Root mean square error of the measured distances, by level, of the first edge with the first observer.
fn measurement_errors(value: &Value) -> Vec<f64> {
    let runs = value["runs"].as_array().expect("runs").iter();
    let geometric = runs.filter(|r| r["sensing"] == "geometric" && r["observer"] == "high-gain");
    geometric.map(|r| r["edges"][0]["measurements"][0].as_f64().expect("a number")).collect()
}

#[test]
fn errors_grow_with_the_noise_of_corners() {
    let scene = scene("vision-circle-three");
    let args = short(&scene, &["--pixel-noise", "0,1,0.1", "--json"]);
    let value = json(&args);
    assert_eq!(value["runs"].as_array().map(Vec::len), Some(7), "truth, and three levels with two observers");
    assert_eq!(value["status"], "complete");
    let errors = measurement_errors(&value);
    assert!(errors.windows(2).all(|w| w[1] > 2.0 * w[0]), "{errors:?}");
    assert!(value["without_camera"].as_str().is_some_and(|why| why.contains("--no-camera")));
    let slope = &value["scaling"][0]["measurements"][0]["slope"];
    assert!(slope.as_f64().is_some_and(|s| s > 0.0), "{slope}");
    assert_eq!(value, json(&args), "the same again");
}

#[test]
fn the_table_has_every_level_and_the_folder_every_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("vision-circle-three");
    let args = short(&scene, &["--pixel-noise", "0.05,0.5", "-o", "out"]);
    let (code, out, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    for word in ["truth", "geometric 0.05 px", "geometric 0.5 px", "unscented", "→ follower-2", "no camera"]
    {
        assert!(out.contains(word), "`{word}` is not in\n{out}");
    }
    let names: Vec<String> = files(folder.path())
        .iter()
        .filter_map(|p| Some(p.file_name()?.to_string_lossy().into_owned()))
        .collect();
    assert_eq!(names, ["budget.csv", "budget.json", "budget.svg"]);
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).expect("text");
    let csv = read("budget.csv");
    // A title, and two edges of truth and of two levels with two observers.
    assert_eq!(csv.lines().count(), 11);
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(columns.iter().all(|c| *c == columns[0]), "{columns:?}");
    assert!(read("budget.svg").contains("noise of a tag's corners (px)"));
}

#[test]
fn observer_constants_are_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("vision-epsilon");
    // Far more than the camera's, so that four seconds show it.
    let more =
        ["--set", "time.duration=4", "--set", "sensing.pixel_noise=1", "--epsilon", "0.001,0.03", "-o", "."];
    let args = [&["budget", &scene, "--no-camera"][..], &more].concat();
    let (code, out, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    for word in ["ε 0.001 s", "ε 0.03 s", "ε adaptive"] {
        assert!(out.contains(word), "`{word}` is not in\n{out}");
    }
    let text = fs::read_to_string(folder.path().join("epsilon.json")).expect("text");
    let value: Value = serde_json::from_str(&text).expect("JSON");
    let rate = |run: usize| value["runs"][run]["edges"][0]["rate_error"][0].as_f64().expect("a number");
    assert!(rate(0) > 3.0 * rate(1), "a fast observer makes noise of noise: {} {}", rate(0), rate(1));
}

fn refused(args: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, err) = told(&echelon(folder.path(), args));
    assert_eq!((code, &*out), (2, ""), "{args:?}: {err}");
    for word in words {
        assert!(err.contains(word), "{args:?} does not say `{word}`: {err}");
    }
    assert!(files(folder.path()).is_empty());
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let scene = scene("vision-circle-three");
    let with = |more: &[&'static str]| [&["budget", &scene, "--no-camera"][..], more].concat();
    refused(&with(&["--pixel-noise=-1"]), &["0 to 50"]);
    refused(&with(&["--pixel-noise", "0.1,much"]), &["0 to 50"]);
    refused(&with(&["--epsilon", "0"]), &["0.000001"]);
    refused(&with(&["--epsilon", "0.1", "--pixel-noise", "1"]), &["cannot be used"]);
    refused(&with(&["--set", "sensing.kind=truth", "--set", "law.kind=full-state"]), &["output-feedback"]);
    refused(&with(&["--set", "sensing.kind=truth", "--set", "time.mode=continuous"]), &["time.mode=sampled"]);
    let folder = tempfile::tempdir().expect("a folder");
    let alone = "schema = 1\ntitle = \"alone\"\n[time]\nduration = 1.0\n[[robots]]\nname = \"ann\"\npose = [0, 0, 0]\n\
        path = { kind = \"constant\", speed = 1.0 }\n";
    let path = folder.path().join("alone.toml");
    fs::write(&path, alone).expect("written");
    refused(&["budget", &path.display().to_string()], &["no followers", "leader"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_place_that_cannot_be_written_is_said_before_the_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("vision-circle-three");
    let (code, _, err) =
        told(&echelon(folder.path(), &["budget", &scene, "--no-camera", "-o", "/proc/nowhere/b"]));
    assert!(code == 3 && err.contains("/proc/nowhere/b"), "{err}");
    assert!(!Path::new("/proc/nowhere").exists());
}
