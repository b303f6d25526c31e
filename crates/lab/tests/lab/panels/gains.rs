//! Law, observer, sensing and limits: rows of a symbol, a slider and a way back.

use super::{asked, assert_says, click, drag, enter, panel, texts, tip, value};
use crate::common::{THREE, app_state, with};
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use lab::action::{Action, LawChoice};
use lab::app_state::{AppState, Selection};
use lab::panels::{law, sensing, world};
use lab::symbols;
use vocabulary::{HeadingReference, LawKind};

/// The values that are asked for, all of one key.
fn values(actions: &[Action], key: &str) -> Vec<String> {
    let value = |action: &Action| match action {
        Action::Tune { key: of, value: Some(value), .. } => {
            assert_eq!(*of, key);
            Some(value.clone())
        }
        _ => None,
    };
    actions.iter().filter_map(value).collect()
}

fn tuned(actions: &[Action], key: &str) -> f64 {
    let values = values(actions, key);
    values.last().unwrap_or_else(|| panic!("nothing is tuned: {actions:?}")).parse().expect("a number")
}

/// Every slider of a panel shows its value, can be dragged and set, and goes back; every symbol explains itself.
pub(super) fn check_rows(
    app_state: impl Fn() -> AppState,
    show: fn(&mut eframe::egui::Ui, &AppState, &mut Vec<Action>),
    rows: &[(symbols::Symbol, &'static str, f64, f64)],
) {
    for (symbol, key, now, next) in rows {
        let mut panel = panel(app_state(), show);
        let name = symbol.name;
        assert!((value(&panel, Role::Slider, name) - now).abs() < 1e-9, "{name}");
        let actions = drag(&mut panel, Role::Slider, name, [0.15, 0.3]);
        assert!(tuned(&actions, key) > 0.0 || *now == 0.0, "{name}: {actions:?}");
        assert_eq!(actions.last(), Some(&Action::Release), "{name}: the hand lets go");
        panel.get_by_role_and_label(Role::Slider, name).set_value_accesskit(*next);
        let actions = asked(&mut panel);
        assert!((tuned(&actions, key) - next).abs() < 1e-9, "{name}: {actions:?}");
        let Action::Tune { what, .. } = &actions[0] else { panic!("{actions:?}") };
        assert_eq!(*what, format!("{name}…"));
        let back = format!("Reset {}", name.to_lowercase());
        let actions = click(&mut panel, Role::Button, &back);
        let untuned = Action::Tune { what: back, key: (*key).into(), value: None };
        assert!(actions.is_empty() || actions == [untuned.clone()], "{actions:?}");
        // Where the value is the default there is no way back.
        assert_eq!(
            actions == [untuned],
            !panel
                .get_by_role_and_label(Role::Button, &format!("Reset {}", name.to_lowercase()))
                .accesskit_node()
                .is_disabled()
        );
        let tip = tip(&mut panel, symbol.sign).join("\n");
        for part in [name, symbol.equation, symbol.growing, symbol.unit] {
            assert!(tip.contains(part), "{name}: `{part}` is not in `{tip}`");
        }
    }
}

#[test]
fn gains_are_shown_tuned_and_explained() {
    check_rows(
        || app_state(THREE, 5),
        law::show,
        &[
            (symbols::GAIN, "law.k", 3.0, 4.5),
            (symbols::ROBUST, "law.beta", 2.0, 1.5),
            (symbols::SLOPE, "law.slope", scene_slope(), 12.0),
        ],
    );
}

#[test]
fn headings_and_standing_are_shown_and_tuned() {
    let text = with(THREE, &[("law.heading", "\"path\""), ("law.standing", "true")]);
    let rows = [
        (symbols::HEADING_LENGTH, "law.heading_length", 1.0, 1.5),
        (symbols::HEADING_LAG, "law.heading_lag", 1.0, 0.5),
    ];
    check_rows(|| app_state(&text, 5), law::show, &rows);
    let mut stands = panel(app_state(&text, 300), law::show);
    assert_says(&stands, &["left is driven by its law", "° behind its leader's"]);
    // No longer than twice the length, which the scene would refuse.
    stands.get_by_role_and_label(Role::Slider, "Heading lag").set_value_accesskit(3.5);
    assert_eq!(values(&asked(&mut stands), "law.heading_lag"), ["2.0"]);
    assert_eq!(
        values(&click(&mut stands, Role::CheckBox, "Stop and stand with the leader"), "law.standing"),
        ["false"]
    );
    // Without a path's heading nobody stands: both at once.
    click(&mut stands, Role::ComboBox, "Heading");
    for action in click(&mut stands, Role::Button, "Bearing against the leader's heading") {
        stands.state_mut().app_state.act(&action);
    }
    let state = &stands.state().app_state;
    let law = state.follower(0).map(|(_, _, follow)| follow.law.clone()).expect("a follower");
    assert!(!law.standing && law.heading == HeadingReference::Leader && state.notice.is_none());
    assert!(!state.log.iter().any(|line| line.text.contains("restarts")), "{:?}", state.log);
    stands.run();
    assert!(stands.query_by_role_and_label(Role::Slider, "Heading lag").is_none());
    let stand = stands.get_by_role_and_label(Role::CheckBox, "Stop and stand with the leader");
    assert!(stand.accesskit_node().is_disabled());
}

fn scene_slope() -> f64 {
    app_state(THREE, 0).follower(0).map(|(_, _, follow)| follow.law.slope[0]).expect("a follower")
}

#[test]
fn what_is_dragged_is_tuned() {
    let mut panel = panel(app_state(THREE, 5), law::show);
    for action in drag(&mut panel, Role::Slider, "Gain", [0.15, 0.35]) {
        panel.state_mut().app_state.act(&action);
    }
    assert_eq!(panel.state().app_state.notice, None);
    assert_eq!(panel.state().app_state.draft.as_ref().and_then(|draft| draft.undoes()), Some("Gain of all"));
    panel.run();
    let now = panel.state().app_state.follower(1).map(|(_, _, follow)| follow.law.k[0]);
    assert_eq!(Some(value(&panel, Role::Slider, "Gain")), now);
    assert_ne!(now, Some(3.0));
}

#[test]
fn gains_of_distance_and_bearing_come_apart() {
    let text = with(THREE, &[("law.k", "[4.0, 2.0]")]);
    let mut panel = panel(app_state(&text, 5), law::show);
    assert_eq!(value(&panel, Role::Slider, "Gain for distance"), 4.0);
    assert_eq!(value(&panel, Role::Slider, "Gain for bearing"), 2.0);
    panel.get_by_role_and_label(Role::Slider, "Gain for bearing").set_value_accesskit(2.5);
    assert_eq!(values(&asked(&mut panel), "law.k"), ["[4.0, 2.5]"]);
    assert!(panel.query_by_role_and_label(Role::Slider, "Slope for distance").is_none());
    assert!(click(&mut panel, Role::CheckBox, "Distance and bearing apart").is_empty());
    panel.get_by_role_and_label(Role::Slider, "Slope for distance").set_value_accesskit(20.0);
    let slope = scene_slope();
    let asked = values(&asked(&mut panel), "law.slope");
    assert_eq!(asked, [format!("[20.0, {slope:?}]")]);
}

#[test]
fn one_follower_or_all() {
    let mut panel = panel(app_state(THREE, 5), law::show);
    assert_eq!(click(&mut panel, Role::Button, "Only left"), [Action::ForAll(false)]);
    assert_eq!(click(&mut panel, Role::Button, "All followers"), [Action::ForAll(true)]);
    panel.state_mut().app_state.act(&Action::Select(Selection::Robot(2)));
    panel.run();
    assert_says(&panel, &["Only right"]);
}

#[test]
fn the_law_is_chosen_by_name() {
    let mut panel = panel(app_state(THREE, 5), law::show);
    assert!(click(&mut panel, Role::ComboBox, "Law").is_empty());
    let actions = click(&mut panel, Role::Button, "Full state feedback");
    assert_eq!(actions, [Action::ChooseLaw(LawChoice::BuiltIn(LawKind::FullState))]);
    for action in &actions {
        assert!(panel.state_mut().app_state.act(action));
    }
    panel.run();
    let law = panel.get_by_role_and_label(Role::ComboBox, "Law");
    assert_eq!(law.value().as_deref(), Some("Full state feedback"));
    assert!(panel.query_by_label("Robust gain").is_none(), "it has no β: {:?}", texts(&panel));
    // One after the other, and each is what it is called.
    for name in ["Robust state feedback", "Output feedback", "Full state feedback"] {
        click(&mut panel, Role::ComboBox, "Law");
        for action in click(&mut panel, Role::Button, name) {
            assert!(panel.state_mut().app_state.act(&action));
        }
        panel.run();
        assert_eq!(panel.state().app_state.notice, None, "{name}");
        let law = panel.get_by_role_and_label(Role::ComboBox, "Law");
        assert_eq!(law.value().as_deref(), Some(name));
    }
    let mut panel = self::panel(app_state(THREE, 5), law::show);
    assert_eq!(values(&click(&mut panel, Role::Button, "sign"), "law.switching"), ["\"sign\""]);
    assert!(click(&mut panel, Role::Button, "tanh").is_empty(), "it is so already");
}

#[test]
fn the_observer_is_shown_tuned_and_explained() {
    let text = with(THREE, &[("observer.epsilon", "0.02"), ("observer.alpha1", "3.0")]);
    check_rows(
        || app_state(&text, 5),
        law::observer,
        &[
            (symbols::EPSILON, "observer.epsilon", 0.02, 0.05),
            (symbols::ALPHA_ONE, "observer.alpha1", 3.0, 2.5),
            (symbols::ALPHA_TWO, "observer.alpha2", 1.0, 1.5),
        ],
    );
    let mut panel = panel(app_state(&text, 5), law::observer);
    // s² + 3 s + 1 at ε = 0.02 s: (−3 ± √5) / 0.04.
    assert_says(&panel, &["Poles at −131 and −19.1 1/s"]);
    let actions = click(&mut panel, Role::Button, "Disturb and restart");
    assert!(
        matches!(&actions[..], [Action::Set { values, .. }, Action::Restart] if values[0].0 == "observer.start")
    );
    let told = with(THREE, &[("law.kind", "full-state")]);
    assert_says(&self::panel(app_state(&told, 5), law::observer), &["This law knows the rates."]);
    let looking = with(THREE, &[("sensing", "{ kind = \"noise\" }")]);
    let mut panel = self::panel(app_state(&looking, 5), law::observer);
    let actions = click(&mut panel, Role::CheckBox, "Adapt ε to the noise of each measurement");
    assert_eq!(values(&actions, "observer.adaptive").len(), 1);
}

#[test]
fn sensing_is_shown_tuned_and_explained() {
    let text = with(
        THREE,
        &[(
            "sensing",
            "{ kind = \"noise\", rate = 20.0, latency = 0.05, drop = 0.2, distance_noise = 0.01 }",
        )],
    );
    check_rows(
        || app_state(&text, 30),
        sensing::show,
        &[
            (symbols::RATE, "sensing.rate", 20.0, 25.0),
            (symbols::LATENCY, "sensing.latency", 0.05, 0.1),
            (symbols::DROPS, "sensing.drop", 0.2, 0.4),
            (symbols::DISTANCE_NOISE, "sensing.distance_noise", 0.01, 0.02),
        ],
    );
    assert_says(&panel(app_state(&text, 60), sensing::show), &["left ", "last measurement", "ms ago"]);
    let tags = with(THREE, &[("sensing", "{ kind = \"geometric\", pixel_noise = 0.3 }")]);
    check_rows(
        || app_state(&tags, 5),
        sensing::show,
        &[(symbols::PIXEL_NOISE, "sensing.pixel_noise", 0.3, 0.5)],
    );
    let mut panel = panel(app_state(THREE, 5), sensing::show);
    assert!(panel.query_by_role_and_label(Role::Slider, "Latency").is_none(), "the truth has none");
    for (name, kind) in [("Camera", "camera"), ("Noise", "noise"), ("Tags", "geometric"), ("Truth", "truth")]
    {
        click(&mut panel, Role::ComboBox, "Sensing");
        let actions = click(&mut panel, Role::Button, name);
        assert_eq!(values(&actions, "sensing.kind"), [format!("{kind:?}")]);
        for action in actions {
            assert!(panel.state_mut().app_state.act(&action));
        }
        panel.run();
        assert_eq!(panel.state().app_state.notice, None, "{name}");
        let sensing = panel.get_by_role_and_label(Role::ComboBox, "Sensing");
        assert_eq!(sensing.value().as_deref(), Some(name));
    }
}

#[test]
fn limits_are_shown_tuned_and_explained() {
    let text = with(THREE, &[("vehicle.speed_max", "1.8"), ("vehicle.acceleration_max", "3.0")]);
    let limit = |limit: fn(&scene::Vehicle) -> f64| {
        limit(&app_state(&text, 0).scene().expect("a scene").robots[1].vehicle)
    };
    check_rows(
        || app_state(&text, 5),
        world::limits,
        &[
            (symbols::SPEED_MIN, "vehicle.speed_min", limit(|v| v.speed_min), 0.2),
            (symbols::SPEED_MAX, "vehicle.speed_max", 1.8, 2.5),
            (symbols::TURN_MAX, "vehicle.turn_rate_max", limit(|v| v.turn_rate_max), 2.0),
            (symbols::ACCELERATION_MAX, "vehicle.acceleration_max", 3.0, 5.0),
        ],
    );
    let mut panel = panel(app_state(THREE, 5), world::limits);
    assert_says(&panel, &["unbounded, as in the paper"]);
    let actions = click(&mut panel, Role::Button, "Set a limit");
    assert_eq!(values(&actions, "vehicle.acceleration_max"), ["4.0"]);
}

/// A number can be typed, also one that is beyond the slider, and nonsense is nothing.
#[test]
fn numbers_can_be_typed() {
    for (text, value) in [("4.25", Some(4.25)), ("50", Some(50.0)), ("nonsense", None), ("-3", None)] {
        let mut panel = panel(app_state(THREE, 5), law::show);
        let actions = enter(&mut panel, Role::SpinButton, "Gain", text);
        let tuned = values(&actions, "law.k").last().map(|value| value.parse::<f64>().expect("a number"));
        match value {
            Some(value) => assert_eq!(tuned, Some(value), "{text}"),
            None => assert!(tuned.is_none_or(|tuned| tuned > 0.0), "{text}: {tuned:?}"),
        }
    }
}
