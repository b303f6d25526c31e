//! How followers sense their leaders.

use super::controls::{Range, SliderRow};
use super::law::scope;
use super::{choice, empty_panel};
use crate::action::Action;
use crate::app_state::AppState;
use crate::symbols;
use eframe::egui::Ui;
use scene::{Sensing, SensingKind};
use vocabulary::TrackingState;

const KINDS: [(SensingKind, &str, &str); 4] = [
    (SensingKind::Truth, "Truth", "Followers know distance and bearing exactly."),
    (SensingKind::Noise, "Noise", "The true values with noise."),
    (SensingKind::Geometric, "Tags", "Projected corners of tags with noise; no images are rendered."),
    (SensingKind::Camera, "Camera", "Detects tags in rendered images of each follower's camera."),
];

pub(crate) const RATE: SliderRow =
    SliderRow::new(symbols::RATE, "sensing.rate", Range::factors(1.0, 100.0), 1);
pub(crate) const LATENCY: SliderRow =
    SliderRow::new(symbols::LATENCY, "sensing.latency", Range::linear(0.0, 0.3), 3);
pub(crate) const DROPS: SliderRow =
    SliderRow::new(symbols::DROPS, "sensing.drop", Range::linear(0.0, 0.9), 2);
pub(crate) const DISTANCE_NOISE: SliderRow =
    SliderRow::new(symbols::DISTANCE_NOISE, "sensing.distance_noise", Range::linear(0.0, 0.1), 4);
pub(crate) const PIXEL_NOISE: SliderRow =
    SliderRow::new(symbols::PIXEL_NOISE, "sensing.pixel_noise", Range::linear(0.0, 2.0), 3);

/// Sensing of the selected follower.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((edge, _, name, follow)) = app_state.tuned_follower() else {
        return empty_panel(ui, app_state, "There is no follower, so nothing is sensed.");
    };
    scope(ui, app_state, name, out);
    let (sensing, default) = (&follow.sensing, Sensing::default());
    choice(ui, "Sensing", "sensing.kind", sensing.kind, &KINDS, out);
    if sensing.kind == SensingKind::Truth {
        return;
    }
    RATE.one(ui, sensing.rate, default.rate, out);
    LATENCY.one(ui, sensing.latency, default.latency, out);
    DROPS.one(ui, sensing.drop, default.drop, out);
    match sensing.kind {
        SensingKind::Noise => DISTANCE_NOISE.one(ui, sensing.distance_noise, default.distance_noise, out),
        SensingKind::Geometric => PIXEL_NOISE.one(ui, sensing.pixel_noise, default.pixel_noise, out),
        SensingKind::Truth | SensingKind::Camera => {}
    }
    if let Some(state) = app_state.record().and_then(|record| record.edges.get(edge).copied()) {
        let word = match state.sight {
            TrackingState::Truth => "uses the true values",
            TrackingState::Waiting => "has not seen its leader yet",
            TrackingState::Tracking => "sees its leader",
            TrackingState::Coasting => "coasts on its estimate",
            TrackingState::Lost => "has lost its leader",
        };
        ui.label(format!("{name} {word}"));
        ui.weak(format!("last measurement {} ms ago", crate::numbers::fixed(state.age * 1e3, 0)));
    }
    ui.weak("Changing the sensing restarts the run.");
}
