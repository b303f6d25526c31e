//! What CI systems use: pictures compared, expectations as JUnit XML.

use crate::common::{echelon, scene, told};
use serde_json::Value;
use std::fs;

fn capture(folder: &std::path::Path, out: &str, more: &[&str]) {
    let line = scene("line-three");
    let size = if more.contains(&"--size") { &[][..] } else { &["--size", "160x90"] };
    let base = [&["capture", &line, "--at", "0,2", "-q", "-o", out], size].concat();
    let (code, _, err) = told(&echelon(folder, &[&base[..], more].concat()));
    assert_eq!(code, 0, "{err}");
}

#[test]
fn pictures_are_alike_or_it_is_told_where_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |args: &[&str]| told(&echelon(folder.path(), args));
    capture(folder.path(), "a", &[]);
    capture(folder.path(), "b", &[]);
    capture(folder.path(), "c", &["--set", "robots.follower-2.pose=[-3.2, 1.4, 0.4]"]);
    let (code, out, _) = run(&["compare", "a", "b"]);
    assert!(code == 0 && out.contains("2 of 2 pictures alike"), "{out}");
    let (code, out, _) = run(&["compare", "a", "c", "-o", "where", "--junit", "report.xml", "--json"]);
    assert_eq!(code, 1);
    let value: Value = serde_json::from_str(&out).expect("JSON");
    assert!(value["failed"].as_u64().is_some_and(|n| n >= 1), "{out}");
    assert!(folder.path().join("where/line-three-000.000.difference.png").exists());
    let report = fs::read_to_string(folder.path().join("report.xml")).expect("a report");
    assert!(report.contains("<failure") && report.contains("line-three-000.000.png"), "{report}");
    // Two centimetres are found, even in a picture as small as this.
    capture(folder.path(), "d", &["--set", "robots.follower-2.pose=[-2.02, 1.0, 0.0]"]);
    let (code, out, _) = run(&["compare", "a", "d", "--json"]);
    let value: Value = serde_json::from_str(&out).expect("JSON");
    assert!(code == 1 && value["pictures"][0]["passes"] == false, "{out}");
    // Anything goes at a threshold of zero.
    assert_eq!(run(&["compare", "a", "c", "--threshold", "0"]).0, 0);
    // One picture less, and one of another size.
    fs::remove_file(folder.path().join("b/line-three-002.000.png")).expect("removed");
    let (code, out, _) = run(&["compare", "a", "b"]);
    assert!(code == 1 && out.contains("is not in b"), "{out}");
    capture(folder.path(), "b", &["--size", "80x45"]);
    let (code, out, _) = run(&["compare", "a", "b"]);
    assert!(code == 1 && out.contains("is 80×45 pixels, wanted 160×90"), "{out}");
}

#[test]
fn what_cannot_be_compared_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |args: &[&str]| told(&echelon(folder.path(), args));
    capture(folder.path(), "a", &[]);
    fs::write(folder.path().join("text.png"), "no picture").expect("written");
    fs::create_dir(folder.path().join("empty")).expect("made");
    let one = "a/line-three-000.000.png";
    for (args, wanted) in [
        (["compare", one, "text.png"], "cannot read text.png"),
        (["compare", one, "nowhere.png"], "nowhere.png"),
        (["compare", "a", one], "is a folder"),
        (["compare", "empty", "empty"], "holds a .png"),
    ] {
        let (code, _, err) = run(&args);
        assert!(code == 2 && err.contains(wanted), "{args:?}: {err}");
    }
    assert_eq!(run(&["compare", "a", "a", "--threshold", "2"]).0, 2);
    // Difference pictures among the references would be compared the next time.
    capture(folder.path(), "moved", &["--set", "robots.follower-2.pose=[-3.2, 1.4, 0.4]"]);
    let (code, _, err) = run(&["compare", "a", "moved", "-o", "./a"]);
    assert!(code == 2 && err.contains("name another one for the differences"), "{err}");
    assert!(!folder.path().join("a/line-three-000.000.difference.png").exists());
}

#[test]
fn expectations_are_test_cases() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = scene("line-three");
    let args = ["run", &line, "--no-record", "-q", "--junit", "report.xml"];
    assert_eq!(told(&echelon(folder.path(), &args)).0, 0);
    let report = fs::read_to_string(folder.path().join("report.xml")).expect("a report");
    assert!(report.contains("failures=\"0\"") && report.contains("settling_time"), "{report}");
    let args = [&args[..], &["--set", "expect.settling_time=0.2"]].concat();
    assert_eq!(told(&echelon(folder.path(), &args)).0, 1);
    let report = fs::read_to_string(folder.path().join("report.xml")).expect("a report");
    assert!(report.contains("failures=\"1\"") && report.contains("wanted"), "{report}");
}

/// Standard output is the report's, and people read standard error.
#[test]
fn a_report_goes_to_standard_output_where_asked_to() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = scene("line-three");
    let args = ["run", &line, "--no-record", "--junit", "-"];
    let (code, out, err) = told(&echelon(folder.path(), &args));
    assert!(code == 0 && out.starts_with("<?xml") && out.trim_end().ends_with("</testsuites>"), "{out}");
    assert!(err.contains("met    settling_time") && err.contains("digest"), "{err}");
    // On the suites, the suite, and every case.
    let times = 2 + out.matches("<testcase").count();
    assert!(times > 4 && out.matches(" time=\"").count() == times, "{out}");
    assert!(fs::read_dir(folder.path()).expect("a folder").next().is_none(), "nothing called `-`");
    fs::write(folder.path().join("bad.toml"), "schema = = 1\n").expect("written");
    let (code, out, _) = told(&echelon(folder.path(), &["run", "bad.toml", "--junit", "-"]));
    // A message of several lines keeps them.
    assert!(code == 2 && out.contains("errors=\"1\"") && out.contains("schema = = 1&#10;"), "{out}");
    assert!(out.lines().all(|line| line.trim_start().starts_with('<')), "{out}");
    // A picture that cannot be read ends the comparison, and the report says so.
    for name in ["a", "b"] {
        fs::create_dir(folder.path().join(name)).expect("made");
        fs::write(folder.path().join(name).join("x.png"), "no picture").expect("written");
    }
    let (code, out, _) = told(&echelon(folder.path(), &["compare", "a", "b", "--junit", "-"]));
    assert!(code == 2 && out.contains("errors=\"1\"") && out.contains("cannot read a/x.png"), "{out}");
}
