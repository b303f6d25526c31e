//! `echelon figures`: what it leaves and tells, and what it refuses.

use crate::common::{echelon, files, scene, told};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn names(folder: &Path) -> Vec<String> {
    files(folder).iter().filter_map(|p| Some(p.file_name()?.to_string_lossy().into_owned())).collect()
}

fn claims(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("claims.json")).expect("text");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn the_papers_figures_come_without_an_adapter_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, err) = told(&echelon(folder.path(), &["figures", "-o", "out", "--no-pictures"]));
    assert_eq!(code, 0, "{err}");
    let out_folder = folder.path().join("out");
    let names = names(&out_folder);
    for number in (3..=12).chain([15]) {
        for ending in ["svg", "png", "pdf", "csv"] {
            let name = format!("figure-{number:02}.{ending}");
            assert!(names.contains(&name), "{name} is not in {names:?}");
        }
    }
    assert_eq!(names.len(), 11 * 4 + 2, "{names:?}");
    let claims = claims(&out_folder);
    assert_eq!(claims["status"], "complete");
    assert_eq!(claims["files"].as_array().map(Vec::len), Some(names.len() - 1), "all but itself");
    let all = claims["claims"].as_array().expect("claims");
    let failed: Vec<&Value> = all.iter().filter(|claim| claim["holds"] == false).collect();
    assert!(!all.is_empty() && claims["holding"] == all.len() - failed.len());
    assert_eq!(out.matches("NOT SO").count(), failed.len(), "{out}");
    assert!(out.contains("left out: Snake views and films: --no-pictures was given."), "{out}");
    let html = fs::read_to_string(out_folder.join("report.html")).expect("text");
    assert_eq!(html.matches("<figure id=").count(), 11);
    assert!(html.contains("Snake views and films: --no-pictures was given."));
    assert!(!html.contains("src=\"http") && !html.contains("url(http"));
    let pdf = fs::read(out_folder.join("figure-04.pdf")).expect("a page");
    let text = String::from_utf8_lossy(&pdf).into_owned();
    assert!(text.contains("Inter") && text.contains("FontFile3"), "the font is embedded");
}

#[test]
fn any_scene_has_figures() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("seven-v");
    let args = ["figures", &scene, "-o", ".", "--no-pictures", "--set", "time.duration=3", "--json"];
    let (code, out, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    let value: Value = serde_json::from_str(&out).expect("JSON only on standard output");
    // As written, three laws, three constants.
    assert_eq!(value["runs"].as_array().map(Vec::len), Some(7));
    assert!(value["claims"].as_array().is_some_and(|claims| claims.iter().any(|c| c["holds"] == false)));
    for stem in ["trajectories", "inputs", "errors", "observer", "laws-errors", "constants-inputs", "graph"] {
        assert!(folder.path().join(stem).with_extension("pdf").exists(), "{stem}");
    }
}

#[test]
fn what_stands_in_the_folder_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("line-three");
    let args = |more: &[&'static str]| {
        let args = ["figures", &scene, "-o", ".", "--no-pictures", "--set", "time.duration=1"];
        told(&echelon(folder.path(), &[&args[..], more].concat()))
    };
    fs::write(folder.path().join("notes.txt"), "mine").expect("written");
    let (code, _, err) = args(&["--force"]);
    assert!(code == 2 && err.contains("holds other files"), "{err}");
    fs::remove_file(folder.path().join("notes.txt")).expect("removed");
    assert_eq!(args(&["-q"]), (0, String::new(), String::new()));
    let before = claims(folder.path());
    let (code, _, err) = args(&[]);
    assert!(code == 2 && err.contains("already holds figures") && err.contains("--force"), "{err}");
    assert_eq!(args(&["-q", "--force"]).0, 0);
    assert_eq!(before, claims(folder.path()), "the same again");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |args: &[&str], word: &str| {
        let (code, out, err) = told(&echelon(folder.path(), args));
        assert_eq!((code, &*out), (2, ""), "{args:?}: {err}");
        assert!(err.contains(word), "{args:?} does not say `{word}`: {err}");
        assert!(files(folder.path()).is_empty());
    };
    refused(&["figures"], "--out");
    refused(&["figures", "-o", "out", "--set", "law.k=3"], "SCENE");
    refused(&["figures", "nowhere.toml", "-o", "out"], "nowhere.toml");
}
