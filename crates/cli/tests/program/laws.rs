//! Custom laws: `echelon laws`, and runs with laws that work, break off, or do not fit.

use crate::common::{echelon, scene, told};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A law that gives no command from 5 s on.
const BREAKS: &str = "# Works for five seconds\nknows rates\nlet idle = 0 / (time - time) * 1 [s]\n\
                      let e = wanted.distance - leader.distance\ncommand = -4 [1/s^2] * e * sqrt(1 - time / 5 [s]), 0\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("breaks.law"), BREAKS).expect("a file");
    folder
}

fn run(folder: &Path, law: &str, more: &[&str]) -> (i32, String, String) {
    let law = format!("law.file={law}");
    told(&echelon(folder, &[&["run", "circle-three", "--no-record", "--set", &law], more].concat()))
}

#[test]
fn laws_are_listed_shown_checked_and_begun() {
    let folder = folder();
    let laws = |args: &[&str]| told(&echelon(folder.path(), &[&["laws"], args].concat()));
    let (code, listed, _) = laws(&[]);
    assert_eq!(code, 0);
    assert!(listed.contains("two-distances") && listed.contains("2 leaders"), "{listed}");
    let all: Value = serde_json::from_str(&laws(&["--json"]).1).expect("JSON");
    let integral = all.as_array().and_then(|all| all.iter().find(|law| law["name"] == "integral"));
    assert_eq!(integral.expect("a law")["parameters"][2]["unit"], "s");

    let (code, path, _) = laws(&["new", "mine.law"]);
    assert_eq!((code, path.trim()), (0, "mine.law"));
    let (code, _, told_) = laws(&["new", "mine.law"]);
    assert!(code == 2 && told_.contains("is there already"), "{told_}");
    let (code, _, told_) = laws(&["new", "integral"]);
    assert!(
        code == 2 && told_.contains("comes with the program") && !folder.path().join("integral").exists()
    );
    let (code, out, _) = laws(&["check", "mine.law"]);
    assert!(code == 0 && out.contains("memory: sum") && out.contains("0.2 to 10"), "{out}");

    fs::write(folder.path().join("wrong.law"), "let a = leader.distance + leader.bearing\ncommand = x, 0\n")
        .expect("a file");
    let (code, out, err) = laws(&["check", "wrong.law"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("wrong.law:1:9: ") && err.contains("wrong.law:2:11: "), "{err}");
    let (code, out, _) = laws(&["check", "--json", "mine.law", "wrong.law"]);
    let found: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!((code, &found[0]["law"], &found[0]["mistakes"]), (2, &Value::from("mine.law"), &Value::Null));
    let mistake = &found[1]["mistakes"][0];
    assert_eq!((&mistake["line"], &mistake["column"]), (&Value::from(1), &Value::from(9)), "{out}");
    let (code, text, _) = laws(&["show", "integral"]);
    assert!(code == 0 && text.starts_with("# Output feedback with an integral"));
    let (code, _, err) = laws(&["show", "nothing"]);
    assert!(code == 2 && err.contains("integral"), "{err}");
}

#[test]
fn the_law_that_stands_in_a_scene_becomes_a_file() {
    let folder = folder();
    let args = ["run", "circle-three", "-o", "run", "--no-log", "--set", "law.file=breaks.law"];
    told(&echelon(folder.path(), &args));
    let show = |scene: &str| told(&echelon(folder.path(), &["laws", "show", scene]));
    let (code, text, err) = show("run/scene.toml");
    assert_eq!((code, text.as_str()), (0, BREAKS), "{err}");
    let (code, _, err) = show(&scene("circle-three"));
    assert!(code == 2 && err.contains("no follower has a law file"), "{err}");
    let mixed = fs::read_to_string(scene("circle-three")).expect("a scene");
    let mixed = format!("{mixed}\n[law]\nfile = \"integral\"\n").replacen(
        "leader = \"leader\"",
        "leader = \"leader\"\nlaw.file = \"sliding-mode\"",
        1,
    );
    fs::write(folder.path().join("mixed.toml"), mixed).expect("a file");
    let (code, _, err) = show("mixed.toml");
    assert!(code == 2 && err.contains("have different laws"), "{err}");
}

#[test]
fn certify_names_the_fault_of_a_law_and_tries_its_parameters() {
    let folder = folder();
    let certify = |law: &str, more: &[&str]| {
        let set = format!("law.file={law}");
        told(&echelon(folder.path(), &[&["certify", "line-three", "--set", &set], more].concat()))
    };
    let (code, out, _) = certify("breaks.law", &["--paper-only"]);
    let fault = "THE LAW BREAKS OFF: follower-1, t = 5.01 s (sample 501), breaks.law:5:";
    assert!(code == 0 && out.contains(fault), "{out}");
    assert_eq!(certify("breaks.law", &["--paper-only", "--strict"]).0, 1);
    let (code, out, _) = certify("breaks.law", &["--paper-only", "--json"]);
    let found: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!((code, &found["edges"][0]["law_fault"]["sample"]), (0, &Value::from(501)));
    let (code, out, _) = certify("integral", &["--json"]);
    let found: Value = serde_json::from_str(&out).expect("JSON");
    let gains = found["beyond"]["sensitivity"]["gains"].as_array().expect("gains");
    let names: Vec<_> = gains.iter().filter_map(|gain| gain["gain"].as_str()).collect();
    assert!(code == 0 && names.contains(&"T") && names.contains(&"ε distance"), "{names:?}");
    // Where the error is measured as something, a parameter moves it.
    let moved = gains.iter().filter(|gain| gain["gain"] == "T").filter_map(|gain| gain["edges"].as_array());
    assert_eq!(moved.flatten().count(), 2);
}

#[test]
fn a_test_prints_poles_and_says_whether_they_decay() {
    let folder = folder();
    fs::write(folder.path().join("still.law"), "# Stands still\ncommand = 0, 0\n").expect("a file");
    let test = |args: &[&str]| told(&echelon(folder.path(), &[&["laws", "test"], args].concat()));
    let (code, out, _) = test(&["full-state", "--set", "k1=2", "--period", "0.001"]);
    assert!(code == 0 && out.contains("k₁ 2 1/s · k₂ 5 1/s") && out.ends_with("stable\n"), "{out}");
    let (code, out, _) = test(&["still.law"]);
    assert!(
        code == 1 && out.contains("does not decay") && out.contains("not asymptotically stable"),
        "{out}"
    );
    let (code, out, _) = test(&["full-state", "--json"]);
    let found: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(
        (code, &found["stable"], found["poles"].as_array().map(Vec::len)),
        (0, &Value::Bool(true), Some(4))
    );
    for (args, words) in [
        (vec!["full-state", "--set", "k9=2"], "no parameter `k9`"),
        (vec!["full-state", "--set", "k1=200"], "from 0.1 to 20"),
        (vec!["full-state", "--period", "0"], "--period must be from"),
        (vec!["nothing.law"], "no such file"),
    ] {
        let (code, _, err) = test(&args);
        assert!(code == 2 && err.contains(words), "{args:?}: {err}");
    }
}

#[test]
fn a_law_that_breaks_off_is_told_with_its_place_and_replays() {
    let folder = folder();
    let args = ["run", "circle-three", "-o", "run", "--set", "law.file=breaks.law"];
    let (code, out, _) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 1);
    for words in
        ["follower-1 brakes: its law gives no command", "follower-1, t = 5.01 s (sample 501), breaks.law:5:"]
    {
        assert!(out.contains(words), "{out}");
    }
    let metrics = fs::read_to_string(folder.path().join("run/metrics.json")).expect("metrics");
    assert!(metrics.contains("\"law_faults\"") && metrics.contains("\"sample\": 501"));
    // Its text is in the run; a `let` that is no number is the same number again.
    fs::remove_file(folder.path().join("breaks.law")).expect("a file");
    let (code, out, err) = told(&echelon(folder.path(), &["replay", "run"]));
    assert!(code == 0 && out.contains("same: bit for bit"), "{out}{err}");
}

