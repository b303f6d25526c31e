//! Robots with several leaders: how they are written, what is wrong with them, and what may change.

use scene::{Override, Role, Scene, SceneText};
use vocabulary::ScalarTrajectory;

/// Why a scene is none.
fn fault(text: &str) -> String {
    Scene::parse(text, "t.toml", &[]).expect_err("a fault").to_string()
}

/// One that leads, two that follow it, and `dan`.
fn scene(dan: &str) -> String {
    format!(
        r#"
schema = 1
title = "t"
[[robots]]
name = "ann"
pose = [0.0, 0.0, 0.0]
path = {{ kind = "constant" }}
[[robots]]
name = "bob"
pose = [-1.5, 1.5, 0.0]
leader = "ann"
distance = 2.0
bearing = "135 deg"
[[robots]]
name = "cy"
pose = [-1.5, -1.5, 0.0]
leader = "ann"
distance = 2.0
bearing = "-135 deg"
[[robots]]
name = "dan"
pose = [-3.0, 0.0, 0.0]
{dan}
"#
    )
}

const TWO: &str =
    r#"leaders = [{ name = "bob", distance = 2.0 }, { name = "cy", distance = 1.5, bearing = "90 deg" }]"#;
/// What is left to say of a scene that is right but for its law.
const NO_LAW: &str =
    "`dan` has 2 leaders, and its law looks at one: a law for 2 leaders is needed, `law.file`";

