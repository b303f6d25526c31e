//! The bar of time, and curves over it.

use super::{Panel, asked, assert_says, click, drag, panel, texts, value};
use crate::common::{Rig, THREE, app_state};
use eframe::egui::{Key, Modifiers, accesskit::Role, pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use lab::action::Action;
use lab::app_state::AppState;
use lab::panels::{curves, time_bar};
use lab::quantities::{self, PlotQuantity, csv};

fn bar(app_state: AppState, filming: bool) -> Panel {
    let mut bar = panel(app_state, move |ui, app_state, out| time_bar::show(ui, app_state, filming, out));
    bar.set_size([1200.0, 700.0].into());
    bar.run();
    bar
}

fn seeks(actions: &[Action]) -> Vec<f64> {
    let seek = |action: &Action| match action {
        Action::Seek(time) => Some(*time),
        _ => None,
    };
    actions.iter().filter_map(seek).collect()
}

#[test]
fn the_run_is_played_from_the_bar() {
    let mut bar = bar(app_state(THREE, 101), false);
    assert_says(&bar, &["t = 1.00 s"]);
    for (name, action) in [
        ("Play", Action::Toggle),
        ("Step", Action::Step),
        ("Restart", Action::Restart),
        ("Film", Action::Film),
        ("Picture", Action::Picture),
        ("Share", Action::Share),
        ("Scenes", Action::Gallery),
    ] {
        assert_eq!(click(&mut bar, Role::Button, name), [action], "{name}");
    }
    bar.state_mut().app_state.playing = true;
    assert_eq!(click(&mut bar, Role::Button, "Pause"), [Action::Toggle]);
}

#[test]
fn the_line_leads_to_the_past() {
    let mut bar = bar(app_state(THREE, 601), false);
    assert_eq!(value(&bar, Role::Slider, "Timeline"), 6.0);
    bar.get_by_role_and_label(Role::Slider, "Timeline").click();
    // 9 s are planned.
    let times = seeks(&asked(&mut bar));
    assert!(times.len() == 1 && (times[0] - 4.5).abs() < 0.05, "{times:?}");
    let times = seeks(&drag(&mut bar, Role::Slider, "Timeline", [0.6, 0.2]));
    assert!((times[times.len() - 1] - 1.8).abs() < 0.05, "{times:?}");
    bar.state_mut().app_state.act(&Action::Seek(2.5));
    bar.run();
    assert_eq!(value(&bar, Role::Slider, "Timeline"), 2.5);
    assert_says(&bar, &["t = 2.50 s"]);
    // A run that is longer than planned has room.
    let mut long = self::bar(app_state(THREE, 1001), false);
    long.get_by_role_and_label(Role::Slider, "Timeline").click();
    assert!((seeks(&asked(&mut long))[0] - 5.1).abs() < 0.05);
}

#[test]
fn the_pace_is_set_and_finds_back_to_one() {
    let mut bar = bar(app_state(THREE, 5), false);
    assert_eq!(value(&bar, Role::Slider, "Pace"), 1.0);
    bar.get_by_role_and_label(Role::Slider, "Pace").set_value_accesskit(4.0);
    assert_eq!(asked(&mut bar), [Action::Pace(4.0)]);
    bar.get_by_role_and_label(Role::Slider, "Pace").set_value_accesskit(1.05);
    assert_eq!(asked(&mut bar), [Action::Pace(1.0)]);
    let actions = drag(&mut bar, Role::Slider, "Pace", [0.2, 0.45]);
    let paces = |action: &Action| matches!(action, Action::Pace(pace) if (0.1..50.0).contains(pace));
    assert!(actions.len() > 2 && actions.iter().all(paces), "{actions:?}");
}

#[test]
fn more_is_in_a_menu() {
    let open = |app_state: AppState| {
        let mut bar = bar(app_state, false);
        assert!(click(&mut bar, Role::Button, "More").is_empty());
        bar
    };
    for (name, action) in [
        ("Keep the run", Action::KeepRun),
        ("Curves as CSV", Action::CurvesCsv),
        ("Curves as SVG", Action::CurvesSvg),
        ("Light or dark", Action::Theme),
        ("Shortcuts", Action::Help),
    ] {
        let mut bar = open(app_state(THREE, 5));
        bar.get_by_label_contains(name).click();
        assert_eq!(asked(&mut bar), [action], "{name}");
        assert!(bar.query_by_label_contains(name).is_none(), "it closes");
    }
    // What cannot be done cannot be pressed.
    let words = ["Save scene", "Reload from disk", "Undo", "Redo"];
    let disabled =
        |bar: &Panel| words.map(|word| bar.get_by_label_contains(word).accesskit_node().is_disabled());
    assert_eq!(disabled(&open(app_state(THREE, 5))), [true; 4]);
    let mut app_state = app_state(THREE, 5);
    app_state.act(&Action::Tune {
        what: "Gain".to_owned(),
        key: "law.k".into(),
        value: Some("5.0".to_owned()),
    });
    let mut bar = open(app_state);
    assert_eq!(disabled(&bar), [false, true, false, true]);
    bar.get_by_label_contains("Undo").click();
    assert_eq!(asked(&mut bar), [Action::Undo]);
    let mut bar = open(self::app_state(THREE, 5));
    bar.get_by_label_contains("Panels").click();
    bar.run();
    bar.get_by_role_and_label(Role::Button, "Sensing").click();
    assert_eq!(asked(&mut bar), [Action::Panel("Sensing")]);
    let mut bar = open(self::app_state(THREE, 5));
    bar.get_by_label_contains("Size").click();
    bar.run();
    bar.get_by_role_and_label(Role::Button, "150 %").click();
    assert_eq!(asked(&mut bar), [Action::Scale(1.5)]);
}

#[test]
fn a_scene_is_saved_under_another_name() {
    let mut bar = bar(app_state(THREE, 5), false);
    click(&mut bar, Role::Button, "More");
    bar.get_by_label_contains("Save as").click();
    bar.run();
    bar.get_by_role(Role::TextInput).click();
    bar.run();
    bar.key_press_modifiers(Modifiers::COMMAND, Key::A);
    bar.event(eframe::egui::Event::Text("/tmp/mine".to_owned()));
    bar.run();
    bar.key_press(Key::Enter);
    assert_eq!(asked(&mut bar), [Action::SaveAs("/tmp/mine.toml".into())]);
}

#[test]
fn a_film_under_way_is_ended() {
    let mut bar = bar(app_state(THREE, 5), true);
    assert_eq!(click(&mut bar, Role::Button, "Film"), [Action::Film]);
    bar.get_by_role_and_label(Role::Button, "Film").hover();
    bar.run_steps(8);
    assert!(texts(&bar).iter().any(|text| text.contains("End the film")), "{:?}", texts(&bar));
}

#[test]
fn a_click_on_a_curve_looks_at_its_time() {
    for quantity in PlotQuantity::all() {
        let mut panel = panel(app_state(THREE, 601), move |ui, app_state, out| {
            curves::show(ui, app_state, &[quantity], out);
        });
        panel.set_size([400.0, 200.0].into());
        panel.run();
        let mut last = -1.0;
        for x in [150.0, 250.0, 350.0] {
            panel.hover_at(pos2(x, 80.0));
            panel.run();
            panel.drag_at(pos2(x, 80.0));
            panel.drop_at(pos2(x, 80.0));
            let times = seeks(&asked(&mut panel));
            assert!(times.len() == 1 && times[0] > last + 1.0 && times[0] < 6.5, "{quantity:?}: {times:?}");
            last = times[0];
        }
    }
}

#[test]
fn curves_are_those_of_the_run() {
    let mut rig = Rig::new(THREE);
    rig.steps(100);
    let gain = Action::Tune { what: "Gain".to_owned(), key: "law.k".into(), value: Some("5.0".to_owned()) };
    rig.act(&[Action::Seek(0.5), gain, Action::NameBranch(0, "a, b".to_owned())]);
    rig.steps(50);
    let table = csv(&rig.app_state);
    let rows: Vec<&str> = table.lines().skip(1).collect();
    let of = |start: &str| rows.iter().filter(|row| row.starts_with(start)).count();
    assert_eq!(of("branch 1,left,distance_error_m,"), 101, "each sample once");
    assert_eq!(of("branch 1,leader,speed_m_s,"), 101, "leaders have a speed");
    assert!(of("\"a, b\",left,distance_error_m,") > 45, "and what the other branch has of its own");
    let record = rig.app_state.record().expect("a moment");
    let last = rows.iter().rfind(|row| row.starts_with("branch 1,right,bearing_error_deg,")).expect("a row");
    let degrees: f64 = last.rsplit(',').next().and_then(|value| value.parse().ok()).expect("a value");
    assert!((degrees - record.edges[1].error[1].to_degrees()).abs() < 1e-9);
    let mut twice: Vec<&str> =
        rows.iter().filter_map(|row| row.rsplit_once(',').map(|(key, _)| key)).collect();
    let count = twice.len();
    twice.dedup();
    assert_eq!(twice.len(), count, "no row twice");
}

/// A plot of a long run names the largest value of all samples, not of those that it has room for.
#[test]
fn thinned_curves_keep_the_largest_command_and_the_largest_error_of_the_observer() {
    let state = app_state(THREE, 1400);
    let largest = |quantity, most| {
        let all = quantities::curves(&state, quantity, most);
        all.iter().flat_map(|curve| &curve.points).map(|point| point[1].abs()).fold(0.0, f64::max)
    };
    for quantity in [
        PlotQuantity::Acceleration,
        PlotQuantity::TurnRate,
        PlotQuantity::Speed,
        PlotQuantity::DistanceRateError,
        PlotQuantity::BearingRateError,
    ] {
        let whole = largest(quantity, usize::MAX);
        assert!(whole > 0.0);
        assert_eq!(largest(quantity, 100), whole, "{quantity:?}");
        let drawn = quantities::curves(&state, quantity, 100);
        assert!(drawn.iter().all(|curve| curve.points.len() <= 101), "{quantity:?}");
    }
}
