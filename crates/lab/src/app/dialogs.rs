//! Draws what covers the panels: notices, the list of scenes, shortcuts, hints and questions.

use super::{BARE, LabApp};
use crate::action::Action;
use crate::panels::on_click;
use eframe::egui::{self, Context, Ui};

/// What covers the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Dialog {
    /// Nothing.
    #[default]
    Nothing,
    /// The list of scenes.
    Gallery,
    /// The shortcuts.
    Help,
    /// The question before closing with unsaved changes.
    Closing,
    /// The question before another scene replaces unsaved changes.
    Leaving,
}

impl LabApp {
    /// Shows the offer to restore unsaved work, in a line under the bar.
    pub(crate) fn notices(&mut self, ui: &mut Ui, out: &mut Vec<Action>) {
        if let Some(left) = &self.left {
            let name = left.home.display();
            egui::Panel::top("left").frame(BARE).show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    ui.label(format!("The last session ended with unsaved changes to {name}."));
                    on_click(&ui.button("Restore them"), Action::Recover, out);
                    on_click(&ui.button("Discard them"), Action::Forget, out);
                });
            });
        }
    }

    /// Shows what became of a link, in a line under the bar.
    pub(crate) fn status(&self, ui: &mut Ui, out: &mut Vec<Action>) {
        let Some(status) = &self.app_state.status else { return };
        egui::Panel::top("status").frame(BARE).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                if status.fault {
                    ui.colored_label(ui.visuals().error_fg_color, &status.text);
                } else {
                    ui.label(&status.text);
                }
                if status.offers_file {
                    on_click(&ui.button("Write a scene instead"), Action::SaveBranch, out);
                }
                on_click(&ui.button("Close").on_hover_text("Esc"), Action::CloseStatus, out);
            });
        });
    }

    /// Shows an error over the view, so that nothing moves under the pointer.
    fn show_notice(&self, ctx: &Context, out: &mut Vec<Action>) {
        let Some(notice) = self.app_state.notice.clone() else { return };
        let view = self.viewport.rect;
        let wide = (view.width() - 40.0).clamp(260.0, 760.0);
        egui::Area::new(egui::Id::unique("notice"))
            .order(egui::Order::Foreground)
            .fixed_pos(view.center_top() + egui::vec2(0.0, 12.0))
            .pivot(egui::Align2::CENTER_TOP)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_width(wide);
                    let colour = ui.visuals().error_fg_color;
                    egui::ScrollArea::vertical().max_height(180.0).show(ui, |ui| {
                        let text = egui::RichText::new(notice).color(colour).monospace();
                        ui.add(egui::Label::new(text).wrap());
                    });
                    on_click(&ui.button("Dismiss").on_hover_text("Esc"), Action::Dismiss, out);
                });
            });
    }

    /// Shows the windows over the view.
    pub(crate) fn windows(&mut self, ctx: &Context, out: &mut Vec<Action>) {
        let mut open = true;
        let window = |name: &'static str| {
            let middle = ctx.content_rect().center();
            egui::Window::new(name).collapsible(false).pivot(egui::Align2::CENTER_CENTER).default_pos(middle)
        };
        let room = ctx.content_rect().size();
        let large = egui::vec2((room.x - 60.0).min(1000.0), room.y - 110.0);
        match self.dialog {
            Dialog::Nothing => {}
            Dialog::Gallery => {
                window("Scenes").open(&mut open).default_size(large).show(ctx, |ui| {
                    self.gallery.show(ui, &self.recent, out);
                });
            }
            Dialog::Help => {
                window("Shortcuts")
                    .open(&mut open)
                    .resizable(false)
                    .default_height(large.y)
                    .show(ctx, crate::keys::page);
            }
            Dialog::Closing => self.ask_before_closing(ctx, out),
            Dialog::Leaving => self.ask_before_leaving(ctx, out),
        }
        if !open {
            self.dialog = Dialog::Nothing;
        }
        self.show_notice(ctx, out);
        if self.hints && self.viewport.rect.width() > 460.0 {
            self.show_hints(ctx);
        }
    }

    fn show_hints(&mut self, ctx: &Context) {
        let mut open = true;
        egui::Window::new("Three things to try")
            .open(&mut open)
            .collapsible(false)
            .resizable(false)
            .fixed_pos(self.viewport.rect.right_top() + egui::vec2(-12.0, 12.0))
            .pivot(egui::Align2::RIGHT_TOP)
            .default_width(300.0)
            .show(ctx, |ui| {
                ui.label(
                    "1.  Drag the bright ring: the set point moves, and the thin lines show the prediction.",
                );
                ui.label("2.  Drag ε in the panel Observer, press Shift Home, and watch it peak.");
                ui.label("3.  Drag back on the timeline, change a gain, and play: this makes a branch.");
                if ui.button("Got it").clicked() {
                    self.hints = false;
                }
            });
        self.hints &= open;
    }

    fn ask_before_closing(&mut self, ctx: &Context, out: &mut Vec<Action>) {
        let answers = ["Save and close", "Close without saving", "Cancel"];
        let [save, close, stay] = ask_about_changes(ctx, answers);
        if close {
            self.autosave.done();
            self.app_state.draft = None;
        }
        if save {
            out.push(Action::Save);
        }
        if save || close {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        if save || close || stay {
            self.dialog = Dialog::Nothing;
        }
    }

    fn ask_before_leaving(&mut self, ctx: &Context, out: &mut Vec<Action>) {
        let [save, go, stay] = ask_about_changes(ctx, ["Save and open", "Open without saving", "Cancel"]);
        if save || go || stay {
            self.dialog = Dialog::Nothing;
            let next = self.next.take();
            if save {
                out.push(Action::Save);
            }
            if go && let Some(draft) = &mut self.app_state.draft {
                draft.abandon();
            }
            if !stay {
                // If saving failed, the question is asked again.
                out.extend(next);
            }
        }
    }
}

/// Asks what to do with unsaved changes; which of the answers was clicked.
fn ask_about_changes(ctx: &Context, answers: [&str; 3]) -> [bool; 3] {
    let asked = egui::Modal::new(egui::Id::unique("unsaved")).show(ctx, |ui| {
        ui.label("The scene has unsaved changes.");
        ui.horizontal(|ui| answers.map(|answer| ui.button(answer).clicked())).inner
    });
    asked.inner
}
