//! Studies of many runs: what is made, gone on with, put together and refused.

use crate::common::{command, echelon, told};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

const SHORT: &str = "time.duration=1";

/// The columns of a folder's rows that do not depend on the machine's speed, row by row.
fn rows(folder: &Path) -> Vec<String> {
    let mut columns: Vec<Vec<String>> = vec![];
    let files = sweeps::row_files(folder).expect("files");
    let design = sweeps::Design::new(scene::Study::load(&folder.join("study.toml")).expect("a study"));
    for path in files {
        let mut table = sweeps::RowTable::new(&design);
        recording::append_columns(&path, table.columns_mut()).expect("rows");
        for (k, named) in table.columns().iter().filter(|named| named.name != "wall_time_s").enumerate() {
            columns.resize(columns.len().max(k + 1), vec![]);
            columns[k].extend((0..named.column.len()).map(|row| named.column.text(row)));
        }
    }
    let count = columns.first().map_or(0, Vec::len);
    let mut rows: Vec<String> =
        (0..count).map(|k| columns.iter().map(|c| c[k].as_str()).collect::<Vec<_>>().join(";")).collect();
    rows.sort_by_key(|row| row.split(';').next().and_then(|index| index.parse::<u64>().ok()));
    rows
}

fn json(output: &std::process::Output) -> Value {
    let (code, out, error) = told(output);
    serde_json::from_str(&out).unwrap_or_else(|_| panic!("{code}: {out}{error}"))
}

#[test]
fn rows_are_the_same_on_one_thread_in_shards_and_in_files() {
    let root = tempfile::tempdir().expect("a folder");
    let study = [
        "sweep",
        "line-three",
        "--set",
        SHORT,
        "--vary",
        "law.k=4,6",
        "--seeds",
        "4",
        "--scatter",
        "0.2,10 deg",
        "-q",
    ];
    let run = |more: &[&str]| {
        let (code, _, error) = told(&echelon(root.path(), &[&study[..], more].concat()));
        assert_eq!(code, 0, "{error}");
    };
    run(&["-o", "whole"]);
    run(&["-o", "one", "--threads", "1"]);
    let whole = rows(&root.path().join("whole"));
    assert_eq!((whole.len(), &whole), (8, &rows(&root.path().join("one"))));
    for shard in 1..=3 {
        run(&["-o", &format!("shard-{shard}"), "--shard", &format!("{shard}/3")]);
    }
    let (code, _, error) =
        told(&echelon(root.path(), &["sweep", "merge", "joined", "shard-1", "shard-2", "shard-3", "-q"]));
    assert_eq!((code, rows(&root.path().join("joined"))), (0, whole.clone()), "{error}");
    // Once more, and into one of the parts.
    let merge = |out: &str| {
        told(&echelon(root.path(), &["sweep", "merge", out, "shard-1", "shard-2", "shard-3", "-q"]))
    };
    assert_eq!((merge("joined").0, rows(&root.path().join("joined"))), (0, whole.clone()));
    let (code, _, error) = merge("shard-2");
    assert!(code == 2 && error.contains("into itself"), "{error}");
    run(&["-o", "a.parquet", "--range", "0..5"]);
    run(&["-o", "b.parquet", "--range", "5..8"]);
    let study = ["--study", "whole/study.toml", "-q"];
    let merge = |names: &[&str]| {
        told(&echelon(root.path(), &[&["sweep", "merge", "files"], names, &study[..]].concat()))
    };
    let (code, _, error) = merge(&["b.parquet"]);
    assert!(code == 2 && error.contains("0..5"), "{error}");
    let (code, _, error) = merge(&["a.parquet", "a.parquet", "b.parquet"]);
    assert!(code == 2 && error.contains("run 0 is there twice"), "{error}");
    let (code, _, error) = merge(&["a.parquet", "b.parquet"]);
    assert_eq!((code, rows(&root.path().join("files"))), (0, whole), "{error}");
}

/// The line that is printed with a run makes it again, starts that were scattered and all.
#[test]
fn the_worst_run_is_made_again_by_its_line() {
    let root = tempfile::tempdir().expect("a folder");
    let found = json(&echelon(
        root.path(),
        &[
            "sweep",
            "line-three",
            "--set",
            SHORT,
            "--scatter",
            "0.2,10 deg",
            "--seeds",
            "2",
            "--vary",
            "law.k=normal:5,0.5",
            "--samples",
            "2",
            "--json",
        ],
    ));
    let worst = &found["worst"][0];
    let line = worst["again"].as_str().expect("a line");
    let script = format!("{} --no-record --json", line.replacen("echelon", env!("CARGO_BIN_EXE_echelon"), 1));
    let again =
        std::process::Command::new("sh").args(["-c", &script]).current_dir(root.path()).output().expect("sh");
    assert_eq!(json(&again)["digest"], worst["digest"], "{line}");
    assert_eq!(found["summary"]["runs"], 4);
}

