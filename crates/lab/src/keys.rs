//! Keyboard shortcuts: one list for key handling, the page of shortcuts and the book.

use crate::action::Action;
use crate::app_state::{AppState, Selection, Tool};
use eframe::egui::{self, Key, Modifiers};
use std::f64::consts::PI;

/// A shortcut, for people and for the window.
pub struct Shortcut {
    /// The keys as text.
    pub keys: &'static str,
    /// What it does.
    pub what: &'static str,
    /// The bindings; none for mouse gestures of the view.
    bindings: &'static [Binding],
}

/// A key and its effect.
struct Binding {
    modifiers: Modifiers,
    key: Key,
    effect: KeyEffect,
}

/// The effect of a key.
enum KeyEffect {
    /// An action, if there is an object for it.
    Act(fn(&AppState) -> Option<Action>),
    /// Moves the selected set point by m and degrees. All presses of a frame count and make one move.
    Nudge([f64; 2]),
}

const fn row(keys: &'static str, what: &'static str, bindings: &'static [Binding]) -> Shortcut {
    Shortcut { keys, what, bindings }
}

const fn bare(key: Key, action: fn(&AppState) -> Option<Action>) -> Binding {
    Binding { modifiers: Modifiers::NONE, key, effect: KeyEffect::Act(action) }
}

const fn shift(key: Key, action: fn(&AppState) -> Option<Action>) -> Binding {
    Binding { modifiers: Modifiers::SHIFT, key, effect: KeyEffect::Act(action) }
}

/// With Ctrl, or ⌘ on a Mac; also active in text fields.
const fn command(key: Key, action: fn(&AppState) -> Option<Action>) -> Binding {
    Binding { modifiers: Modifiers::COMMAND, key, effect: KeyEffect::Act(action) }
}

const fn nudge(key: Key, by: [f64; 2]) -> Binding {
    Binding { modifiers: Modifiers::NONE, key, effect: KeyEffect::Nudge(by) }
}

const TIME: &[Shortcut] = &[
    row("Space", "play or pause", &[bare(Key::Space, |_| Some(Action::Toggle))]),
    row(
        "→  ←",
        "one sample forward, one sample back; with Shift one second",
        &[
            bare(Key::ArrowRight, |_| Some(Action::Step)),
            bare(Key::ArrowLeft, |state| Some(Action::Back(state.period()))),
            shift(Key::ArrowRight, |_| Some(Action::Back(-1.0))),
            shift(Key::ArrowLeft, |_| Some(Action::Back(1.0))),
        ],
    ),
    row(
        "Home  End",
        "show the start, the present",
        &[bare(Key::Home, |_| Some(Action::Seek(0.0))), bare(Key::End, |_| Some(Action::Present))],
    ),
    row(
        ",  .",
        "slower, faster",
        &[
            bare(Key::Comma, |state| Some(Action::Pace(slower(state.pace)))),
            bare(Key::Period, |state| Some(Action::Pace(faster(state.pace)))),
        ],
    ),
    row("B", "branch here", &[bare(Key::B, |_| Some(Action::Fork))]),
    row(
        "[  ]",
        "previous branch, next branch",
        &[
            bare(Key::OpenBracket, |state| Some(Action::Branch(state.branch.saturating_sub(1)))),
            bare(Key::CloseBracket, |state| Some(Action::Branch(state.branch + 1))),
        ],
    ),
    row("Shift Home", "restart at 0 s", &[shift(Key::Home, |_| Some(Action::Restart))]),
];

const FORMATION: &[Shortcut] = &[
    row(
        "Tab",
        "next edge; with Shift the previous edge",
        &[
            bare(Key::Tab, |state| Some(Action::Select(next(state, 1)))),
            shift(Key::Tab, |state| Some(Action::Select(next(state, -1)))),
        ],
    ),
    row("W  S", "set point 0.1 m nearer, farther", &[nudge(Key::W, [-0.1, 0.0]), nudge(Key::S, [0.1, 0.0])]),
    row(
        "A  D",
        "set point 5° to the left, to the right",
        &[nudge(Key::A, [0.0, 5.0]), nudge(Key::D, [0.0, -5.0])],
    ),
    row("M", "mirror: both sides move", &[bare(Key::M, |state| Some(Action::Mirror(!state.mirror)))]),
    row(
        "Ctrl −  Ctrl +",
        "whole formation smaller, larger",
        &[
            command(Key::Minus, |_| Some(Action::Shape { scale: 1.0 / 1.1, turn: 0.0 })),
            command(Key::Plus, |_| Some(Action::Shape { scale: 1.1, turn: 0.0 })),
            command(Key::Equals, |_| Some(Action::Shape { scale: 1.1, turn: 0.0 })),
        ],
    ),
    row(
        "Insert  Delete",
        "add a robot, remove the selected one",
        &[
            bare(Key::Insert, |_| Some(Action::AddRobot)),
            bare(Key::Delete, |state| chosen(state).map(|(_, name)| Action::RemoveRobot(name))),
        ],
    ),
    row(
        "C  O  Esc",
        "connect robots, place pillars, cancel",
        &[
            bare(Key::C, |_| Some(Action::UseTool(Tool::Connect))),
            bare(Key::O, |_| Some(Action::UseTool(Tool::Pillar))),
            bare(Key::Escape, |_| Some(Action::Dismiss)),
        ],
    ),
];

