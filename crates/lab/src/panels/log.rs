//! What happened, newest last.

use super::on_click;
use crate::action::Action;
use crate::app_state::AppState;
use crate::numbers::fixed;
use eframe::egui::{self, RichText, Ui};

/// The log of events.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    if app_state.log.is_empty() {
        return super::nothing(ui, "Changes, branches and faults appear here.");
    }
    egui::ScrollArea::vertical().auto_shrink([false, false]).stick_to_bottom(true).show(ui, |ui| {
        for event in &app_state.log {
            ui.horizontal_wrapped(|ui| {
                let time = RichText::new(format!("{} s", fixed(event.time, 2))).monospace().weak();
                on_click(&ui.link(time).on_hover_text("Go to this time"), Action::Seek(event.time), out);
                let text = event.text.trim_end_matches('…');
                if event.fault {
                    ui.colored_label(ui.visuals().error_fg_color, text);
                } else {
                    ui.label(text);
                }
            });
        }
    });
}
