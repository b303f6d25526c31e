//! What became of a scene's expectations, as `metrics.json` holds it.

use serde::Serialize;

/// One expectation and what became of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExpectationMetrics {
    /// The key in the scene's `[expect]`.
    pub key: String,
    /// What was wanted, with unit.
    pub wanted: String,
    /// What was found, with unit, and on which edge or between which robots.
    pub found: String,
    /// Whether it was met; `None` where the run does not show it.
    pub met: Option<bool>,
}
