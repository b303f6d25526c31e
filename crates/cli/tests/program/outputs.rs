//! Where results go: looked at before the work, told whatever becomes of a file, and nobody else's files touched.

use crate::common::{command, echelon, files, scene, told};
use std::fs;
use std::path::Path;
use std::process::Stdio;

const SHORT: [&str; 4] = ["--set", "time.duration=1", "--set", "expect={}"];

fn run(folder: &Path, args: &[&str]) -> (i32, String, String) {
    told(&echelon(folder, args))
}

#[test]
fn folders_are_made_where_they_are_missing() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = scene("line-three");
    let small = ["--size", "64x48", "--set", "time.duration=0.2", "--set", "expect={}", "-q"];
    let args = [&["run", &line, "--no-record", "--junit", "reports/deep/x.xml"], &SHORT[..]].concat();
    let (code, out, err) = run(folder.path(), &args);
    assert!(code == 0 && out.contains("samples") || out.contains("steps"), "{code} {out}{err}");
    assert!(folder.path().join("reports/deep/x.xml").exists());
    for film in ["new/dir/f.mp4", "new/gif/f.gif", "new/frames/f"] {
        let (code, _, err) =
            run(folder.path(), &[&["film", &line, "-o", film, "--fps", "5"], &small[..]].concat());
        assert!(code == 0 && folder.path().join(film).exists(), "{film}: {err}");
    }
    let (code, _, err) =
        run(folder.path(), &[&["capture", &line, "-o", "new/pictures/deep"], &small[..]].concat());
    assert!(code == 0 && folder.path().join("new/pictures/deep/line-three-000.200.png").exists(), "{err}");
}

/// Before the work begins, and without a trace.
#[test]
fn places_that_cannot_be_are_refused_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("file"), "mine").expect("written");
    fs::create_dir(at("folder")).expect("made");
    let before = files(folder.path());
    let line = scene("line-three");
    // A run this long would not end before the test does.
    let long = ["--set", "time.duration=20000"];
    for (args, code, words) in [
        (vec!["run", &line, "--no-record", "--junit", "folder"], 2, "is a folder"),
        (vec!["run", &line, "--no-record", "--junit", "file/x.xml"], 2, "file is a file: name a folder"),
        (vec!["run", &line, "--no-record", "--json", "--junit", "-"], 2, "name a file for one of them"),
        (vec!["compare", "folder", "folder", "--json", "--junit", "-"], 2, "name a file for one of them"),
        (vec!["run", &line, "-o", "file"], 2, "is a file"),
        (vec!["run", &line, "-o", "-"], 2, "standard output"),
        (vec!["film", &line, "-o", "-"], 2, "standard output"),
        (vec!["film", &line, "-o", "file/f.mp4"], 2, "file is a file: name a folder"),
        (vec!["film", &line, "-o", "x.png"], 2, "x.png is no name of a film: write NAME.mp4, .m4v or .gif"),
        (vec!["film", &line, "-o", "x.xyz"], 2, ".webm, .mkv"),
        (vec!["film", &line, "-o", "deep/.mp4"], 2, "deep/.mp4 is no name of a film"),
        (vec!["film", &line, "-o", "frames", "--ffmpeg"], 2, "frames is no name of a film"),
        (vec!["run", &line, "-o", "run.mcap"], 2, "leave the ending out"),
        (vec!["capture", &line, "-o", "deep/x.png"], 2, "deep/x.png has the ending of a file"),
        (vec!["stills", &line, "-o", "x.png"], 2, "leave the ending out"),
        (vec!["figures", &line, "-o", "x.pdf", "--no-pictures"], 2, "leave the ending out"),
        (vec!["dataset", &line, "-o", "x.json"], 2, "leave the ending out"),
        (vec!["budget", &line, "-o", "x.svg"], 2, "leave the ending out"),
        (vec!["certify", &line, "-o", "x.json"], 2, "leave the ending out"),
        (vec!["capture", &line, "-o", "file"], 2, "is a file"),
        (vec!["capture", &line, "-o", "-"], 2, "standard output"),
        (vec!["stills", &line, "-o", "file"], 2, "is a file"),
        (vec!["certify", &line, "-o", "file"], 2, "is a file"),
        (vec!["budget", &line, "-o", "file"], 2, "is a file"),
        (vec!["dataset", &line, "-o", "file"], 2, "is a file"),
        (vec!["figures", &line, "-o", "file", "--no-pictures"], 2, "is a file"),
        (vec!["compare", "folder", "folder", "-o", "file"], 2, ""),
    ] {
        let more: &[&str] = if args[0] == "compare" { &[] } else { &long };
        let (found, _, err) = run(folder.path(), &[&args[..], more].concat());
        assert!(found == code && err.contains(words), "{args:?}: {found} {err}");
        assert_eq!(files(folder.path()), before, "{args:?}");
    }
    assert_eq!(fs::read_to_string(at("file")).expect("kept"), "mine");
    if cfg!(unix) {
        let args = [&["run", &line, "--no-record", "--junit", "/dev/null"], &long[..]].concat();
        let (code, _, err) = run(folder.path(), &args);
        assert!(code == 2 && err.contains("device"), "{err}");
    }
}

