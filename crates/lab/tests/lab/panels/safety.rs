//! What safety filters do, in words and over time, and what tunes them.

use super::{assert_says, click, gains::check_rows, panel, texts};
use crate::common::{Rig, THREE, app_state, with};
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use lab::action::Action;
use lab::app_state::{AppState, Selection};
use lab::panels::safety;
use lab::quantities::{PlotQuantity, curves};
use lab::symbols;
use vocabulary::{BarrierState, Body, Constraint, FleetInfo, RobotInfo, SafetyState, StepRecord};

const PILLAR: &str = include_str!("../../../../../scenes/pillar.toml");

fn filtered() -> String {
    with(THREE, &[("proximity.range", "4.0"), ("safety.filter", "true")])
}

/// The first time at which a filter has moved the command of a robot by much, s.
fn held(app_state: &AppState, robot: usize) -> f64 {
    let history = app_state.history.as_ref().expect("a run");
    let moved = |record: &&&StepRecord| record.safety.iter().any(|s| s.robot == robot && s.moved > 0.3);
    let records = history.between(0, [0.0, f64::INFINITY], usize::MAX);
    records.iter().find(moved).expect("a filter acts").snapshot.time
}

#[test]
fn barriers_are_shown_tuned_and_explained() {
    check_rows(
        || app_state(&filtered(), 5),
        safety::show,
        &[
            (symbols::BARRIER_MARGIN, "safety.margin", 0.05, 0.2),
            (symbols::POINT_AHEAD, "safety.point_ahead", 0.1, 0.2),
            (symbols::BARRIER_GAIN, "safety.gain", 2.0, 3.0),
            (symbols::BARRIER_HORIZON, "safety.horizon", 0.1, 0.2),
        ],
    );
    let views = with(&filtered(), &[("safety.view_distance", "3.0"), ("safety.view_angle", "\"25 deg\"")]);
    let mut panel = panel(app_state(&views, 5), safety::show);
    assert_eq!(super::value(&panel, Role::Slider, "View distance"), 3.0);
    panel.get_by_role_and_label(Role::Slider, "View angle").set_value_accesskit(30.0);
    let actions = super::asked(&mut panel);
    let Some(Action::Tune { key, value: Some(value), .. }) = actions.first() else { panic!("{actions:?}") };
    assert_eq!((&**key, &**value), ("safety.view_angle", "\"30.0 deg\""));
}

#[test]
fn every_key_that_is_live_changes_while_the_run_goes() {
    let mut panel = panel(app_state(&filtered(), 50), safety::show);
    let mut edit = |actions: Vec<Action>| {
        assert!(!actions.is_empty());
        for action in actions {
            assert!(panel.state_mut().app_state.act(&action));
        }
        panel.run();
    };
    for (key, value) in [
        ("margin", "0.1"),
        ("point_ahead", "0.15"),
        ("gain", "1.5"),
        ("horizon", "0.2"),
        ("view_angle", "0.4"),
    ] {
        let key = symbol_key(key);
        edit(vec![Action::Tune { what: "x".to_owned(), key: key.into(), value: Some(value.to_owned()) }]);
    }
    for name in ["Keep the leader near", "Stay within an arena", "Filter commands"] {
        let actions = click(&mut panel, Role::CheckBox, name);
        for action in actions {
            assert!(panel.state_mut().app_state.act(&action));
        }
    }
    let state = &panel.state().app_state;
    assert_eq!(state.notice, None);
    assert!(!state.log.iter().any(|line| line.text.contains("restarts")), "{:?}", state.log);
    let safety = state.scene_now().expect("a scene").robots[1].safety;
    assert_eq!((safety.margin, safety.view_distance, safety.filter), (Some(0.1), Some(4.0), false));
    let [x0, y0, x1, y1] = safety.arena.expect("an arena");
    assert!(x0 < -2.0 && y0 < -1.0 && x1 > 0.0 && y1 > 1.0);
}

fn symbol_key(key: &str) -> &'static str {
    match key {
        "margin" => "safety.margin",
        "point_ahead" => "safety.point_ahead",
        "gain" => "safety.gain",
        "horizon" => "safety.horizon",
        _ => "safety.view_angle",
    }
}

#[test]
fn one_robot_is_tuned_or_all_and_a_robot_that_leads_is_one() {
    let mut state = app_state(&filtered(), 5);
    state.act(&Action::Select(Selection::Robot(0)));
    state.act(&Action::ForAll(false));
    let mut panel = panel(state, safety::show);
    assert_says(&panel, &["Only leader", "It leads, and keeps to its path."]);
    for action in click(&mut panel, Role::CheckBox, "Those that lead, too") {
        panel.state_mut().app_state.act(&action);
    }
    let leads = |state: &AppState| {
        let robots = &state.scene_now().expect("a scene").robots;
        robots.iter().map(|robot| robot.safety.leads).collect::<Vec<_>>()
    };
    assert_eq!(leads(&panel.state().app_state), [true, false, false]);
    let state = &mut panel.state_mut().app_state;
    state.act(&Action::ForAll(true));
    let margin =
        Action::Tune { what: "m".to_owned(), key: "safety.margin".into(), value: Some("0.12".to_owned()) };
    state.act(&margin);
    let robots = &state.scene_now().expect("a scene").robots;
    assert!(robots.iter().all(|robot| robot.safety.margin == Some(0.12)));
}

