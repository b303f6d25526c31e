//! A scene's text edited in place: what is not edited stays as it was written.

use proptest::prelude::*;
use scene::SceneText;
use std::path::PathBuf;
use toml_edit::{DocumentMut, Item};

const SCENE: &str = r#"# About the scene.
schema = 1
title = "t"   # in short
vehicle = "car"

[time] # all of it
duration = 15.0                 # s

# Who leads.
[[robots]]
name = "leader"
pose = [0.0, 0.0, "90 deg"]
path = { kind = "circle", speed = 1.0 }

# Who follows, outside.
[[robots]]
name = "bob"
leader = "leader"
# as the paper has it
distance = 2.0                  # m
bearing = "-135 deg"            # behind

[[groups]]
shape = "v"
count = 4
leader = "bob"

[views]
default = "follow:bob"

# The second half.
[[changes]]
at = 5.0
set = [
    "robots.bob.distance=1.5",  # nearer
    'robots.robot-3.law.k=3',
]
# The end.
"#;

#[track_caller]
fn edit(work: impl Fn(&mut SceneText)) -> String {
    let mut text = SceneText::parse(SCENE).unwrap();
    work(&mut text);
    let edited = text.text();
    for comment in SCENE.lines().filter(|line| line.starts_with('#')) {
        assert!(edited.lines().any(|line| line == comment), "`{comment}` is gone:\n{edited}");
    }
    edited
}

#[track_caller]
fn assert_set(path: &str, value: &str, from: &str, to: &str) {
    let edited = edit(|text| text.set(path, value).unwrap_or_else(|error| panic!("{path}: {error}")));
    assert!(SCENE.contains(from), "{from}");
    assert_eq!(edited, SCENE.replacen(from, to, 1), "{path}");
}

#[test]
fn values_are_put_where_they_stand() {
    assert_set("time.duration", "20", "duration = 15.0  ", "duration = 20  ");
    assert_set("title", "Two words", "\"t\"   # in", "\"Two words\"   # in");
    assert_set("robots.bob.distance", "1.5", "distance = 2.0", "distance = 1.5");
    assert_set("robots.1.bearing", "2.356194490192345", "\"-135 deg\"", "\"135 deg\"");
    assert_set("robots.bob.bearing", "-1", "\"-135 deg\"", "\"-57.29578 deg\"");
    assert_set("robots.leader.pose", "[1, 2.5, 0.0]", "[0.0, 0.0, \"90 deg\"]", "[1, 2.5, \"0 deg\"]");
    assert_set("robots.leader.path.speed", "0.8", "speed = 1.0 }", "speed = 0.8 }");
    assert_set("robots.leader.path.turn_rate", "0.3", "speed = 1.0 }", "speed = 1.0, turn_rate = 0.3 }");
    assert_set("vehicle.mass", "6.0", "\"car\"", "{ kind = \"car\", mass = 6.0 }");
    assert_set(
        "robots.bob.distance",
        "{ mean = 2.0, amplitude = 0.3, rate = 0.5 }",
        "2.0  ",
        "{ mean = 2.0, amplitude = 0.3, rate = 0.5 }  ",
    );
    assert_set("changes.0.at", "6", "at = 5.0", "at = 6");
    assert_set(
        "changes.0.set",
        "[\"robots.bob.distance=1\", \"law.k=3\"]",
        "distance=1.5\",  # nearer\n    'robots.robot-3.law.k=3'",
        "distance=1\",  # nearer\n    \"law.k=3\"",
    );
}

#[test]
fn what_is_not_there_yet_is_made() {
    assert_set("robots.bob.law.k", "3.0", "# behind\n", "# behind\nlaw = { k = 3.0 }\n");
    assert_set("law.k", "3.0", "# s\n", "# s\n\n[law]\nk = 3.0\n");
    assert_set("seed", "7", "\"car\"\n", "\"car\"\nseed = 7\n");
    assert_set("groups.0.law.k", "3.0", "leader = \"bob\"\n\n", "leader = \"bob\"\nlaw = { k = 3.0 }\n\n");
    let member = "leader = \"bob\"\n\n[groups.members.robot-3]\ndistance = 1.5\n\n";
    assert_set("robots.robot-3.distance", "1.5", "leader = \"bob\"\n\n", member);
    let twice = edit(|text| {
        text.set("robots.robot-3.distance", "1.5").unwrap();
        text.set("robots.robot-4.law.k", "2").unwrap();
        text.set("robots.robot-3.distance", "1.7").unwrap();
    });
    let more = member.replace("1.5\n", "1.7\n\n[groups.members.robot-4]\nlaw = { k = 2 }\n");
    assert_eq!(twice, SCENE.replacen("leader = \"bob\"\n\n", &more, 1));
}

