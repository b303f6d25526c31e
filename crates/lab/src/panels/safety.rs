//! Safety filters: what acts now, in words, and the barriers' parameters.

use super::controls::{Range, SliderRow, named, released};
use super::law::scope_of;
use super::{curves, empty_panel, nothing, tune};
use crate::action::Action;
use crate::app_state::AppState;
use crate::numbers::{fixed, toml_number};
use crate::quantities::PlotQuantity;
use crate::symbols;
use eframe::egui::{self, DragValue, RichText, Ui};
use scene::{Robot, Role};
use vocabulary::{BarrierState, FleetInfo, SafetyState};

pub(crate) const MARGIN: SliderRow =
    SliderRow::new(symbols::BARRIER_MARGIN, "safety.margin", Range::linear(0.0, 1.0), 3);
pub(crate) const POINT_AHEAD: SliderRow =
    SliderRow::new(symbols::POINT_AHEAD, "safety.point_ahead", Range::factors(0.02, 2.0), 3);
pub(crate) const GAIN: SliderRow =
    SliderRow::new(symbols::BARRIER_GAIN, "safety.gain", Range::factors(0.1, 20.0), 2);
pub(crate) const HORIZON: SliderRow =
    SliderRow::new(symbols::BARRIER_HORIZON, "safety.horizon", Range::factors(0.01, 1.0), 3);
pub(crate) const VIEW_DISTANCE: SliderRow =
    SliderRow::new(symbols::VIEW_DISTANCE, "safety.view_distance", Range::linear(0.5, 10.0), 2);
pub(crate) const VIEW_ANGLE: SliderRow =
    SliderRow::new(symbols::VIEW_ANGLE, "safety.view_angle", Range::linear(1.0, 90.0), 1);
/// What a robot is given that senses nothing, m.
const SENSES: f64 = 4.0;
/// Most barriers that are listed.
const MOST: usize = 6;

/// The filter of the selected robot.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((index, robot)) = app_state.filtered_robot() else {
        return empty_panel(ui, app_state, "There is no robot.");
    };
    scope_of(ui, app_state, "All robots", &robot.name, out);
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        if switches(ui, app_state, robot, out) {
            now(ui, app_state, index, robot);
            ui.separator();
            parameters(ui, app_state, robot, out);
        }
    });
}

/// Slack, and how far commands are moved, over time.
pub fn plots(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let none = app_state.record().is_some_and(|record| record.safety.is_empty());
    if none && app_state.time() == 0.0 {
        return nothing(ui, "No robot has a safety filter.");
    }
    curves::show(ui, app_state, &[PlotQuantity::Slack, PlotQuantity::Moved], out);
}

/// What switches the filter on and off; whether it is on.
fn switches(ui: &mut Ui, app_state: &AppState, robot: &Robot, out: &mut Vec<Action>) -> bool {
    let safety = &robot.safety;
    if robot.proximity.range.is_none() {
        nothing(ui, "It senses nothing near it, which a filter needs.");
        let tip = "Proximity sensors for all robots; the run restarts";
        let button = ui.button(format!("Sense within {SENSES} m, and filter")).on_hover_text(tip);
        let values = [("proximity.range", toml_number(SENSES)), ("safety.filter", "true".to_owned())];
        let values = values.map(|(key, value)| (key.to_owned(), value)).into();
        let what = "Proximity sensors and safety filters".to_owned();
        super::on_click(&button, Action::Set { what, values }, out);
        return false;
    }
    let leads = matches!(robot.role, Role::Lead { .. });
    ui.horizontal_wrapped(|ui| {
        let mut filter = safety.filter;
        let tip = "Commands are moved as little as the barriers ask";
        if ui.checkbox(&mut filter, "Filter commands").on_hover_text(tip).changed() {
            out.push(tune("Safety filter", "safety.filter", filter.to_string()));
            out.push(Action::Release);
        }
        let mut too = safety.leads;
        let tip = "They chase their paths as their barriers allow; the run restarts";
        let shown = safety.filter && (leads || app_state.for_all);
        if shown && ui.checkbox(&mut too, "Those that lead, too").on_hover_text(tip).changed() {
            out.push(tune("Filter of lead robots", "safety.leads", too.to_string()));
            out.push(Action::Release);
        }
    });
    if safety.filter && !safety.acts(leads) {
        nothing(ui, "It leads, and keeps to its path.");
    }
    safety.acts(leads)
}

/// What the filter did at the shown time.
fn now(ui: &mut Ui, app_state: &AppState, index: usize, robot: &Robot) {
    let (Some(record), Some(fleet)) = (app_state.record(), app_state.fleet()) else { return };
    let Some(state) = record.safety.iter().find(|state| state.robot == index) else {
        return nothing(ui, "The filter acts from the next control sample on.");
    };
    let alarm =
        if state.conflict.is_empty() { ui.visuals().text_color() } else { ui.visuals().error_fg_color };
    ui.add(egui::Label::new(RichText::new(words(state, &robot.name, fleet)).color(alarm)).wrap());
    if state.barriers.is_empty() {
        return;
    }
    egui::Grid::new("barriers").num_columns(3).spacing([10.0, 2.0]).show(ui, |ui| {
        for head in ["barrier", "room", "slack"] {
            ui.weak(head);
        }
        ui.end_row();
        for barrier in state.barriers.iter().take(MOST) {
            let acts = state.is_moved() && state.acting.contains(&barrier.constraint);
            let name = RichText::new(barrier.constraint.name(fleet));
            ui.label(if acts { name.strong() } else { name });
            ui.label(room(barrier));
            ui.label(fixed(barrier.slack, 2));
            ui.end_row();
        }
    });
}

