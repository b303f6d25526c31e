//! The panel Sweep: its choices, its map and its curve.

use super::{Panel, asked, assert_says, click, enter, panel, says};
use crate::common::app_state;
use crate::sweeps::{plan, short, side, sweep, sweep_until};
use eframe::egui::{Key, accesskit::Role, vec2};
use egui_kittest::kittest::Queryable;
use lab::action::Action;
use lab::app_state::AppState;
use lab::app_state::sweep_plan::SweepPlan;
use lab::panels::sweep;
use sweeps::{ChartQuantity, MEASURES};

fn planned(actions: &[Action]) -> &SweepPlan {
    match actions.last() {
        Some(Action::PlanSweep(plan) | Action::StartSweep(plan)) => plan,
        other => panic!("{other:?}"),
    }
}

/// A panel over a sweep that has been made.
fn swept(sides: usize) -> Panel {
    let sides = [side("law.k", [1.0, 9.0], 3), side("law.beta", [1.0, 5.0], 2)][..sides].to_vec();
    let mut app_state = app_state(&short(), 1);
    sweep(&mut app_state, &plan(&sides, 2));
    panel(app_state, sweep::show)
}

/// What a choice asks for, wherever it stands in its list.
fn choose(panel: &mut Panel, list: &str, choice: &str) -> Vec<Action> {
    assert!(click(panel, Role::ComboBox, list).is_empty());
    panel.get_by_role_and_label(Role::Button, choice).click_accesskit();
    let actions = asked(panel);
    // A list stays open for those who do not click with a mouse.
    panel.key_press(Key::Escape);
    panel.run();
    actions
}

/// The pointer at a share of a widget's width and height.
fn point(panel: &mut Panel, name: &str, [x, y]: [f32; 2]) {
    let rect = panel.get_by_role_and_label(Role::Button, name).rect();
    panel.hover_at(rect.min + vec2(x * rect.width(), y * rect.height()));
    panel.run_steps(8);
}

#[test]
fn the_keys_of_the_scene_can_be_chosen_with_ranges_around_them() {
    let mut panel = panel(app_state(&short(), 1), sweep::show);
    assert_says(&panel, &["9 × 9 values: K, ε", "▶ Start 81 runs", "Copy command"]);
    let actions = enter(&mut panel, Role::SpinButton, "Across values", "5");
    let now = planned(&actions).clone();
    assert_eq!((now.sides[0].values(), now.runs()), ("log:0.75..12/5".to_owned(), 45));
    panel.state_mut().app_state.act(&Action::PlanSweep(now));
    let actions = click(&mut panel, Role::CheckBox, "Across log");
    assert_eq!(planned(&actions).sides[0].values(), "0.75..12/5");
    let actions = choose(&mut panel, "Up key", "Bearing ψ of right (°)");
    assert_eq!(planned(&actions).sides[1].values(), "-180..-90 deg/9");
    let actions = choose(&mut panel, "Up key", "one key only");
    assert_eq!(planned(&actions).sides.len(), 1);
    let actions = click(&mut panel, Role::Button, "▶ Start 45 runs");
    assert!(matches!(actions.last(), Some(Action::StartSweep(_))), "{actions:?}");
}

#[test]
fn a_key_that_is_not_in_the_list_can_be_typed() {
    let mut panel = panel(app_state(&short(), 1), sweep::show);
    let actions = choose(&mut panel, "Across key", "another key …");
    let free = planned(&actions).clone();
    panel.state_mut().app_state.act(&Action::PlanSweep(free));
    panel.run();
    let actions = enter(&mut panel, Role::TextInput, "Across path", "robots.left.speed");
    let typed = planned(&actions).clone();
    assert_eq!(
        (&*typed.sides[0].key, typed.sides[0].values()),
        ("robots.left.speed", "0.4..1.2/9".to_owned())
    );
    panel.state_mut().app_state.act(&Action::PlanSweep(typed));
    panel.run();
    assert!(!says(&panel, "no number stands there"));
    let actions = enter(&mut panel, Role::TextInput, "Across path", "law.nothing");
    panel.state_mut().app_state.act(&Action::PlanSweep(planned(&actions).clone()));
    panel.run();
    assert_says(&panel, &["no number stands there at present"]);
}

#[test]
fn a_map_tells_of_its_cells_and_leads_there() {
    let mut panel = swept(2);
    assert_says(&panel, &["12 done"]);
    point(&mut panel, "Map of the sweep", [0.2, 0.2]);
    assert_says(
        &panel,
        &["Gain K (1/s) = 1", "Robust gain β (m/s², rad/s²) = 5", "of 2 runs", "A click sets"],
    );
    panel.get_by_role_and_label(Role::Button, "Map of the sweep").click();
    let actions = asked(&mut panel);
    // Where the widget is clicked is its middle: the second of three gains.
    let [Action::Set { what, values }] = &actions[..] else { panic!("{actions:?}") };
    assert!(what.starts_with("From the sweep: law.k = 5, law.beta = "), "{what}");
    assert_eq!(values[0], ("law.k".to_owned(), "5".to_owned()));
    let app_state = &mut panel.state_mut().app_state;
    assert!(app_state.act(&actions[0]));
    panel.run();
    assert!(!says(&panel, "run it again"), "the map is of this scene still");
    let other = ("observer.alpha1".to_owned(), "2.5".to_owned());
    panel.state_mut().app_state.act(&Action::Set { what: "α₁".to_owned(), values: vec![other] });
    panel.run();
    assert_says(&panel, &["Of the scene as it was before robots.left.observer.alpha1 = 2.5: run it again"]);
}

#[test]
fn a_curve_tells_of_its_values_and_leads_there() {
    let mut panel = swept(1);
    let mut shown = panel.state().app_state.sweep.plan.clone().expect("a plan");
    shown.quantity = ChartQuantity::Measure(0);
    panel.state_mut().app_state.act(&Action::PlanSweep(shown));
    point(&mut panel, "Curve of the sweep", [0.9, 0.5]);
    assert_says(&panel, &["Gain K (1/s) = 9", MEASURES[0].label, "5 to 95 %"]);
    panel.get_by_role_and_label(Role::Button, "Curve of the sweep").click();
    let actions = asked(&mut panel);
    let [Action::Set { values, .. }] = &actions[..] else { panic!("{actions:?}") };
    assert_eq!(*values, [("law.k".to_owned(), "5".to_owned())]);
}

#[test]
fn what_is_under_way_can_be_stopped_and_what_is_refused_says_why() {
    let mut under_way = app_state(&short(), 1);
    let many = plan(&[side("law.k", [1.0, 8.0], 400)], 1);
    sweep_until(&mut under_way, &many, 3);
    let mut bench = panel(under_way, sweep::show);
    assert_says(&bench, &["3 of 400", "left"]);
    assert_eq!(click(&mut bench, Role::Button, "■ Stop"), [Action::StopSweep]);
    bench.state_mut().app_state.act(&Action::StopSweep);
    bench.run();
    assert_says(&bench, &["stopped, 3 of 400", "▶ Start 400 runs"]);
    let mut refused = app_state(&short(), 1);
    sweep(&mut refused, &plan(&[side("law.k", [8.0, 1.0], 3)], 1));
    assert_says(&panel(refused, sweep::show), &["does not rise"]);
    assert_says(&panel(AppState::new(), sweep::show), &["No scene is open."]);
}
