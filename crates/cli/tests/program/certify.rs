//! `echelon certify`: what it prints and leaves.

use crate::common::{echelon, scene, told};
use serde_json::Value;
use std::fs;

#[test]
fn statements_premises_and_constants_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, err) =
        told(&echelon(folder.path(), &["certify", &scene("line-three"), "--bound", "0.01", "-o", "out"]));
    assert_eq!(code, 0, "{err}");
    for wanted in
        ["Lemma 4.1", "tanh instead of sign", "saturation active", "σ_s", "promised for ε up to", "chains"]
    {
        assert!(out.contains(wanted), "{wanted}: {out}");
    }
    let text = fs::read_to_string(folder.path().join("out/certificate.json")).expect("JSON");
    let value: Value = serde_json::from_str(&text).expect("JSON");
    let edge = &value["edges"][0];
    assert_eq!((&edge["leader"], &edge["follower"]), (&Value::from("leader"), &Value::from("follower-1")));
    assert_eq!(edge["statements"].as_array().map(Vec::len), Some(7));
    assert!((edge["p0"][0][0].as_f64().expect("a number") - 0.5).abs() < 1e-12);
    // A bound asked for comes with the ε that the proof promises it for.
    let most = edge["constants"]["wanted"]["epsilon_most"].as_f64().expect("a number");
    assert!(most > 1e-5 && most < 1e-2, "{most}");
    // K acts on its own channel: a stiffer one leaves less.
    let k = &value["beyond"]["sensitivity"]["gains"][0];
    assert_eq!(k["gain"], "k distance");
    assert!(k["edges"][0][0].as_f64().expect("a number") < -0.1);
    let table = fs::read_to_string(folder.path().join("out/certificate.csv")).expect("a table");
    assert_eq!(table.lines().count(), 1 + 2 * 1501);
    for figure in ["certificate.svg", "stability.svg", "reach.svg", "chain.svg"] {
        let text = fs::read_to_string(folder.path().join("out").join(figure)).expect("a figure");
        assert!(text.starts_with("<svg") && text.contains("<path"), "{figure}");
    }
}

#[test]
fn strict_fails_where_a_statement_is_violated() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = scene("line-three");
    let args = ["certify", &line, "--paper-only", "-q", "--strict"];
    assert_eq!(told(&echelon(folder.path(), &args)).0, 0);
    let weak = [&args[..], &["--set", "law.beta=0.3"]].concat();
    assert_eq!(told(&echelon(folder.path(), &weak)).0, 1);
}

#[test]
fn what_has_no_certificate_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let alone = "schema = 1\ntitle = \"alone\"\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\n\
        path = { kind = \"constant\" }\n";
    fs::write(folder.path().join("alone.toml"), alone).expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["certify", "alone.toml"]));
    assert!(code == 2 && err.contains("no robot follows another"), "{err}");
    assert_eq!(told(&echelon(folder.path(), &["certify", &scene("line-three"), "--bound", "0"])).0, 2);
    fs::write(folder.path().join("file"), "x").expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["certify", &scene("line-three"), "-o", "file"]));
    assert!(code == 2 && err.contains("file is a file"), "{err}");
}

#[test]
fn a_run_keeps_its_certificates_in_its_metrics() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = ["run", &scene("circle-three"), "-q", "-o", "run"];
    assert_eq!(told(&echelon(folder.path(), &args)).0, 0);
    let text = fs::read_to_string(folder.path().join("run/metrics.json")).expect("metrics");
    let value: Value = serde_json::from_str(&text).expect("JSON");
    let certificates = value["certificates"].as_array().expect("certificates");
    assert_eq!(certificates.len(), 2);
    assert_eq!(certificates[0]["statements"][0]["outcome"], "holds");
    assert_eq!(certificates[0]["statements"][2]["outcome"], "premise-not-met");
}
