//! What a sweep varies, its start and its progress.

use super::sweep_key::SweepKeys;
use crate::action::Action;
use crate::app_state::AppState;
use crate::app_state::sweep_plan::{SweepPlan, SweepSide};
use crate::app_state::sweep_state::{SweepProgress, SweepResult};
use crate::numbers::plain;
use crate::panels::{chosen, on_click};
use eframe::egui::{self, CollapsingHeader, ComboBox, DragValue, RichText, TextEdit, Ui};
use sweeps::{ChartQuantity, MEASURES};
use vocabulary::counted;

/// Most values of a side, and most runs of a combination.
const MOST: u32 = 1000;
const NAMES: [&str; 2] = ["Across", "Up"];
/// Most letters of the line that names what varies.
const LONGEST: usize = 38;
/// Width of what stands before a choice, points.
const NAME: f32 = 44.0;

/// All choices, the buttons, and how far the sweep is. Where there is little room, the keys fold away at the start.
pub(super) fn show(
    ui: &mut Ui,
    app_state: &AppState,
    keys: &SweepKeys,
    plan: &SweepPlan,
    folds: bool,
    out: &mut Vec<Action>,
) {
    let mut new = plan.clone();
    let running = matches!(app_state.sweep.progress, SweepProgress::Running | SweepProgress::Checking);
    let started = running && app_state.sweep.result.as_ref().is_none_or(|result| result.done == 0);
    if folds {
        CollapsingHeader::new(summary(keys, plan))
            .id_salt("swept keys")
            .default_open(true)
            .open(started.then_some(false))
            .show_unindented(ui, |ui| sides(ui, keys, &mut new));
    } else {
        sides(ui, keys, &mut new);
    }
    ui.horizontal(|ui| {
        before(ui, "Shows");
        let seeds = ui.available_width() - 96.0;
        ui.scope(|ui| {
            ui.set_max_width(seeds);
            quantity(ui, &mut new.quantity, seeds);
        });
        ui.label("seeds");
        number(ui, DragValue::new(&mut new.seeds).range(1..=MOST).speed(0.1), "Seeds");
    });
    if new != *plan {
        out.push(Action::PlanSweep(new.clone()));
    }
    ui.horizontal_wrapped(|ui| {
        if running {
            on_click(&ui.button("■ Stop"), Action::StopSweep, out);
        } else {
            let runs = usize::try_from(new.runs()).unwrap_or(usize::MAX);
            let start = ui.button(format!("▶ Start {}", counted(runs, "run")));
            on_click(&start, Action::StartSweep(new.clone()), out);
        }
        let copy =
            ui.button("Copy command").on_hover_text("`echelon sweep` makes the same runs, with a report");
        on_click(&copy, Action::CopySweep(new), out);
        progress(ui, &app_state.sweep.progress, app_state.sweep.result.as_ref());
    });
    if let SweepProgress::Refused(why) = &app_state.sweep.progress {
        ui.add(egui::Label::new(RichText::new(why).color(ui.visuals().error_fg_color)).wrap());
    }
}

/// What varies, in a line.
fn summary(keys: &SweepKeys, plan: &SweepPlan) -> String {
    let name = |side: &SweepSide| match keys.called(&side.key) {
        Some(known) => known.short(),
        None => side.key.clone(),
    };
    let names: Vec<String> = plan.sides.iter().map(name).collect();
    let counts: Vec<String> = plan.sides.iter().map(|side| side.count.to_string()).collect();
    let all = format!("{} values: {}", counts.join(" × "), names.join(", "));
    // A line that is too long would widen the panel.
    if all.chars().count() <= LONGEST { all } else { all.chars().take(LONGEST - 1).chain(['…']).collect() }
}

/// The keys with their ranges.
fn sides(ui: &mut Ui, keys: &SweepKeys, plan: &mut SweepPlan) {
    for (place, name) in NAMES.into_iter().enumerate() {
        ui.push_id(name, |ui| {
            key(ui, keys, plan, place, name);
            if let Some(side) = plan.sides.get_mut(place) {
                range(ui, side, name);
            }
        });
    }
}

/// The choice of a key.
fn key(ui: &mut Ui, keys: &SweepKeys, plan: &mut SweepPlan, place: usize, name: &str) {
    let now = plan.sides.get(place).map(|side| side.key.clone());
    let known = now.as_deref().and_then(|key| keys.called(key));
    let shown = match (&now, known) {
        (None, _) => "one key only".to_owned(),
        (Some(_), Some(known)) => known.label(),
        (Some(_), None) => OTHER.to_owned(),
    };
    let count = plan.sides.get(place).map(|side| side.count);
    let mut pick = None;
    ui.horizontal(|ui| {
        before(ui, name);
        let combo = ComboBox::from_id_salt("key").selected_text(&shown).width(ui.available_width() - 8.0);
        let response = combo.height(640.0).show_ui(ui, |ui| {
            if place > 0 && ui.selectable_label(now.is_none(), "one key only").clicked() {
                pick = Some(None);
            }
            for known in &keys.keys {
                let label = ui.selectable_label(now.as_ref() == Some(&known.key), known.label());
                if label.on_hover_text(&known.key).clicked() {
                    pick = Some(Some(keys.side(&known.key, count)));
                }
            }
            if ui.selectable_label(now.is_some() && known.is_none(), OTHER).clicked() {
                pick = Some(Some(keys.side("", count)));
            }
        });
        chosen(&response.response, &format!("{name} key"), &shown);
    });
    match pick {
        Some(Some(side)) if place < plan.sides.len() => plan.sides[place] = side,
        Some(Some(side)) => plan.sides.push(side),
        Some(None) => plan.sides.truncate(place),
        None => {}
    }
    if let Some(side) = plan.sides.get_mut(place).filter(|side| keys.called(&side.key).is_none()) {
        other(ui, keys, side, name);
    }
}

