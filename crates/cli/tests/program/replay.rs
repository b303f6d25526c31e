//! `echelon replay`: recorded runs come out the same again, and what differs is told.

use crate::common::{echelon, scene, told};
use recording::{Manifest, Status};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Records a short run into a folder of its own.
fn record(folder: &Path, name: &str) -> PathBuf {
    let run = folder.join("run");
    let out = run.display().to_string();
    let args = ["run", &scene(name), "-q", "-o", &out, "--set", "time.duration=2", "--set", "expect={}"];
    let (code, _, err) = told(&echelon(folder, &args));
    assert_eq!(code, 0, "{err}");
    run
}

fn edit(run: &Path, work: impl FnOnce(&mut Manifest)) {
    let path = run.join("manifest.json");
    let mut manifest: Manifest =
        serde_json::from_str(&fs::read_to_string(&path).expect("a manifest")).expect("valid");
    work(&mut manifest);
    fs::write(&path, serde_json::to_string(&manifest).expect("JSON")).expect("written");
}

#[test]
fn a_run_comes_out_the_same_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = record(folder.path(), "circle-three");
    let (code, out, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("201 samples, 2.00 s") && out.contains("same: bit for bit"), "{out}");
    let (code, out, _) = told(&echelon(folder.path(), &["replay", "run", "--json"]));
    let report: Value = serde_json::from_str(&out).expect("JSON only");
    assert_eq!((code, &report["same"]), (0, &Value::Bool(true)));
    assert_eq!(report["recorded"]["digest"], report["now"]["digest"]);
    edit(&run, |manifest| manifest.program = "echelon 0.0.1".to_owned());
    let (code, out, _) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 0 && out.contains("recorded by echelon 0.0.1"), "{out}");
}

#[test]
fn what_differs_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = record(folder.path(), "circle-three");
    let path = run.join("scene.toml");
    let text = fs::read_to_string(&path).expect("a scene");
    fs::write(&path, text.replacen("distance = 2.0", "distance = 2.1", 1)).expect("written");
    let (code, out, _) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 1 && out.contains("DIFFERENT"), "{out}");
    let (code, out, err) = told(&echelon(folder.path(), &["replay", "run", "-q"]));
    assert!(code == 1 && out.is_empty() && err.contains("DIFFERENT"), "{out}{err}");
    fs::write(&path, text.replacen("duration = 2.0", "duration = 1.0", 1)).expect("written");
    let (code, out, _) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 1 && out.contains("it had 201 samples when it was recorded, and has 101 now"), "{out}");
}

/// An interrupted run is compared over the samples it has.
#[test]
fn an_interrupted_run_is_compared_as_far_as_it_went() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = record(folder.path(), "circle-three");
    let path = run.join("scene.toml");
    let text = fs::read_to_string(&path).expect("a scene");
    fs::write(&path, text.replacen("duration = 2.0", "duration = 9.0", 1)).expect("written");
    edit(&run, |manifest| manifest.status = Status::Interrupted);
    let (code, out, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 0 && out.contains("interrupted") && out.contains("same"), "{out}{err}");
    // Of a run that was killed the log tells.
    edit(&run, |manifest| (manifest.digest, manifest.status, manifest.samples) = (None, Status::Running, 0));
    let (code, out, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 0 && out.contains("201 samples") && out.contains("cut off"), "{out}{err}");
    fs::remove_file(run.join("log.mcap")).expect("removed");
    let (code, _, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 2 && err.contains("no digest and no log"), "{err}");
}

#[test]
fn what_is_no_run_folder_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("notes.txt"), "mine").expect("written");
    for (path, why) in
        [(".", "is not a run folder"), ("nowhere", "is neither a run folder"), ("notes.txt", "is not a log")]
    {
        let (code, out, err) = told(&echelon(folder.path(), &["replay", path]));
        assert!(code == 2 && out.is_empty() && err.contains(why), "{err}");
    }
    fs::write(folder.path().join("manifest.json"), "{}").expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["replay", "."]));
    assert!(code == 2 && err.contains("not the manifest of a run"), "{err}");
    let run = record(folder.path(), "line-three");
    fs::remove_file(run.join("scene.toml")).expect("removed");
    let (code, _, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert_eq!(code, 0, "the log knows the scene: {err}");
    fs::remove_file(run.join("log.mcap")).expect("removed");
    let (code, _, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 2 && err.contains("scene.toml"), "{err}");
}

#[test]
fn a_log_that_stands_in_for_a_broken_manifest_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = record(folder.path(), "line-three");
    fs::write(run.join("manifest.json"), "{ \"program\": ").expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 0 && err.contains("run/manifest.json is not the manifest of a run"), "{err}");
    assert!(err.contains("log.mcap stands in for it"), "{err}");
    // One that is not there at all was not written, as where a log came alone.
    fs::remove_file(run.join("manifest.json")).expect("removed");
    let (code, _, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 0 && !err.contains("manifest"), "{err}");
}

/// A run that ends before its storyboard does could not be replayed: its scene was written out with a shot of no length.
#[test]
fn a_run_shorter_than_its_storyboard_replays() {
    let folder = tempfile::tempdir().expect("a folder");
    let short = ["--set", "time.duration=5", "--set", "expect={}"];
    let args = [&["run", "change-places", "-q", "-o", "short"], &short[..]].concat();
    assert_eq!(told(&echelon(folder.path(), &args)).0, 0);
    let (code, out, err) = told(&echelon(folder.path(), &["replay", "short"]));
    assert!(code == 0 && out.contains("same: bit for bit"), "{out}{err}");
}

/// Who names a scene where a run is wanted, or a run where a scene is, is told which and what to type.
#[test]
fn scenes_and_runs_are_told_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    record(folder.path(), "line-three");
    fs::copy(scene("line-three"), folder.path().join("mine.toml")).expect("copied");
    fs::copy(folder.path().join("run/log.mcap"), folder.path().join("a.mcap")).expect("copied");
    fs::copy(folder.path().join("run/log.mcap"), folder.path().join("renamed")).expect("copied");
    let wanted = "such as runs/line-three-001, or its log.mcap is needed; `echelon run SCENE` leaves one";
    for (args, words) in [
        (&["replay", "nosuch"][..], wanted),
        (&["diff", "run", "nosuch"], wanted),
        (&["replay", "."], wanted),
        (&["replay", "line-three"], "it is a scene; `echelon run line-three` records a run of it"),
        (&["replay", "mine.toml"], "a scene is recorded by `echelon run mine.toml`"),
        (&["replay", "run/metrics.json"], "its run is the folder run"),
        (&["replay", "run/manifest.json"], "its run is the folder run"),
        (
            &["capture", "run"],
            "is a recorded run, but a scene is needed here: `echelon replay run` runs it again",
        ),
        (&["film", "run"], "its scene is run/scene.toml"),
        (&["check", "run"], "is a recorded run"),
        (&["capture", "a.mcap"], "`--capture 0,5` or `--film film.mp4` it draws it"),
        (&["run", "renamed"], "renamed is a recorded run"),
        (&["figures", "run", "-o", "f"], "is a recorded run"),
        (&["budget", "run/log.mcap"], "run/log.mcap is a recorded run"),
        (
            &["compare", "a.mcap", "a.mcap"],
            "a.mcap: it is not a picture; recorded runs are compared by `echelon diff`",
        ),
        (&["compare", "run", "run"], "recorded runs are compared by `echelon diff`"),
    ] {
        let (code, out, err) = told(&echelon(folder.path(), args));
        assert!(code == 2 && out.is_empty() && err.contains(words), "{args:?}: {err}");
    }
}