#[test]
fn what_does_not_fit_is_refused_with_the_reason() {
    let folder = folder();
    fs::write(folder.path().join("integral"), "no law").expect("a file");
    for (law, more, words) in [
        ("law-integral", vec!["--set", "time.mode=continuous"], "no such file"),
        (
            "integral",
            vec!["--set", "time.mode=continuous", "--set", "observer.epsilon=0.01"],
            "acts at samples only",
        ),
        ("/dev/null", vec![], "is no file"),
        ("two-distances", vec![], "one leader"),
        ("integral", vec!["--set", "law.parameters.T=0"], "`T` must be from 0.2 to 20 s"),
    ] {
        let (code, _, err) = run(folder.path(), law, &more);
        assert!(code == 2 && err.contains(words), "{law}: {err}");
    }
    // A file of the name of a law that ships changes nothing.
    let (_, out, _) = run(folder.path(), "integral", &[]);
    assert!(out.contains("Output feedback with an integral of the error"), "{out}");
    let both = "schema = 1\ntitle = \"t\"\n[law]\nfile = \"integral\"\ntext = \"command = 0, 0\"\n[[robots]]\nname = \"a\"\n\
                pose = [0, 0, 0]\npath = { kind = \"constant\", speed = 1.0 }\n[[robots]]\nname = \"b\"\npose = [-2, 0, 0]\n\
                leader = \"a\"\ndistance = 2.0\nbearing = \"180 deg\"\n";
    fs::write(folder.path().join("both.toml"), both).expect("a file");
    let (code, _, err) = told(&echelon(folder.path(), &["check", "both.toml"]));
    assert!(code == 2 && err.contains("both.toml:5:") && err.contains("give one of `file`, `text`"), "{err}");
}
