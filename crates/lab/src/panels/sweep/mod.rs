//! The panel Sweep: one or two keys of the scene are varied beside the window, and a map shows what comes of it, with the
//! present point in it.

mod curve;
mod frame;
mod map;
mod setup;
mod sweep_key;
mod tip;

use self::sweep_key::SweepKeys;
use super::nothing;
use crate::action::Action;
use crate::app_state::AppState;
use crate::app_state::sweep_plan::SweepPlan;
use crate::app_state::sweep_state::SweepResult;
use crate::numbers::plain;
use eframe::egui::{Id, RichText, ScrollArea, Ui};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;
use sweeps::{CellSummary, ChartQuantity, RunPoint, curve as curve_of, heat_map};

/// A panel that is wider has its map beside the choices, points.
const WIDE: f32 = 600.0;
/// Width of the choices there, points.
const CHOICES: f32 = 300.0;
/// Least height of a map, points.
const LEAST: f32 = 170.0;

/// Choices, progress and map.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some(keys) = keys(ui, app_state) else { return nothing(ui, "No scene is open.") };
    let plan = app_state.sweep.plan.clone().unwrap_or_else(|| SweepPlan {
        sides: keys.first(),
        seeds: 1,
        quantity: ChartQuantity::Met,
    });
    let high = ui.available_height();
    if ui.available_width() > WIDE {
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(CHOICES);
                setup::show(ui, app_state, &keys, &plan, false, out);
            });
            ui.separator();
            ui.vertical(|ui| result(ui, app_state, &keys, plan.quantity, high, out));
        });
        return;
    }
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        let top = ui.cursor().top();
        setup::show(ui, app_state, &keys, &plan, true, out);
        let left = high - (ui.cursor().top() - top) - 2.0;
        result(ui, app_state, &keys, plan.quantity, left, out);
    });
}

/// The keys of the scene as it is shown; they are looked for again when its text is another.
fn keys(ui: &Ui, app_state: &AppState) -> Option<Arc<SweepKeys>> {
    let text = app_state.text_shown()?;
    let mut hash = DefaultHasher::new();
    text.hash(&mut hash);
    let (id, hash) = (Id::unique("sweep keys"), hash.finish());
    let known: Option<(u64, Arc<SweepKeys>)> = ui.data(|data| data.get_temp(id));
    if let Some((_, keys)) = known.filter(|(of, _)| *of == hash) {
        return Some(keys);
    }
    let scene = app_state.draft.as_ref()?.read(&text).ok()?;
    let keys = Arc::new(SweepKeys::of(&scene, &text)?);
    ui.data_mut(|data| data.insert_temp(id, (hash, Arc::clone(&keys))));
    Some(keys)
}

/// What the rows show that have come.
fn result(
    ui: &mut Ui,
    app_state: &AppState,
    keys: &SweepKeys,
    quantity: ChartQuantity,
    high: f32,
    out: &mut Vec<Action>,
) {
    let Some(result) = &app_state.sweep.result else { return };
    let top = ui.cursor().top();
    let outdated = app_state.sweep_outdated();
    if let Some(what) = &outdated {
        let text = format!("Of the scene as it was before {what}: run it again.");
        ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
    }
    let high = (high - (ui.cursor().top() - top)).max(LEAST);
    let shown = SweptCells { result, keys, quantity, faded: outdated.is_some() };
    let design = result.job.experiment.design();
    let clicked = if let Some(drawn) = heat_map(design, &result.cells, quantity) {
        map::show(ui, &shown, drawn, high)
    } else if let Some(drawn) = curve_of(design, &result.cells, quantity) {
        curve::show(ui, &shown, drawn, high)
    } else {
        None
    };
    out.extend(clicked.map(|cell| shown.go_to(cell)));
}

/// The cells of a sweep, and what is shown of them.
struct SweptCells<'a> {
    result: &'a SweepResult,
    keys: &'a SweepKeys,
    quantity: ChartQuantity,
    /// Whether the scene is another now.
    faded: bool,
}

impl SweptCells<'_> {
    /// A key that varies: its path, and whether its values are angles in degrees.
    fn side(&self, place: usize) -> Option<(&str, bool)> {
        let parameter = self.result.job.experiment.study().parameters.get(place)?;
        Some((&parameter.key, parameter.values.to_string().contains("deg")))
    }

    /// Its words on an axis.
    fn label(&self, place: usize) -> String {
        self.side(place).map_or_else(String::new, |(key, degrees)| self.keys.label(key, degrees))
    }

    /// What it is at present.
    fn present(&self, place: usize) -> Option<f64> {
        self.side(place).and_then(|(key, degrees)| self.keys.present(key, degrees))
    }

    /// What the rows of a cell say.
    fn cell(&self, cell: u64) -> Option<&CellSummary> {
        self.result.cells.get(cell as usize)
    }

    /// The first run of a cell.
    fn point(&self, cell: u64) -> RunPoint {
        let design = self.result.job.experiment.design();
        design.point(cell * design.runs_per_cell())
    }

    /// Gives the scene the values of a cell.
    fn go_to(&self, cell: u64) -> Action {
        let parameters = self.result.job.experiment.study().parameters.iter();
        let values: Vec<(String, String)> = parameters
            .zip(self.point(cell).values)
            .map(|(parameter, value)| (parameter.key.clone(), value))
            .collect();
        let words = values.iter().map(|(key, value)| format!("{key} = {}", shown_value(value)));
        Action::Set { what: format!("From the sweep: {}", words.collect::<Vec<_>>().join(", ")), values }
    }
}

/// A value of an override, to five digits.
fn shown_value(value: &str) -> String {
    let value = value.trim_matches('"');
    let (number, unit) = value.strip_suffix(" deg").map_or((value, ""), |number| (number, "°"));
    let short = number.parse().map_or_else(|_| number.to_owned(), plain);
    format!("{}{unit}", short.replace('-', "−"))
}