/// Killed as often as it takes; no row is lost, and none is there twice.
#[test]
fn a_study_that_was_killed_goes_on() {
    let root = tempfile::tempdir().expect("a folder");
    let study =
        ["sweep", "line-three", "--set", "time.duration=20", "--vary", "law.k=4..6/40", "--seeds", "5", "-q"];
    let (code, _, error) = told(&echelon(root.path(), &[&study[..], &["-o", "whole"]].concat()));
    assert_eq!(code, 0, "{error}");
    let killed = root.path().join("killed");
    for wait in [300, 2500, 2700] {
        let mut child = command(root.path(), &[&study[..], &["-o", "killed", "--threads", "1"]].concat())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        std::thread::sleep(Duration::from_millis(wait));
        child.kill().expect("killed");
        child.wait().expect("ended");
    }
    let (code, _, error) = told(&echelon(root.path(), &[&study[..], &["-o", "killed"]].concat()));
    assert_eq!(code, 0, "{error}");
    assert_eq!(rows(&killed), rows(&root.path().join("whole")));
    assert!(!killed.join("parts").exists() && killed.join("report.html").exists());
}

#[test]
fn the_edge_is_the_one_of_the_whole_study() {
    let root = tempfile::tempdir().expect("a folder");
    let study = ["sweep", "line-three", "--vary", "law.k=1..8/33", "--vary", "time.duration=1..6/17"];
    let (code, out, error) =
        told(&echelon(root.path(), &[&study[..], &["-o", "edge", "--boundary", "met"]].concat()));
    assert_eq!(code, 0, "{error}");
    assert!(out.contains("times fewer") && out.contains("edge: "), "{out}");
    let (code, _, error) = told(&echelon(root.path(), &[&study[..], &["-o", "whole", "-q"]].concat()));
    assert_eq!(code, 0, "{error}");
    let (some, all) = (rows(&root.path().join("edge")), rows(&root.path().join("whole")));
    assert!(some.len() < all.len() && some.iter().all(|row| all.contains(row)));
    // The rest is made in the same folder.
    let (code, _, error) = told(&echelon(root.path(), &[&study[..], &["-o", "edge", "-q"]].concat()));
    assert_eq!((code, rows(&root.path().join("edge"))), (0, all), "{error}");
}

#[test]
fn theory_is_drawn_over_the_map_and_stays_with_the_study() {
    let root = tempfile::tempdir().expect("a folder");
    let study = ["line-three", "--vary", "law.k=[5,5],[6,6]", "--vary", "time.period=0.01,0.2"];
    let more = ["--seeds", "2", "--set", "time.duration=1", "--theory", "-o", "held"];
    let (code, out, error) = told(&echelon(root.path(), &[&["sweep"], &study[..], &more[..]].concat()));
    assert_eq!(code, 0, "{error}");
    assert!(out.contains("sampled loop stable: true in 2 of 4 cells"), "{out}");
    assert!(out.contains("the same, whatever their seed"), "{out}");
    let read = |file: &str| fs::read_to_string(root.path().join("held").join(file)).expect("a file");
    // A list is one field.
    let theory = read("theory.csv");
    let row = theory.lines().nth(1).expect("a row");
    assert!(theory.starts_with("cell,law.k,time.period,growth_per_period,"), "{theory}");
    assert!(row.starts_with("0,\"[5,5]\",0.01,0.9") && theory.lines().count() == 5, "{theory}");
    let map = read("figures/map-met.svg");
    assert!(map.contains("sampled loop stable"));
    let (code, _, error) = told(&echelon(root.path(), &["sweep", "show", "held", "-q"]));
    assert_eq!((code, read("figures/map-met.svg") == map), (0, true), "{error}");
}

#[test]
fn runs_that_cannot_be_are_rows_and_the_others_go_on() {
    let root = tempfile::tempdir().expect("a folder");
    let study = ["sweep", "line-three", "--vary", "robots.follower-1.pose=uniform:-1..1", "--samples", "2"];
    let (code, _, error) = told(&echelon(root.path(), &study));
    assert!(code == 2 && error.contains("robots.follower-1.pose"), "{error}");
    // Gains below 0 are drawn now and then.
    let drawn = ["sweep", "line-three", "--set", SHORT, "--vary", "law.k=normal:1,2", "--samples", "20"];
    let found = json(&echelon(root.path(), &[&drawn[..], &["--json", "-o", "drawn"]].concat()));
    let count = |status: &str| found["summary"]["by_status"][status].as_u64().unwrap_or(0);
    assert!(count("refused") > 0 && count("complete") > 0, "{found}");
    assert_eq!(count("refused") + count("complete"), 20);
    // Nothing keeps this limit.
    let found = json(&echelon(
        root.path(),
        &["sweep", "line-three", "--set", "time.duration=2000", "--seeds", "2", "--limit", "0.001", "--json"],
    ));
    assert_eq!(found["summary"]["by_status"]["expired"], 2);
    let (code, _, error) = told(&echelon(
        root.path(),
        &["sweep", "line-three", "--set", SHORT, "-q", "--met-at-least", "1", "-o", "x"],
    ));
    assert!(code == 1 && error.contains("100.00 % are asked for"), "{error}");
}