#[test]
fn whole_tables_are_replaced_key_by_key() {
    let text = "schema = 1\n[vehicle]\n# heavy\nmass = 6.0 # kg\nkind = \"car\" # small\n[law]\n# much\nk = 3.0\n# more\nbeta = 2.0\n";
    let mut edited = SceneText::parse(text).unwrap();
    edited.set("vehicle", "differential").unwrap();
    edited.set("law", "{ k = 4.0, slope = 9.0 }").unwrap();
    let wanted = text
        .replace("mass = 6.0 # kg\n", "")
        .replace("car", "differential")
        .replace("3.0", "4.0")
        .replace("# more\nbeta = 2.0\n", "slope = 9.0\n# more\n");
    assert_eq!(edited.text(), wanted);
}

#[test]
fn files_of_other_systems_keep_their_line_ends() {
    let text = SCENE.replace('\n', "\r\n");
    let mut edited = SceneText::parse(&text).unwrap();
    edited.set("robots.bob.distance", "1.5").unwrap();
    edited.remove("title").unwrap();
    let wanted =
        SCENE.replacen("distance = 2.0", "distance = 1.5", 1).replacen("title = \"t\"   # in short\n", "", 1);
    assert_eq!(edited.text(), wanted.replace('\n', "\r\n"));
}

#[test]
fn values_and_tables_are_taken_out_and_comment_lines_stay() {
    let cut = |path: &str| edit(|text| assert!(text.remove(path).unwrap(), "{path}"));
    assert_eq!(cut("robots.bob.distance"), SCENE.replacen("distance = 2.0                  # m\n", "", 1));
    assert_eq!(cut("robots.leader.path.speed"), SCENE.replacen(", speed = 1.0", "", 1));
    assert_eq!(
        cut("time"),
        SCENE.replacen("[time] # all of it\nduration = 15.0                 # s\n", "", 1)
    );
    let list = &SCENE[SCENE.find("[[changes]]").unwrap()..SCENE.find("# The end").unwrap()];
    assert_eq!(cut("changes"), SCENE.replacen(list, "", 1));
    let whole = edit(|text| {
        text.set("robots.robot-3.distance", "1.5").unwrap();
        assert!(text.remove("robots.robot-3.distance").unwrap());
        assert!(!text.remove("robots.robot-3.distance").unwrap() && !text.remove("law.k").unwrap());
    });
    assert_eq!(whole.replace("\n\n\n", "\n\n"), SCENE);
}

#[test]
fn robots_come_and_go() {
    let added =
        edit(|text| text.add_robot("name = \"ann\"\nleader = \"bob\"\n[vehicle]\nkind = \"car\"\n").unwrap());
    let ann = "# behind\n\n[[robots]]\nname = \"ann\"\nleader = \"bob\"\nvehicle = { kind = \"car\" }\n";
    assert_eq!(added, SCENE.replacen("# behind\n", ann, 1));
    let mut text = SceneText::parse(&added).unwrap();
    text.remove_item("robots", "ann").unwrap();
    assert_eq!(text.text(), SCENE);
    text.remove_item("robots", "bob").unwrap();
    assert!(
        !text.text().contains("Who follows") && text.text().contains("}\n\n[[groups]]"),
        "{}",
        text.text()
    );
    let props = edit(|text| text.add_table("props", "name = \"cone\"\nshape = \"cone\"").unwrap());
    assert!(props.ends_with("]\n\n[[props]]\nname = \"cone\"\nshape = \"cone\"\n# The end.\n"), "{props}");
    for fault in [
        SceneText::add_robot(&mut text, "pose = [0, 0, 0]"),
        SceneText::add_robot(&mut text, "name = \"robot-3\""),
        text.remove_item("robots", "robot-9"),
        text.rename_robot("robot-9", "carl"),
        text.rename_robot("leader", "robot-3"),
        text.rename_robot("leader", "a b"),
        text.set("robots.leda.distance", "1"),
        text.set("time", "1"),
        text.set("title.colour", "1"),
        text.set("changes", "1"),
        text.set("..", "1"),
    ] {
        assert!(!fault.unwrap_err().to_string().is_empty());
    }
}

