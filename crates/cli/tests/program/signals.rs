//! What signals do: end a run tidily, end what waits at once, and nothing where they were ignored from the start.

use crate::common::{command, scene, told};
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

const PROGRAM: &str = env!("CARGO_BIN_EXE_echelon");

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
}

/// Waits until `path` is there.
fn wait_for(path: &Path) {
    for _ in 0..1000 {
        if path.exists() {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("{} did not appear", path.display());
}

/// Whether a child has ended by itself within a few seconds; it is killed otherwise.
fn ends(child: &mut Child) -> bool {
    for _ in 0..200 {
        if child.try_wait().expect("asked").is_some() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().expect("killed");
    child.wait().expect("ended");
    false
}

/// `nohup`, and `&` in a plain shell: what was ignored at the start stays ignored, what was not is heeded.
#[test]
fn ignored_signals_stay_ignored() {
    for (ignored, ends_by) in [("HUP", "-TERM"), ("INT", "-TERM"), ("TERM", "-INT")] {
        let folder = tempfile::tempdir().expect("a folder");
        let line = scene("line-three");
        let script = format!("trap '' {ignored}; exec \"$0\" run \"$1\" -o run --set time.duration=20000");
        let mut child = Command::new("sh")
            .args(["-c", &script, PROGRAM, &line])
            .current_dir(folder.path())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        wait_for(&folder.path().join("run/tables/edges.parts/000001.parquet"));
        signal(&child, &format!("-{ignored}"));
        // Rows go on coming.
        wait_for(&folder.path().join("run/tables/edges.parts/000004.parquet"));
        assert!(child.try_wait().expect("asked").is_none(), "{ignored} ended it");
        signal(&child, ends_by);
        assert!(ends(&mut child), "{ends_by} did not end it");
        let manifest = fs::read_to_string(folder.path().join("run/manifest.json")).expect("a manifest");
        assert!(manifest.contains("interrupted"), "{manifest}");
    }
}

/// A pipe that nobody writes to is waited for, and the wait can be ended.
#[test]
fn who_waits_for_a_pipe_is_not_deaf() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe.toml");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    for (subcommand, name) in [("check", "-TERM"), ("check", "-INT"), ("run", "-HUP"), ("diff", "-TERM")] {
        let args = [subcommand, "pipe.toml", "pipe.toml"];
        let args = if subcommand == "run" { &args[..2] } else { &args[..] };
        let mut child = command(folder.path(), args).stderr(Stdio::null()).spawn().expect("started");
        std::thread::sleep(Duration::from_millis(300));
        signal(&child, name);
        assert!(ends(&mut child), "{subcommand} is deaf to {name}");
    }
}

/// The second signal ends a program that does not come to ask for the first.
#[test]
fn a_second_signal_ends_it_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child =
        command(folder.path(), &["run", &scene("line-three"), "-o", "run", "--set", "time.duration=20000"])
            .stderr(Stdio::piped())
            .spawn()
            .expect("started");
    wait_for(&folder.path().join("run/tables/edges.parts/000001.parquet"));
    signal(&child, "-INT");
    signal(&child, "-INT");
    assert!(ends(&mut child));
    let (code, _, _) = told(&child.wait_with_output().expect("ended"));
    assert_eq!(code, 130);
}

/// A comparison that was stopped says so in its numbers.
#[test]
fn a_budget_that_is_stopped_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("vision-circle-three");
    let args = ["budget", &scene, "--no-camera", "--set", "time.duration=2000", "-o", "out"];
    let mut child =
        command(folder.path(), &args).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("started");
    wait_for(&folder.path().join("out"));
    std::thread::sleep(Duration::from_millis(300));
    signal(&child, "-INT");
    assert!(ends(&mut child));
    let text = fs::read_to_string(folder.path().join("out/budget.json")).expect("numbers");
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(value["status"], "interrupted", "{text}");
}

