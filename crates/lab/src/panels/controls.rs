//! Rows with a symbol, a slider and a reset to the default.

use super::{pair, tune};
use crate::action::Action;
use crate::numbers::toml_number;
use crate::symbols::Symbol;
use eframe::egui::{self, Slider, Ui};
use std::borrow::Cow;

/// Range and scale of a slider.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    /// Limits of the slider; other values can be typed.
    pub(crate) span: [f64; 2],
    /// Limits of typed values.
    pub(crate) hard: [f64; 2],
    /// Whether the scale is logarithmic.
    pub(crate) logarithmic: bool,
}

impl Range {
    /// A linear scale.
    pub(crate) const fn linear(low: f64, high: f64) -> Self {
        Self { span: [low, high], hard: [low, f64::INFINITY], logarithmic: false }
    }

    /// A logarithmic scale.
    pub(crate) const fn factors(low: f64, high: f64) -> Self {
        Self { span: [low, high], hard: [f64::MIN_POSITIVE, f64::INFINITY], logarithmic: true }
    }
}

/// A slider for a quantity of the scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SliderRow {
    pub(crate) symbol: Symbol,
    /// Its key, without the robot.
    pub(crate) key: &'static str,
    pub(crate) range: Range,
    pub(crate) decimals: usize,
}

impl SliderRow {
    /// A slider for the quantity at a key of the scene.
    pub(crate) const fn new(symbol: Symbol, key: &'static str, range: Range, decimals: usize) -> Self {
        Self { symbol, key, range, decimals }
    }

    /// A row for one value and its default.
    pub(crate) fn one(&self, ui: &mut Ui, value: f64, default: f64, out: &mut Vec<Action>) {
        self.frame(ui, value != default, &toml_number(default), out, |ui, out| {
            self.edit(ui, value, self.symbol.name, out, toml_number);
        });
    }

    /// A row for an angle in rad, shown in degrees, and its default.
    pub(crate) fn degrees(&self, ui: &mut Ui, value: f64, default: f64, out: &mut Vec<Action>) {
        let shown = toml_number(default.to_degrees());
        self.frame(ui, value != default, &shown, out, |ui, out| {
            // A value that is not dragged stays as it is written.
            let degrees = (value.to_degrees() * 1e9).round() / 1e9;
            self.edit(ui, degrees, self.symbol.name, out, |new| format!("\"{} deg\"", toml_number(new)));
        });
    }

    /// A row for a pair: one slider if both are equal and `apart` is not set, else two.
    pub(crate) fn two(
        &self,
        ui: &mut Ui,
        value: [f64; 2],
        default: [f64; 2],
        apart: bool,
        out: &mut Vec<Action>,
    ) {
        let shown = pair(default);
        self.frame(ui, value != default, shown.trim_matches(['[', ']']), out, |ui, out| {
            if value[0] == value[1] && !apart {
                return self.edit(ui, value[0], self.symbol.name, out, |new| pair([new; 2]));
            }
            ui.vertical(|ui| {
                let [distance, bearing] =
                    ["distance", "bearing"].map(|of| format!("{} for {of}", self.symbol.name));
                self.edit(ui, value[0], &distance, out, |new| pair([new, value[1]]));
                self.edit(ui, value[1], &bearing, out, |new| pair([value[0], new]));
            });
        });
    }

    /// A slider for a value; `toml` formats a new one for the scene.
    fn edit(
        &self,
        ui: &mut Ui,
        value: f64,
        name: &str,
        out: &mut Vec<Action>,
        toml: impl FnOnce(f64) -> String,
    ) {
        let mut new = value;
        let response = self.slider(ui, &mut new, name);
        if response.changed() && new != value {
            out.push(tune(self.symbol.name, self.key, toml(new)));
        }
        released(&response, out);
    }

    fn frame(
        &self,
        ui: &mut Ui,
        differs: bool,
        default: &str,
        out: &mut Vec<Action>,
        sliders: impl FnOnce(&mut Ui, &mut Vec<Action>),
    ) {
        ui.horizontal(|ui| {
            sign(ui, |ui| self.symbol.label(ui));
            sliders(ui, out);
            let name = self.symbol.name.to_lowercase();
            reset(ui, differs, &name, &format!("{default} {}", self.symbol.unit), self.key.into(), out);
        });
    }

    fn slider(&self, ui: &mut Ui, value: &mut f64, name: &str) -> egui::Response {
        ui.spacing_mut().slider_width = slider_width(ui);
        let [low, high] = self.range.span;
        let unit = if self.symbol.unit.contains(',') { "" } else { self.symbol.unit };
        let suffix = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let [least, most] = self.range.hard;
        let before = *value;
        let mut slider = Slider::new(value, low.min(*value).max(least)..=high.max(*value).min(most))
            .logarithmic(self.range.logarithmic)
            .max_decimals(self.decimals)
            .suffix(suffix)
            // Numbers beyond the slider can be typed.
            .clamping(egui::SliderClamping::Never);
        if self.range.logarithmic {
            slider = slider.smallest_positive(low.max(1e-9));
        }
        let response = ui.add(slider);
        if *value != before {
            *value = value.clamp(least, most);
        }
        response.widget_info(|| egui::WidgetInfo::slider(true, *value, name));
        response.on_hover_ui(|ui| self.symbol.tip(ui))
    }
}

/// The place of a symbol at the front of a row.
pub(crate) fn sign(ui: &mut Ui, symbol: impl FnOnce(&mut Ui) -> egui::Response) {
    let size = egui::vec2(34.0, ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
        ui.set_min_width(size.x);
        symbol(ui)
    });
}

/// Width of a slider that leaves room for its number and its way back.
pub(crate) fn slider_width(ui: &Ui) -> f32 {
    (ui.available_width() - 118.0).clamp(60.0, 260.0)
}

/// The way back of the value at `key` to its default, at the end of a row.
pub(crate) fn reset(
    ui: &mut Ui,
    differs: bool,
    name: &str,
    default: &str,
    key: Cow<'static, str>,
    out: &mut Vec<Action>,
) {
    let back = ui.add_enabled(differs, egui::Button::new("↺").frame(false));
    let what = format!("Reset {name}");
    back.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, differs, what.clone()));
    if back.on_hover_text(format!("{what}: {default}")).clicked() {
        out.push(Action::Tune { what, key, value: None });
    }
}

/// Gives a number its accessible name and value.
pub(crate) fn named(response: &egui::Response, value: f64, name: &str) {
    response.widget_info(|| egui::WidgetInfo::drag_value(true, value));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SpinButton, true, name));
}

/// Emits an action when a slider is released.
pub(crate) fn released(response: &egui::Response, out: &mut Vec<Action>) {
    if response.drag_stopped() || response.lost_focus() {
        out.push(Action::Release);
    }
}