/// What a filter did, in a sentence.
pub fn words(state: &SafetyState, name: &str, fleet: &FleetInfo) -> String {
    let moved = format!("its command is moved by {} m/s²", fixed(state.moved, 2));
    if let Some(conflict) = state.conflict_words(fleet) {
        let [collisions, views] = state.relaxed;
        // What keeps the leader in view gives way first; its rows have units of their own.
        let gives = if collisions > 0.0 {
            format!("barriers give way by {} m/s", fixed(collisions, 2))
        } else {
            format!("the view gives way by {}", fixed(views, 2))
        };
        return format!("For {name} there is {conflict}: {gives}; {moved}.");
    }
    match (state.acting_words(fleet), state.least_room()) {
        (Some(acting), _) => format!("{name} is held by {acting}: {moved}."),
        (None, Some(room)) => {
            let to = room.constraint.name(fleet);
            format!("{name} drives as decided, with {} m of room to {to}.", fixed(room.value, 2))
        }
        (None, None) => format!("{name} drives as decided. Nothing near forbids a command."),
    }
}

/// The value of a barrier with its unit.
fn room(barrier: &BarrierState) -> String {
    if barrier.constraint.is_angle() {
        return format!("{}°", fixed(barrier.value.to_degrees(), 1));
    }
    format!("{} m", fixed(barrier.value, 2))
}

fn parameters(ui: &mut Ui, app_state: &AppState, robot: &Robot, out: &mut Vec<Action>) {
    let (safety, usual) = (&robot.safety, scene::Safety::default());
    let (kind, length) = (robot.vehicle.kind, robot.vehicle.body().length);
    MARGIN.one(ui, safety.margin_of(length), usual.margin_of(length), out);
    POINT_AHEAD.one(ui, safety.point_ahead_of(kind, length), usual.point_ahead_of(kind, length), out);
    GAIN.one(ui, safety.gain, usual.gain, out);
    HORIZON.one(ui, safety.horizon, usual.horizon, out);
    if robot.role.follow().is_some() {
        // Within what its sensor reaches, and not at once too near.
        let reach = robot.proximity.range.unwrap_or(SENSES);
        let start = toml_number(reach);
        switch(ui, "Keep the leader near", &VIEW_DISTANCE, safety.view_distance.is_some(), &start, out);
        if let Some(distance) = safety.view_distance {
            VIEW_DISTANCE.one(ui, distance, distance, out);
        }
        switch(
            ui,
            "Keep the leader in the picture",
            &VIEW_ANGLE,
            safety.view_angle.is_some(),
            "\"25 deg\"",
            out,
        );
        if let Some(angle) = safety.view_angle {
            VIEW_ANGLE.degrees(ui, angle, angle, out);
        }
    }
    arena(ui, app_state, safety.arena, out);
}

/// A box that gives a key a value, or none.
fn switch(ui: &mut Ui, text: &str, row: &SliderRow, mut on: bool, start: &str, out: &mut Vec<Action>) {
    if ui.checkbox(&mut on, text).changed() {
        let what = format!("{}: {}", text, if on { "on" } else { "off" });
        out.push(Action::Tune { what, key: row.key.into(), value: on.then(|| start.to_owned()) });
    }
}

/// The rectangle that the robot stays within.
fn arena(ui: &mut Ui, app_state: &AppState, arena: Option<[f64; 4]>, out: &mut Vec<Action>) {
    let key = "safety.arena";
    let mut on = arena.is_some();
    if ui.checkbox(&mut on, "Stay within an arena").changed() {
        let value = on.then(|| rectangle(around(app_state)));
        out.push(Action::Tune { what: "Arena".to_owned(), key: key.into(), value });
    }
    let Some(sides) = arena else { return };
    let mut new = sides;
    ui.horizontal(|ui| {
        for (side, name) in new.iter_mut().zip(["West edge", "South edge", "East edge", "North edge"]) {
            let drag = DragValue::new(side).speed(0.05).range(-1e4..=1e4).max_decimals(2).suffix(" m");
            let response = ui.add(drag).on_hover_text(name);
            named(&response, *side, name);
            released(&response, out);
        }
    });
    if new != sides {
        out.push(tune("Arena", key, rectangle(new)));
    }
}

/// A rectangle as scenes write it.
fn rectangle(sides: [f64; 4]) -> String {
    format!("[{}]", sides.map(toml_number).join(", "))
}

/// A rectangle with room around all robots, at their start and now, m.
fn around(app_state: &AppState) -> [f64; 4] {
    let starts =
        app_state.scene_now().into_iter().flat_map(|scene| scene.robots.iter().map(|robot| robot.pose));
    let record = app_state.record();
    let now = record.iter().flat_map(|record| record.snapshot.robots.iter().map(|robot| robot.motion.pose));
    let mut sides = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for pose in starts.chain(now) {
        sides = [sides[0].min(pose.x), sides[1].min(pose.y), sides[2].max(pose.x), sides[3].max(pose.y)];
    }
    [sides[0] - ROOM, sides[1] - ROOM, sides[2] + ROOM, sides[3] + ROOM].map(f64::round)
}

/// What a new arena leaves around the robots, m.
const ROOM: f64 = 10.0;