/// Nothing was written, and a CI system took the job for one without results.
#[test]
fn a_run_that_is_stopped_has_a_report_all_the_same() {
    for name in ["-INT", "-TERM"] {
        let folder = tempfile::tempdir().expect("a folder");
        let line = scene("line-three");
        let args = ["run", &line, "-o", "run", "--junit", "report.xml", "--set", "time.duration=20000"];
        let mut child = command(folder.path(), &args).stderr(Stdio::null()).spawn().expect("started");
        wait_for(&folder.path().join("run/tables/edges.parts/000001.parquet"));
        signal(&child, name);
        assert!(ends(&mut child), "{name}");
        let text = fs::read_to_string(folder.path().join("report.xml")).expect("a report");
        let (cases, skipped) = (text.matches("<testcase").count(), text.matches("<skipped").count());
        assert!(text.contains("errors=\"1\"") && text.contains("failures=\"0\""), "{text}");
        assert!(cases > 2 && skipped == cases - 1 && text.contains("interrupted at"), "{text}");
        assert!(text.contains("settling_time") && text.contains("of 20000 s, recorded in run"), "{text}");
    }
}

/// More pictures than are compared while a signal comes.
const PICTURES: usize = 200;

/// A comparison that is stopped says of every picture what became of it.
#[test]
fn a_comparison_that_is_stopped_has_a_report_all_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let line = scene("line-three");
    let args = ["capture", &line, "--at", "0,2", "--size", "1280x720", "--samples", "1", "-q", "-o", "drawn"];
    assert_eq!(told(&command(folder.path(), &args).output().expect("it ran")).0, 0);
    for (side, time) in [("a", "000.000"), ("b", "002.000")] {
        fs::create_dir(at(side)).expect("made");
        for k in 0..PICTURES {
            let drawn = at(&format!("drawn/line-three-{time}.png"));
            fs::hard_link(drawn, at(side).join(format!("{k:03}.png"))).expect("linked");
        }
    }
    let args = ["compare", "a", "b", "-q", "-o", "where", "--junit", "report.xml"];
    let mut child =
        command(folder.path(), &args).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("started");
    wait_for(&at("where/000.difference.png"));
    signal(&child, "-TERM");
    assert!(ends(&mut child));
    let (code, _, err) = told(&child.wait_with_output().expect("ended"));
    assert!(code == 130 && err.contains(&format!("of {PICTURES} pictures are compared")), "{err}");
    let text = fs::read_to_string(at("report.xml")).expect("a report");
    assert!(text.matches("<testcase").count() == PICTURES + 1 && text.contains("errors=\"1\""), "{text}");
    assert!(text.contains("failures=\"") && text.contains("the comparison was interrupted"), "{text}");
}

/// Measuring ends between two lines; what was measured is printed.
#[test]
fn measuring_the_machine_can_be_ended() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child = command(folder.path(), &["doctor", "--bench", "--budget", "0"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    let mut lines = BufReader::new(child.stdout.take().expect("a pipe")).lines().map_while(Result::ok);
    let row = lines.find(|line| line.starts_with("picture "));
    assert!(row.is_some_and(|row| row.contains("circle-three") && row.contains(" ms ")));
    signal(&child, "-INT");
    // The pipe is read to its end: nothing is lost.
    assert!(!lines.any(|line| line.contains("measured in")), "it went on to its end");
    let (code, _, err) = told(&child.wait_with_output().expect("ended"));
    assert_eq!((code, err.as_str()), (130, "interrupted: what was measured until then is printed\n"));
}

/// A scene from a pipe that nobody writes to is waited for aloud; once it comes, all is as with a file.
#[test]
fn who_waits_for_a_pipe_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe.toml");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let mut child = command(folder.path(), &["check", "pipe.toml"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    let mut said = String::new();
    let errors = child.stderr.take().expect("a pipe");
    BufReader::new(errors).read_line(&mut said).expect("a line");
    assert_eq!(said, "waiting for pipe.toml, which is no file: something has to write a scene to it\n");
    fs::copy(scene("line-three"), &pipe).expect("written");
    let (code, out, _) = told(&child.wait_with_output().expect("ended"));
    assert!(code == 0 && out.contains("pipe.toml: good"), "{out}");
}
