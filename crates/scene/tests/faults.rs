//! One test for each way a scene can be wrong: where it points, and what it says.

use scene::{Diagnostic, Scene};
use std::{fs, io::Write, path::Path};

/// A scene without faults; the tests change lines of it.
const GOOD: &str = "\
schema = 1
title = \"Two robots\"

[time]
duration = 10.0
period = 0.01

[observer]
epsilon = 0.001

[[robots]]
name = \"leader\"
pose = [0.0, 0.0, 0.0]
path = { kind = \"constant\", speed = 1.0 }

[[robots]]
name = \"follower\"
pose = [-2.0, -1.0, 0.0]
leader = \"leader\"
distance = 2.0
bearing = \"-135 deg\"
";

fn faults(text: &str) -> Vec<Diagnostic> {
    match Scene::parse(text, "test.toml", &[]) {
        Ok(_) => vec![],
        Err(diagnostics) => diagnostics.all().to_vec(),
    }
}

/// Asserts that `text` has one fault, at `line:column`, whose message holds all `words`.
#[track_caller]
fn assert_fault(text: &str, at: (usize, usize), words: &[&str]) {
    let faults = faults(text);
    let [fault] = faults.as_slice() else { panic!("one fault expected, not {faults:#?}") };
    assert_eq!((fault.line, fault.column), at, "{fault}");
    for word in words {
        assert!(fault.message.contains(word), "`{word}` is not in: {}", fault.message);
    }
    assert_eq!(Some(fault.excerpt.as_str()), text.lines().nth(at.0 - 1), "{fault}");
}

/// As [`assert_fault`], with `from` replaced by `to` in the good scene.
#[track_caller]
fn assert_changed(from: &str, to: &str, at: (usize, usize), words: &[&str]) {
    assert!(GOOD.contains(from), "{from}");
    assert_fault(&GOOD.replacen(from, to, 1), at, words);
}

/// Asserts that the file at `path` is refused as a whole, with `words`.
#[track_caller]
fn assert_refused(path: &Path, words: &[&str]) {
    let diagnostics = Scene::load(path, &[]).unwrap_err();
    let [fault] = diagnostics.all() else { panic!("one fault expected, not {diagnostics}") };
    assert_eq!((fault.line, fault.column), (0, 0));
    assert!(diagnostics.to_string().starts_with(&path.display().to_string()), "{diagnostics}");
    for word in words {
        assert!(fault.message.contains(word), "`{word}` is not in: {}", fault.message);
    }
}

#[test]
fn the_good_scene_is_good() {
    assert_eq!(faults(GOOD), []);
    assert_eq!(faults(&GOOD.replace('\n', "\r\n")), []);
}

#[test]
fn missing_empty_and_directory() {
    let folder = tempfile::tempdir().unwrap();
    assert_refused(&folder.path().join("nowhere.toml"), &["no such file"]);
    assert_refused(folder.path(), &["is a directory"]);
    let empty = folder.path().join("empty.toml");
    fs::write(&empty, " \n").unwrap();
    assert_refused(&empty, &["is empty", "schema = 1"]);
}

#[test]
fn hundred_megabytes_are_refused_unread() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.toml");
    fs::File::create(&path).unwrap().set_len(100_000_000).unwrap();
    assert_refused(&path, &["larger than 10 MB"]);
}

#[test]
fn not_utf8() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("latin.toml");
    fs::File::create(&path).unwrap().write_all(b"schema = 1\ntitle = \"Br\xfccke\"\n").unwrap();
    assert_refused(&path, &["not UTF-8", "line 2"]);
}

#[test]
fn not_toml() {
    assert_changed("duration = 10.0", "duration = = 10.0", (5, 12), &["not TOML"]);
    assert_changed("period = 0.01", "duration = 0.01", (6, 1), &["not TOML", "duplicate key"]);
    assert_changed("[time]", "[time", (4, 6), &["not TOML"]);
}

