//! Limits of the vehicles, obstacles, and light.

use super::controls::{Range, SliderRow};
use super::law::scope;
use super::{empty_panel, nothing, on_click};
use crate::action::Action;
use crate::app_state::{AppState, Tool};
use crate::numbers::toml_number;
use crate::symbols;
use eframe::egui::{self, Slider, Ui, WidgetInfo};
use scene::Vehicle;
use vocabulary::counted;

pub(crate) const SPEED_MIN: SliderRow = SliderRow::new(
    symbols::SPEED_MIN,
    "vehicle.speed_min",
    Range { span: [0.01, 1.0], hard: [0.001, 100.0], logarithmic: true },
    3,
);
pub(crate) const SPEED_MAX: SliderRow =
    SliderRow::new(symbols::SPEED_MAX, "vehicle.speed_max", Range::factors(0.5, 20.0), 2);
pub(crate) const TURN_MAX: SliderRow =
    SliderRow::new(symbols::TURN_MAX, "vehicle.turn_rate_max", Range::factors(0.2, 20.0), 2);
pub(crate) const ACCELERATION_MAX: SliderRow =
    SliderRow::new(symbols::ACCELERATION_MAX, "vehicle.acceleration_max", Range::factors(0.2, 50.0), 2);

/// Limits of the selected follower.
pub fn limits(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((_, robot, name, follow)) = app_state.tuned_follower() else {
        return empty_panel(ui, app_state, "There is no follower.");
    };
    let Some(vehicle) = app_state.scene_now().and_then(|scene| scene.robots.get(robot)).map(|r| r.vehicle)
    else {
        return;
    };
    scope(ui, app_state, name, out);
    let default = Vehicle::ready_made(vehicle.kind);
    if follow.law.standing {
        ui.weak("It stops with its leader, so it has no minimum speed.");
    } else {
        SPEED_MIN.one(ui, vehicle.speed_min, default.speed_min, out);
    }
    SPEED_MAX.one(ui, vehicle.speed_max, default.speed_max, out);
    TURN_MAX.one(ui, vehicle.turn_rate_max, default.turn_rate_max, out);
    if vehicle.acceleration_max.is_finite() {
        ACCELERATION_MAX.one(ui, vehicle.acceleration_max, default.acceleration_max, out);
    } else {
        ui.horizontal(|ui| {
            symbols::ACCELERATION_MAX.label(ui);
            ui.weak("unbounded, as in the paper");
            if ui.button("Set a limit").clicked() {
                let (what, value) = ("Maximum acceleration".to_owned(), Some("4.0".to_owned()));
                out.push(Action::Tune { what, key: ACCELERATION_MAX.key.into(), value });
            }
        });
    }
}

/// Obstacles and light.
pub fn surroundings(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some(scene) = app_state.scene() else { return nothing(ui, "No scene is open.") };
    ui.horizontal(|ui| {
        let pillar = app_state.tool == Tool::Pillar;
        let tip = "Click on the ground to place a pillar (O)";
        let label = ui.selectable_label(pillar, "+ Pillar").on_hover_text(tip);
        on_click(&label, Action::UseTool(Tool::Pillar), out);
        ui.weak(match scene.props.len() {
            0 => "no obstacles".to_owned(),
            count => counted(count, "obstacle"),
        });
    });
    egui::ScrollArea::vertical().id_salt("props").max_height(110.0).show(ui, |ui| {
        for prop in &scene.props {
            ui.horizontal(|ui| {
                ui.label(&prop.name);
                let remove = format!("Remove {}", prop.name);
                let button = ui.small_button("×").on_hover_text(&remove);
                button.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &remove));
                on_click(&button, Action::RemoveProp(prop.name.clone()), out);
            });
        }
    });
    ui.separator();
    let environment = &scene.environment;
    for (name, key, value, span) in [
        ("Sun's height", "environment.sun_elevation", environment.sun_elevation.to_degrees(), 5.0..=90.0),
        ("Sun's direction", "environment.sun_azimuth", environment.sun_azimuth.to_degrees(), -180.0..=180.0),
    ] {
        ui.horizontal(|ui| {
            ui.label(name);
            // The light changes when the slider is released.
            let id = ui.scope_id().with(key);
            let mut new: f64 = ui.data(|data| data.get_temp(id)).unwrap_or(value);
            let response = ui.add(Slider::new(&mut new, span).suffix("°").max_decimals(0));
            response.widget_info(|| WidgetInfo::slider(true, new, name));
            if response.dragged() {
                ui.data_mut(|data| data.insert_temp(id, new));
            } else {
                ui.data_mut(|data| data.remove::<f64>(id));
                if (response.drag_stopped() || response.changed()) && (new - value).abs() > 0.25 {
                    let values = vec![(key.to_owned(), format!("\"{} deg\"", toml_number(new.round())))];
                    out.push(Action::Set { what: name.to_owned(), values });
                }
            }
        });
    }
}