/// The scene, which is the same once it has been written.
fn load(text: &str) -> Scene {
    let scene = Scene::parse(text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let written = scene.to_toml();
    let again = Scene::parse(&written, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}\n{written}"));
    assert_eq!(scene, again.scene, "{written}");
    scene
}

/// With a law for two.
fn with_two() -> Scene {
    load(&scene(&format!("{TWO}\nlaw = {{ file = \"two-distances\" }}")))
}

#[test]
fn what_is_wrong_is_said_once_and_where_it_is() {
    let two = |a: &str, b: &str| format!("leaders = [{a}, {b}]");
    let bob = r#"{ name = "bob", distance = 2.0 }"#;
    let cases = [
        (TWO.to_owned(), "t.toml:23:11", NO_LAW),
        (two(bob, r#"{ name = "cyr", distance = 2.0 }"#), ":23:", "there is no robot called `cyr`"),
        (two(bob, r#"{ name = "dan", distance = 2.0 }"#), ":23:", "`dan` cannot follow itself"),
        (two(bob, bob), ":23:", "`bob` is named twice: the leaders of a robot must differ"),
        (
            two(bob, r#"{ name = "cy" }"#),
            ":23:",
            "`dan` wants nothing of `cy`: give a `distance`, a `bearing`, or both",
        ),
        (
            two(bob, r#"{ name = "cy", distance = 0.01 }"#),
            ":23:",
            "`distance` falls to 0.01 m, below the law's",
        ),
        (two(bob, r#"{ name = "cy", bearing = "900 deg" }"#), ":23:", "`bearing` must be an angle"),
        (two(bob, "{ distance = 1.0 }"), ":23:", "`name` is missing"),
        (two(bob, r#"{ name = "cy", distance = 1.0, spacing = 1.0 }"#), ":23:", "unknown key `spacing`"),
        (format!("leaders = [{bob}]"), ":23:", "`leaders` must be a list of 2 to 4 values"),
        (format!("{TWO}\nleader = \"bob\""), ":24:", "leave out this `leader`"),
        (format!("{TWO}\ndistance = 2.0"), ":24:", "leave out this `distance`"),
        (format!("{TWO}\npath = {{ kind = \"constant\" }}"), ":23:", "a robot leads or follows"),
        (
            format!("{TWO}\nsensing = \"camera\""),
            ":23:",
            "`dan` has several leaders and cannot have sensing `camera`: a camera looks at one leader",
        ),
        (format!("{TWO}\nsensing = \"geometric\""), ":23:", "cannot have sensing `geometric`"),
        (
            format!("{TWO}\nlaw = {{ heading = \"path\", standing = true }}"),
            ":23:",
            "cannot have `standing`: a robot stands where the path of one leader ends",
        ),
        (
            format!(
                "{TWO}\nproximity = {{ range = 9.0 }}\nlaw.heading = \"path\"\nnarrowing = {{ narrows = true }}"
            ),
            ":23:",
            "cannot have `narrows`: a column is filed in behind one leader",
        ),
        (
            format!(
                "{TWO}\nproximity = {{ range = 9.0 }}\nsafety = {{ filter = true, view_distance = 3.0 }}"
            ),
            ":23:",
            "cannot have `view_distance` and `view_angle`: they keep one leader in view",
        ),
        (
            "leader = \"bob\"\ndistance = 2.0".to_owned(),
            ":23:",
            "`bearing` is missing: a robot that follows one leader",
        ),
    ];
    for (dan, place, words) in cases {
        let told = fault(&scene(&dan));
        assert!(told.contains(words) && told.contains(place), "{dan}\n{told}");
        // One error apart from the law that is missing.
        let others = told.lines().filter(|line| line.contains("t.toml:") && !line.contains(NO_LAW));
        assert!(others.count() <= 1, "{dan}\n{told}");
    }
}

#[test]
fn a_ring_is_found_through_any_leader() {
    let second = r#"leaders = [{ name = "ann", distance = 2.0 }, { name = "dan", distance = 2.0 }]"#;
    let text = scene("leader = \"cy\"\ndistance = 2.0\nbearing = 3.0").replace(
        "pose = [-1.5, -1.5, 0.0]\nleader = \"ann\"\ndistance = 2.0\nbearing = \"-135 deg\"",
        &format!("pose = [-1.5, -1.5, 0.0]\n{second}"),
    );
    let told = fault(&text);
    assert!(told.contains("the followers form a cycle: `cy` follows `dan` follows `cy`"), "{told}");
}

#[test]
fn a_scene_writes_one_leader_as_ever_and_several_as_a_list() {
    let scene = with_two();
    let text = scene.to_toml();
    assert!(text.contains("[[robots.leaders]]\nname = \"bob\"\ndistance = 2.0\n\n"), "{text}");
    assert!(text.contains("[[robots.leaders]]\nname = \"cy\"\ndistance = 1.5\nbearing = 1.57"), "{text}");
    assert_eq!(text.matches("\nleader = \"ann\"\n").count(), 2, "{text}");
    let edges: Vec<_> = scene.edges().map(|(name, _, leader)| (name, leader.name.as_str())).collect();
    assert_eq!(edges, [("bob", "ann"), ("cy", "ann"), ("dan", "bob"), ("dan", "cy")]);
}

#[test]
fn parts_that_are_wanted_change_and_others_do_not() {
    let (before, mut after) = (with_two(), with_two());
    let edit = |scene: &mut Scene, work: &dyn Fn(&mut scene::Leaders)| {
        let Role::Follow(follow) = &mut scene.robots[3].role else { panic!("dan follows") };
        work(&mut follow.leaders);
    };
    edit(&mut after, &|leaders| {
        leaders.first.distance = Some(ScalarTrajectory::Constant(1.25));
        leaders.also[0].bearing = Some(ScalarTrajectory::Constant(1.0));
    });
    let sets = before.sets_to(&after).expect("sets");
    assert_eq!(sets, ["robots.dan.leaders.bob.distance=1.25", "robots.dan.leaders.cy.bearing=1.0"]);
    edit(&mut after, &|leaders| leaders.first.bearing = Some(ScalarTrajectory::Constant(1.0)));
    let why = before.sets_to(&after).expect_err("a part that was free");
    assert!(why[0].starts_with("`robots.dan.leaders.bob.bearing` cannot change"), "{why:?}");
    let mut other = with_two();
    edit(&mut other, &|leaders| leaders.also[0].name = "ann".to_owned());
    assert!(before.sets_to(&other).expect_err("another leader")[0].starts_with("`robots.dan.leader` cannot"));
}

#[test]
fn overrides_and_changes_reach_a_leader_by_name_or_number() {
    let with = |sets: &[&str], more: &str| {
        let sets: Vec<Override> = sets.iter().map(|set| set.parse().expect("an override")).collect();
        Scene::parse(&(scene(TWO) + more), "t.toml", &sets).expect_err("no law yet").to_string()
    };
    for path in ["robots.dan.leaders.bob.distance", "robots.3.leaders.0.distance"] {
        assert!(with(&[&format!("{path}=0.01")], "").contains("--set:1:"), "{path}");
        assert!(!with(&[&format!("{path}=1.0")], "").contains("--set"), "{path}");
    }
    let told = with(&["robots.dan.leaders.bo.distance=1.0"], "");
    assert!(told.contains("no item of this list is called `bo`, did you mean `bob`?"), "{told}");
}

#[test]
fn text_is_edited_where_a_leader_stands() {
    let mut text = SceneText::parse(&scene(TWO)).expect("a text");
    text.set("robots.dan.leaders.cy.distance", "1.75").expect("set");
    text.set("robots.dan.leaders.0.distance", "2.25").expect("set");
    assert!(
        text.text().contains(r#"name = "bob", distance = 2.25 }, { name = "cy", distance = 1.75, bearing"#)
    );
    assert_eq!(text.get("robots.dan.leaders.bob.distance").as_deref(), Some("2.25"));
    let error = text.set("robots.dan.leaders.cyr.distance", "1.0").expect_err("nobody").to_string();
    assert!(error.contains("no item of `leaders` is called `cyr`"), "{error}");
    let change = "[[changes]]\nat = 1.0\nset = [\"robots.dan.leaders.bob.distance=1.0\", \"robots.bob.distance=1.0\"]\n";
    let mut text = SceneText::parse(&(scene(TWO) + change)).expect("a text");
    text.rename_robot("bob", "beth").expect("renamed");
    assert!(!text.text().contains("bob"), "{}", text.text());
    assert!(text.text().contains("robots.dan.leaders.beth.distance=1.0"));
    let heads = "[[robots.leaders]]\nname = \"bob\"\ndistance = 2.0\n[[robots.leaders]]\nname = \"cy\"\ndistance = 2.0";
    let mut text = SceneText::parse(&scene(heads)).expect("a text");
    text.rename_robot("cy", "cleo").expect("renamed");
    text.set("robots.dan.leaders.cleo.distance", "1.5").expect("set");
    assert!(text.text().contains("name = \"cleo\"\ndistance = 1.5"), "{}", text.text());
}

#[test]
fn events_leave_a_robot_its_several_leaders() {
    let with = |event: &str| fault(&format!("{}\n[[events]]\nat = 1.0\n{event}\n", scene(TWO)));
    let told = with("robot = \"dan\"\nleader = \"ann\"");
    assert!(told.contains("`dan` has several leaders and keeps them"), "{told}");
    let told = with("assign = \"ann\"");
    assert!(told.contains("`dan` follows `ann` and has several leaders"), "{told}");
    for event in [
        "robot = \"bob\"\nfails = \"stop\"",
        "robot = \"dan\"\npath = { kind = \"constant\" }",
        "assign = \"dan\"",
    ] {
        let told = with(event);
        assert!(told.contains(NO_LAW) && !told.contains("several leaders and"), "{event}\n{told}");
    }
    // Whoever is followed, through a second leader too, cannot follow.
    let told = with("robot = \"cy\"\nleader = \"dan\"");
    assert!(
        told.contains("at 1 s the followers would form a cycle: `cy` follows `dan` follows `cy`"),
        "{told}"
    );
}

#[test]
fn a_change_sets_what_is_wanted_of_a_leader_and_no_name() {
    let two = format!("{TWO}\nlaw = {{ file = \"two-distances\" }}\n");
    let with = |set: &str| scene(&two) + &format!("[[changes]]\nat = 1.0\nset = [{set}]\n");
    let loaded =
        load(&with("\"robots.dan.leaders.bob.distance=1.0\", 'robots.dan.leaders.1.bearing=\"80 deg\"'"));
    let sets = &loaded.changes[0].set;
    assert_eq!(sets[0], "robots.dan.leaders.bob.distance=1.0");
    assert!(sets[1].starts_with("robots.dan.leaders.cy.bearing=1.39"), "{sets:?}");
    for (set, words) in [
        (
            "\"robots.dan.leaders.bob.name=ann\"",
            "`robots.dan.leaders.bob.name` cannot change while a run goes",
        ),
        (
            "\"robots.dan.leaders.bob.bearing=1.0\"",
            "`robots.dan.leaders.bob.bearing` cannot change while a run goes",
        ),
        ("\"robots.dan.leaders=[]\"", "`robots.dan.leaders` cannot change while a run goes"),
        ("\"robots.dan.leaders.eve.distance=1.0\"", "no item of this list is called `eve`"),
        ("\"robots.dan.leaders.bob.distance=0.01\"", "below the law's `distance_min`"),
        ("\"robots.dan.law.standing=true\", \"robots.dan.law.heading=path\"", "cannot have `standing`"),
    ] {
        let told = fault(&with(set));
        assert!(told.contains(words), "{set}\n{told}");
    }
}

#[test]
fn a_law_says_how_many_leaders_its_follower_has() {
    let file = "law = { file = \"two-distances\" }";
    let one = format!("leader = \"bob\"\ndistance = 2.0\nbearing = 3.0\n{file}");
    let told = fault(&scene(&one));
    assert!(told.contains("`dan` has one leader, and its law looks at 2: give them as `leaders`"), "{told}");
    let three = TWO.replace("leaders = [", "leaders = [{ name = \"ann\", distance = 3.0 }, ");
    let told = fault(&scene(&format!("{three}\n{file}")));
    assert!(told.contains("`dan` has 3 leaders, and its law looks at 2"), "{told}");
    let group = format!(
        "{file}\n{}[[groups]]\nshape = \"v\"\ncount = 3\npath = {{ kind = \"constant\" }}\n",
        "schema = 1\ntitle = \"t\"\n"
    );
    let told = fault(&group);
    assert!(told.contains("`robot-2` has one leader, and its law looks at 2"), "{told}");
}

#[test]
fn what_a_law_reads_of_a_set_point_must_not_be_left_free() {
    let text = "leaders 2\nlet e = wrap(wanted1.bearing - leader1.bearing)\n\
                command = (wanted2.distance - leader2.distance) / 1 [s^2], e / 1 [s]";
    let law = format!("law = {{ text = {text:?} }}");
    let leaders = "leaders = [{ name = \"bob\", distance = 2.0 }, { name = \"cy\", distance = 2.0 }]";
    let told = fault(&scene(&format!("{leaders}\n{law}")));
    assert!(
        told.contains("law.text reads `wanted1.bearing`, but `dan` leaves its bearing from `bob` free"),
        "{told}"
    );
    assert!(!told.contains("wanted2"), "{told}");
}
