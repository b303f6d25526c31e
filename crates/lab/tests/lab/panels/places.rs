//! The tree of robots, the edge that is selected, branches and the log.

use super::{asked, assert_says, click, enter, panel, says, texts, tip, value};
use crate::common::{Rig, THREE, app_state, with};
use eframe::egui::{self, Key, Modifiers, accesskit::Role};
use egui_kittest::kittest::Queryable;
use lab::action::Action;
use lab::app_state::{Selection, Tool};
use lab::panels::{branches, edge, formation, log};
use lab::session::prediction::Prediction;
use lab::symbols;
use vocabulary::EntityId;

#[test]
fn the_tree_shows_who_follows_whom() {
    let panel = panel(app_state(include_str!("../../../../../scenes/seven-v.toml"), 5), formation::show);
    let place = |name| panel.get_by_role_and_label(Role::Button, name).rect().min;
    for (leader, follower) in [("robot-1", "robot-2"), ("robot-2", "robot-4"), ("robot-3", "robot-5")] {
        let (leader, follower) = (place(leader), place(follower));
        assert!(follower.x > leader.x + 5.0 && follower.y > leader.y);
    }
    assert!(place("robot-6").y < place("robot-3").y, "wing by wing");
    let errors = texts(&panel).iter().filter(|text| text.ends_with(" m")).count();
    assert_eq!(errors, 6, "an error for each edge: {:?}", texts(&panel));
}

#[test]
fn robots_are_selected_and_made_in_the_tree() {
    let mut panel = panel(app_state(THREE, 5), formation::show);
    assert_eq!(click(&mut panel, Role::Button, "right"), [Action::Select(Selection::Robot(2))]);
    assert_eq!(click(&mut panel, Role::Button, "+ Robot"), [Action::AddRobot]);
    assert_eq!(click(&mut panel, Role::Button, "Connect"), [Action::UseTool(Tool::Connect)]);
    panel.state_mut().app_state.act(&Action::UseTool(Tool::Connect));
    assert_eq!(click(&mut panel, Role::Button, "Connect"), [Action::UseTool(Tool::Connect)]);
}

#[test]
fn a_robot_dropped_on_another_follows_it() {
    let mut panel = panel(app_state(THREE, 5), formation::show);
    let [from, to] =
        ["right", "left"].map(|name| panel.get_by_role_and_label(Role::Button, name).rect().center());
    for drop in [to, from] {
        panel.drag_at(from);
        panel.run();
        panel.hover_at(from.lerp(drop, 0.5) + egui::vec2(9.0, 0.0));
        panel.run();
        panel.hover_at(drop);
        panel.run();
        panel.drop_at(drop);
        let actions = asked(&mut panel);
        let connects: Vec<_> =
            actions.iter().filter(|action| matches!(action, Action::Connect { .. })).collect();
        if drop == to {
            assert_eq!(connects, [&Action::Connect { leader: 1, follower: 2, adds: false }]);
        } else {
            assert!(connects.is_empty(), "nobody follows himself");
        }
    }
}

#[test]
fn a_robot_has_a_menu() {
    for (item, action) in [
        ("Follow with the camera", Action::Follow(Some(1))),
        ("See through its camera", Action::Viewpoint("camera:left".to_owned())),
        ("Remove", Action::RemoveRobot("left".to_owned())),
    ] {
        let mut panel = panel(app_state(THREE, 5), formation::show);
        panel.get_by_role_and_label(Role::Button, "left").click_secondary();
        assert!(asked(&mut panel).is_empty());
        assert_eq!(click(&mut panel, Role::Button, item), [action]);
    }
    let mut panel = panel(app_state(THREE, 5), formation::show);
    panel.get_by_role_and_label(Role::Button, "left").click_secondary();
    panel.run();
    panel.get_by_role(Role::TextInput).click();
    panel.run();
    panel.key_press_modifiers(Modifiers::COMMAND, Key::A);
    panel.event(egui::Event::Text("port ".to_owned()));
    panel.run();
    panel.key_press(Key::Enter);
    assert_eq!(asked(&mut panel), [Action::RenameRobot("left".to_owned(), "port".to_owned())]);
    assert!(panel.query_by_role(Role::TextInput).is_none(), "it closes");
    // What was typed and left is not there the next time.
    panel.get_by_role_and_label(Role::Button, "left").click_secondary();
    panel.run();
    assert_eq!(panel.get_by_role(Role::TextInput).value().as_deref(), Some("left"));
}

#[test]
fn an_edge_shows_what_is_wanted_and_what_is() {
    let app_state = app_state(THREE, 40);
    let state = app_state.record().expect("a moment").edges[0];
    let mut panel = panel(app_state, edge::show);
    assert_says(&panel, &["leader → left", &format!("is {:.3} m", state.relative.distance)]);
    assert_says(&panel, &[&format!("is {:.1}°", state.relative.bearing.to_degrees()), "error "]);
    assert_eq!(value(&panel, Role::SpinButton, "Distance"), 2.0);
    assert!((value(&panel, Role::SpinButton, "Bearing") - 135.0).abs() < 1e-9);
    for symbol in [symbols::DISTANCE, symbols::BEARING] {
        let tip = tip(&mut panel, symbol.sign).join("\n");
        assert!(tip.contains(symbol.equation) && tip.contains(symbol.growing), "{tip}");
    }
    panel.state_mut().app_state.selection = Selection::Robot(0);
    panel.run();
    assert_says(&panel, &["Click a follower or its edge."]);
}

