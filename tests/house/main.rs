//! House rules that a compiler does not check.

mod measures;
mod picture;

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Dependencies of every workspace member on other packages: those of its library or program, and, if asked for, of its
/// tests, examples, benchmarks and build script.
fn dependencies(all_kinds: bool) -> BTreeMap<String, BTreeSet<String>> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version=1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo metadata");
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let name = |value: &Value| value["name"].as_str().expect("a name").to_owned();
    let uses = |package: &Value| {
        let dependencies = package["dependencies"].as_array().expect("a list").iter();
        dependencies.filter(|d| all_kinds || d["kind"].is_null()).map(name).collect()
    };
    let packages = metadata["packages"].as_array().expect("packages");
    packages.iter().map(|package| (name(package), uses(package))).collect()
}

/// Whom each crate may use among our own; everybody else may not.
const ARROWS: [(&str, &[&str]); 24] = [
    ("vocabulary", &[]),
    ("output", &[]),
    ("film", &["vocabulary", "output"]),
    ("laws", &["vocabulary"]),
    ("scene", &["vocabulary", "laws"]),
    ("formation", &["vocabulary", "laws"]),
    ("planning", &["vocabulary"]),
    ("safety", &["vocabulary"]),
    ("world", &["vocabulary"]),
    ("perception", &["vocabulary"]),
    ("metrics", &["vocabulary"]),
    ("recording", &["vocabulary", "metrics", "output"]),
    // Its tests, examples and benches write pictures and films with `film`.
    ("rendering", &["vocabulary", "film"]),
    ("figures", &["vocabulary"]),
    (
        "simulation",
        &["vocabulary", "laws", "scene", "formation", "planning", "safety", "world", "perception"],
    ),
    ("digests", &["vocabulary", "metrics", "scene", "simulation"]),
    (
        "studies",
        &[
            "vocabulary",
            "output",
            "metrics",
            "laws",
            "scene",
            "formation",
            "perception",
            "simulation",
            "recording",
        ],
    ),
    (
        "sweeps",
        &[
            "vocabulary",
            "output",
            "metrics",
            "laws",
            "scene",
            "simulation",
            "studies",
            "recording",
            "figures",
        ],
    ),
    ("footage", &["vocabulary", "output", "scene", "studies", "metrics", "recording", "film", "rendering"]),
    ("report", &["vocabulary", "scene", "simulation", "studies", "metrics", "figures"]),
    (
        "lab",
        &[
            "vocabulary",
            "output",
            "laws",
            "scene",
            "formation",
            "simulation",
            "studies",
            "sweeps",
            "metrics",
            "recording",
            "film",
            "rendering",
            "figures",
        ],
    ),
    (
        "cli",
        &[
            "vocabulary",
            "output",
            "laws",
            "scene",
            "studies",
            "sweeps",
            "metrics",
            "recording",
            "film",
            "rendering",
            "footage",
            "figures",
            "report",
            "lab",
        ],
    ),
    ("web", &["lab"]),
    (
        "python",
        &[
            "vocabulary",
            "laws",
            "scene",
            "simulation",
            "studies",
            "sweeps",
            "metrics",
            "output",
            "recording",
            "rendering",
            "footage",
            "cli",
        ],
    ),
];

/// Heavy crates and the only members that may name them.
const LEAVES: [(&str, &[&str]); 12] = [
    ("wgpu", &["rendering", "lab"]),
    ("eframe", &["lab"]),
    ("parquet", &["recording"]),
    ("mcap", &["recording"]),
    ("foxglove", &["recording"]),
    ("clap", &["cli"]),
    ("openh264", &["film"]),
    ("rapier3d-f64", &["world"]),
    ("resvg", &["report"]),
    ("svg2pdf", &["report"]),
    ("wasmi", &["laws"]),
    ("pyo3", &["python"]),
];

#[test]
fn arrows_point_one_way() {
    let all = dependencies(true);
    let ours: BTreeSet<&str> = ARROWS.iter().map(|(name, _)| *name).collect();
    for (name, uses) in &all {
        let Some((_, allowed)) = ARROWS.iter().find(|(member, _)| member == name) else {
            let leaf = ["tests", "fuzz"].contains(&name.as_str());
            assert!(leaf, "`{name}` has no place in the list of arrows");
            continue;
        };
        for used in uses.iter().filter(|u| ours.contains(u.as_str())) {
            assert!(allowed.contains(&used.as_str()), "`{name}` may not use `{used}`");
        }
        for (heavy, members) in LEAVES {
            assert!(
                !uses.contains(heavy) || members.contains(&name.as_str()),
                "`{name}` may not use `{heavy}`"
            );
        }
    }
    assert_eq!(all.len(), ARROWS.len() + 2);
}