const VIEW: &[Shortcut] = &[
    row(
        "1 … 5",
        "snake, snake eye, top, orbit, camera of the selected robot",
        &[
            bare(Key::Num1, |_| Some(Action::Viewpoint("snake".to_owned()))),
            bare(Key::Num2, |_| Some(Action::Viewpoint("snake-eye".to_owned()))),
            bare(Key::Num3, |_| Some(Action::Viewpoint("top".to_owned()))),
            bare(Key::Num4, |_| Some(Action::Viewpoint("orbit".to_owned()))),
            bare(Key::Num5, |state| {
                chosen(state).map(|(_, name)| Action::Viewpoint(format!("camera:{name}")))
            }),
        ],
    ),
    row(
        "G",
        "follow the selected robot",
        &[bare(Key::G, |state| chosen(state).map(|(robot, _)| Action::Follow(Some(robot))))],
    ),
    row(
        "I",
        "its camera image in the corner",
        &[bare(Key::I, |state| chosen(state).map(|(robot, _)| Action::Inset(Some(robot))))],
    ),
    row("Drag", "turn; right button: move; wheel: zoom", &[]),
    row("Drag a ring", "set point, in steps of 0.1 m and 5°; Shift: freely", &[]),
    row("Ctrl drag a ring", "whole formation", &[]),
    row("T", "light or dark", &[bare(Key::T, |_| Some(Action::Theme))]),
];

const WORK: &[Shortcut] = &[
    row("Ctrl S", "save the scene", &[command(Key::S, |_| Some(Action::Save))]),
    row("Ctrl O", "scenes", &[command(Key::O, |_| Some(Action::Gallery))]),
    row("Ctrl R", "reload the file", &[command(Key::R, |_| Some(Action::Reload))]),
    row(
        "Ctrl Z  Ctrl Y",
        "undo, redo",
        &[command(Key::Z, |_| Some(Action::Undo)), command(Key::Y, |_| Some(Action::Redo))],
    ),
    row(
        "P  F  K  L",
        "picture, film, keep the run, copy a link",
        &[
            bare(Key::P, |_| Some(Action::Picture)),
            bare(Key::F, |_| Some(Action::Film)),
            bare(Key::K, |_| Some(Action::KeepRun)),
            bare(Key::L, |_| Some(Action::Share)),
        ],
    ),
    row("Ctrl P", "picture of the whole window", &[command(Key::P, |_| Some(Action::WindowPicture))]),
    // `?` depends on the keyboard layout: `pressed` reads it as text.
    row("?  F1", "this page", &[bare(Key::F1, |_| Some(Action::Help))]),
];

/// All shortcuts and mouse gestures: the window obeys this list, and the page of shortcuts shows it.
pub const LIST: &[(&str, &[Shortcut])] =
    &[("Time", TIME), ("Formation", FORMATION), ("View", VIEW), ("Work", WORK)];

/// Actions of the keys pressed in this frame; none in a text field, and none behind a menu or, where the view is
/// `covered`, a window.
pub fn pressed(ctx: &egui::Context, app_state: &AppState, covered: bool, out: &mut Vec<Action>) {
    take(ctx, app_state, Modifiers::COMMAND, out);
    if covered && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
        out.push(Action::Dismiss);
    }
    if ctx.egui_wants_keyboard_input() || covered || egui::Popup::is_any_open(ctx) {
        return;
    }
    // A key without modifiers also matches with Shift held, so bindings with Shift come first.
    take(ctx, app_state, Modifiers::SHIFT, out);
    take(ctx, app_state, Modifiers::NONE, out);
    if ctx.input(|input| input.events.iter().any(|e| matches!(e, egui::Event::Text(text) if text == "?"))) {
        out.push(Action::Help);
    }
}

/// Actions of the pressed keys of the list with these modifiers.
fn take(ctx: &egui::Context, app_state: &AppState, modifiers: Modifiers, out: &mut Vec<Action>) {
    let mut moved = [0.0; 2];
    let edge = app_state.chosen_edge();
    let bindings = LIST.iter().flat_map(|(_, rows)| rows.iter()).flat_map(|row| row.bindings);
    for binding in bindings.filter(|binding| binding.modifiers == modifiers) {
        let count = || ctx.input_mut(|input| input.count_and_consume_key(modifiers, binding.key));
        match &binding.effect {
            // Without an edge the keys are left to other widgets.
            KeyEffect::Nudge([metres, degrees]) if edge.is_some() => {
                let times = count() as f64;
                moved = [moved[0] + times * metres, moved[1] + times * degrees];
            }
            KeyEffect::Nudge(_) => {}
            KeyEffect::Act(action) => {
                if let Some(action) = action(app_state)
                    && count() > 0
                {
                    out.push(action);
                }
            }
        }
    }
    if let Some(edge) = edge.filter(|_| moved != [0.0; 2]) {
        out.extend(nudged(app_state, edge, moved));
    }
}

