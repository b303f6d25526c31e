//! What became of a scene's expectations.

use serde::Serialize;

/// One expectation and what became of it, as `metrics.json` holds it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JudgedExpectation {
    /// The key in the scene's `[expect]`.
    pub key: &'static str,
    /// What was wanted, with unit.
    pub wanted: String,
    /// What was found, with unit, and on which edge or between which robots.
    pub found: String,
    /// Whether it was met; `None` where the run is too short to show it.
    pub met: Option<bool>,
}

impl JudgedExpectation {
    /// Whether it was judged and not met.
    pub fn failed(&self) -> bool {
        self.met == Some(false)
    }
}
