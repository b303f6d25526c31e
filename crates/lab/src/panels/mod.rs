//! Panels: each shows part of the desk and tells what a person asks for. None of them changes anything by itself.

pub mod branches;
pub mod controls;
pub mod curves;
pub mod edge;
pub mod film;
pub mod formation;
mod icons;
pub mod law;
pub mod log;
pub mod sensing;
pub mod time_bar;
pub mod world;

use crate::action::Action;
use crate::desk::Desk;
use crate::tidy::tidy;
use eframe::egui::{Color32, Ui};

/// Says that there is nothing to show, and why.
pub(crate) fn nothing(ui: &mut Ui, why: &str) {
    ui.weak(why);
}

/// Says that there is nothing to show: no scene, or because of this.
pub(crate) fn nobody(ui: &mut Ui, desk: &Desk, why: &str) {
    nothing(ui, if desk.scene().is_none() { "No scene is open." } else { why });
}

/// The colour of a robot on light and dark ground.
pub(crate) fn colour(desk: &Desk, robot: usize, ui: &Ui) -> Color32 {
    let Some(history) = &desk.history else { return Color32::GRAY };
    let colours = rendering::robot_colours(history.cast());
    let leads = history.cast().members.get(robot).is_some_and(|member| member.leads);
    if leads && ui.visuals().dark_mode {
        // Near-black would be lost, and the gold of its stripe is too near to the first follower's orange.
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

/// A change of one value of the follower that is selected, or of all.
pub(crate) fn tune(what: &str, key: &'static str, value: String) -> Action {
    Action::Tune { what: format!("{what}…"), key, value }
}

/// A pair of values as TOML: one where both are the same.
pub(crate) fn pair(values: [f64; 2]) -> String {
    if values[0] == values[1] {
        tidy(values[0])
    } else {
        format!("[{}, {}]", tidy(values[0]), tidy(values[1]))
    }
}
