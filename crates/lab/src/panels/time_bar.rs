//! The bar at the top: playback, pace, and the timeline with a row for each branch.

use super::icons::{Icon, button};
use super::{menu_item, on_click};
use crate::action::Action;
use crate::app_state::AppState;
use crate::numbers::fixed;
use crate::session::history::History;
use eframe::egui::containers::menu::{MenuConfig, SubMenuButton};
use eframe::egui::{self, Color32, RichText, Sense, Slider, Stroke, Ui, WidgetInfo};

/// Maximum number of branches in the timeline.
const MOST_ROWS: usize = 5;

/// Maximum number of events that the pointer tells.
const MOST_TOLD: usize = 6;

/// The bar at the top.
pub fn show(ui: &mut Ui, app_state: &AppState, filming: bool, out: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        buttons(ui, app_state, out);
        if ui.available_width() > 420.0 {
            ui.separator();
            pace(ui, app_state, out);
            ui.separator();
        }
        let text = format!("t = {} s", fixed(app_state.time(), 2));
        ui.add_sized([92.0, 20.0], egui::Label::new(RichText::new(text).monospace()))
            .on_hover_text("Simulated time shown");
        let tail = 290.0;
        // In a narrow window the timeline comes first.
        let narrow = ui.available_width() < tail + 60.0;
        let wide = ui.available_width() - if narrow { 40.0 } else { tail };
        line(ui, app_state, wide.max(30.0), out);
        if !narrow {
            buttons_of_work(ui, filming, out);
        }
        menu(ui, app_state, out);
    });
}

fn buttons(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let plays = app_state.playing && app_state.history.is_some();
    let (icon, name) = if plays { (Icon::Pause, "Pause") } else { (Icon::Play, "Play") };
    let play = button(ui, icon, "", name, None).on_hover_text(format!("{name} (Space)"));
    on_click(&play, Action::Toggle, out);
    let step = button(ui, Icon::Step, "", "Step", None).on_hover_text("One control sample (→)");
    on_click(&step, Action::Step, out);
    let restart = button(ui, Icon::Restart, "", "Restart", None).on_hover_text("Restart at 0 s (Shift Home)");
    on_click(&restart, Action::Restart, out);
}

fn pace(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let mut pace = app_state.pace;
    ui.spacing_mut().slider_width = 84.0;
    let slider = Slider::new(&mut pace, 0.1..=50.0)
        .logarithmic(true)
        .custom_formatter(|value, _| format!("{value:.*}×", usize::from(value < 10.0)))
        .custom_parser(|text| text.trim_end_matches(['×', 'x']).trim().parse().ok());
    let response =
        ui.add(slider).on_hover_text("Simulated seconds per second (, and .); double click for 1×");
    response.widget_info(|| WidgetInfo::slider(true, pace, "Pace"));
    if response.double_clicked() {
        out.push(Action::Pace(1.0));
    } else if response.changed() {
        // Snaps to 1×.
        out.push(Action::Pace(if (0.93..1.07).contains(&pace) { 1.0 } else { pace }));
    }
}

/// The timeline. Every branch is a row of it; dragging shows the past.
fn line(ui: &mut Ui, app_state: &AppState, wide: f32, out: &mut Vec<Action>) {
    let rows = app_state.branches.len().clamp(1, MOST_ROWS);
    let (rect, response) = ui.allocate_exact_size(egui::vec2(wide, 26.0), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::slider(true, app_state.time(), "Timeline"));
    let span = span(app_state);
    let x_of = |time: f64| rect.left() + (time / span) as f32 * rect.width();
    let painter = ui.painter_at(rect.expand(1.0));
    let visuals = ui.visuals();
    painter.rect_filled(rect, 4.0, visuals.extreme_bg_color);
    let first = app_state.branches.len().saturating_sub(rows);
    let high = (rect.height() - 6.0) / rows as f32;
    for (row, (index, branch)) in app_state.branches.iter().enumerate().skip(first).enumerate() {
        let y = rect.top() + 3.0 + (row as f32 + 0.5) * high;
        let from = branch.parent.map_or(0.0, |(_, time)| time);
        let end = app_state.history.as_ref().map_or(0.0, |history| history.end(index));
        let colour = branch_colour(index, app_state.branch, visuals);
        let half = (0.36 * high).clamp(1.0, 5.0);
        let bar =
            egui::Rect::from_x_y_ranges(x_of(from)..=x_of(end).max(x_of(from) + 1.0), y - half..=y + half);
        painter.rect_filled(bar, half.min(2.0), colour);
        for change in branch.changes.iter().filter(|change| change.time >= from) {
            let stroke = Stroke::new(1.0, visuals.extreme_bg_color);
            painter.vline(x_of(change.time), y - half..=y + half, stroke);
        }
    }
    let events = app_state.history.as_ref().map_or(&[][..], |history| history.events(app_state.branch));
    for (time, event) in events {
        let colour = if event.happened() { visuals.warn_fg_color } else { visuals.error_fg_color };
        let (x, y) = (x_of(*time), rect.top());
        let tip = [egui::pos2(x - 4.0, y), egui::pos2(x + 4.0, y), egui::pos2(x, y + 7.0)];
        painter.add(egui::Shape::convex_polygon(tip.to_vec(), colour, Stroke::NONE));
    }
    painter.vline(x_of(app_state.time()), rect.y_range(), Stroke::new(2.0, visuals.strong_text_color()));
    let under = |pos: egui::Pos2| f64::from(((pos.x - rect.left()) / rect.width()).clamp(0.0, 1.0)) * span;
    if let Some(pos) = response.interact_pointer_pos()
        && (response.dragged() || response.clicked())
    {
        out.push(Action::Seek(under(pos)));
    }
    if let Some(pos) = response.hover_pos() {
        let near = events.iter().filter(|(time, _)| (x_of(*time) - pos.x).abs() < 5.0);
        let told = near.take(MOST_TOLD).filter_map(|(time, event)| {
            Some(format!("\n{} s: {}", fixed(*time, 2), event.words(app_state.fleet()?)))
        });
        let told: String = told.collect();
        response.on_hover_text_at_pointer(format!("{} s: drag to look back{told}", fixed(under(pos), 2)));
    }
}