#[test]
fn what_cannot_be_a_study_is_said_before_anything_runs() {
    let root = tempfile::tempdir().expect("a folder");
    let at = |name: &str| root.path().join(name);
    fs::write(
        at("study.toml"),
        "schema = 1\nscene = \"line-three\"\n[vary]\n\"law.k\" = \"1..2/3\"\n\"law.kk\" = \"1..2/3\"\n",
    )
    .expect("written");
    fs::write(at("other.toml"), "schema = 1\nscene = \"line-three\"\nset = [\"time.duration=1\"]\n")
        .expect("written");
    let set = "set = [\"time.duration=1\", \"law.q=1\"]";
    fs::write(at("set.toml"), format!("schema = 1\nscene = \"line-three\"\n{set}\n")).expect("written");
    let two = "set = [\"vehicle.wheelbase=0.6\", \"law.p=1\", \"vehicle.length=0.6\"]";
    fs::write(at("two.toml"), format!("schema = 1\nscene = \"line-three\"\n{two}\n")).expect("written");
    fs::write(at("lost.toml"), "schema = 1\nscene = \"lost-scene.toml\"\n").expect("written");
    for (args, wanted) in [
        (vec!["study.toml"], "study.toml:5:1"),
        (vec!["set.toml"], "set.toml:3:27: unknown key `q`"),
        (vec!["set.toml", "--set", "law.p=1"], "unknown key `p`"),
        (vec!["two.toml"], "two.toml:3:33: unknown key `p`"),
        (vec!["other.toml", "--set", "law.p=1"], "--set:1:5: unknown key `p`"),
        (vec!["lost.toml"], "lost.toml:2:9: no such file"),
        (vec!["line-three", "--vary", "law.kk=1,2"], "--vary law.kk: `law.kk` cannot be 1"),
        (vec!["line-three", "--vary", "law.k=-1,2"], "cannot be -1"),
        (
            vec!["line-three", "--vary", "law.k=1..2/1000000", "--vary", "law.beta=1..2/1000000"],
            "1000000000000 cells",
        ),
        (vec!["line-three", "--vary", "law.k=1,2", "--vary", "law={ k = 2 }"], "contradict"),
        (vec!["line-three", "--vary", "law.k"], "KEY=VALUES"),
        (vec!["line-three", "--vary", "law.k=3..1/5"], "does not rise"),
        (vec!["line-three", "--samples", "5"], "`seeds`"),
        (vec!["line-three", "--range", "5..9"], "the study has 1 run"),
        (vec!["line-three", "--shard", "4/3"], "from 1 to N"),
        (vec!["line-three", "--boundary", "met"], "--boundary needs"),
        (vec!["line-three", "--theory", "--vary", "law.k=1,2"], "--theory needs two keys"),
        (vec!["line-three", "--seeds", "0"], "0 is not in 1.."),
        (vec!["no-such-scene"], "no such file"),
        (vec!["vision-seven-v"], "take pictures"),
        (vec!["merge", "out", "study.toml"], "--study"),
        (vec!["show", "nowhere"], "study.json"),
        (vec![], "STUDY|SCENE"),
    ] {
        let (code, _, error) = told(&echelon(root.path(), &[&["sweep"], &args[..]].concat()));
        assert!(code == 2 && error.contains(wanted), "{args:?}: {code} {error}");
    }
    assert!(!at("sweeps").exists());
    // A folder belongs to one study.
    let sweep = |file: &str, more: &[&str]| {
        told(&echelon(root.path(), &[&["sweep", file, "-o", "folder", "-q"], more].concat()))
    };
    assert_eq!(sweep("other.toml", &[]).0, 0);
    let (code, _, error) = sweep("other.toml", &["--seed", "2"]);
    assert!(code == 2 && error.contains("another study") && error.contains("--force"), "{error}");
    assert_eq!(sweep("other.toml", &["--seed", "2", "--force"]).0, 0);
    fs::create_dir(at("mine")).expect("made");
    fs::write(at("mine/notes.txt"), "mine").expect("written");
    let (code, _, error) =
        told(&echelon(root.path(), &["sweep", "other.toml", "-o", "mine", "-q", "--force"]));
    assert!(code == 2 && error.contains("other files"), "{error}");
}
