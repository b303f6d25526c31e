//! What the thread of the run reports to the window.

use super::branches::BranchChange;
use std::sync::Arc;
use vocabulary::{FleetInfo, StepRecord};

/// A branch that was made.
pub struct Fork {
    /// Its index.
    pub branch: usize,
    /// The branch it leaves.
    pub from: usize,
    /// The first sample that is its own.
    pub sample: u64,
    /// What it is called.
    pub name: String,
    /// Changes it shares with the branch it leaves.
    pub changes: Vec<BranchChange>,
}

/// What the window is told.
pub enum RunEvent {
    /// A scene was opened.
    Opened {
        /// Who is on stage.
        fleet: Arc<FleetInfo>,
        /// Control period, s.
        period: f64,
    },
    /// A branch was made and is the one that goes on.
    Forked(Fork),
    /// The run that was recorded was taken up: whether it is the same bit for bit.
    RecordingResumed(bool),
    /// Samples of a branch.
    Records(usize, Vec<StepRecord>),
    /// Parameters of a branch were changed, or, where nothing is set, are as before again.
    Changed(usize, BranchChange),
    /// All there is to know of a branch so far.
    Summary {
        /// Its index.
        branch: usize,
        /// What was changed.
        changes: Vec<BranchChange>,
        /// Samples so far.
        samples: u64,
        /// Their digest.
        digest: String,
    },
    /// The run stands, and why, where it was not asked to.
    Stopped(Option<String>),
    /// Something cannot be done.
    Refused(String),
}
