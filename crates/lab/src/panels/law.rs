//! Law, gains and observer.

use super::controls::{Range, SliderRow};
use super::{choice, empty_panel, nothing, on_click, tune};
use crate::action::Action;
use crate::app_state::AppState;
use crate::symbols;
use eframe::egui::{Id, Ui};
use scene::{Law, Observer, SwitchingKind, VehicleKind};
use vocabulary::{LawKind, ObserverKind, Word};

const LAWS: [(LawKind, &str, &str); 3] = [
    (LawKind::FullState, "Full state feedback", "Knows its leader's motion (eq 20)."),
    (LawKind::RobustState, "Robust state feedback", "Knows the rates of ℓ and ψ (eq 22)."),
    (LawKind::OutputFeedback, "Output feedback", "Knows ℓ and ψ only (eq 42)."),
];

const GAIN: SliderRow = SliderRow::new(symbols::GAIN, "law.k", Range::factors(0.1, 20.0), 3);
const ROBUST: SliderRow = SliderRow::new(symbols::ROBUST, "law.beta", Range::linear(0.0, 20.0), 3);
const SLOPE: SliderRow = SliderRow::new(symbols::SLOPE, "law.slope", Range::factors(1.0, 200.0), 2);
const EPSILON: SliderRow = SliderRow::new(symbols::EPSILON, "observer.epsilon", Range::factors(1e-4, 1.0), 5);
const ALPHA_ONE: SliderRow =
    SliderRow::new(symbols::ALPHA_ONE, "observer.alpha1", Range::factors(0.1, 10.0), 3);
const ALPHA_TWO: SliderRow =
    SliderRow::new(symbols::ALPHA_TWO, "observer.alpha2", Range::factors(0.1, 10.0), 3);

/// The law of the selected follower.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((_, robot, name, follow)) = app_state.tuned_follower() else {
        return empty_panel(ui, app_state, "There is no follower, so there is no law to tune.");
    };
    scope(ui, app_state, name, out);
    let kind = vehicle(app_state, robot);
    let (law, default) = (&follow.law, Law::fitting(kind));
    choice(ui, "Law", "law.kind", law.kind, &LAWS, out);
    let apart = ui.data(|data| data.get_temp(apart_id()).unwrap_or(false));
    GAIN.two(ui, law.k, default.k, apart, out);
    if law.kind != LawKind::FullState {
        ROBUST.two(ui, law.beta, default.beta, apart, out);
        switching(ui, law, out);
        if law.switching == SwitchingKind::Tanh {
            SLOPE.two(ui, law.slope, default.slope, apart, out);
        }
    }
    let mut apart_now = apart;
    if ui.checkbox(&mut apart_now, "Distance and bearing apart").on_hover_text(APART).changed() {
        ui.data_mut(|data| data.insert_temp(apart_id(), apart_now));
    }
}

/// The observer of the selected follower.
pub fn observer(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((_, robot, name, follow)) = app_state.tuned_follower() else {
        return empty_panel(ui, app_state, "There is no follower, so there is nothing to observe.");
    };
    let measures = follow.sensing.kind != scene::SensingKind::Truth;
    if follow.law.kind != LawKind::OutputFeedback && !measures {
        return nothing(ui, "This law knows the rates. Output feedback estimates them.");
    }
    scope(ui, app_state, name, out);
    let (observer, default) = (&follow.observer, Observer::fitting(vehicle(app_state, robot)));
    if measures {
        let mut adaptive = observer.adaptive;
        if ui.checkbox(&mut adaptive, "Adapt ε to the noise of each measurement").changed() {
            out.push(tune("Adaptive ε", "observer.adaptive", adaptive.to_string()));
            out.push(Action::Release);
        }
        if observer.kind == ObserverKind::Unscented {
            ui.weak("Two unscented Kalman filters replace the observer.");
        }
    }
    ui.add_enabled_ui(!(measures && observer.adaptive), |ui| {
        EPSILON.two(ui, observer.epsilon, default.epsilon, false, out);
    });
    ALPHA_ONE.two(ui, observer.alpha1, default.alpha1, false, out);
    ALPHA_TWO.two(ui, observer.alpha2, default.alpha2, false, out);
    if !(measures && observer.adaptive) {
        ui.weak(format!("Poles at {}", poles(observer)));
    }
    let disturb = ui.button("Disturb and restart");
    if disturb.on_hover_text("It starts 0.2 m and 10° off, and peaks like 1/ε").clicked() {
        out.push(Action::Set {
            what: "Observer starts 0.2 m and 10° off".to_owned(),
            values: vec![("observer.start".to_owned(), "{ offset = [0.2, \"10 deg\"] }".to_owned())],
        });
        out.push(Action::Restart);
    }
}

/// The observer's poles as text.
fn poles(observer: &Observer) -> String {
    let one = |k: usize| {
        let [epsilon, a, b] = [observer.epsilon[k], observer.alpha1[k], observer.alpha2[k]];
        let root = 0.25 * a * a - b;
        let middle = -0.5 * a / epsilon;
        if root < 0.0 {
            format!("{} ± {}i 1/s", short(middle), short((-root).sqrt() / epsilon))
        } else if root == 0.0 {
            format!("{} 1/s, twice", short(middle))
        } else {
            let apart = root.sqrt() / epsilon;
            format!("{} and {} 1/s", short(middle - apart), short(middle + apart))
        }
    };
    let (a, b) = (one(0), one(1));
    if a == b { a } else { format!("{a}; {b}") }
}

fn short(value: f64) -> String {
    let digits = usize::from(value.abs() < 100.0);
    crate::numbers::fixed(value, digits)
}

/// The choice whether changes apply to all followers or to one.
pub(crate) fn scope(ui: &mut Ui, app_state: &AppState, name: &str, out: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        on_click(&ui.selectable_label(app_state.for_all, "All followers"), Action::ForAll(true), out);
        let only = ui.selectable_label(!app_state.for_all, format!("Only {name}"));
        on_click(&only, Action::ForAll(false), out);
    });
    ui.add_space(2.0);
}

fn switching(ui: &mut Ui, law: &Law, out: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        for (kind, tip) in [
            (SwitchingKind::Tanh, "β tanh(κ e), as in the paper's simulations"),
            (SwitchingKind::Sign, "β sign(e), as in the theorems; it chatters when sampled"),
        ] {
            let label = ui.selectable_label(law.switching == kind, kind.word()).on_hover_text(tip);
            if label.clicked() && law.switching != kind {
                out.push(tune("Switching term", "law.switching", format!("{:?}", kind.word())));
                out.push(Action::Release);
            }
        }
    });
}

pub(crate) fn vehicle(app_state: &AppState, robot: usize) -> VehicleKind {
    app_state
        .scene_now()
        .and_then(|scene| scene.robots.get(robot))
        .map_or(VehicleKind::Unicycle, |r| r.vehicle.kind)
}

fn apart_id() -> Id {
    Id::unique("gains apart")
}

const APART: &str = "A slider for each channel: K = diag(k₁, k₂), and so on";
