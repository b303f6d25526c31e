//! What is drawn and filmed, obstacles and light.

use super::{Panel, asked, assert_says, click, drag, panel, value};
use crate::common::{THREE, app_state};
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use lab::action::Action;
use lab::app_state::Tool;
use lab::panels::{film, world};
use rendering::Style;

fn film(filming: Option<&'static str>) -> Panel {
    let style = Style::default();
    panel(app_state(THREE, 5), move |ui, app_state, out| film::show(ui, app_state, &style, filming, out))
}

#[test]
fn pictures_and_films_are_asked_for() {
    let mut panel = film(None);
    for (name, action) in [("Picture", Action::Picture), ("Keep the run", Action::KeepRun)] {
        assert_eq!(click(&mut panel, Role::Button, name), [action], "{name}");
    }
    panel.get_by_role_and_label(Role::Button, "● Film").click();
    assert_eq!(asked(&mut panel), [Action::Film]);
    let mut panel = film(Some("12 s of film"));
    assert_says(&panel, &["12 s of film"]);
    panel.get_by_label_contains("End the film").click();
    assert_eq!(asked(&mut panel), [Action::Film]);
}

#[test]
fn a_film_is_taken_from_a_view() {
    let mut panel = film(None);
    click(&mut panel, Role::ComboBox, "Film from");
    let actions = click(&mut panel, Role::Button, "orbit");
    assert_eq!(actions, [Action::FilmFrom(Some("orbit".to_owned()))]);
}

#[test]
fn the_look_ahead_is_set() {
    let mut panel = film(None);
    assert_eq!(value(&panel, Role::Slider, "Look ahead"), 6.0);
    panel.get_by_role_and_label(Role::Slider, "Look ahead").set_value_accesskit(10.0);
    assert_eq!(asked(&mut panel), [Action::Ahead(10.0)]);
}

#[test]
fn elements_are_switched_by_words() {
    let style = Style::default();
    for (text, name) in
        [("Ribbons along driven paths", "ribbons"), ("Names", "names"), ("Shadows", "shadows")]
    {
        let mut panel = film(None);
        assert_eq!(
            click(&mut panel, Role::CheckBox, text),
            [Action::Element(name_of(name), !style.shows(name))]
        );
    }
}

/// The name as the action has it.
fn name_of(name: &str) -> &'static str {
    ["ribbons", "names", "shadows"].into_iter().find(|known| *known == name).expect("a name")
}

#[test]
fn obstacles_come_and_go() {
    let pillar = "\n[[props]]\nname = \"post\"\nshape = \"cylinder\"\nradius = 0.1\nheight = 0.5\npose = [5.0, 5.0, 0.0]\n";
    let mut panel = panel(app_state(&format!("{THREE}{pillar}"), 5), world::surroundings);
    assert_says(&panel, &["1 obstacle", "post"]);
    assert_eq!(click(&mut panel, Role::Button, "+ Pillar"), [Action::UseTool(Tool::Pillar)]);
    assert_eq!(click(&mut panel, Role::Button, "Remove post"), [Action::RemoveProp("post".to_owned())]);
    assert_says(&self::panel(app_state(THREE, 5), world::surroundings), &["no obstacles"]);
}

#[test]
fn the_sun_moves_when_it_is_let_go() {
    let mut panel = panel(app_state(THREE, 5), world::surroundings);
    for (name, path) in
        [("Sun's height", "environment.sun_elevation"), ("Sun's direction", "environment.sun_azimuth")]
    {
        let actions = drag(&mut panel, Role::Slider, name, [0.15, 0.3]);
        let [Action::Set { what, values }] = &actions[..] else { panic!("{name}: {actions:?}") };
        assert!(what == name && values[0].0 == path && values[0].1.ends_with(" deg\""), "{actions:?}");
        let before = value(&panel, Role::Slider, name);
        for action in actions {
            assert!(panel.state_mut().app_state.act(&action));
        }
        panel.run();
        assert_ne!(value(&panel, Role::Slider, name), before);
        assert_eq!(panel.state().app_state.notice, None);
    }
}
