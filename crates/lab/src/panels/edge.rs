//! The selected edge: its set point in numbers, and the shape of the whole formation.

use super::controls::{named, released};
use super::empty_panel;
use crate::action::Action;
use crate::app_state::AppState;
use crate::numbers::fixed;
use crate::symbols;
use eframe::egui::{self, DragValue, RichText, Ui};
use vocabulary::{ScalarTrajectory, wrap};

/// The selected edge, and all others of its follower.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((edge, (robot, ..))) = app_state.chosen_edge().and_then(|e| Some((e, app_state.follower(e)?)))
    else {
        return empty_panel(ui, app_state, "Click a follower or its edge.");
    };
    let all = app_state.beside(edge);
    for own in &all {
        if !place(ui, app_state, *own, out) {
            return;
        }
        ui.add_space(if all.len() > 1 { 6.0 } else { 0.0 });
    }
    if all.len() < 2 {
        mirror(ui, app_state, edge, out);
    }
    let record = app_state.shown();
    for own in all {
        let Some(state) = record.as_ref().and_then(|record| record.edges.get(own)) else { continue };
        ui.weak(format!("error {} m, {}°", fixed(state.error[0], 3), fixed(state.error[1].to_degrees(), 2)));
        if state.limited && own == edge {
            let filtered = app_state.record().is_some_and(|record| record.is_filtered(robot));
            let cuts =
                if filtered { "its safety filter moves the command" } else { "a limit cuts the command" };
            ui.colored_label(ui.visuals().warn_fg_color, cuts);
        }
    }
    shape(ui, out);
    ahead(ui, app_state, edge);
}

/// The set point of an edge in numbers; whether its follower follows by it.
fn place(ui: &mut Ui, app_state: &AppState, edge: usize, out: &mut Vec<Action>) -> bool {
    let Some((_, name, _)) = app_state.follower(edge) else { return false };
    let Some(wanted) = app_state.leader(edge) else { return false };
    let record = app_state.shown();
    let pair = record.as_ref().zip(app_state.fleet()).map(|(record, fleet)| record.edge(fleet, edge));
    let leader = match (pair, app_state.fleet()) {
        (Some(Some(pair)), Some(fleet)) => fleet.pair(pair)[0].to_owned(),
        (Some(None), _) => {
            ui.label(RichText::new(format!("{name} follows nobody")).strong());
            return false;
        }
        _ => wanted.name.clone(),
    };
    ui.label(RichText::new(format!("{leader} → {name}")).strong());
    let state = record.and_then(|record| record.edges.get(edge).copied());
    let [distance, bearing] = app_state.set_point(edge).unwrap_or_default();
    let (mut new_distance, mut new_degrees) = (distance, bearing.to_degrees());
    egui::Grid::new(("set point", edge)).num_columns(3).spacing([8.0, 4.0]).show(ui, |ui| {
        symbols::DISTANCE.label(ui);
        let drag = DragValue::new(&mut new_distance).speed(0.02).range(0.05..=1000.0).max_decimals(3);
        let drag = drag.custom_formatter(|value, _| format!("{} m", fixed(value, 2))).custom_parser(number);
        if wanted.distance.is_some() {
            let response = ui.add(drag);
            named(&response, new_distance, symbols::DISTANCE.name);
            released(&response, out);
        } else {
            free(ui);
        }
        ui.weak(state.map_or_else(String::new, |s| format!("is {} m", fixed(s.relative.distance, 3))));
        ui.end_row();
        symbols::BEARING.label(ui);
        let drag = DragValue::new(&mut new_degrees).speed(0.5).range(-180.0..=180.0).max_decimals(2);
        let drag = drag.custom_formatter(|value, _| format!("{}°", fixed(value, 1))).custom_parser(number);
        if wanted.bearing.is_some() {
            let response = ui.add(drag);
            named(&response, new_degrees, symbols::BEARING.name);
            released(&response, out);
        } else {
            free(ui);
        }
        ui.weak(state.map_or_else(String::new, |s| {
            let bearing = wrap(s.relative.bearing + s.behind);
            format!("is {}°", fixed(bearing.to_degrees(), 1))
        }));
        ui.end_row();
    });
    if new_distance != distance || (new_degrees - bearing.to_degrees()).abs() > 1e-9 {
        out.push(Action::SetPoint { edge, distance: new_distance, bearing: new_degrees.to_radians() });
    }
    let moves = |channel: &Option<ScalarTrajectory>| {
        channel.as_ref().is_some_and(|channel| !matches!(channel, ScalarTrajectory::Constant(_)))
    };
    if moves(&wanted.distance) || moves(&wanted.bearing) {
        ui.weak("This set point changes over time; a value set here is constant.");
    }
    true
}

/// In place of a value of which nothing is wanted.
fn free(ui: &mut Ui) {
    ui.weak("free").on_hover_text("The follower's other leaders say where it is to be");
}

/// Whether the follower on the other side moves too.
fn mirror(ui: &mut Ui, app_state: &AppState, edge: usize, out: &mut Vec<Action>) {
    let mut mirror = app_state.mirror;
    let tip = "The follower on the other side of the same leader moves too";
    if ui.checkbox(&mut mirror, "Mirror the other side").on_hover_text(tip).changed() {
        out.push(Action::Mirror(mirror));
    }
    if app_state.mirror
        && app_state.set_point(edge).is_some_and(|place| app_state.twin(edge, place).is_none())
    {
        ui.weak("No follower is at its mirror image.");
    }
}

/// Scale and turn of the whole formation.
fn shape(ui: &mut Ui, out: &mut Vec<Action>) {
    ui.add_space(4.0);
    ui.label(RichText::new("Whole formation").strong());
    ui.horizontal_wrapped(|ui| {
        for (text, scale, turn, tip) in [
            ("−10 %", 1.0 / 1.1, 0.0, "All distances smaller (Ctrl −)"),
            ("+10 %", 1.1, 0.0, "All distances larger (Ctrl +)"),
            ("↺ 5°", 1.0, 5.0, "All bearings to the left"),
            ("↻ 5°", 1.0, -5.0, "All bearings to the right"),
        ] {
            if ui.button(text).on_hover_text(tip).clicked() {
                out.push(Action::Shape { scale, turn: f64::to_radians(turn) });
                out.push(Action::Release);
            }
        }
    });
}

/// What the prediction tells about the edge.
fn ahead(ui: &mut Ui, app_state: &AppState, edge: usize) {
    let Some(prediction) = app_state.prediction.as_ref().filter(|ahead| ahead.branch == app_state.branch)
    else {
        return;
    };
    ui.add_space(4.0);
    let seconds = prediction.span[1] - prediction.span[0];
    if let Some([distance, bearing]) = prediction.late_error.get(edge) {
        ui.label(format!(
            "in {} s: within {} m, {}°",
            fixed(seconds, 0),
            fixed(*distance, 3),
            fixed(bearing.to_degrees(), 2)
        ));
    }
    if let Some((time, things)) = &prediction.contact
        && let Some(fleet) = app_state.fleet()
    {
        let [a, b] = things.map(|thing| fleet.name(thing).to_owned());
        let text = format!("contact at {} s: {a} and {b}", fixed(*time, 1));
        ui.colored_label(ui.visuals().error_fg_color, text);
    }
}

/// A number as people type it, with its unit or without.
fn number(text: &str) -> Option<f64> {
    text.trim().trim_end_matches(['m', '°']).trim().replace('−', "-").replace(',', ".").parse().ok()
}