#[test]
fn a_new_name_is_new_everywhere() {
    let renamed = edit(|text| text.rename_robot("bob", "carl").unwrap());
    assert_eq!(renamed, SCENE.replace("bob", "carl"));
    let renamed = edit(|text| text.rename_robot("leader", "anna").unwrap());
    assert_eq!(renamed, SCENE.replace("\"leader\"", "\"anna\""));
}

/// Robots that a group makes are renamed and removed as others are: the group says so.
#[test]
fn robots_of_a_group_are_renamed_and_removed_one_by_one() {
    let renamed = edit(|text| text.rename_robot("robot-3", "left").unwrap());
    let member = "leader = \"bob\"\n\n[groups.members.robot-3]\nname = \"left\"\n\n[views]";
    assert!(renamed.contains(member) && renamed.contains("\"robots.left.law.k=3\""), "{renamed}");
    let mut text = SceneText::parse(&renamed).unwrap();
    text.set("robots.left.distance", "1.5").unwrap();
    assert!(text.text().contains("name = \"left\"\ndistance = 1.5\n"), "{}", text.text());
    assert!(
        text.rename_robot("robot-2", "left").is_err() && text.set("robots.robot-3.distance", "1").is_err()
    );
    text.rename_robot("left", "robot-3").unwrap();
    text.remove("robots.robot-3.distance").unwrap();
    assert_eq!(text.text().replace("\n\n\n", "\n\n"), SCENE.replace('\'', "\""));
    text.remove_item("robots", "robot-4").unwrap();
    assert!(text.text().contains("[groups.members.robot-4]\nabsent = true\n"), "{}", text.text());
    // Whom a member of a group is told to follow is spoken of, too.
    let told = "\n[groups.members.robot-3]\nleader = \"robot-2\"\n";
    let mut text = SceneText::parse(&SCENE.replace("\n[views]", &format!("{told}\n[views]"))).unwrap();
    text.rename_robot("robot-2", "right").unwrap();
    assert!(text.text().contains("leader = \"right\""), "{}", text.text());
}

fn shipped() -> Vec<String> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let texts = paths.iter().filter_map(|path| std::fs::read_to_string(path).ok());
    texts.chain([include_str!("everything.toml").to_owned(), SCENE.to_owned()]).collect()
}

/// Paths of all values of a text, with the values.
fn values(text: &str) -> Vec<(String, String)> {
    fn walk(item: &Item, at: &str, found: &mut Vec<(String, String)>) {
        if let Some(table) = item.as_table_like() {
            for (key, item) in table.iter() {
                walk(item, &format!("{at}.{key}"), found);
            }
        } else if let Some(tables) = item.as_array_of_tables() {
            for (index, table) in tables.iter().enumerate() {
                walk(&Item::Table(table.clone()), &format!("{at}.{index}"), found);
            }
        } else if let Some(value) = item.as_value() {
            found.push((at.trim_start_matches('.').to_owned(), value.clone().decorated("", "").to_string()));
        }
    }
    let mut found = vec![];
    walk(text.parse::<DocumentMut>().unwrap().as_item(), "", &mut found);
    found
}

#[test]
fn a_value_set_to_what_it_is_changes_nothing() {
    for text in shipped() {
        let read = SceneText::parse(&text).unwrap();
        assert_eq!(read.text(), text);
        for (path, value) in values(&text) {
            let mut edited = read.clone();
            edited.set(&path, &value).unwrap_or_else(|error| panic!("{path} = {value}: {error}"));
            assert_eq!(edited.text(), text, "{path} = {value}");
            assert_eq!(read.get(&path), Some(value), "{path}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Any value in any place, and any value taken away: all other lines stay, those of comments above all.
    #[test]
    fn other_lines_stay(which in 0usize..1000, place in 0usize..1000, value in "[-0-9.a-z\"\\[\\]{}= ]{0,12}", cut: bool) {
        let texts = shipped();
        let text = &texts[which % texts.len()];
        let all = values(text);
        let (path, _) = &all[place % all.len()];
        let mut edited = SceneText::parse(text).unwrap();
        if cut { edited.remove(path).map(drop) } else { edited.set(path, &value) }.unwrap();
        let after = edited.text();
        for comment in text.lines().filter(|line| line.trim_start().starts_with('#')) {
            prop_assert!(after.lines().any(|line| line == comment), "`{}` is gone:\n{}", comment, after);
        }
        prop_assert!(SceneText::parse(&after).is_ok());
    }
}
