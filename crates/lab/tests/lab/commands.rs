//! What actions mean: for the text, which keeps its comments, for undo, and for the run, which goes on where it can.

use crate::common::{Rig, THREE, app_state, with};
use lab::action::Action;
use lab::app_state::{AppState, Selection, Tool};
use lab::session::runner::RunRequest;
use vocabulary::math;

/// Two groups, and one robot that has gains of its own.
const GROUPS: &str = "\
schema = 1
title = \"Groups\"
[time]
duration = 5.0
[[robots]]
name = \"leader\"
pose = [0.0, 0.0, 0.0]
path = { kind = \"constant\", speed = 1.0 }
[[groups]]
name = \"wing\"
shape = \"v\"
count = 4
leader = \"leader\"
distance = 2.0
law = { k = 4.0, beta = 1.0 } # of the wing
[[robots]]
name = \"own\"
pose = [-9.0, 0.0, 0.0]
leader = \"leader\"
distance = 9.0
bearing = \"180 deg\"
law = { k = 2.5 }
";

fn text(app_state: &AppState) -> String {
    app_state.draft.as_ref().expect("a draft").text().to_owned()
}

/// What the run is asked for.
fn requests(app_state: &AppState) -> Vec<&'static str> {
    let word = |request: &RunRequest| match request {
        RunRequest::ResumeRecording(_) => "take up",
        RunRequest::Open { .. } => "open",
        RunRequest::Recorded(_) => "recorded",
        RunRequest::Play(_) => "play",
        RunRequest::Pace(_) => "pace",
        RunRequest::Step => "step",
        RunRequest::Change(_) => "change",
        RunRequest::Fork { .. } => "fork",
        RunRequest::Switch(_) => "switch",
        RunRequest::Ahead(_) => "ahead",
        RunRequest::Reach(_) => "reach",
        RunRequest::Digest { .. } => "digest",
        RunRequest::Summarize(_) => "tell",
    };
    app_state.requests.iter().map(word).collect()
}

const RETUNE: &[&str] = &["change"];
const RESTART: &[&str] = &["open", "ahead", "play"];

pub(crate) fn tune(key: &'static str, value: &str) -> Action {
    Action::Tune { what: "Gain…".to_owned(), key: key.into(), value: Some(value.to_owned()) }
}

fn untune(key: &'static str) -> Action {
    Action::Tune { what: "Reset gain".to_owned(), key: key.into(), value: None }
}

pub(crate) fn set(path: &str, value: &str) -> Action {
    Action::Set { what: "Value".to_owned(), values: vec![(path.to_owned(), value.to_owned())] }
}

pub(crate) fn point(edge: usize, distance: f64, degrees: f64) -> Action {
    Action::SetPoint { edge, distance, bearing: degrees.to_radians() }
}