/// Length of the timeline, s: at least the scene's duration, and a little more than is simulated.
fn span(app_state: &AppState) -> f64 {
    let end = app_state.history.as_ref().map_or(0.0, History::latest);
    let planned = app_state.scene().map_or(1.0, |scene| scene.time.duration);
    if end <= planned { planned } else { end * 1.02 }.max(1e-3)
}

/// The colour of a branch: pale for all but the active one.
pub(crate) fn branch_colour(index: usize, active: usize, visuals: &egui::Visuals) -> Color32 {
    if index == active { visuals.selection.bg_fill } else { visuals.weak_text_color().gamma_multiply(0.6) }
}

/// Film, picture, link, scenes.
fn buttons_of_work(ui: &mut Ui, filming: bool, out: &mut Vec<Action>) {
    let (icon, tip, colour) = if filming {
        (Icon::Stop, "End the film (F)", Some(ui.visuals().error_fg_color))
    } else {
        (Icon::Record, "Film the view (F)", None)
    };
    on_click(&button(ui, icon, "Film", "Film", colour).on_hover_text(tip), Action::Film, out);
    let picture = button(ui, Icon::Camera, "", "Picture", None).on_hover_text("A PNG of the view (P)");
    on_click(&picture, Action::Picture, out);
    let share = button(ui, Icon::Share, "Share", "Share", None)
        .on_hover_text("Copy a link to this time of the run, with all that was changed (L)");
    on_click(&share, Action::Share, out);
    let scenes = button(ui, Icon::Menu, "Scenes", "Scenes", None).on_hover_text("Open a scene (Ctrl O)");
    on_click(&scenes, Action::Gallery, out);
}

/// The menu for everything else.
fn menu(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let more = button(ui, Icon::More, "", "More", None);
    // Items close the menu themselves; a click into its text field does not.
    let stays = egui::PopupCloseBehavior::CloseOnClickOutside;
    egui::Popup::menu(&more).close_behavior(stays).show(|ui| {
        let on_disk = app_state.draft.as_ref().is_some_and(|draft| draft.path.is_some());
        for (text, action, on) in [
            ("Scenes   Ctrl O", Action::Gallery, true),
            ("Film   F", Action::Film, true),
            ("Picture   P", Action::Picture, true),
            ("Save scene   Ctrl S", Action::Save, app_state.unsaved()),
            ("Reload from disk   Ctrl R", Action::Reload, on_disk),
            ("Undo   Ctrl Z", Action::Undo, app_state.undoes().is_some()),
            ("Redo   Ctrl Y", Action::Redo, app_state.draft.as_ref().is_some_and(|d| d.redoes().is_some())),
            ("Share a link   L", Action::Share, true),
            ("Keep the run   K", Action::KeepRun, true),
            ("Curves as CSV", Action::CurvesCsv, true),
            ("Curves as SVG", Action::CurvesSvg, true),
            ("Light or dark   T", Action::Theme, true),
            ("Shortcuts   ?", Action::Help, true),
        ] {
            menu_item(ui, on, text, action, out);
        }
        ui.separator();
        let config = MenuConfig::new().close_behavior(stays);
        SubMenuButton::new("Save as").config(config).ui(ui, |ui| save_as(ui, out));
        ui.menu_button("Panels", |ui| {
            for (name, _) in crate::panes::PANES {
                menu_item(ui, true, name, Action::Panel(name), out);
            }
        });
        ui.menu_button("Size", |ui| {
            for scale in [0.75, 1.0, 1.25, 1.5, 2.0, 3.0] {
                menu_item(ui, true, &format!("{:.0} %", scale * 100.0), Action::Scale(scale), out);
            }
        });
    });
}

/// A path to save the scene to.
fn save_as(ui: &mut Ui, out: &mut Vec<Action>) {
    let id = egui::Id::unique("save as");
    let mut path: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let edit =
        ui.add(egui::TextEdit::singleline(&mut path).hint_text("path/to/scene.toml").desired_width(240.0));
    let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
    ui.data_mut(|data| data.insert_temp(id, path.clone()));
    if !entered {
        super::take_focus(&edit, ui);
    }
    let path = path.trim();
    if (ui.add_enabled(!path.is_empty(), egui::Button::new("Save")).clicked() || entered) && !path.is_empty()
    {
        let path = std::path::PathBuf::from(path);
        let path = if path.extension().is_none() { path.with_extension("toml") } else { path };
        out.push(Action::SaveAs(path));
        ui.close();
    }
}
