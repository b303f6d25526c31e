//! What lies over the panels: notices, the menu of scenes, shortcuts, hints, questions.

use crate::action::Action;
use crate::app::{BARE, Lab};
use eframe::egui::{self, Context, Ui};

/// What lies over the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Over {
    /// Nothing.
    #[default]
    Nothing,
    /// The menu of scenes.
    Gallery,
    /// The shortcuts.
    Help,
    /// The question before unsaved work is closed.
    Closing,
}

impl Lab {
    /// Lines under the bar: faults, and work that a crash has left.
    pub(crate) fn notices(&mut self, ui: &mut Ui, out: &mut Vec<Action>) {
        if let Some(left) = &self.left {
            let name =
                left.path.as_ref().map_or_else(|| "a scene".to_owned(), |path| path.display().to_string());
            egui::Panel::top("left").frame(BARE).show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    ui.label(format!("Unsaved work on {name} was left when Echelon ended last time."));
                    if ui.button("Go on with it").clicked() {
                        out.push(Action::Recover);
                    }
                    if ui.button("Forget it").clicked() {
                        out.push(Action::Forget);
                    }
                });
            });
        }
        if let Some(notice) = self.desk.notice.clone() {
            egui::Panel::top("notice").frame(BARE).show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    if ui.button("×").on_hover_text("Dismiss (Esc)").clicked() {
                        out.push(Action::Dismiss);
                    }
                    let colour = ui.visuals().error_fg_color;
                    egui::ScrollArea::vertical().max_height(140.0).show(ui, |ui| {
                        ui.add(
                            egui::Label::new(egui::RichText::new(notice).color(colour).monospace()).wrap(),
                        );
                    });
                });
            });
        }
    }

    /// Windows over the view.
    pub(crate) fn windows(&mut self, ctx: &Context, out: &mut Vec<Action>) {
        let mut open = true;
        let window = |name: &'static str| {
            let middle = ctx.content_rect().center();
            egui::Window::new(name).collapsible(false).pivot(egui::Align2::CENTER_CENTER).default_pos(middle)
        };
        match self.over {
            Over::Nothing => {}
            Over::Gallery => {
                window("Scenes").open(&mut open).default_width(780.0).show(ctx, |ui| {
                    self.gallery.show(ui, &self.recent, out);
                });
            }
            Over::Help => {
                window("Shortcuts").open(&mut open).resizable(false).show(ctx, crate::keys::page);
            }
            Over::Closing => self.ask_before_closing(ctx, out),
        }
        if !open {
            self.over = Over::Nothing;
        }
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
                    "1.  Drag the bright ring: the set point moves, and the thin lines show the future.",
                );
                ui.label("2.  Drag ε in the panel Observer, then press Shift Home, and watch it peak.");
                ui.label("3.  Drag back on the line of time, change a gain, and play: a branch.");
                if ui.button("Got it").clicked() {
                    self.hints = false;
                }
            });
        self.hints &= open;
    }

    fn ask_before_closing(&mut self, ctx: &Context, out: &mut Vec<Action>) {
        egui::Modal::new(egui::Id::unique("closing")).show(ctx, |ui| {
            ui.label("The scene has changes that are not saved.");
            ui.horizontal(|ui| {
                if ui.button("Save and close").clicked() {
                    out.push(Action::Save);
                    self.over = Over::Nothing;
                    ctx.send_viewport_cmd(egui::ViewportCommand::Close);
                }
                if ui.button("Close without saving").clicked() {
                    self.kept.done();
                    self.desk.draft = None;
                    self.over = Over::Nothing;
                    ctx.send_viewport_cmd(egui::ViewportCommand::Close);
                }
                if ui.button("Stay").clicked() {
                    self.over = Over::Nothing;
                }
            });
        });
    }
}