#[test]
fn wrong_types() {
    assert_changed("10.0", "\"ten\"", (5, 12), &["`duration`", "number in s", "the text \"ten\""]);
    assert_changed("\"Two robots\"", "2", (2, 9), &["`title`", "text", "`2`"]);
    assert_changed("[-2.0, -1.0, 0.0]", "[-2.0, -1.0]", (18, 8), &["`pose`", "three values", "list of 2"]);
    assert_changed("0.001", "true", (9, 11), &["`epsilon`", "number in s", "`true`"]);
    assert_changed(
        "{ kind = \"constant\", speed = 1.0 }",
        "1979-05-27",
        (14, 8),
        &["`path`", "a table", "date"],
    );
    assert_changed("[time]\nduration", "[[time]]\nduration", (4, 1), &["`time`", "a table", "a list of 1"]);
}

#[test]
fn nan_and_infinities() {
    assert_changed("10.0", "nan", (5, 12), &["`duration`", "`nan`"]);
    assert_changed("10.0", "inf", (5, 12), &["`duration`", "at most", "`inf`"]);
    assert_changed("[0.0, 0.0, 0.0]", "[0.0, -inf, 0.0]", (13, 14), &["`pose`", "`-inf`"]);
    assert_changed("\"-135 deg\"", "\"nan deg\"", (21, 11), &["`bearing`", "\"nan deg\""]);
    assert_changed("10.0", "1e999", (5, 12), &["`duration`"]);
}

#[test]
fn distance_not_above_zero() {
    assert_changed("distance = 2.0", "distance = -2.0", (20, 12), &["`distance`", "above 0", "`-2.0`"]);
    assert_changed("distance = 2.0", "distance = 0", (20, 12), &["`distance`", "above 0", "`0`"]);
    let swing = "distance = { mean = 1.0, amplitude = 0.95, rate = 1.0 }";
    assert_changed("distance = 2.0", swing, (20, 12), &["falls to 0.05", "distance_min"]);
}

#[test]
fn bearing_beyond_half_a_turn() {
    assert_changed("\"-135 deg\"", "\"-181 deg\"", (21, 11), &["`bearing`", "-180 deg to 180 deg"]);
    assert_changed("\"-135 deg\"", "3.2", (21, 11), &["`bearing`", "`3.2`"]);
    assert_eq!(faults(&GOOD.replace("-135 deg", "-180 deg")), []);
    assert_changed("\"-135 deg\"", "\"-135 degrees\"", (21, 11), &["`bearing`", "\"135 deg\""]);
}

#[test]
fn unknown_keys_name_the_nearest() {
    assert_changed("duration", "durration", (5, 1), &["unknown key `durration`", "did you mean `duration`?"]);
    assert_changed("[observer]", "[obsever]", (8, 2), &["`obsever`", "`observer`?"]);
    assert_changed("speed = 1.0", "sped = 1.0", (14, 29), &["`sped`", "`speed`?", "`turn_rate`"]);
    assert_changed("\"constant\"", "\"circel\"", (14, 17), &["`kind`", "did you mean `circle`?"]);
    assert_changed("title", "colour = 3\ntitle", (2, 1), &["unknown key `colour`", "known here"]);
}

#[test]
fn missing_keys() {
    assert_changed("schema = 1\n", "", (1, 1), &["`schema` is missing"]);
    assert_changed("schema = 1", "schema = 2", (1, 10), &["`schema` must be 1", "`2`"]);
    assert_changed("name = \"leader\"\n", "", (11, 1), &["`name` is missing"]);
    assert_changed("distance = 2.0\n", "", (19, 10), &["`distance` is missing"]);
}

#[test]
fn roles() {
    assert_changed("leader = \"leader\"\n", "", (17, 8), &["`follower` is not connected", "`path`"]);
    let both = "leader = \"leader\"\npath = { kind = \"constant\" }";
    assert_changed("leader = \"leader\"", both, (19, 10), &["a `path` and a `leader`"]);
    assert_changed(
        "speed = 1.0 }",
        "speed = 1.0 }\nbearing = 1.0",
        (15, 1),
        &["`bearing`", "`leader` leads"],
    );
}

#[test]
fn several_robots_may_lead() {
    let text = format!("{GOOD}\n[[robots]]\nname = \"lone\"\npose = [0, 5, 0]\npath.kind = \"constant\"\n");
    assert_eq!(faults(&text), []);
}

