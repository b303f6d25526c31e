//! Keyboard shortcuts: one table for what keys do and for the page that lists them.

use crate::action::Action;
use crate::app_state::{AppState, Selection, Tool};
use crate::session::history::History;
use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};
use std::f64::consts::PI;

/// What a key does, for people.
pub struct Shortcut {
    /// As it is written.
    pub keys: &'static str,
    /// What it does.
    pub what: &'static str,
}

/// All shortcuts and what the mouse does, as the page of shortcuts lists them.
pub const LIST: &[(&str, &[Shortcut])] = &[
    (
        "Time",
        &[
            Shortcut { keys: "Space", what: "play or pause" },
            Shortcut { keys: "→  ←", what: "a sample on, a sample back; with Shift a second" },
            Shortcut { keys: "Home  End", what: "look at the start, at the present" },
            Shortcut { keys: ",  .", what: "slower, faster" },
            Shortcut { keys: "B", what: "branch here" },
            Shortcut { keys: "[  ]", what: "branch before, next branch" },
            Shortcut { keys: "Shift Home", what: "begin again at 0" },
        ],
    ),
    (
        "Formation",
        &[
            Shortcut { keys: "Tab", what: "next edge; with Shift the one before" },
            Shortcut { keys: "W  S", what: "set point 0.1 m nearer, farther" },
            Shortcut { keys: "A  D", what: "set point 5° to the left, to the right" },
            Shortcut { keys: "M", what: "mirror: both sides move" },
            Shortcut { keys: "Ctrl −  Ctrl +", what: "whole formation smaller, larger" },
            Shortcut { keys: "Insert  Delete", what: "add a robot, remove the selected one" },
            Shortcut { keys: "C  O  Esc", what: "connect robots, place pillars, neither" },
        ],
    ),
    (
        "View",
        &[
            Shortcut { keys: "1 … 5", what: "snake, snake eye, top, orbit, camera of the selected robot" },
            Shortcut { keys: "G", what: "follow the selected robot" },
            Shortcut { keys: "I", what: "its camera in the corner" },
            Shortcut { keys: "Drag", what: "turn; with the right button move; wheel to zoom" },
            Shortcut {
                keys: "Drag a ring",
                what: "set point, in steps of 0.1 m and 5°; Shift without steps",
            },
            Shortcut { keys: "Ctrl drag a ring", what: "whole formation" },
            Shortcut { keys: "T", what: "light or dark" },
        ],
    ),
    (
        "Work",
        &[
            Shortcut { keys: "Ctrl S", what: "save the scene" },
            Shortcut { keys: "Ctrl O", what: "scenes" },
            Shortcut { keys: "Ctrl R", what: "read the file again" },
            Shortcut { keys: "Ctrl Z  Ctrl Y", what: "undo, redo" },
            Shortcut { keys: "P  F  K", what: "picture, film, keep the run" },
            Shortcut { keys: "Ctrl P", what: "picture of the whole window" },
            Shortcut { keys: "?", what: "this page" },
        ],
    ),
];

/// What keys ask for in this frame; nothing while a text is written, and nothing behind a menu or, where the view is
/// `covered`, a window.
pub fn pressed(ctx: &egui::Context, app_state: &AppState, covered: bool, out: &mut Vec<Action>) {
    commands(ctx, out);
    if covered && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
        out.push(Action::Dismiss);
    }
    if ctx.egui_wants_keyboard_input() || covered || egui::Popup::is_any_open(ctx) {
        return;
    }
    nudges(ctx, app_state, out);
    let period = app_state.history.as_ref().map_or(0.01, History::period);
    let mut take = |modifiers: Modifiers, key: Key, action: Action| {
        if ctx.input_mut(|input| input.consume_key(modifiers, key)) {
            out.push(action);
        }
    };
    let (none, shift) = (Modifiers::NONE, Modifiers::SHIFT);
    take(none, Key::Space, Action::Toggle);
    take(none, Key::ArrowRight, Action::Step);
    take(none, Key::ArrowLeft, Action::Back(period));
    take(shift, Key::ArrowLeft, Action::Back(1.0));
    take(shift, Key::ArrowRight, Action::Back(-1.0));
    take(shift, Key::Home, Action::Restart);
    take(none, Key::Home, Action::Seek(0.0));
    take(none, Key::End, Action::Present);
    take(none, Key::Comma, Action::Pace(slower(app_state.pace)));
    take(none, Key::Period, Action::Pace(faster(app_state.pace)));
    take(none, Key::B, Action::Fork);
    take(none, Key::OpenBracket, Action::Branch(app_state.branch.saturating_sub(1)));
    take(none, Key::CloseBracket, Action::Branch(app_state.branch + 1));
    take(none, Key::Tab, Action::Choose(next(app_state, 1)));
    take(shift, Key::Tab, Action::Choose(next(app_state, -1)));
    take(none, Key::M, Action::Mirror(!app_state.mirror));
    take(none, Key::Insert, Action::AddRobot);
    take(none, Key::C, Action::Take(Tool::Connect));
    take(none, Key::O, Action::Take(Tool::Pillar));
    take(none, Key::Escape, Action::Dismiss);
    for (key, view) in
        [(Key::Num1, "snake"), (Key::Num2, "snake-eye"), (Key::Num3, "top"), (Key::Num4, "orbit")]
    {
        take(none, key, Action::Viewpoint(view.to_owned()));
    }
    take(none, Key::T, Action::Theme);
    take(none, Key::P, Action::Picture);
    take(none, Key::F, Action::Film);
    take(none, Key::K, Action::KeepRun);
    take(none, Key::F1, Action::Help);
    if let Some((robot, name)) = chosen(app_state) {
        take(none, Key::Num5, Action::Viewpoint(format!("camera:{name}")));
        take(none, Key::G, Action::Follow(Some(robot)));
        take(none, Key::I, Action::Inset(Some(robot)));
        take(none, Key::Delete, Action::RemoveRobot(name));
    }
    if ctx.input(|input| input.events.iter().any(|e| matches!(e, egui::Event::Text(text) if text == "?"))) {
        out.push(Action::Help);
    }
}

