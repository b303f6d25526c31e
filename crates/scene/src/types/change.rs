//! What changes while a run goes.

use super::Scene;
use serde::Serialize;

/// Something that is set anew while a run goes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// It holds from the first control sample at or after this on, s, not below 0.
    pub at: f64,
    /// What is set, robot by robot, in the words of `--set`: all that differs from what held before.
    pub set: Vec<String>,
    /// The scene that holds from then on. Start poses and speeds are those of the run, and there are no changes in it.
    #[serde(skip)]
    pub then: Box<Scene>,
}