/// `report.tmp` was taken for the draft of `report.xml`, and `film.mp4` left nothing but its own.
#[test]
fn files_beside_an_output_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let names = ["report.tmp", "line-three.tmp", "manifest.tmp"];
    for name in names {
        fs::write(folder.path().join(name), "mine").expect("written");
    }
    let line = scene("line-three");
    let args = [&["run", &line, "--no-record", "-q", "--junit", "report.xml"], &SHORT[..]].concat();
    assert_eq!(run(folder.path(), &args).0, 0);
    for name in names {
        assert_eq!(fs::read_to_string(folder.path().join(name)).expect("kept"), "mine", "{name}");
    }
    assert_eq!(files(folder.path()).len(), names.len() + 1);
}

/// Two runs in one folder would leave a mixture of both.
#[cfg(unix)]
#[test]
fn a_folder_that_a_live_run_writes_is_refused_though_forced() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = scene("line-three");
    let args = ["run", &line, "-o", "run", "--set", "time.duration=20000"];
    let mut child = command(folder.path(), &args).stderr(Stdio::null()).spawn().expect("started");
    let manifest = folder.path().join("run/manifest.json");
    for _ in 0..600 {
        if manifest.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let again = [&["run", &line, "-o", "run", "-q", "--force"], &SHORT[..]].concat();
    let refused = run(folder.path(), &again);
    let before = fs::read_to_string(&manifest).expect("a manifest");
    child.kill().expect("killed");
    child.wait().expect("ended");
    assert!(refused.0 == 2 && refused.2.contains("another program"), "{}", refused.2);
    assert!(before.contains("20000"), "{before}");
    // What was killed holds nothing back.
    let (code, _, err) = run(folder.path(), &again);
    assert_eq!(code, 0, "{err}");
    assert!(!folder.path().join("run/.lock").exists());
}

/// The last sample of a run of 2.3 s stands at 230 · 0.01 = 2.3000000000000003 s.
#[test]
fn one_rule_for_times() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = scene("line-three");
    let capture = |at: &str| {
        let base =
            ["capture", &line, "--size", "64x48", "--set", "time.duration=2.3", "--set", "expect={}", "-q"];
        run(folder.path(), &[&base[..], &["--at", at]].concat())
    };
    for at in ["2.3000000000000003,-0", "1.0001", "1.0004", "2.3"] {
        let (code, _, err) = capture(at);
        assert_eq!(code, 0, "{at}: {err}");
    }
    let names: Vec<String> = files(folder.path())
        .iter()
        .filter_map(|path| path.file_name().map(|name| name.to_string_lossy().into_owned()))
        .collect();
    let wanted = ["000.000", "001.0001", "001.0004", "002.300"].map(|t| format!("line-three-{t}.png"));
    assert_eq!(names, wanted);
    let (code, _, err) = capture("2.31");
    assert!(code == 2 && err.contains("0 to 2.3 s"), "{err}");
}

/// The crash ends its run at 1.41 s: there is no picture of 3 s.
#[test]
fn a_picture_after_the_end_is_called_by_the_time_it_shows() {
    let folder = tempfile::tempdir().expect("a folder");
    let base =
        ["capture", &scene("cars-crash"), "--size", "64x48", "--set", "physics.on_contact=stop", "--json"];
    let (code, out, err) = run(folder.path(), &[&base[..], &["--at", "1,2,3"]].concat());
    assert_eq!(code, 0, "{err}");
    let names: Vec<String> = files(folder.path()).iter().map(|path| path.display().to_string()).collect();
    assert!(names.len() == 2 && names[1].ends_with("cars-crash-001.410.png"), "{names:?}");
    assert!(err.contains("the run ended at 1.41 s"), "{err}");
    let value: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    assert!((value["times"][1].as_f64().expect("a time") - 1.41).abs() < 1e-9, "{out}");
}

