//! Law, gains and observer.

use super::controls::{Range, SliderRow};
use super::{choice, custom_law, empty_panel, nothing, on_click, tune};
use crate::action::Action;
use crate::app_state::AppState;
use crate::symbols;
use eframe::egui::{self, Id, Ui};
use scene::{Law, Observer, SwitchingKind, VehicleKind};
use vocabulary::{HeadingReference, LawKind, MotionPhase, ObserverKind, Word};

const LAWS: [(LawKind, &str, &str); 3] = [
    (LawKind::FullState, "Full state feedback", "Knows its leader's motion (eq 20)."),
    (LawKind::RobustState, "Robust state feedback", "Knows the rates of ℓ and ψ (eq 22)."),
    (LawKind::OutputFeedback, "Output feedback", "Knows ℓ and ψ only (eq 42)."),
];

pub(crate) const GAIN: SliderRow = SliderRow::new(symbols::GAIN, "law.k", Range::factors(0.1, 20.0), 3);
pub(crate) const ROBUST: SliderRow = SliderRow::new(symbols::ROBUST, "law.beta", Range::linear(0.0, 20.0), 3);
pub(crate) const SLOPE: SliderRow =
    SliderRow::new(symbols::SLOPE, "law.slope", Range::factors(1.0, 200.0), 2);
pub(crate) const HEADING_LENGTH: SliderRow =
    SliderRow::new(symbols::HEADING_LENGTH, "law.heading_length", Range::factors(0.1, 10.0), 2);
pub(crate) const HEADING_LAG: SliderRow =
    SliderRow::new(symbols::HEADING_LAG, "law.heading_lag", Range::linear(0.0, 4.0), 2);
pub(crate) const EPSILON: SliderRow =
    SliderRow::new(symbols::EPSILON, "observer.epsilon", Range::factors(1e-4, 1.0), 5);
pub(crate) const ALPHA_ONE: SliderRow =
    SliderRow::new(symbols::ALPHA_ONE, "observer.alpha1", Range::factors(0.1, 10.0), 3);
pub(crate) const ALPHA_TWO: SliderRow =
    SliderRow::new(symbols::ALPHA_TWO, "observer.alpha2", Range::factors(0.1, 10.0), 3);
const HEADINGS: [(HeadingReference, &str, &str); 2] = [
    (
        HeadingReference::Leader,
        "Bearing against the leader's heading",
        "As in the paper: when the leader turns, its followers swing.",
    ),
    (
        HeadingReference::Path,
        "Bearing against the leader's path",
        "Its heading, filtered along its path: chains do not swing.",
    ),
];

/// The law of the selected follower.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((edge, robot, name, follow)) = app_state.tuned_follower() else {
        return empty_panel(ui, app_state, "There is no follower, so there is no law to tune.");
    };
    scope(ui, app_state, name, out);
    let kind = vehicle(app_state, robot);
    let state = app_state.record().and_then(|record| record.edges.get(edge).copied());
    if let Some(state) = state.filter(|_| follow.law.standing) {
        ui.label(format!("{name} {}", phase(state.phase)));
    }
    // In a small window there is more than fits.
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        let (law, default) = (&follow.law, Law::fitting(kind));
        custom_law::choice(ui, law, &LAWS, out);
        if law.custom().is_some() {
            custom_law::parameters(ui, app_state, law, out);
        } else {
            gains(ui, law, &default, out);
        }
        heading(ui, law, default.heading_length, default.heading_lag, out);
        if let Some(state) = state.filter(|_| law.heading == HeadingReference::Path) {
            let behind = crate::numbers::fixed(state.behind.to_degrees(), 1);
            ui.weak(format!("{name} goes by a heading {behind}° behind its leader's"));
        }
    });
}

/// The gains of a built-in law.
fn gains(ui: &mut Ui, law: &Law, default: &Law, out: &mut Vec<Action>) {
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

/// Against what heading the bearing is held, and whether the follower stands.
fn heading(ui: &mut Ui, law: &Law, length: f64, lag: f64, out: &mut Vec<Action>) {
    let before = out.len();
    choice(ui, "Heading", "law.heading", law.heading, &HEADINGS, out);
    let path = law.heading == HeadingReference::Path;
    if law.standing && out.len() > before {
        // Without a path's heading nobody stands.
        out.insert(before, tune("Standing", "law.standing", "false".to_owned()));
    }
    if path {
        let bounded = |row: SliderRow, hard| SliderRow { range: Range { hard, ..row.range }, ..row };
        let shortest = (0.5 * law.heading_lag).max(0.01);
        bounded(HEADING_LENGTH, [shortest, 1000.0]).one(ui, law.heading_length, length, out);
        bounded(HEADING_LAG, [0.0, 2.0 * law.heading_length]).one(ui, law.heading_lag, lag, out);
    }
    let mut standing = law.standing;
    let text = egui::Checkbox::new(&mut standing, "Stop and stand with the leader");
    if ui.add_enabled(path, text).on_hover_text(STANDS).on_disabled_hover_text(STANDS).changed() {
        out.push(tune("Standing", "law.standing", standing.to_string()));
        out.push(Action::Release);
    }
}

/// What drives a follower, in words.
fn phase(phase: MotionPhase) -> &'static str {
    match phase {
        MotionPhase::Law => "is driven by its law",
        MotionPhase::Track => "tracks its place: its leader is slow",
        MotionPhase::Hold => "holds: its leader stands",
    }
}

/// The observer of the selected follower.
pub fn observer(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some((_, robot, name, follow)) = app_state.tuned_follower() else {
        return empty_panel(ui, app_state, "There is no follower, so there is nothing to observe.");
    };
    let measures = follow.sensing.kind != scene::SensingKind::Truth;
    if !follow.law.observes() && !measures {
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
    scope_of(ui, app_state, "All followers", name, out);
}

/// The choice whether changes apply to `all` or to one.
pub(crate) fn scope_of(ui: &mut Ui, app_state: &AppState, all: &str, name: &str, out: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        on_click(&ui.selectable_label(app_state.for_all, all), Action::ForAll(true), out);
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

const STANDS: &str =
    "Followers brake with their leader, stand and start again; it needs a bearing against the path";
const APART: &str = "A slider for each channel: K = diag(k₁, k₂), and so on";