fn chosen(app_state: &AppState) -> Option<(usize, String)> {
    let robot = app_state.chosen_robot()?;
    Some((robot, app_state.fleet()?.robots.get(robot)?.name.clone()))
}

/// The edge after or before the selected one.
fn next(app_state: &AppState, by: i64) -> Selection {
    let edges = app_state.fleet().map_or(0, |fleet| fleet.edges.len()) as i64;
    if edges == 0 {
        return Selection::Nothing;
    }
    let now = app_state.chosen_edge().map_or(if by > 0 { -1 } else { 0 }, |edge| edge as i64);
    Selection::Edge((now + by).rem_euclid(edges) as usize)
}

/// The action that moves the set point of an edge by m and degrees.
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

    /// A binding in the notation of the list.
    fn written(binding: &Binding) -> String {
        let key = match binding.key {
            Key::ArrowRight => "→",
            Key::ArrowLeft => "←",
            Key::Comma => ",",
            Key::Period => ".",
            Key::OpenBracket => "[",
            Key::CloseBracket => "]",
            Key::Minus => "−",
            Key::Plus => "+",
            Key::Escape => "Esc",
            other => other.name(),
        };
        match binding.modifiers {
            Modifiers::COMMAND => format!("Ctrl {key}"),
            Modifiers::SHIFT => format!("Shift {key}"),
            _ => key.to_owned(),
        }
    }

    fn rows() -> impl Iterator<Item = &'static Shortcut> {
        LIST.iter().flat_map(|(_, rows)| rows.iter())
    }

    #[test]
    fn every_key_is_listed_and_bound_once() {
        let mut all = Vec::new();
        for row in rows() {
            for binding in row.bindings.iter().filter(|binding| binding.key != Key::Equals) {
                let name = written(binding);
                let said = row.keys.split("  ").any(|key| key == name)
                    || (row.keys == "1 … 5" && "12345".contains(&name))
                    || (name.starts_with("Shift") && row.what.contains("with Shift"));
                assert!(said, "{name} is not in {:?}", row.keys);
                assert!(!all.contains(&name), "{name} is bound twice");
                all.push(name);
            }
        }
        assert!(all.len() > 40, "{}", all.len());
    }

    /// The book names keys in the same notation.
    #[test]
    fn the_book_names_keys_that_are_bound() {
        let book = include_str!("../../../docs/lab.md");
        let keys: Vec<&str> = rows().flat_map(|row| row.keys.split("  ")).collect();
        let is_key = |word: &str| {
            let single = word.chars().count() == 1 && !word.starts_with(|c: char| c.is_lowercase());
            single
                || word.starts_with("Ctrl ")
                || word.starts_with("Shift ")
                || Key::from_name(word).is_some()
        };
        let named: Vec<&str> = book.split('`').skip(1).step_by(2).filter(|word| is_key(word)).collect();
        for key in &named {
            assert!(keys.contains(key), "docs/lab.md names `{key}`, which is not bound");
        }
        assert!(named.len() > 15, "{named:?}");
    }

    fn asked(modifiers: Modifiers, key: Key) -> Vec<Action> {
        let ctx = egui::Context::default();
        let mut out = Vec::new();
        let press = egui::Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
        let input = egui::RawInput { events: vec![press], ..egui::RawInput::default() };
        let mut output = ctx.run_ui(input, |ui| pressed(ui.ctx(), &AppState::new(), false, &mut out));
        output.textures_delta.clear();
        out
    }

    /// The arrow without modifiers must not shadow the one with Shift.
    #[test]
    fn shift_makes_a_second_of_a_sample() {
        assert_eq!(asked(Modifiers::NONE, Key::ArrowRight), [Action::Step]);
        assert_eq!(asked(Modifiers::SHIFT, Key::ArrowRight), [Action::Back(-1.0)]);
        assert_eq!(asked(Modifiers::SHIFT, Key::ArrowLeft), [Action::Back(1.0)]);
        assert_eq!(asked(Modifiers::SHIFT, Key::Home), [Action::Restart]);
        assert_eq!(asked(Modifiers::COMMAND, Key::S), [Action::Save]);
    }

    #[test]
    fn paces_go_up_and_down_and_stop() {
        assert_eq!((faster(1.0), faster(50.0), slower(1.0), slower(0.1)), (2.0, 50.0, 0.5, 0.1));
        assert_eq!((faster(1.3), slower(1.3)), (2.0, 1.0));
    }
}