/// The set points that are asked for.
fn points(actions: &[Action]) -> Vec<(usize, f64, f64)> {
    let point = |action: &Action| match action {
        Action::SetPoint { edge, distance, bearing } => {
            Some((*edge, *distance, bearing.to_degrees().round()))
        }
        _ => None,
    };
    actions.iter().filter_map(point).collect()
}

#[test]
fn set_points_are_typed_and_dragged() {
    for (text, distance) in [("1.5", 1.5), ("2.5 m", 2.5), ("1,25", 1.25)] {
        let mut panel = panel(app_state(THREE, 5), edge::show);
        let actions = enter(&mut panel, Role::SpinButton, "Distance", text);
        assert_eq!(points(&actions).first(), Some(&(0, distance, 135.0)), "{text}: {actions:?}");
        assert!(actions.contains(&Action::Release), "{text}");
    }
    for (text, degrees) in [("-90", -90.0), ("−45°", -45.0), ("500", 180.0)] {
        let mut panel = panel(app_state(THREE, 5), edge::show);
        let actions = enter(&mut panel, Role::SpinButton, "Bearing", text);
        assert_eq!(points(&actions).first(), Some(&(0, 2.0, degrees)), "{text}: {actions:?}");
    }
    let mut panel = panel(app_state(THREE, 5), edge::show);
    let actions = enter(&mut panel, Role::SpinButton, "Distance", "far");
    assert!(points(&actions).is_empty(), "{actions:?}");
    let actions = super::drag(&mut panel, Role::SpinButton, "Distance", [0.5, 1.5]);
    assert!(points(&actions).iter().all(|(edge, distance, _)| *edge == 0 && *distance > 2.0), "{actions:?}");
    assert!(!points(&actions).is_empty() && actions.last() == Some(&Action::Release), "{actions:?}");
}

#[test]
fn the_formation_is_mirrored_scaled_and_turned() {
    let mut panel = panel(app_state(THREE, 5), edge::show);
    assert_eq!(click(&mut panel, Role::CheckBox, "Mirror the other side"), [Action::Mirror(true)]);
    for (name, wanted) in
        [("+10 %", (1.1, 0.0)), ("−10 %", (1.0 / 1.1, 0.0)), ("↺ 5°", (1.0, 5.0)), ("↻ 5°", (1.0, -5.0))]
    {
        let actions = click(&mut panel, Role::Button, name);
        let [Action::Shape { scale, turn }, Action::Release] = &actions[..] else { panic!("{actions:?}") };
        assert_eq!((*scale, turn.to_degrees().round()), wanted, "{name}");
    }
}

#[test]
fn an_edge_tells_what_comes() {
    let mut app_state = app_state(THREE, 5);
    app_state.prediction = Some(Prediction {
        span: [0.0, 6.0],
        late_error: vec![[0.012, 0.1], [0.5, 0.5]],
        contact: Some((3.21, [EntityId::Robot(1), EntityId::Robot(2)])),
        ..Prediction::default()
    });
    let mut panel = panel(app_state, edge::show);
    assert_says(&panel, &["in 6 s: within 0.012 m, 5.73°", "contact at 3.2 s: left and right"]);
    if let Some(prediction) = &mut panel.state_mut().app_state.prediction {
        prediction.branch = 1;
    }
    panel.run();
    assert!(!says(&panel, "contact"), "that is another branch's");
    let limited = with(THREE, &[("robots.left.vehicle.speed_max", "0.82")]);
    assert_says(&self::panel(self::app_state(&limited, 60), edge::show), &["a limit cuts the command"]);
    let moving = include_str!("../../../../../scenes/moving-set-point.toml");
    assert_says(&self::panel(self::app_state(moving, 60), edge::show), &["This set point changes over time"]);
}

#[test]
fn branches_are_shown_with_their_changes() {
    let mut rig = Rig::new(THREE);
    rig.steps(50);
    let gain = Action::Tune { what: "Gain".to_owned(), key: "law.k".into(), value: Some("5.0".to_owned()) };
    rig.act(&[Action::Seek(0.2), gain]);
    rig.steps(10);
    let mut panel = panel(rig.app_state, branches::show);
    assert_says(&panel, &["main", "branch 1", "forks from main at 0.20 s", "law.k = [5.0, 5.0] of 2 robots"]);
    assert_eq!(click(&mut panel, Role::Button, "main"), [Action::Branch(0)]);
    assert_eq!(click(&mut panel, Role::Button, "Branch here"), [Action::Fork]);
    panel.get_by_role_and_label(Role::Button, "branch 1").click_secondary();
    panel.run();
    panel.get_by_role(Role::TextInput).click();
    panel.run();
    panel.key_press_modifiers(Modifiers::COMMAND, Key::A);
    panel.event(egui::Event::Text("stiff".to_owned()));
    panel.run();
    panel.key_press(Key::Enter);
    assert_eq!(asked(&mut panel), [Action::NameBranch(1, "stiff".to_owned())]);
}

#[test]
fn the_log_leads_to_its_times() {
    let mut app_state = app_state(THREE, 50);
    app_state.note("Gain of all…");
    app_state.act(&Action::Seek(0.2));
    app_state.fault("This cannot be");
    let mut panel = panel(app_state, log::show);
    assert_says(&panel, &["Gain of all", "This cannot be", "0.49 s"]);
    assert!(!says(&panel, "…"), "what goes on under a hand is over in the log");
    assert_eq!(click(&mut panel, Role::Link, "0.20 s"), [Action::Seek(0.2)]);
}