#[test]
fn unknown_leader() {
    assert_changed(
        "leader = \"leader\"",
        "leader = \"leda\"",
        (19, 10),
        &["no robot called `leda`", "`leader`?"],
    );
    assert_changed("leader = \"leader\"", "leader = \"follower\"", (19, 10), &["cannot follow itself"]);
}

const MORE: &str = "
[[robots]]
name = \"NAME\"
pose = [0.0, 5.0, 0.0]
leader = \"LEADER\"
distance = 2.0
bearing = 0.5
";

fn another(name: &str, leader: &str) -> String {
    MORE.replace("NAME", name).replace("LEADER", leader)
}

#[test]
fn duplicate_names() {
    let text = format!("{GOOD}{}", another("follower", "leader"));
    assert_fault(&text, (24, 8), &["two robots called `follower`"]);
    // A robot of a group stands where its own name is written.
    let group = "[[groups]]\nname = \"g\"\nshape = \"column\"\ncount = 3\nleader = \"leader\"\n";
    let member = "[groups.members.g-2]\nname = \"follower\"\n";
    assert_fault(&format!("{GOOD}\n{group}{member}"), (29, 8), &["two robots called `follower`"]);
}

/// What was typed is at fault, though the robot stands before the other in the file.
#[test]
fn a_name_given_twice_by_the_command_line_is_shown_there() {
    let change = "robots.leader.name=follower".parse().unwrap();
    let diagnostics = Scene::parse(GOOD, "test.toml", &[change]).unwrap_err();
    let twice = diagnostics.all().iter().find(|fault| fault.message.contains("two robots")).unwrap();
    assert_eq!((twice.origin.as_str(), twice.column), ("--set", 20), "{diagnostics}");
}

#[test]
fn cycles_name_their_robots() {
    let text = format!("{GOOD}{}{}{}", another("a", "c"), another("b", "a"), another("c", "b"));
    assert_fault(&text, (26, 10), &["form a cycle", "`a` follows `c` follows `b` follows `a`"]);
    let tail = format!("{text}{}", another("d", "a"));
    assert_eq!(faults(&tail).len(), 1, "a robot behind a cycle is no second cycle");
}

#[test]
fn no_robot_and_one_robot() {
    let none = GOOD.split("[[robots]]").next().unwrap();
    assert_fault(none, (1, 1), &["at least one robot", "[[robots]]"]);
    let one = GOOD.rsplit_once("[[robots]]").unwrap().0;
    assert_eq!(faults(one), []);
}

#[test]
fn period_larger_than_duration() {
    assert_changed("0.01", "11.0", (6, 10), &["`period` of 11 s", "`duration` of 10 s"]);
    assert_changed(
        "duration = 10.0\nperiod = 0.01",
        "duration = 0.001",
        (5, 12),
        &["larger than `duration`"],
    );
    assert_changed(
        "duration = 10.0\nperiod = 0.01",
        "duration = 1e5\nperiod = 1e-5",
        (6, 10),
        &["control periods"],
    );
    assert_changed("0.01", "0", (6, 10), &["`period`", "from 0.00001"]);
}

#[test]
fn observer_epsilon_not_above_zero() {
    assert_changed("epsilon = 0.001", "epsilon = 0.0", (9, 11), &["`epsilon`", "above 0", "`0.0`"]);
    assert_changed("epsilon = 0.001", "epsilon = [0.001, -1]", (9, 19), &["`epsilon`", "above 0", "`-1`"]);
    assert_changed("epsilon = 0.001", "alpha1 = 0", (9, 10), &["`alpha1`", "above 0"]);
}

#[test]
fn limits_that_contradict() {
    assert_changed(
        "[observer]",
        "[vehicle]\nspeed_min = 2.0\n[observer]",
        (9, 13),
        &["`speed_min`", "below"],
    );
    let fast = ["`path` reaches 2 m/s", "`speed_max`"];
    assert_changed("speed = 1.0", "speed = 2.0", (14, 8), &fast);
    assert_changed(
        "distance = 2.0",
        "distance = 2.0\nspeed = 3.0",
        (21, 9),
        &["`speed` of 3 m/s", "0.01 to 1.6"],
    );
    assert_changed("[observer]", "[film]\nsize = [641, 480]\n[observer]", (9, 8), &["`size`", "even"]);
}