#[test]
fn scenes_are_found_by_name_from_anywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, err) =
        run(folder.path(), &[&["run", "circle-three", "--no-record"], &SHORT[..]].concat());
    assert!(code == 0 && out.contains("leader"), "{out}{err}");
    let (code, out, _) = run(folder.path(), &["scenes"]);
    assert!(code == 0 && out.lines().count() >= 28 && out.contains("cars-yard"), "{out}");
    let (code, out, _) = run(folder.path(), &["scenes", "circle-three"]);
    assert_eq!(code, 0);
    assert_eq!(out, fs::read_to_string(scene("circle-three")).expect("a scene"));
    for args in [["run", "circle-tree"], ["check", "scenes/circle-three.toml"], ["scenes", "circle-tree"]] {
        let (code, _, err) = run(folder.path(), &args);
        assert!(code == 2 && err.contains("`circle-three`"), "{args:?}: {err}");
    }
    // A file of that name comes first.
    fs::write(folder.path().join("circle-three"), "schema = 1\n").expect("written");
    let (code, _, err) = run(folder.path(), &["check", "circle-three"]);
    assert!(code == 2 && err.contains("title"), "{err}");
}

/// Every line of the start and of the help that begins with `echelon` is a line that works.
#[test]
fn the_examples_of_the_start_work_anywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, start, _) = run(folder.path(), &[]);
    let lines: Vec<&str> = start.lines().filter_map(|line| line.strip_prefix("  echelon ")).collect();
    assert!(lines.len() >= 5, "{start}");
    for line in lines {
        let mut args: Vec<&str> = line.split(' ').take_while(|word| *word != ">").collect();
        match args[0] {
            "film" => args.extend(["--size", "64x48", "--fps", "2"]),
            "capture" => args.extend(["--size", "64x48"]),
            _ => {}
        }
        let (code, _, err) = run(folder.path(), &args);
        // ε = 0.1 is there to show what goes wrong.
        assert!(code == 0 || line.contains("epsilon=0.1") && code == 1, "{line}: {err}");
    }
}

#[test]
fn a_scene_that_cannot_be_read_is_a_junit_error() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("bad.toml"), "schema = = 1\n").expect("written");
    let (code, _, err) = run(folder.path(), &["run", "bad.toml", "--no-record", "--junit", "ci/report.xml"]);
    assert_eq!(code, 2, "{err}");
    let report = fs::read_to_string(folder.path().join("ci/report.xml")).expect("a report");
    assert!(report.contains("errors=\"1\"") && report.contains("bad.toml:1:"), "{report}");
}

#[test]
fn titles_do_not_steer_the_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = fs::read_to_string(scene("line-three")).expect("a scene");
    let from = text.lines().find(|line| line.starts_with("title")).expect("a title");
    let text = text.replace(from, "title = \"a\\u001b[31mred\\u0007\\u009b2J\\u202eb\"");
    fs::write(folder.path().join("red.toml"), text).expect("written");
    for args in [
        &["check", "red.toml"][..],
        &["check", "red.toml", "--resolved"],
        &["run", "red.toml", "--no-record"],
    ] {
        let (_, out, err) = run(folder.path(), args);
        let steering = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
        assert!(!out.contains(steering) && !err.contains(steering), "{args:?}: {out:?} {err:?}");
        assert!(out.contains("red"), "{out}");
    }
    let (_, out, _) = run(folder.path(), &["check", "red.toml", "--resolved"]);
    fs::write(folder.path().join("again.toml"), out).expect("written");
    assert_eq!(run(folder.path(), &["check", "again.toml"]).0, 0);
}

/// A disk that takes `blocks` of 1024 bytes in a file and no more, as a full one does.
#[cfg(target_os = "linux")]
fn on_a_full_disk(folder: &Path, blocks: u32, args: &[&str]) -> (i32, String, String) {
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let mut command = std::process::Command::new("bash");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_echelon")]).args(args).current_dir(folder);
    told(&command.output().expect("it ran"))
}