/// A field for a key that is not in the list.
fn other(ui: &mut Ui, keys: &SweepKeys, side: &mut SweepSide, name: &str) {
    ui.horizontal(|ui| {
        before(ui, "");
        let mut text = side.key.clone();
        let field = TextEdit::singleline(&mut text).hint_text("its path, such as vision.blur");
        let field = ui.add(field.desired_width(ui.available_width() - 16.0));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, format!("{name} path")));
        if field.changed() {
            *side = keys.side(&text, Some(side.count));
            side.key = text;
        }
    });
    if !side.key.is_empty() && keys.present(&side.key, side.degrees).is_none() {
        ui.horizontal(|ui| {
            before(ui, "");
            ui.weak("no number stands there at present");
        });
    }
}

/// The range of a key.
fn range(ui: &mut Ui, side: &mut SweepSide, name: &str) {
    ui.horizontal(|ui| {
        before(ui, "");
        let speed = 0.005 * (side.to - side.from).abs().max(1e-6);
        let unit = if side.degrees { "°" } else { "" };
        let logarithmic = side.logarithmic;
        let end = |ui: &mut Ui, value: &mut f64, which: &str| {
            let speed = if logarithmic { 0.01 * value.abs().max(1e-9) } else { speed };
            let drag = DragValue::new(value).speed(speed).suffix(unit);
            let drag = drag.custom_formatter(|number, _| plain(number).replace('-', "−"));
            number(ui, drag, &format!("{name} {which}"));
        };
        end(ui, &mut side.from, "from");
        ui.label("to");
        end(ui, &mut side.to, "to");
        ui.label("in");
        let count = DragValue::new(&mut side.count).range(2..=MOST).speed(0.1);
        number(ui, count, &format!("{name} values"));
        let log = ui.checkbox(&mut side.logarithmic, "log").on_hover_text("Values with equal ratios");
        log.widget_info(|| {
            egui::WidgetInfo::selected(egui::Role::CheckBox, true, side.logarithmic, format!("{name} log"))
        });
    });
}

/// A number with its accessible name.
fn number(ui: &mut Ui, drag: DragValue<'_>, name: &str) {
    let response = ui.add(drag);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SpinButton, true, name));
}

/// The choice of what is shown.
fn quantity(ui: &mut Ui, now: &mut ChartQuantity, wide: f32) {
    let combo = ComboBox::from_id_salt("quantity").selected_text(now.label()).width(wide).truncate();
    let response = combo.height(420.0).show_ui(ui, |ui| {
        let measures = (0..MEASURES.len()).map(ChartQuantity::Measure);
        for quantity in [ChartQuantity::Met].into_iter().chain(measures) {
            ui.selectable_value(now, quantity, quantity.label());
        }
    });
    chosen(&response.response, "Shows", now.label());
}

/// How far the sweep is.
fn progress(ui: &mut Ui, progress: &SweepProgress, result: Option<&SweepResult>) {
    let [done, runs] = result.map_or([0; 2], |result| [result.done, result.runs()]);
    let text = match progress {
        SweepProgress::Idle | SweepProgress::Refused(_) => return,
        SweepProgress::Checking => "checking …".to_owned(),
        SweepProgress::Running => match result.and_then(SweepResult::left) {
            Some(left) => format!("{done} of {runs}, {} left", spoken(left.as_secs_f64())),
            None => format!("{done} of {runs}"),
        },
        SweepProgress::Stopped => format!("stopped, {done} of {runs}"),
        SweepProgress::Complete => format!("{runs} done"),
    };
    ui.label(text);
}

/// A time as one says it.
fn spoken(seconds: f64) -> String {
    match seconds.ceil() {
        seconds if seconds < 100.0 => format!("{seconds} s"),
        seconds if seconds < 6000.0 => format!("{} min", (seconds / 60.0).round()),
        seconds => format!("{} h", (seconds / 3600.0).round()),
    }
}

/// The place of a word before a choice.
fn before(ui: &mut Ui, word: &str) {
    let size = egui::vec2(NAME, ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
        ui.set_min_width(size.x);
        if !word.is_empty() {
            ui.label(word);
        }
    });
}

const OTHER: &str = "another key …";
