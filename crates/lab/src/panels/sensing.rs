//! How followers sense their leaders.

use super::controls::{Range, SliderRow};
use super::law::scope;
use super::{chosen, nobody, tune};
use crate::action::Action;
use crate::app_state::AppState;
use crate::symbols;
use eframe::egui::{ComboBox, Ui};
use scene::{Sensing, SensingKind};
use vocabulary::TrackingState;

const KINDS: [(SensingKind, &str, &str, &str); 4] = [
    (SensingKind::Truth, "Truth", "truth", "Every follower is told distance and bearing."),
    (SensingKind::Noise, "Noise", "noise", "The truth, with errors."),
    (SensingKind::Geometric, "Tags", "geometric", "Corners of tags, with errors; nothing is drawn."),
    (SensingKind::Camera, "Camera", "camera", "Each follower's own pictures, drawn, searched for tags."),
];

const RATE: SliderRow =
    SliderRow { symbol: symbols::RATE, key: "sensing.rate", range: Range::factors(1.0, 100.0), decimals: 1 };
const LATENCY: SliderRow = SliderRow {
    symbol: symbols::LATENCY,
    key: "sensing.latency",
    range: Range::linear(0.0, 0.3),
    decimals: 3,
};
const DROPS: SliderRow =
    SliderRow { symbol: symbols::DROPS, key: "sensing.drop", range: Range::linear(0.0, 0.9), decimals: 2 };
const DISTANCE_NOISE: SliderRow = SliderRow {
    symbol: symbols::DISTANCE_NOISE,
    key: "sensing.distance_noise",
    range: Range::linear(0.0, 0.1),
    decimals: 4,
};
const PIXEL_NOISE: SliderRow = SliderRow {
    symbol: symbols::PIXEL_NOISE,
    key: "sensing.pixel_noise",
    range: Range::linear(0.0, 2.0),
    decimals: 3,
};

/// Sensing of the follower that is selected.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((edge, (_, name, follow))) =
        app_state.chosen_edge().or(Some(0)).and_then(|edge| Some((edge, app_state.follower(edge)?)))
    else {
        return nobody(ui, app_state, "Nobody follows: nobody has to see.");
    };
    scope(ui, app_state, name, out);
    let (sensing, default) = (&follow.sensing, Sensing::default());
    kind(ui, sensing, out);
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
            TrackingState::Truth => "is told the truth",
            TrackingState::Waiting => "has not seen its leader yet",
            TrackingState::Tracking => "sees its leader",
            TrackingState::Coasting => "coasts on what it believes",
            TrackingState::Lost => "has lost its leader",
        };
        ui.label(format!("{name} {word}"));
        ui.weak(format!("last measurement {} ms ago", crate::tidy::fixed(state.age * 1e3, 0)));
    }
    ui.weak("A change of sensing runs the scene again from the start.");
}

fn kind(ui: &mut Ui, sensing: &Sensing, out: &mut Vec<Action>) {
    let now = KINDS.iter().find(|(kind, ..)| *kind == sensing.kind).map_or("", |(_, name, ..)| name);
    let combo = ComboBox::from_id_salt("sensing").selected_text(now).width(ui.available_width() - 8.0);
    let response = combo.show_ui(ui, |ui| {
        for (kind, name, word, tip) in KINDS {
            let label = ui.selectable_label(kind == sensing.kind, name).on_hover_text(tip);
            if label.clicked() && kind != sensing.kind {
                out.push(tune("Sensing", "sensing.kind", format!("{word:?}")));
                out.push(Action::Rest);
            }
        }
    });
    chosen(&response.response, "Sensing", now);
}