/// What there is all the same stood nowhere, nor that a film goes on.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_with_what_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = scene("line-three");
    let run_on = |blocks: u32, args: &[&str]| on_a_full_disk(folder.path(), blocks, args);
    let (code, _, err) =
        run_on(400, &["run", &line, "-q", "-o", "run", "--set", "time.duration=200", "--set", "expect={}"]);
    assert!(code == 3 && err.contains("; run keeps the run up to "), "{err}");
    assert!(err.contains("which `echelon replay run` draws") && err.contains("says interrupted"), "{err}");
    let manifest = fs::read_to_string(folder.path().join("run/manifest.json")).expect("a manifest");
    assert!(manifest.contains("\"interrupted\""), "{manifest}");
    let film = ["film", &line, "-q", "--size", "320x180", "--fps", "5", "-o"];
    let (code, _, err) = run_on(60, &[&film[..], &["f.mp4"]].concat());
    let (_, rest) = err.split_once("; the first ").unwrap_or_else(|| panic!("{code} {err}"));
    let seconds: f64 =
        rest.split_once(" s are kept beside it").expect("how much").0.parse().expect("seconds");
    assert!(code == 3 && seconds >= 2.0 && err.contains("the same command goes on from there"), "{err}");
    assert!(!folder.path().join("f.mp4").exists());
    let (code, out, err) = run(
        folder.path(),
        &[&["film", &line, "--size", "320x180", "--fps", "5", "-o"], &["f.mp4"][..]].concat(),
    );
    assert!(code == 0 && err.contains(&format!("going on after {seconds:.2} s")), "{out}{err}");
    let (code, _, err) = run_on(30, &[&film[..], &["f.gif"]].concat());
    assert!(code == 3 && err.contains("nothing of the film is kept"), "{err}");
    let pictures = ["capture", &line, "-q", "--at", "0,1", "--size", "640x360"];
    let (code, _, err) = run_on(4, &pictures);
    assert!(code == 3 && err.contains("0 of 2 pictures were written before"), "{err}");
}

/// Small and short.
fn drawn<'a>(args: &[&'a str]) -> Vec<&'a str> {
    [args, &["--size", "64x48", "--set", "time.duration=0.2", "--set", "expect={}"]].concat()
}

/// A film replaced another without a word. One rule for all: files are replaced, and that is told.
#[test]
fn what_is_replaced_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = scene("line-three");
    let film = drawn(&["film", &line, "-o", "f.mp4", "--fps", "5"]);
    let pictures = drawn(&["capture", &line, "-o", "p", "--at", "0,0.1"]);
    let (line_args, plain) = (["--set", "time.duration=1", "--set", "expect={}"], &line);
    let report = [&["run", plain, "--no-record", "--junit", "r.xml"], &line_args[..]].concat();
    let certificate = [&["certify", plain, "-o", "c", "--paper-only"], &line_args[..]].concat();
    for (args, name) in [
        (film, "f.mp4"),
        (drawn(&["film", &line, "-o", "f.gif", "--fps", "5"]), "f.gif"),
        (pictures, "p/line-three-000.000.png, p/line-three-000.100.png"),
        (
            drawn(&["stills", &line, "-o", "s", "--count", "2"]),
            "s/line-three-sheet.png, s/line-three-strobe.png",
        ),
        (report, "r.xml"),
        (certificate, "c/certificate.json"),
    ] {
        let (code, _, err) = run(folder.path(), &args);
        assert!(code == 0 && !err.contains("replaced"), "{args:?}: {err}");
        let (code, _, err) = run(folder.path(), &args);
        assert!(code == 0 && err.contains(&format!("replaced {name}")), "{args:?}: {err}");
        let (code, _, err) = run(folder.path(), &[&args[..], &["-q"]].concat());
        assert!(code == 0 && err.is_empty(), "{args:?}: {err}");
    }
}

#[test]
fn there_is_a_manual_page_for_every_subcommand() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, _, err) = told(&echelon(folder.path(), &["manuals", "man/man1"]));
    assert_eq!(code, 0, "{err}");
    let page = |name: &str| {
        let path = folder.path().join(format!("man/man1/{name}.1"));
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let (_, help, _) = told(&echelon(folder.path(), &["--help"]));
    let commands = help.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1);
    let commands = commands
        .take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<&str> = commands.filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.len() > 15, "{names:?}");
    let whole = page("echelon");
    for name in names.into_iter().filter(|name| *name != "help") {
        assert!(whole.contains(&format!("echelon\\-{name}(1)")), "{name}");
        assert!(page(&format!("echelon-{name}")).contains(".SH SYNOPSIS"), "{name}");
    }
    assert!(page("echelon-laws-test").contains("turn"), "subcommands of subcommands have pages, too");
    fs::write(folder.path().join("file"), "").expect("a file");
    let (code, _, err) = told(&echelon(folder.path(), &["manuals", "file"]));
    assert!(code == 3 && err.contains("cannot write to file"), "{err}");
}