/// Every action on the scene: what is done, what it is done to, what it writes, and what the run is asked for.
fn commands() -> Vec<(Action, String, Vec<&'static str>, &'static [&'static str])> {
    let three = || THREE.to_owned();
    let own = || with(THREE, &[("robots.left.law.k", "7.0")]);
    let pillar = || {
        format!(
            "{THREE}\n[[props]]\nname = \"post\"\nshape = \"cylinder\"\nradius = 0.1\nheight = 0.5\npose = [5.0, 5.0, 0.0]\n"
        )
    };
    vec![
        (
            point(0, 1.5, 120.0),
            three(),
            vec!["distance = 1.5 # from the leader", "bearing = \"120 deg\""],
            RETUNE,
        ),
        (Action::Shape { scale: 1.1, turn: 0.0 }, three(), vec!["distance = 2.2 # from the leader"], RETUNE),
        (tune("law.k", "4.0"), three(), vec!["k = 4.0 # not too stiff"], RETUNE),
        (tune("law.k", "4.0"), own(), vec!["k = 4.0 # not too stiff"], RETUNE),
        (tune("observer.epsilon", "0.02"), three(), vec!["epsilon = 0.02"], RETUNE),
        (tune("law.kind", "\"robust-state\""), three(), vec!["kind = \"robust-state\""], RETUNE),
        (tune("vehicle.speed_max", "1.5"), three(), vec!["speed_max = 1.5"], RETUNE),
        (tune("sensing.kind", "\"noise\""), three(), vec!["\"noise\""], RESTART),
        (untune("law.beta"), three(), vec!["k = 3.0 # not too stiff"], RETUNE),
        (
            set("robots.left.pose", "[-3.0, 1.0, 0.0]"),
            three(),
            vec!["[-3.0, 1.0, 0.0] # where it starts"],
            RESTART,
        ),
        (untune("law.k"), three(), vec!["# Gains of all."], RETUNE),
        (
            Action::Connect { leader: 1, follower: 2, adds: false },
            three(),
            vec!["leader = \"left\""],
            RESTART,
        ),
        (Action::AddRobot, three(), vec!["name = \"follower-1\"", "leader = \"left\""], RESTART),
        (Action::RemoveRobot("right".to_owned()), three(), vec!["# To the left."], RESTART),
        (
            Action::RenameRobot("leader".to_owned(), "boss".to_owned()),
            three(),
            vec!["leader = \"boss\""],
            RESTART,
        ),
        (
            Action::AddProp("pillar", [3.0, -2.5]),
            three(),
            vec!["name = \"pillar-1\"", "[3.0, -2.5, 0.0]"],
            RESTART,
        ),
        (Action::RemoveProp("post".to_owned()), pillar(), vec!["name = \"right\""], RESTART),
    ]
}

#[test]
fn every_deed_is_written_is_told_and_can_be_undone() {
    for (action, before, written, told) in commands() {
        let mut app_state = app_state(&before, 30);
        let comments = |text: &str| text.matches("# ").count();
        assert!(app_state.act(&action), "{action:?}");
        assert_eq!(app_state.notice, None, "{action:?}");
        let after = text(&app_state);
        for part in &written {
            assert!(after.contains(part), "{action:?}: `{part}` is not in\n{after}");
        }
        // With a robot the lines right above it go.
        let gone = usize::from(matches!(action, Action::RemoveRobot(_)));
        assert!(comments(&after) + gone + 1 >= comments(&before), "{action:?} loses comments:\n{after}");
        assert_eq!(requests(&app_state), told, "{action:?}");
        assert!(app_state.draft.as_ref().is_some_and(|draft| draft.unsaved() && draft.redoes().is_none()));
        for _ in 0..2 {
            app_state.requests.clear();
            assert!(app_state.act(&Action::Undo));
            assert_eq!(text(&app_state), before, "{action:?} undone");
            assert_eq!(requests(&app_state), told, "{action:?} undone");
            assert!(
                app_state.draft.as_ref().is_some_and(|draft| !draft.unsaved() && draft.undoes().is_none())
            );
            app_state.requests.clear();
            assert!(app_state.act(&Action::Redo));
            assert_eq!(text(&app_state), after, "{action:?} done again");
            assert_eq!(requests(&app_state), told, "{action:?} done again");
        }
    }
}

#[test]
fn undo_with_nothing_to_undo_does_nothing() {
    let mut app_state = app_state(THREE, 3);
    app_state.act(&Action::Undo);
    app_state.act(&Action::Redo);
    assert!(text(&app_state) == THREE && app_state.requests.is_empty() && app_state.log.is_empty());
}

#[test]
fn set_points_move_alone_or_with_their_mirror_image() {
    let mut app_state = app_state(THREE, 3);
    app_state.act(&point(0, 1.5, 120.0));
    assert_eq!(app_state.set_point(0).map(|[d, b]| (d, b.to_degrees().round())), Some((1.5, 120.0)));
    assert_eq!(app_state.set_point(1).map(|[d, b]| (d, b.to_degrees().round())), Some((2.0, -135.0)));
    app_state.act(&Action::Undo);
    app_state.act(&Action::Mirror(true));
    for degrees in [130.0, 120.0, 110.0] {
        app_state.act(&point(0, 1.5, degrees));
    }
    for (edge, degrees) in [(0, 110.0), (1, -110.0)] {
        let [distance, bearing] = app_state.set_point(edge).expect("a set point");
        assert_eq!((distance, bearing.to_degrees().round()), (1.5, degrees));
    }
    app_state.act(&Action::Undo);
    assert_eq!(text(&app_state), THREE, "one hand, one step");
    // Who has no mirror image moves alone.
    app_state.act(&Action::Mirror(false));
    app_state.act(&point(0, 1.0, 100.0));
    app_state.act(&Action::Mirror(true));
    app_state.act(&point(1, 3.0, -90.0));
    assert_eq!(app_state.set_point(0).map(|[d, _]| d), Some(1.0));
    // Nobody comes closer than the law allows.
    app_state.act(&point(1, 0.0, -90.0));
    let least = app_state.follower(1).map(|(_, _, follow)| follow.law.distance_min);
    assert_eq!(app_state.set_point(1).map(|[d, _]| d), least);
    assert_eq!(app_state.notice, None);
    // 180° is written one way only.
    app_state.act(&point(1, 3.0, -180.0));
    assert!(text(&app_state).contains("bearing = \"180 deg\""), "{}", text(&app_state));
    app_state.act(&point(9, 3.0, 0.0));
    assert_eq!(app_state.notice, None);
}

#[test]
fn a_set_point_that_moves_in_time_stays_where_it_is_put() {
    let mut app_state = app_state(include_str!("../../../../scenes/moving-set-point.toml"), 60);
    let [distance, _] = app_state.set_point(0).expect("a set point");
    assert!((distance - 2.0).abs() > 0.01, "it has moved");
    app_state.act(&point(0, 2.5, -120.0));
    assert_eq!(app_state.notice, None);
    assert!(text(&app_state).contains("distance = 2.5\nbearing = \"-120 deg\""), "{}", text(&app_state));
    assert_eq!(app_state.set_point(0).map(|[d, _]| d), Some(2.5));
    assert_eq!(requests(&app_state), RETUNE);
}

#[test]
fn the_whole_formation_is_scaled_and_turned() {
    let mut app_state = app_state(include_str!("../../../../scenes/seven-v.toml"), 3);
    let before: Vec<_> = (0..6).map(|edge| app_state.set_point(edge).expect("a set point")).collect();
    app_state.act(&Action::Shape { scale: 1.5, turn: f64::to_radians(50.0) });
    assert_eq!(app_state.notice, None);
    for (edge, [distance, bearing]) in before.into_iter().enumerate() {
        let [d, b] = app_state.set_point(edge).expect("a set point");
        let turned = vocabulary::wrap(bearing + f64::to_radians(50.0));
        assert!(
            (d - 1.5 * distance).abs() < 1e-3 && vocabulary::wrap(b - turned).abs() < 1e-4,
            "edge {edge}"
        );
    }
    assert_eq!(requests(&app_state), RETUNE, "one change for all of them");
}

/// K of the distance of every follower.
pub(crate) fn gains(app_state: &AppState) -> Vec<f64> {
    (0..).map_while(|edge| app_state.follower(edge).map(|(_, _, follow)| follow.law.k[0])).collect()
}

#[test]
fn gains_are_tuned_for_all_or_for_one() {
    let mut app_state = app_state(GROUPS, 3);
    // Robots come before those that groups make.
    assert_eq!(gains(&app_state), [2.5, 4.0, 4.0, 4.0]);
    app_state.act(&Action::ForAll(false));
    app_state.act(&Action::Select(Selection::Edge(2)));
    app_state.act(&tune("law.k", "6.0"));
    assert_eq!(gains(&app_state), [2.5, 4.0, 6.0, 4.0], "{}", text(&app_state));
    let (robot, ..) = app_state.follower(0).expect("a follower");
    app_state.act(&Action::Select(Selection::Robot(robot)));
    app_state.act(&tune("law.k", "[1.0, 2.0]"));
    assert_eq!(gains(&app_state), [1.0, 4.0, 6.0, 4.0]);
    app_state.act(&untune("law.k"));
    let usual = gains(&app_state)[0];
    assert!(usual != 1.0 && usual != 2.5, "its default");
    app_state.act(&Action::ForAll(true));
    app_state.act(&tune("law.k", "3.5"));
    assert_eq!(gains(&app_state), [3.5; 4], "{}", text(&app_state));
    assert!(text(&app_state).contains("beta = 1.0"), "what was not tuned stays:\n{}", text(&app_state));
    app_state.act(&untune("law.k"));
    assert_eq!(gains(&app_state), [usual; 4]);
    assert_eq!(app_state.notice, None);
    // The log tells whose gain it was, and to what it went.
    let log: Vec<&str> = app_state.log.iter().map(|event| &*event.text).collect();
    assert!(log.iter().any(|text| text.contains("of own")), "{log:?}");
    assert!(log.contains(&"Reset gain of all: its default"), "{log:?}");
}

#[test]
fn nobody_follows_in_a_circle() {
    let mut app_state = app_state(include_str!("../../../../scenes/seven-v.toml"), 3);
    let before = text(&app_state);
    for (leader, follower, circle) in [
        (5, 1, "robot-2 → robot-6 → robot-4 → robot-2"),
        (3, 3, "robot-4 → robot-4"),
        (6, 0, "robot-1 → robot-7 → robot-5 → robot-3 → robot-1"),
    ] {
        app_state.act(&Action::Connect { leader, follower, adds: false });
        let notice = app_state.notice.take().expect("a notice");
        assert!(notice.contains(circle), "{notice}");
        assert!(text(&app_state) == before && app_state.requests.is_empty());
    }
    app_state.act(&Action::Connect { leader: 99, follower: 1, adds: false });
    assert!(app_state.notice.is_none() && app_state.requests.is_empty());
}

#[test]
fn a_lead_robot_becomes_a_follower_where_it_is() {
    let second = "\n[[robots]]\nname = \"second\" # on its own\npose = [3.0, 4.0, 0.0]\npath = { kind = \"constant\", speed = 1.0 }\n";
    let mut app_state = app_state(&format!("{THREE}{second}"), 40);
    app_state.act(&Action::Connect { leader: 0, follower: 3, adds: false });
    assert_eq!(app_state.notice, None);
    let now = app_state.record().expect("a moment");
    let relative =
        vocabulary::Relative::between(now.snapshot.robots[0].motion.pose, now.snapshot.robots[3].motion.pose);
    let [distance, bearing] = app_state.set_point(2).expect("a set point");
    assert!((distance - relative.distance).abs() <= 0.026, "{distance} m, is {} m", relative.distance);
    assert!((bearing - relative.bearing).abs() < 0.01);
    let after = text(&app_state);
    assert!(
        after.contains("name = \"second\" # on its own") && !after.contains("path = { kind = \"constant\"")
    );
    assert_eq!(requests(&app_state), RESTART);
    assert!(
        matches!(&app_state.requests[0], RunRequest::Open { until, .. } if *until == app_state.end()),
        "at once to where it was"
    );
}

#[test]
fn robots_are_added_where_there_is_room() {
    let mut rig = Rig::new(THREE);
    rig.act(&[Action::Select(Selection::Robot(0)), Action::AddRobot]);
    assert_eq!(rig.app_state.selection, Selection::Robot(3), "the new one is selected");
    rig.act(&[Action::Select(Selection::Robot(0)), Action::AddRobot, Action::AddRobot]);
    assert_eq!(rig.app_state.notice, None);
    let scene = rig.app_state.scene().expect("a scene").clone();
    let names: Vec<&str> = scene.robots.iter().map(|robot| &*robot.name).collect();
    assert_eq!(names, ["leader", "left", "right", "follower-1", "follower-2", "follower-3"]);
    for (k, a) in scene.robots.iter().enumerate() {
        for b in &scene.robots[..k] {
            let apart = math::hypot(a.pose.x - b.pose.x, a.pose.y - b.pose.y);
            assert!(apart >= 1.0, "{} and {} are {apart} m apart", a.name, b.name);
        }
    }
    assert!(
        matches!(&scene.robots[5].role, scene::Role::Follow(follow) if follow.leaders.first.name == "follower-2")
    );
    assert_eq!(rig.app_state.history.as_ref().expect("a run").fleet().robots.len(), 6);
}

#[test]
fn a_robot_that_is_followed_stays() {
    let mut app_state = app_state(include_str!("../../../../scenes/seven-v.toml"), 3);
    let before = text(&app_state);
    for (name, followers) in [("robot-2", "robot-4 follows it"), ("robot-1", "robot-2, robot-3 follow it")] {
        app_state.act(&Action::RemoveRobot(name.to_owned()));
        let notice = app_state.notice.take().expect("a notice");
        assert!(notice.starts_with(&format!("{name} stays")) && notice.contains(followers), "{notice}");
        assert!(text(&app_state) == before && app_state.requests.is_empty());
    }
    app_state.act(&Action::RemoveRobot("robot-6".to_owned()));
    assert!(!text(&app_state).contains("robot-6") && app_state.notice.is_none());
}

#[test]
fn what_cannot_be_changes_nothing_and_is_said_once() {
    let cases = [
        (tune("law.k", "-1.0"), "`k` must be"),
        (tune("observer.epsilon", "1e-9"), "sampled"),
        (set("time.period", "0.0"), "period"),
        (set("robots.nobody.distance", "2.0"), "nobody"),
        (Action::RenameRobot("left".to_owned(), "right".to_owned()), "right"),
        (Action::RenameRobot("left".to_owned(), "no name!".to_owned()), "no name!"),
        (Action::RenameRobot("nobody".to_owned(), "x".to_owned()), "nobody"),
        (Action::RemoveRobot("nobody".to_owned()), "nobody"),
        (Action::RemoveProp("nothing".to_owned()), "nothing"),
    ];
    let continuous = with(THREE, &[("time.mode", "continuous"), ("observer.epsilon", "0.02")]);
    for past in [false, true] {
        for (action, word) in &cases {
            let mut app_state = app_state(&continuous, 30);
            if past {
                app_state.act(&Action::Seek(0.1));
            }
            app_state.act(action);
            let notice = app_state.notice.clone().unwrap_or_else(|| panic!("{action:?} is no fault"));
            assert!(notice.contains(word) && notice.lines().count() <= 8, "{action:?}: {notice}");
            let faults = app_state.log.iter().filter(|event| event.fault).count();
            assert_eq!((faults, app_state.log.len()), (1, 1), "{action:?}: {:?}", app_state.log);
            assert_eq!(text(&app_state), continuous, "{action:?}");
            assert_eq!(requests(&app_state), [""; 0], "{action:?}, in the past: {past}");
            assert!(app_state.draft.as_ref().is_some_and(|draft| draft.undoes().is_none()), "{action:?}");
        }
    }
}

#[test]
fn a_deed_that_changes_nothing_is_none() {
    for past in [false, true] {
        let mut app_state = app_state(THREE, 30);
        if past {
            app_state.act(&Action::Seek(0.1));
        }
        for action in [
            tune("law.k", "3.0"),
            Action::RenameRobot("left".to_owned(), "left".to_owned()),
            untune("law.slope"),
        ] {
            app_state.act(&action);
            assert!(
                text(&app_state) == THREE && app_state.requests.is_empty() && app_state.log.is_empty(),
                "{action:?}"
            );
        }
    }
}

#[test]
fn the_run_is_led_by_hand() {
    let mut app_state = app_state(THREE, 50);
    app_state.act(&Action::Toggle);
    assert!(app_state.playing && matches!(app_state.requests.pop(), Some(RunRequest::Play(true))));
    app_state.act(&Action::Seek(0.2));
    assert!(!app_state.playing && matches!(app_state.requests.pop(), Some(RunRequest::Play(false))));
    assert_eq!((app_state.cursor, app_state.time()), (Some(0.2), 0.2));
    app_state.act(&Action::Step);
    assert!(
        (app_state.time() - 0.21).abs() < 1e-12 && app_state.requests.is_empty(),
        "a step in the past asks for nothing"
    );
    app_state.act(&Action::Back(0.1));
    assert!((app_state.time() - 0.11).abs() < 1e-12);
    app_state.act(&Action::Back(7.0));
    assert_eq!(app_state.time(), 0.0);
    app_state.act(&Action::Present);
    assert_eq!((app_state.cursor, app_state.time()), (None, 0.49));
    app_state.act(&Action::Step);
    assert_eq!(requests(&app_state), ["step"]);
    app_state.act(&Action::Seek(99.0));
    assert_eq!(app_state.cursor, None);
    for (asked, got) in [(0.001, 0.1), (2.0, 2.0), (999.0, 50.0)] {
        app_state.act(&Action::Pace(asked));
        assert_eq!(app_state.pace, got);
    }
    app_state.act(&Action::Ahead(0.0));
    assert!(app_state.ahead == 0.0 && app_state.prediction.is_none());
    app_state.act(&Action::UseTool(Tool::Pillar));
    assert_eq!(app_state.tool, Tool::Pillar);
    app_state.act(&Action::UseTool(Tool::Pillar));
    assert_eq!(app_state.tool, Tool::Select, "taken twice is put down");
    app_state.act(&Action::NameBranch(0, "trunk".to_owned()));
    assert_eq!(app_state.branches[0].name, "trunk");
    app_state.requests.clear();
    app_state.act(&Action::Restart);
    assert_eq!(requests(&app_state), RESTART);
    assert!(!app_state.act(&Action::Save), "files are the window's");
}

#[test]
fn what_is_selected_is_there() {
    let mut rig = Rig::new(THREE);
    assert_eq!(
        (rig.app_state.selection, rig.app_state.chosen_robot()),
        (Selection::Edge(0), Some(1)),
        "an edge, to begin with"
    );
    rig.act(&[Action::Select(Selection::Robot(2))]);
    assert_eq!(rig.app_state.chosen_edge(), Some(1));
    rig.act(&[Action::RemoveRobot("right".to_owned())]);
    assert_eq!(rig.app_state.selection, Selection::Nothing, "nobody selects who is gone");
    rig.act(&[Action::Select(Selection::Robot(0))]);
    assert_eq!((rig.app_state.chosen_edge(), rig.app_state.chosen_robot()), (None, Some(0)));
}
