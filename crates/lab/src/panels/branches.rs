//! The branches of the run: their names and their changes.

use super::{naming, on_click};
use crate::action::Action;
use crate::app_state::AppState;
use crate::numbers::fixed;
use eframe::egui::{self, RichText, Role, Ui, WidgetInfo};

/// All branches.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let fork = ui.button("Branch here").on_hover_text("Fork this branch at the time shown (B)");
    on_click(&fork, Action::Fork, out);
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        for (index, branch) in app_state.branches.iter().enumerate() {
            let chosen = index == app_state.branch;
            let response = ui.selectable_label(chosen, &branch.name);
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &branch.name));
            on_click(&response, Action::Branch(index), out);
            if let Some(name) = naming(&response, &branch.name, |_| ()) {
                out.push(Action::NameBranch(index, name));
            }
            if let Some((parent, time)) = branch.parent {
                let from = app_state.branches.get(parent).map_or("", |parent| &parent.name);
                ui.weak(format!("forks from {from} at {} s", fixed(time, 2)));
            }
            let own = branch.parent.map_or(0.0, |(_, time)| time);
            for change in branch.changes.iter().filter(|change| change.time >= own) {
                let text =
                    format!("{} s  {}", fixed(change.time, 2), crate::app_state::commands::words(change));
                ui.label(RichText::new(text).small().weak());
            }
        }
    });
}
