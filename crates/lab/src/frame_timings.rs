//! Frame times of the window, printed when it closes.

use crate::action::Action;
use crate::app_state::AppState;
use crate::session::prediction::Prediction;
use web_time::{Duration, Instant};

/// Frame times of a window.
#[derive(Debug, Default)]
pub(crate) struct FrameTimings {
    /// When the window was requested, and the time until its first 3D picture, s.
    started: Option<Instant>,
    first: Option<Duration>,
    /// Time spent in a frame, ms.
    frames: Vec<f32>,
    /// Between the starts of frames, ms.
    between: Vec<f32>,
    last: Option<Instant>,
    predictions: Vec<f32>,
    /// When a set point or goal was moved whose prediction is still pending.
    asked: Option<Instant>,
    answered: Vec<f32>,
    pictures: u64,
}

/// Number of frames that are kept.
const MOST: usize = 100_000;

impl FrameTimings {
    /// For a window that was requested at `began`.
    pub(crate) fn since(began: Instant) -> Self {
        Self { started: Some(began), ..Self::default() }
    }

    pub(crate) fn frame(&mut self, spent: Duration, whole: Option<f32>, pictures: u64) {
        let now = Instant::now();
        if pictures > 0 && self.first.is_none() {
            self.first = self.started.map(|started| now - started);
        }
        if self.frames.len() < MOST {
            let spent = whole.map_or(spent.as_secs_f32(), |whole| whole.max(spent.as_secs_f32()));
            self.frames.push(1e3 * spent);
            if let Some(last) = self.last {
                self.between.push(1e3 * (now - last).as_secs_f32());
            }
        }
        self.last = Some(now);
        self.pictures = pictures;
    }

    pub(crate) fn asked(&mut self, action: &Action) {
        if matches!(
            action,
            Action::SetPoint { .. } | Action::Goal { .. } | Action::Tune { .. } | Action::Shape { .. }
        ) {
            self.asked.get_or_insert_with(Instant::now);
        }
    }

    pub(crate) fn prediction(&mut self, prediction: &Prediction) {
        if self.predictions.len() < MOST {
            self.predictions.push(1e3 * prediction.took as f32);
        }
        if let Some(asked) = self.asked.take() {
            self.answered.push(1e3 * asked.elapsed().as_secs_f32());
        }
    }

    pub(crate) fn print(&self, app_state: &AppState) {
        use std::io::Write;
        let mut out = std::io::stdout();
        if let Some(first) = self.first {
            // A closed pipe loses only these numbers.
            let _ = writeln!(out, "first 3D picture after {:.2} s", first.as_secs_f64());
        }
        for (name, values) in [
            ("work in a frame", &self.frames),
            ("from frame to frame", &self.between),
            ("a prediction", &self.predictions),
            ("from a change to its prediction", &self.answered),
        ] {
            let mut sorted = values.clone();
            sorted.sort_by(f32::total_cmp);
            let at =
                |share: f32| sorted.get(((sorted.len() as f32 - 1.0) * share).max(0.0) as usize).copied();
            if let (Some(middle), Some(late)) = (at(0.5), at(0.95)) {
                // A closed pipe loses only these numbers.
                let _ =
                    writeln!(out, "{name}: median {middle:.1} ms, 95 % {late:.1} ms, {} times", sorted.len());
            }
        }
        let _ = writeln!(out, "3D pictures: {}", self.pictures);
        let _ = writeln!(out, "branches: {}, t = {:.2} s", app_state.branches.len(), app_state.time());
    }
}