#[test]
fn views() {
    assert_changed(
        "[observer]",
        "[views]\ndefault = \"snek\"\n[observer]",
        (9, 11),
        &["`snake`", "did you mean"],
    );
    let follow = "[views]\ndefault = \"follow:folower\"\n[observer]";
    assert_changed("[observer]", follow, (9, 11), &["no robot called `folower`", "`follower`?"]);
}

#[test]
fn set_points_in_time() {
    let line = |value: &str| GOOD.replace("distance = 2.0", &format!("distance = {value}"));
    let ramp = "{ from = 2.0, to = 1.0, start = 5.0, over = 3.0 }";
    assert_eq!(faults(&line(ramp)), []);
    assert_eq!(faults(&line(&format!("[{ramp}, {{ to = 2.0, start = 9.0, over = 1.0 }}]"))), []);
    let early = format!("[{ramp}, {{ to = 2.0, start = 7.0, over = 1.0 }}]");
    assert_fault(&line(&early), (20, 84), &["before the last passage ends at 8 s"]);
    let gap = format!("[{ramp}, {{ from = 1.5, to = 2.0, start = 9.0, over = 1.0 }}]");
    assert_fault(&line(&gap), (20, 73), &["`from` must be 1"]);
    assert_fault(&line("{ to = 1.0, start = 0, over = 1 }"), (20, 12), &["`from` is missing"]);
    assert_fault(&line("{ mean = 2.0, amplitude = 0.1 }"), (20, 12), &["`rate` is missing"]);
}

#[test]
fn several_faults_come_at_once_in_order() {
    let text =
        GOOD.replace("10.0", "-1").replace("epsilon", "epsilom").replace("distance = 2.0", "distance = 0");
    let lines: Vec<_> = faults(&text).iter().map(|fault| fault.line).collect();
    assert_eq!(lines, [5, 9, 20]);
}

#[test]
fn a_fault_is_printed_with_its_line() {
    let diagnostics = Scene::parse(&GOOD.replace("duration", "durration"), "a.toml", &[]).unwrap_err();
    assert_eq!(
        diagnostics.to_string(),
        "a.toml:5:1: unknown key `durration`, did you mean `duration`? (known here: `duration`, `period`, `mode`)\n  \
           5 | durration = 10.0\n    | ^^^^^^^^^"
    );
}

/// Letters and marks that leave no trace: `bob` and `bob` would be two robots.
#[test]
fn names_that_cannot_be_seen_are_refused() {
    let validator = jsonschema::validator_for(&scene::schema()).unwrap();
    let fits = |name: &str| {
        validator.is_valid(&serde_json::json!({
            "schema": 1, "title": "t",
            "robots": [{ "name": name, "pose": [0, 0, 0], "path": { "kind": "constant" } }],
        }))
    };
    for sign in
        "\u{3164}\u{ffa0}\u{115f}\u{1160}\u{34f}\u{17b4}\u{180b}\u{fe0f}\u{e0100}\u{200b}\u{2060}\u{feff}"
            .chars()
    {
        for name in [format!("{sign}"), format!("leader{sign}")] {
            let words = format!(": U+{:04X} in it cannot be seen", u32::from(sign));
            let to = format!("name = \"{name}\"");
            let text = GOOD.replacen("name = \"leader\"", &to, 1);
            let all = faults(&text);
            assert!(all.iter().any(|fault| fault.line == 12 && fault.message.contains(&words)), "{all:?}");
            assert!(!fits(&name), "the schema takes U+{:04X}", u32::from(sign));
        }
    }
    for name in ["leader", "Amélie-2", "로봇_1", "गाड़ी"] {
        assert_eq!(faults(&GOOD.replace("\"leader\"", &format!("\"{name}\""))), [], "{name}");
        assert!(fits(name), "{name}");
    }
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let text = "schema = 1\ntitle = \"t\"\n\"\\u001b[2J\" = 1\n\"a\u{85}b\" = \"\\u0007\"";
    let printed = Scene::parse(text, "a.toml", &[]).unwrap_err().to_string();
    assert!(printed.chars().all(|c| c == '\n' || !c.is_control()), "{printed:?}");
}
