//! Laws that are WebAssembly modules, on the command line.

use crate::common::{echelon, scene, told};
use std::fs;

/// `laws/c/output_feedback.c`, built.
const C: &[u8] = include_bytes!("../../../laws/tests/modules/output_feedback.wasm");

#[test]
fn a_module_is_checked_tested_driven_and_replayed_like_a_law_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |args: &[&str]| told(&echelon(folder.path(), args));
    fs::write(folder.path().join("mine.wasm"), C).expect("written");
    let (code, out, err) = run(&["laws", "check", "mine.wasm"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.starts_with("mine.wasm: good: Output feedback (eq 42), in C; knows distance and bearing;"),
        "{out}"
    );
    // The loop is that of the same law as a law file.
    let [module, file] = ["mine.wasm", "output-feedback"].map(|law| run(&["laws", "test", law]));
    assert_eq!((module.0, file.0), (0, 0), "{}", module.2);
    // A module may read the clock, so it is followed for the whole minute.
    let loop_of = |out: &str| {
        let lines =
            out.lines().skip(1).map(|line| line.split_once(" s: error").map_or(line, |(_, rest)| rest));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(loop_of(&module.1), loop_of(&file.1));
    // A run carries the module, and replays without it.
    let home = scene("line-three");
    let set = ["--set", "law.file=mine.wasm", "--set", "time.duration=1", "--set", "expect={}"];
    fs::copy(&home, folder.path().join("mine.toml")).expect("copied");
    let (code, _, err) = run(&[&["run", "mine.toml", "-o", "out"], &set[..]].concat());
    assert_eq!(code, 0, "{err}");
    fs::remove_file(folder.path().join("mine.wasm")).expect("removed");
    let (code, _, err) = run(&["replay", "out"]);
    assert_eq!(code, 0, "{err}");
}

#[test]
fn a_module_that_is_no_law_or_does_not_end_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("empty.wasm"), b"\0asm\x01\0\0\0").expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["laws", "check", "empty.wasm"]));
    assert_eq!(code, 2);
    for word in ["empty.wasm: it exports no `memory`", "empty.wasm: it exports no function `decide`"] {
        assert!(err.contains(word), "{err}");
    }
    let endless = include_str!("../../../laws/tests/modules/counter.wat").replace(
        "(f64.store (local.get $memory)",
        "(loop $again (br $again)) (f64.store (local.get $memory)",
    );
    let endless = wat::parse_str(endless).expect("a module");
    fs::write(folder.path().join("endless.wasm"), endless).expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["laws", "test", "endless.wasm"]));
    assert_ne!(code, 0);
    assert!(err.contains("endless.wasm: out of fuel: it ran for more than 5000000 instructions"), "{err}");
}