/// Features add up over all who use a library: one of them could switch on mathematics that differs between machines.
#[test]
fn libraries_compute_the_same_on_every_machine() {
    let output = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--workspace",
            "--locked",
            "--offline",
            "--edges=normal",
            "--prefix=none",
            "--format={p} {f}",
        ])
        .current_dir(root())
        .output()
        .expect("cargo tree");
    let tree = String::from_utf8(output.stdout).expect("text");
    for (library, feature, wanted) in [
        ("rapier3d-f64 ", "enhanced-determinism", true),
        ("parry3d-f64 ", "enhanced-determinism", true),
        ("simba ", "libm_force", true),
        ("glam ", "libm", true),
        ("glam ", "fast-math", false),
    ] {
        let lines: Vec<&str> = tree.lines().filter(|line| line.starts_with(library)).collect();
        assert!(!lines.is_empty(), "nobody uses {library}");
        for line in lines {
            let features = line.split(' ').nth(2).expect("features");
            assert_eq!(features.split(',').any(|have| have == feature), wanted, "{feature}: {line}");
        }
    }
}

/// Source files of the project, with their text.
fn sources(endings: &[&str]) -> Vec<(PathBuf, String)> {
    let mut open: Vec<PathBuf> =
        ["crates", "tests", "fuzz/src", "fuzz/tests", "fuzz/examples", "shaders", "scripts", "scenes", ".ci"]
            .iter()
            .map(|d| root().join(d))
            .collect();
    let mut found = vec![];
    while let Some(folder) = open.pop() {
        for path in fs::read_dir(&folder).expect("a folder").flatten().map(|e| e.path()) {
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| endings.iter().any(|ending| e == *ending)) {
                found.push((path.clone(), fs::read_to_string(&path).expect("text")));
            }
        }
    }
    assert!(!found.is_empty());
    found
}

#[test]
fn every_file_says_why_it_exists() {
    for (path, text) in sources(&["rs", "wgsl"]) {
        let head = if path.extension().is_some_and(|e| e == "rs") { "//!" } else { "//" };
        assert!(text.starts_with(head), "{} does not begin with `{head}`", path.display());
    }
}

/// Pictures and pages that the documentation points at are there.
#[test]
fn links_lead_somewhere() {
    let docs = fs::read_dir(root().join("docs")).expect("a folder").flatten().map(|entry| entry.path());
    let pages = docs.filter(|path| path.extension().is_some_and(|e| e == "md"));
    let mut linked = 0;
    for page in pages.chain([root().join("README.md")]) {
        let text = fs::read_to_string(&page).expect("a page");
        let links: Vec<&str> = text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
        linked += links.len();
        for link in links.iter().filter(|l| !l.starts_with("http")) {
            let link = link.split('#').next().unwrap_or(link);
            let target = page.with_file_name("").join(link);
            assert!(target.exists(), "{} points at {link}", page.display());
        }
    }
    assert!(linked > 50, "{linked} links");
}

/// How long the first build takes is said in three places.
#[test]
fn the_first_build_takes_as_long_everywhere() {
    let read = |name: &str| fs::read_to_string(root().join(name)).expect("a text").replace('\n', " ");
    let script = read("scripts/film");
    let (figure, _) = script
        .split_once("the first time this takes ")
        .and_then(|(_, rest)| rest.split_once(" minutes"))
        .expect("a figure");
    for page in ["README.md", "docs/start.md"] {
        let said = format!("The first build takes {figure} minutes");
        assert!(read(page).contains(&said), "{page} does not say: {said}");
    }
}

#[test]
fn nothing_is_silenced_or_left_undone() {
    // Written in two parts so that this file does not find itself.
    let words = [["#![", "allow"], ["#[", "allow("], ["todo", "!("], ["unimplemented", "!("], ["FIX", "ME"]];
    for (path, text) in sources(&["rs"]) {
        for word in words.map(|w| w.concat()) {
            assert!(!text.contains(&word), "{} contains `{word}`", path.display());
        }
    }
}

#[test]
fn the_clock_is_read_by_the_program_only() {
    let words = [["Instant::", "now"], ["SystemTime::", "now"]].map(|w| w.concat());
    for (path, text) in sources(&["rs"]) {
        let allowed = path
            .components()
            .any(|c| ["cli", "lab", "benches", "examples"].iter().any(|a| c.as_os_str() == *a));
        assert!(allowed || !words.iter().any(|w| text.contains(w)), "{} reads the clock", path.display());
    }
}

/// Numbers are narrowed where pixels and drawings are made, nowhere before.
#[test]
fn numbers_are_f64_until_they_are_drawn() {
    let wide = ["scene", "formation", "planning", "safety", "world", "metrics", "simulation"];
    for (path, text) in sources(&["rs"]) {
        let member = path.components().skip_while(|c| c.as_os_str() != "crates").nth(1);
        if member.is_some_and(|m| wide.iter().any(|name| m.as_os_str() == *name)) {
            let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            for line in code {
                let found = line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == "f32");
                assert!(!found, "{}: {line}", path.display());
            }
        }
    }
}