#[test]
fn who_senses_nothing_is_given_a_sensor_and_a_filter() {
    let mut panel = panel(app_state(THREE, 5), safety::show);
    assert_says(&panel, &["It senses nothing near it"]);
    for action in click(&mut panel, Role::Button, "Sense within 4 m, and filter") {
        panel.state_mut().app_state.act(&action);
    }
    let robot = &panel.state().app_state.scene_now().expect("a scene").robots[1];
    assert_eq!((robot.proximity.range, robot.safety.filter), (Some(4.0), true));
    assert_eq!(panel.state().app_state.notice, None);
}

#[test]
fn words_and_room_are_those_of_the_shown_time_and_branch() {
    let mut rig = Rig::new(PILLAR);
    rig.steps(1100);
    let robot = 2;
    let time = held(&rig.app_state, robot);
    rig.act(&[Action::Select(Selection::Robot(robot)), Action::Seek(time)]);
    let says = |rig: &mut Rig, wanted: &[&str]| {
        let state = std::mem::take(&mut rig.app_state);
        let panel = panel(state, safety::show);
        assert_says(&panel, wanted);
        rig.app_state = panel.into_state().app_state;
    };
    says(&mut rig, &["robot-3 is held by pillar-1: its command is moved by", "pillar-1"]);
    rig.act(&[Action::Seek(2.0)]);
    says(&mut rig, &["robot-3 drives as decided"]);
    // In the past a change is a branch of its own; there the filter is off, and on the first it is not.
    rig.act(&[Action::Tune {
        what: "f".to_owned(),
        key: "safety.filter".into(),
        value: Some("false".to_owned()),
    }]);
    rig.steps(3);
    assert_eq!(rig.app_state.branch, 1);
    let record = rig.app_state.record().expect("a moment");
    assert!(record.safety.is_empty() && record.snapshot.time > 2.0, "{record:?}");
    rig.act(&[Action::Branch(0), Action::Seek(time)]);
    says(&mut rig, &["robot-3 is held by pillar-1"]);
}

#[test]
fn a_conflict_is_a_sentence() {
    let named = |name: &str| RobotInfo::new(name, false, Body::default());
    let fleet = FleetInfo { robots: vec![named("ann"), named("bob")], ..FleetInfo::default() };
    let mut state = SafetyState {
        moved: 2.5,
        relaxed: [0.375, 0.0],
        conflict: vec![Constraint::Robot(1), Constraint::Edge(3), Constraint::LeftTurn],
        ..SafetyState::default()
    };
    let between = "For ann there is no way between bob, the north edge and the left turn limit";
    assert_eq!(
        safety::words(&state, "ann", &fleet),
        format!("{between}: barriers give way by 0.38 m/s; its command is moved by 2.50 m/s².")
    );
    state.relaxed = [0.0, 0.5];
    assert!(safety::words(&state, "ann", &fleet).contains("the view gives way by 0.50;"));
    (state.moved, state.conflict) = (0.0, vec![]);
    assert_eq!(
        safety::words(&state, "ann", &fleet),
        "ann drives as decided. Nothing near forbids a command."
    );
    state.barriers =
        vec![BarrierState { constraint: Constraint::Robot(1), value: 0.5, ..BarrierState::default() }];
    assert_eq!(safety::words(&state, "ann", &fleet), "ann drives as decided, with 0.50 m of room to bob.");
}

#[test]
fn slack_and_moves_are_plotted_of_every_robot_with_a_filter() {
    let state = app_state(PILLAR, 1100);
    let (time, most) = (held(&state, 2), 10_000);
    let at = |quantity: PlotQuantity| {
        let all = curves(&state, quantity, most);
        let points = all.iter().filter(|curve| curve.robot == Some(2)).flat_map(|curve| curve.points.clone());
        points.clone().find(|[t, _]| (t - time).abs() < 1e-9).map(|[_, value]| (value, points.count()))
    };
    let (moved, count) = at(PlotQuantity::Moved).expect("a value");
    assert!(moved > 0.3 && count == 1100);
    let (slack, few) = at(PlotQuantity::Slack).expect("a value");
    assert!(slack.abs() < 1e-6 && few < 1100, "held, and at other times nothing is near: {slack}, {few}");
    assert!(curves(&state, PlotQuantity::Moved, most).iter().all(|curve| curve.robot != Some(0)));
    assert!(curves(&app_state(THREE, 5), PlotQuantity::Moved, most).is_empty());
    let panel = panel(app_state(THREE, 1), safety::plots);
    assert!(texts(&panel).contains(&"No robot has a safety filter.".to_owned()));
}