/// Keys that move the selected set point.
fn nudges(ctx: &egui::Context, app_state: &AppState, out: &mut Vec<Action>) {
    if let Some(edge) = app_state.chosen_edge() {
        // Every press of a frame counts, and all of them are one move.
        let times =
            |key: Key| ctx.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key)) as f64;
        let metres = 0.1 * (times(Key::S) - times(Key::W));
        let degrees = 5.0 * (times(Key::A) - times(Key::D));
        if metres != 0.0 || degrees != 0.0 {
            out.extend(nudged(app_state, edge, [metres, degrees]));
        }
    }
}

/// Shortcuts with Ctrl, or ⌘ on a Mac.
fn commands(ctx: &egui::Context, out: &mut Vec<Action>) {
    let mut take = |key: Key, action: Action| {
        if ctx.input_mut(|input| input.consume_shortcut(&KeyboardShortcut::new(Modifiers::COMMAND, key))) {
            out.push(action);
        }
    };
    take(Key::S, Action::Save);
    take(Key::O, Action::Gallery);
    take(Key::R, Action::Reload);
    take(Key::P, Action::WindowPicture);
    take(Key::Y, Action::Redo);
    take(Key::Z, Action::Undo);
    take(Key::Minus, Action::Shape { scale: 1.0 / 1.1, turn: 0.0 });
    take(Key::Plus, Action::Shape { scale: 1.1, turn: 0.0 });
    take(Key::Equals, Action::Shape { scale: 1.1, turn: 0.0 });
}

fn chosen(app_state: &AppState) -> Option<(usize, String)> {
    let robot = app_state.chosen_robot()?;
    Some((robot, app_state.history.as_ref()?.fleet().robots.get(robot)?.name.clone()))
}

/// The edge after or before the one that is selected.
fn next(app_state: &AppState, by: i64) -> Selection {
    let edges = app_state.history.as_ref().map_or(0, |history| history.fleet().edges.len()) as i64;
    if edges == 0 {
        return Selection::Nothing;
    }
    let now = app_state.chosen_edge().map_or(if by > 0 { -1 } else { 0 }, |edge| edge as i64);
    Selection::Edge((now + by).rem_euclid(edges) as usize)
}

/// A set point moved by m and degrees.
fn nudged(app_state: &AppState, edge: usize, [metres, degrees]: [f64; 2]) -> Option<Action> {
    let [distance, bearing] = app_state.set_point(edge)?;
    let bearing = vocabulary::wrap(bearing + degrees / 180.0 * PI);
    Some(Action::SetPoint { edge, distance: (distance + metres).max(0.1), bearing })
}

/// Paces that keys step through.
const PACES: [f64; 9] = [0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];

fn slower(pace: f64) -> f64 {
    PACES.into_iter().rev().find(|p| *p < 0.99 * pace).unwrap_or(PACES[0])
}

fn faster(pace: f64) -> f64 {
    PACES.into_iter().find(|p| *p > 1.01 * pace).unwrap_or(PACES[8])
}

/// The page of shortcuts.
pub fn page(ui: &mut egui::Ui) {
    let high = (ui.ctx().content_rect().height() - 90.0).max(80.0);
    egui::ScrollArea::vertical().max_height(high).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            let wide = ui.ctx().content_rect().width() > 900.0;
            let halves = if wide { vec![&LIST[..2], &LIST[2..]] } else { vec![LIST] };
            for half in halves {
                ui.vertical(|ui| half.iter().for_each(|(head, shortcuts)| part(ui, head, shortcuts)));
                ui.add_space(16.0);
            }
        });
    });
}

fn part(ui: &mut egui::Ui, head: &str, shortcuts: &[Shortcut]) {
    ui.add_space(4.0);
    ui.label(egui::RichText::new(head).strong());
    egui::Grid::new(head).num_columns(2).spacing([16.0, 3.0]).show(ui, |ui| {
        for shortcut in shortcuts {
            ui.label(egui::RichText::new(shortcut.keys).color(ui.visuals().hyperlink_color));
            ui.add(egui::Label::new(shortcut.what).wrap_mode(egui::TextWrapMode::Extend));
            ui.end_row();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paces_go_up_and_down_and_stop() {
        assert_eq!((faster(1.0), faster(50.0), slower(1.0), slower(0.1)), (2.0, 50.0, 0.5, 0.1));
        assert_eq!((faster(1.3), slower(1.3)), (2.0, 1.0));
    }
}
