//! Films, pictures and the elements that they show.

use super::on_click;
use crate::action::Action;
use crate::app_state::AppState;
use eframe::egui::{self, Slider, Ui, WidgetInfo};
use rendering::Style;

/// Elements that can be switched, with their labels.
const ELEMENTS: [(&str, &str); 13] = [
    ("ribbons", "Ribbons along driven paths"),
    ("ghosts", "Ghosts of past poses"),
    ("set-points", "Rings at set points"),
    ("edges", "Edges"),
    ("labels", "Distances and bearings"),
    ("names", "Names"),
    ("grid", "Grid"),
    ("inset", "Chart of errors"),
    ("caption", "Title and law"),
    ("shadows", "Shadows"),
    ("barriers", "Barriers of safety filters"),
    ("events", "What happens to the formation"),
    ("plans", "Ways to goals"),
];

/// Films, pictures and their elements.
pub fn show(ui: &mut Ui, app_state: &AppState, style: &Style, filming: Option<&str>, out: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        let text = if filming.is_some() { "■ End the film" } else { "● Film" };
        for (text, tip, action) in [
            (text, "An MP4 of the view, without lost frames (F)", Action::Film),
            ("Picture", "A PNG with the scene, the time and the view embedded (P)", Action::Picture),
            (
                "Keep the run",
                "Write the run to a folder: the scene with its changes, and the tables (K)",
                Action::KeepRun,
            ),
        ] {
            on_click(&ui.button(text).on_hover_text(tip), action, out);
        }
    });
    if let Some(text) = filming {
        ui.label(text);
    }
    from(ui, app_state, out);
    ui.separator();
    let mut ahead = app_state.ahead;
    ui.horizontal(|ui| {
        ui.label("Look ahead");
        let response = ui.add(Slider::new(&mut ahead, 0.0..=20.0).suffix(" s").max_decimals(0));
        response.widget_info(|| WidgetInfo::slider(true, ahead, "Look ahead"));
        if response.changed() {
            out.push(Action::Ahead(ahead.round()));
        }
    });
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        for (name, text) in ELEMENTS {
            let mut on = style.shows(name);
            if ui.checkbox(&mut on, text).changed() {
                out.push(Action::Element(name, on));
            }
        }
    });
}

/// The box to choose the view of films.
fn from(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let robots = app_state.fleet().map_or(&[][..], |fleet| &fleet.robots);
    let now = app_state.film_from.as_deref().unwrap_or(SEEN);
    ui.horizontal(|ui| {
        ui.label("Film from");
        let combo = egui::ComboBox::from_id_salt("film from").selected_text(now);
        let response = combo.show_ui(ui, |ui| {
            if ui.selectable_label(app_state.film_from.is_none(), SEEN).clicked() {
                out.push(Action::FilmFrom(None));
            }
            let plain = ["snake", "snake-eye", "top", "orbit", "snake+top"].map(str::to_owned).into_iter();
            let names = robots.iter().map(|robot| &robot.name);
            let bound = names.flat_map(|name| [format!("follow:{name}"), format!("camera:{name}")]);
            for view in plain.chain(bound.take(40)) {
                if ui.selectable_label(app_state.film_from.as_ref() == Some(&view), &view).clicked() {
                    out.push(Action::FilmFrom(Some(view)));
                }
            }
        });
        super::chosen(&response.response, "Film from", now);
    });
}

/// The default view of films.
const SEEN: &str = "the current view";
