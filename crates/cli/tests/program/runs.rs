//! `echelon run`, `check`, `schema`, `completions`: what they print, what they leave, how they end.

use crate::common::{command, echelon, files, scene, told};
use recording::{Manifest, Status, TableKind, read_table};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

fn manifest(folder: &Path) -> Manifest {
    let text = fs::read_to_string(folder.join("manifest.json")).expect("a manifest");
    serde_json::from_str(&text).expect("valid")
}

#[test]
fn every_shipped_scene_meets_its_expectations() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut names: Vec<_> = fs::read_dir(scenes)
        .expect("scenes")
        .flatten()
        .map(|e| e.path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .collect();
    names.sort();
    assert!(names.len() >= 7, "{names:?}");
    // Eight minutes of pictures are too many for a test: tags are calculated, with the noise that cameras have. The loop
    // on pictures has tests of its own.
    let calculated = ["--set", "sensing.kind=geometric", "--set", "sensing.pixel_noise=0.05"];
    for path in names {
        let sees = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("vision-"));
        let scene = path.display().to_string();
        let more: &[&str] = if sees { &calculated } else { &[] };
        let (code, out, err) =
            told(&echelon(folder.path(), &[&["run", &scene, "--no-record"][..], more].concat()));
        assert_eq!(code, 0, "{}\n{out}\n{err}", path.display());
        assert!(out.contains("expectations"), "{} expects nothing", path.display());
    }
}

#[test]
fn a_run_leaves_a_folder_that_runs_again_to_the_same_digest() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = folder.path().join("first");
    let out = run.display().to_string();
    let (code, _, err) =
        told(&echelon(folder.path(), &["run", &scene("line-three"), "-o", &out, "--csv", "-q"]));
    assert_eq!(code, 0, "{err}");
    let names: Vec<String> =
        files(&run).iter().map(|p| p.strip_prefix(&run).expect("inside").display().to_string()).collect();
    let expected = [
        "log.mcap",
        "manifest.json",
        "metrics.json",
        "scene.toml",
        "tables/contacts.csv",
        "tables/contacts.parquet",
        "tables/edges.csv",
        "tables/edges.parquet",
        "tables/robots.csv",
        "tables/robots.parquet",
    ];
    assert_eq!(names, expected);
    let first = manifest(&run);
    assert_eq!((first.status, first.samples), (Status::Complete, 1501));
    // The resolved scene is a scene of its own, and gives the same run.
    let resolved = run.join("scene.toml").display().to_string();
    let (code, text, err) = told(&echelon(folder.path(), &["run", &resolved, "--json", "--no-record"]));
    assert_eq!(code, 0, "{err}");
    let report: Value = serde_json::from_str(&text).expect("JSON only on standard output");
    assert_eq!(report["digest"].as_str(), first.digest.as_deref());
    assert_eq!(report["met"], true);
}

#[test]
fn a_failed_expectation_is_exit_code_1_and_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = ["run", &scene("line-three"), "--no-record", "--set", "expect.final_distance_error=0.001"];
    let (code, out, _) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 1);
    assert!(out.lines().any(|l| l.contains("FAILED") && l.contains("final_distance_error")), "{out}");
    let (code, out, err) = told(&echelon(folder.path(), &[&args[..], &["--quiet"]].concat()));
    assert_eq!((code, &*out), (1, ""));
    assert!(err.contains("final_distance_error"), "{err}");
}

#[test]
fn an_existing_run_is_kept_unless_forced_and_default_folders_count_up() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = ["run", &scene("line-three"), "-q", "--set", "time.duration=1", "--set", "expect={}"];
    for _ in 0..2 {
        assert_eq!(told(&echelon(folder.path(), &args)).0, 0);
    }
    assert!(folder.path().join("runs/line-three-002/manifest.json").exists());
    let again = [&args[..], &["-o", "runs/line-three-001"]].concat();
    let (code, _, err) = told(&echelon(folder.path(), &again));
    assert_eq!(code, 2);
    assert!(err.contains("already holds a run") && err.contains("--force"), "{err}");
    assert_eq!(told(&echelon(folder.path(), &[&again[..], &["--force"]].concat())).0, 0);
}

