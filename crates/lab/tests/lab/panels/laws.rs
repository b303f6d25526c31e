//! The panel of a custom law: the choice, sliders of what it declares, and its text.

use super::{asked, assert_says, click, panel, says, value};
use crate::common::{THREE, app_state, with};
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use lab::action::{Action, LawChoice};
use lab::app_state::AppState;
use lab::panels::{curves, custom_law, law};
use laws::TEMPLATE;

/// A state whose followers have the law of the template.
fn custom(samples: usize) -> AppState {
    app_state(
        &with(THREE, &[("law.text", &scene::toml_text(TEMPLATE)), ("law.parameters.k", "3.0")]),
        samples,
    )
}

#[test]
fn parameters_are_sliders_with_symbol_unit_range_and_a_way_back() {
    let mut panel = panel(custom(2), law::show);
    assert!((value(&panel, Role::Slider, "k") - 3.0).abs() < 1e-9);
    assert!((value(&panel, Role::Slider, "d") - 0.8).abs() < 1e-9);
    panel.get_by_role_and_label(Role::Slider, "k").set_value_accesskit(40.0);
    let actions = asked(&mut panel);
    let tuned = |value: &str| Action::Tune {
        what: "k…".to_owned(),
        key: "law.parameters.k".into(),
        value: Some(value.to_owned()),
    };
    assert_eq!(actions.first(), Some(&tuned("10.0")), "the law says how far it goes");
    let back = Action::Tune { what: "Reset k".to_owned(), key: "law.parameters.k".into(), value: None };
    assert_eq!(click(&mut panel, Role::Button, "Reset k"), [back]);
    assert!(panel.get_by_role_and_label(Role::Button, "Reset d").accesskit_node().is_disabled());
    assert_eq!(click(&mut panel, Role::Button, "Edit its text"), [Action::ShowPanel("Law text")]);
    let without = super::panel(app_state(THREE, 2), custom_law::text);
    assert_says(&without, &["a law of the paper", "New law"]);
}

#[test]
fn mistakes_are_listed_with_their_places() {
    let mut state = custom(2);
    let wrong = TEMPLATE.replace("2 * d * k * de.x", "leader.bearing");
    assert!(state.act(&Action::EditLaw(wrong.clone())));
    let panel = panel(state, custom_law::text);
    let line = wrong.lines().position(|line| line.starts_with("let along")).expect("a line") + 1;
    assert_says(&panel, &[&format!("{line}:14: ")]);
    assert!(!says(&panel, "Takes hold"));
}

/// A mistake on the way to what is meant must not take the keyboard away.
#[test]
fn the_text_keeps_the_keyboard_through_mistakes() {
    let mut panel = panel(custom(2), custom_law::text);
    click(&mut panel, Role::MultilineTextInput, "Text of the law");
    let typed = |panel: &mut super::Panel, text: &str| {
        panel.event(eframe::egui::Event::Text(text.to_owned()));
        let actions = asked(panel);
        let Some(Action::EditLaw(edited)) = actions.first() else { panic!("{actions:?}") };
        let edited = edited.clone();
        assert!(panel.state_mut().app_state.act(&actions[0]));
        panel.run();
        edited
    };
    // A line that begins with a Greek letter is a line like any other.
    for (text, mistaken) in [("\nx", true), ("\nε", true), ("# ψ", true), ("(", true)] {
        let edited = typed(&mut panel, text);
        assert!(edited.contains(text));
        assert_eq!(
            panel.state().app_state.law_edit().is_some_and(|edit| !edit.mistakes.is_empty()),
            mistaken
        );
    }
}

#[test]
fn laws_of_the_paper_those_that_ship_and_a_new_one_can_be_chosen() {
    for (entry, choice) in [
        ("Full state feedback", LawChoice::BuiltIn(vocabulary::LawKind::FullState)),
        ("Robust state feedback (eq 22) (law file)", LawChoice::Shipped("robust-state")),
        ("New law…", LawChoice::Text(TEMPLATE.to_owned())),
    ] {
        let mut panel = panel(app_state(THREE, 2), law::show);
        click(&mut panel, Role::ComboBox, "Law");
        let node = panel.get_by_label(entry);
        node.click();
        assert_eq!(asked(&mut panel), [Action::ChooseLaw(choice)], "{entry}");
    }
}

#[test]
fn memory_and_lets_are_curves() {
    let mut panel = panel(custom(30), curves::signals);
    assert_says(&panel, &["sum", "e.x", "e.y", "along", "across"]);
    let empty = super::panel(app_state(THREE, 3), curves::signals);
    assert_says(&empty, &["A custom law shows its memory"]);
    assert!(click(&mut panel, Role::Button, "along").is_empty());
    // A sum grows by its error times the period from one sample to the next.
    let [sums, errors] = ["sum", "e.x"].map(|name| lab::quantities::signal_curves(&custom(30), name, 100));
    let values = |at: usize, of: &[lab::quantities::QuantityCurve]| of[0].points[at][1];
    assert_eq!((sums.len(), sums[0].points.len(), errors[0].points.len()), (2, 30, 30));
    for at in 1..30 {
        let grown = values(at, &sums) - values(at - 1, &sums);
        assert!((grown - 0.01 * values(at, &errors)).abs() < 1e-12, "{at}");
    }
}

#[test]
fn a_law_that_breaks_off_is_told_at_its_text() {
    let broken = TEMPLATE.replace("command = ahead", "command = ahead * sqrt(0.05 - time / 1 [s])");
    let text = with(THREE, &[("law.text", &scene::toml_text(&broken))]);
    for (show, name) in [(custom_law::text as fn(&mut _, &_, &mut _), "Law text"), (law::show, "Law")] {
        let panel = panel(app_state(&text, 10), show);
        assert_says(&panel, &["Law of left, t = 0.06 s", "brakes until its law is changed"]);
        assert!(!says(&panel, "Takes hold") && !says(&panel, "has mistakes"), "{name}");
    }
}
