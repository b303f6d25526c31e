//! How a run ended.

use serde::{Deserialize, Serialize};

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Still going, or killed: the rows are there up to the last part.
    Running,
    /// Stopped early, by Ctrl-C or an error; all rows up to then are there.
    Interrupted,
    /// To its end.
    Complete,
    /// Ended by its scene, where bodies touched, or where a number was not finite.
    Stopped,
}