#[test]
fn runs_started_together_get_a_folder_each() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = ["run", &scene("line-three"), "-q", "--set", "time.duration=1", "--set", "expect={}"];
    let start = |_| command(folder.path(), &args).stderr(Stdio::piped()).spawn().expect("started");
    let children: Vec<_> = (0..4).map(start).collect();
    for child in children {
        let (code, _, err) = told(&child.wait_with_output().expect("ended"));
        assert_eq!(code, 0, "{err}");
    }
    for number in 1..=4 {
        let run = folder.path().join(format!("runs/line-three-00{number}"));
        assert_eq!(manifest(&run).status, Status::Complete);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_is_lost_is_the_machines_failure() {
    let folder = tempfile::tempdir().expect("a folder");
    let full = fs::File::options().write(true).open("/dev/full").expect("always full");
    let output = command(folder.path(), &["schema"]).stdout(full).output().expect("it ran");
    let (code, _, err) = told(&output);
    assert!(code == 3 && err.contains("standard output"), "{code} {err}");
}

/// A run long enough to be stopped, recording into `folder`/run; returns once its first rows are on disk.
#[cfg(unix)]
fn long_run(folder: &Path) -> std::process::Child {
    let args = ["run", &scene("seven-v"), "-o", "run", "--set", "time.duration=20000"];
    let mut child =
        command(folder, &args).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("started");
    let parts = folder.join("run/tables/edges.parts/000001.parquet");
    for _ in 0..600 {
        if parts.exists() {
            return child;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    child.kill().expect("killed");
    panic!("no rows appeared: {:?}", child.wait());
}

#[cfg(unix)]
fn signal(child: &std::process::Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_a_readable_run_marked_interrupted() {
    let folder = tempfile::tempdir().expect("a folder");
    let child = long_run(folder.path());
    signal(&child, "-INT");
    let (code, _, err) = told(&child.wait_with_output().expect("ended"));
    assert_eq!(code, 130, "{err}");
    assert!(err.contains("recorded in"), "{err}");
    let run = folder.path().join("run");
    let manifest = manifest(&run);
    assert_eq!(manifest.status, Status::Interrupted);
    let robots = read_table(&run, TableKind::Robots).expect("a table");
    let recording::Column::Number(time) = &robots[0] else { panic!("no times") };
    assert_eq!(time.len() as u64, 7 * manifest.samples);
}

#[cfg(unix)]
#[test]
fn kill_leaves_the_rows_written_so_far() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child = long_run(folder.path());
    signal(&child, "-KILL");
    child.wait().expect("ended");
    let run = folder.path().join("run");
    assert_eq!(manifest(&run).status, Status::Running);
    let edges = read_table(&run, TableKind::Edges).expect("parts");
    let recording::Column::Number(time) = &edges[0] else { panic!("no times") };
    assert!(time.len() >= 1500, "{} rows", time.len());
}

#[test]
fn check_names_good_scenes_and_prints_resolved_ones() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, _) = told(&echelon(folder.path(), &["check", &scene("seven-v"), &scene("hundred")]));
    assert_eq!(code, 0);
    assert!(out.contains("7 robots and 6 edges") && out.contains("100 robots and 99 edges"), "{out}");
    let (_, out, _) = told(&echelon(folder.path(), &["check", &scene("line-three"), "--resolved"]));
    assert!(out.contains("epsilon = ") && out.contains("schema = 1"), "{out}");
}

#[test]
fn schema_and_completions_print_what_they_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, out, _) = told(&echelon(folder.path(), &["schema"]));
    let schema: Value = serde_json::from_str(&out).expect("JSON");
    assert!(schema["properties"]["robots"].is_object());
    let (code, out, _) = told(&echelon(folder.path(), &["completions", "bash"]));
    assert!(code == 0 && out.contains("_echelon"), "{out}");
}

/// The scene of README.md is good, and shows what it expects, with every block after it pasted below it.
#[test]
fn the_scene_of_the_readme_runs() {
    let readme =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md")).expect("a text");
    let blocks = readme.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let folder = tempfile::tempdir().expect("a folder");
    let (mut scene, mut count) = (String::new(), 0);
    for block in blocks {
        scene = format!("{scene}\n{block}");
        count += 1;
        fs::write(folder.path().join("two.toml"), &scene).expect("written");
        let (code, out, err) = told(&echelon(folder.path(), &["run", "two.toml", "--no-record"]));
        assert_eq!(code, 0, "with {count} blocks: {out}{err}");
        assert!(out.contains("met    final_distance_error"), "{out}");
    }
    assert_eq!(count, 1);
}

#[test]
fn alone_it_prints_a_helpful_start() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, _) = told(&echelon(folder.path(), &[]));
    assert!(code == 0 && out.contains("echelon film circle-three"), "{out}");
}

/// A head-on collision: recorded, or the end of the run, or its failure.
#[test]
fn a_contact_is_recorded_or_ends_the_run_or_fails_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let crash = scene("cars-crash");
    let run = |on_contact: &str, out: &str| {
        let set = format!("physics.on_contact={on_contact}");
        // Cut short at the first touch, the contact has not pushed as hard as it will.
        let expect = ["expect.completed=false", "expect.contact_impulse_within=[0.1, 20.0]"];
        let args = ["run", &crash, "--set", &set, "--set", expect[0], "--set", expect[1], "--csv", "-o", out];
        told(&echelon(folder.path(), &args))
    };
    let (code, text, err) = run("record", "recorded");
    assert_eq!(code, 0, "{text}{err}");
    assert!(text.contains("contact of eastbound and westbound at 1.41 s"), "{text}");
    let table = fs::read_to_string(folder.path().join("recorded/tables/contacts.csv")).expect("contacts");
    assert!(table.lines().nth(1).is_some_and(|l| l.starts_with("eastbound,westbound,1.4")), "{table}");
    assert_eq!(table.lines().count(), 2, "{table}");
    let (code, text, _) = run("stop", "stopped");
    assert!(code == 0 && text.contains("1.41 s in 142 steps"), "{text}");
    assert_eq!(manifest(&folder.path().join("stopped")).status, Status::Stopped);
    let table = fs::read_to_string(folder.path().join("stopped/tables/contacts.csv")).expect("contacts");
    assert_eq!(table.lines().count(), 2, "a contact that has not ended is told too: {table}");
    let (code, text, _) = run("fail", "failed");
    assert!(code == 1 && text.contains("FAILED on_contact"), "{text}");
}

#[test]
fn physics_gives_the_same_digest_in_every_process() {
    let folder = tempfile::tempdir().expect("a folder");
    let digest = || {
        let args = ["run", &scene("cars-rough"), "--no-record", "--json", "--set", "time.duration=8"];
        let (_, text, _) = told(&echelon(folder.path(), &args));
        serde_json::from_str::<Value>(&text).expect("JSON")["digest"].as_str().map(str::to_owned)
    };
    let first = digest();
    assert!(first.is_some() && first == digest());
}
