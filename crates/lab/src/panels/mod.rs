//! Panels: each shows part of the state and emits actions. None of them changes the state itself.

pub mod branches;
pub mod certificates;
pub mod controls;
pub mod curves;
pub mod custom_law;
pub mod edge;
pub mod film;
pub mod formation;
mod icons;
pub mod law;
pub mod log;
pub mod safety;
pub mod sensing;
pub mod sweep;
pub mod time_bar;
pub mod world;

use crate::action::Action;
use crate::app_state::AppState;
use crate::numbers::toml_number;
use eframe::egui::{self, Color32, ComboBox, Popup, PopupCloseBehavior, Response, TextEdit, Ui};
use std::borrow::Cow;
use vocabulary::Word;

/// Emits an action if a widget was clicked.
pub(crate) fn on_click(widget: &Response, action: Action, out: &mut Vec<Action>) {
    if widget.clicked() {
        out.push(action);
    }
}

/// A menu item that emits an action and closes the menu.
pub(crate) fn menu_item(ui: &mut Ui, enabled: bool, text: &str, action: Action, out: &mut Vec<Action>) {
    if ui.add_enabled(enabled, egui::Button::new(text)).clicked() {
        out.push(action);
        ui.close();
    }
}

/// Shows why a panel is empty.
pub(crate) fn nothing(ui: &mut Ui, why: &str) {
    ui.weak(why);
}

/// A menu with a field for a name on top; the name once it is entered.
pub(crate) fn naming(response: &Response, name: &str, more: impl FnOnce(&mut Ui)) -> Option<String> {
    let id = response.id.with("name");
    // Clears the text of the last time.
    if response.secondary_clicked() {
        response.ctx.data_mut(|data| data.remove::<String>(id));
    }
    // A click into the field does not close the menu.
    let menu = Popup::context_menu(response).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let entered = menu.show(|ui| {
        let mut text: String = ui.data(|data| data.get_temp(id)).unwrap_or_else(|| name.to_owned());
        let edit = ui.add(TextEdit::singleline(&mut text).hint_text("new name"));
        let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        ui.data_mut(|data| data.insert_temp(id, text.clone()));
        if entered {
            ui.close();
        } else {
            take_focus(&edit, ui);
        }
        more(ui);
        entered.then(|| text.trim().to_owned())
    });
    entered?.inner.filter(|text| !text.is_empty() && text != name)
}

/// A box to choose the value of a scene's key from `kinds`, each with its name and description.
pub(crate) fn choice<K: Word>(
    ui: &mut Ui,
    name: &str,
    key: &'static str,
    now: K,
    kinds: &[(K, &str, &str)],
    out: &mut Vec<Action>,
) {
    let shown = kinds.iter().find(|(kind, ..)| *kind == now).map_or("", |(_, shown, _)| shown);
    let combo = ComboBox::from_id_salt(name).selected_text(shown).width(ui.available_width() - 8.0);
    let response = combo.show_ui(ui, |ui| {
        for (kind, shown, tip) in kinds {
            let label = ui.selectable_label(*kind == now, *shown).on_hover_text(*tip);
            if label.clicked() && *kind != now {
                out.push(tune(name, key, format!("{:?}", kind.word())));
                out.push(Action::Release);
            }
        }
    });
    chosen(&response.response, name, shown);
}

/// Gives a box its accessible name and value.
pub(crate) fn chosen(response: &Response, name: &str, now: &str) {
    response.widget_info(|| egui::WidgetInfo {
        current_text_value: Some(now.to_owned()),
        ..egui::WidgetInfo::labeled(egui::Role::ComboBox, true, name)
    });
}

/// Gives a field the keyboard focus if nothing else has it: keys typed into an open menu are text.
pub(crate) fn take_focus(field: &Response, ui: &Ui) {
    if ui.memory(|memory| memory.focused().is_none()) {
        field.request_focus();
    }
}

/// Shows why a panel is empty: no scene is open, or `why`.
pub(crate) fn empty_panel(ui: &mut Ui, app_state: &AppState, why: &str) {
    nothing(ui, if app_state.scene().is_none() { "No scene is open." } else { why });
}

/// The colour of a robot on light and dark ground.
pub(crate) fn colour(app_state: &AppState, robot: usize, ui: &Ui) -> Color32 {
    let Some(fleet) = app_state.fleet() else { return Color32::GRAY };
    let colours = rendering::robot_colours(fleet);
    let leads = fleet.robots.get(robot).is_some_and(|member| member.leads);
    if leads && ui.visuals().dark_mode {
        // Near-black would be invisible, and the gold of its stripe is too close to the first follower's orange.
        return Color32::from_rgb(0xe6, 0xe2, 0xd6);
    }
    let [r, g, b] = colours.get(robot).copied().unwrap_or([0.5; 3]).map(|c| (c * 255.0).round() as u8);
    let colour = Color32::from_rgb(r, g, b);
    // The two lightest are hard to see on paper.
    if ui.visuals().dark_mode || (u32::from(r) + u32::from(g) + u32::from(b)) < 480 {
        colour
    } else {
        Color32::from_rgb(dim(r), dim(g), dim(b))
    }
}

fn dim(channel: u8) -> u8 {
    (f32::from(channel) * 0.82) as u8
}

/// The action that sets one value of the selected follower or of all followers.
pub(crate) fn tune(what: &str, key: impl Into<Cow<'static, str>>, value: String) -> Action {
    Action::Tune { what: format!("{what}…"), key: key.into(), value: Some(value) }
}

/// A pair of values as TOML: one where both are the same.
pub(crate) fn pair(values: [f64; 2]) -> String {
    if values[0] == values[1] {
        toml_number(values[0])
    } else {
        format!("[{}, {}]", toml_number(values[0]), toml_number(values[1]))
    }
}
