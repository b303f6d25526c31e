//! `echelon link`, and what other subcommands do with a link.

use crate::common::{echelon, files, told};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// What `echelon` prints, without the line break; it has to succeed.
fn printed(folder: &Path, args: &[&str]) -> String {
    let (code, out, err) = told(&echelon(folder, args));
    assert_eq!(code, 0, "{args:?}: {err}");
    out.trim_end().to_owned()
}

const SHORT: [&str; 8] = ["link", "line-three", "--set", "law.k=3", "--at", "0.5", "--select", "follower-1"];

#[test]
fn a_link_leads_to_the_run_it_was_made_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let link = printed(folder, &[&SHORT[..], &["--view", "snake+top"]].concat());
    let start = "#line-three?law.k=3&t=0.5&view=snake%2Btop&selected=follower-1&v=";
    assert!(link.starts_with(start), "{link}");
    // The digest is that of a run as long.
    let args =
        ["run", "line-three", "--set", "law.k=3", "--set", "time.duration=0.5", "--no-record", "--json"];
    let (_, out, _) = told(&echelon(folder, &args));
    let run: Value = serde_json::from_str(&out).expect("JSON");
    let digest = run["digest"].as_str().expect("a digest");
    assert!(link.ends_with(&format!("&d={}", &digest[..8])), "{link}: {digest}");
    // With `--page` it is an address, and both open alike.
    let page = printed(folder, &[&SHORT[..], &["--page", "https://example.org/lab.html#old"]].concat());
    assert!(page.starts_with("https://example.org/lab.html#line-three?law.k=3&"), "{page}");
    for link in [&link, &page] {
        let (_, out, _) = told(&echelon(folder, &["run", link, "--no-record"]));
        assert!(out.contains("\nthe same run, bit for bit, up to t = 0.5 s\n"), "{out}");
    }
    let (code, _, err) = told(&echelon(folder, &["run", &link, "-q", "--set", "expect={}"]));
    assert_eq!(code, 0, "{err}");
    assert!(folder.join("runs/line-three-001/manifest.json").exists(), "{:?}", files(folder));
}

#[test]
fn a_run_that_is_another_is_told_and_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let link = "#line-three?@0.2:law.k=3&t=0.5&v=0.0.1&d=00000000";
    let (code, out, err) = told(&echelon(folder.path(), &["run", link, "--no-record", "-q"]));
    assert_eq!((code, &*out), (1, ""));
    assert!(err.contains("DIFFERENT at t = 0.5 s or before: digest 00000000 in the link"), "{err}");
    assert!(err.contains("made by echelon 0.0.1, this is"), "{err}");
    let (code, out, _) = told(&echelon(folder.path(), &["run", link, "--no-record", "--json"]));
    let run: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!((code, &run["link"]["same"], &run["met"]), (1, &Value::from(false), &Value::from(false)));
    // What the command line changes is not compared.
    let (code, out, _) = told(&echelon(folder.path(), &["run", link, "--no-record", "--seed", "5"]));
    assert!(code == 0 && !out.contains("DIFFERENT"), "{out}");
}

#[test]
fn a_scene_of_ones_own_is_carried_in_the_link_or_beside_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let mut text = scene::shipped("line-three").expect("a scene").text.to_owned();
    text.push_str(
        "\n[[props]]\nname = \"p\"\nshape = \"cylinder\"\nradius = 0.1\nheight = 1.0\npose = [9, 9, 0]\n",
    );
    fs::write(folder.join("mine.toml"), &text).expect("written");
    let link = printed(folder, &["link", "mine.toml", "--at", "0.2"]);
    assert!(link.starts_with("#~"), "{link}");
    assert!(
        printed(folder, &["run", &link, "--no-record"])
            .contains("the same run, bit for bit, up to t = 0.2 s")
    );
    assert!(printed(folder, &["check", &link]).starts_with("scene: good: "));
    // Too long for some programs: a file does the same.
    let word = |k: u64| format!("{:016x}", (k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let noise: String = (0..200).map(word).collect();
    fs::write(folder.join("long.toml"), format!("# {noise}\n{text}")).expect("written");
    let (code, _, err) = told(&echelon(folder, &["link", "long.toml", "--at", "0.2"]));
    assert!(code == 0 && err.contains("--out FILE writes a scene"), "{err}");
    let (code, long, err) = told(&echelon(folder, &["link", "long.toml", "--at", "0.2", "-o", "out.toml"]));
    assert!(code == 0 && err.contains("out.toml leads to the same run") && long.len() > 2000, "{err}");
    let digits = long.trim_end().rsplit('=').next().expect("a digest");
    let head = fs::read_to_string(folder.join("out.toml")).expect("a scene");
    assert!(head.starts_with(&format!("# Up to t = 0.2 s the digest of this run begins with {digits}.\n")));
    let args = ["run", "out.toml", "--set", "time.duration=0.2", "--set", "expect={}", "--no-record"];
    assert!(printed(folder, &args).contains(&format!("digest {digits}")));
    let (code, _, err) = told(&echelon(folder, &["link", "long.toml", "--at", "0.2", "-o", "out.toml"]));
    assert!(code == 2 && err.contains("--force"), "{err}");
}

#[test]
fn pictures_are_those_of_the_link() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = ["capture", "#line-three?t=0.5&view=top", "--size", "64x36", "-o", "p", "--samples", "1"];
    printed(folder.path(), &args);
    let args = [
        "capture",
        "line-three",
        "--at",
        "0.5",
        "--view",
        "top",
        "--size",
        "64x36",
        "-o",
        "q",
        "--samples",
        "1",
    ];
    printed(folder.path(), &args);
    let name = "line-three-000.500.png";
    printed(folder.path(), &["compare", &format!("p/{name}"), &format!("q/{name}")]);
}

#[test]
fn bad_links_are_refused_in_words() {
    let folder = tempfile::tempdir().expect("a folder");
    for (args, said) in [
        (&["run", "#circle-tree"][..], "did you mean `circle-three`"),
        (&["check", "https://example.org/lab.html"], "has no `#`"),
        (&["run", "#line-three?t=1&v=0.1.0&d=1a2b"], "cut off"),
        (&["check", "#line-three?warp=9&v=99.0.0&d=1a2b3c4d"], "echelon 99.0.0 made this link"),
        (&["check", "#line-three?view=bird"], "unknown view"),
        (&["link", "line-three", "--at", "-1"], "a time from 0 to"),
        (&["link", "line-three", "--select", "nobody"], "no robot of that name"),
        (&["link", "line-three", "--view", "bird"], "unknown view"),
        (&["link", "line-tree"], "did you mean `line-three`"),
    ] {
        let (code, _, err) = told(&echelon(folder.path(), args));
        assert!(code == 2 && err.contains(said), "{args:?}: {code} {err}");
    }
    assert!(files(folder.path()).is_empty());
}
