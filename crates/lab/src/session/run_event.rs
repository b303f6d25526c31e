//! Events that the thread of the run sends to the window.

use super::branches::BranchChange;
use std::sync::Arc;
use vocabulary::{FleetInfo, StepRecord};

/// A new branch.
pub struct Fork {
    /// Its index.
    pub branch: usize,
    /// The branch it forks from.
    pub from: usize,
    /// Its first own sample.
    pub sample: u64,
    /// Its name.
    pub name: String,
    /// Changes it shares with that branch.
    pub changes: Vec<BranchChange>,
}

/// A run as the window saw it, for comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SeenRun {
    /// Samples of the run.
    pub samples: u64,
    /// Their digest.
    pub digest: String,
}

/// An event of the run.
pub enum RunEvent {
    /// A scene was opened.
    Opened {
        /// Robots and edges.
        fleet: Arc<FleetInfo>,
        /// Control period, s.
        period: f64,
    },
    /// A branch was made and is active.
    Forked(Fork),
    /// The recorded run was simulated again: whether it is the same bit for bit.
    RecordingResumed(bool),
    /// New records of a branch.
    Records(usize, Vec<StepRecord>),
    /// Parameters of a branch changed; an empty change reverts the one before the same sample.
    Changed(usize, BranchChange),
    /// Summary of a branch so far.
    Summary {
        /// Its index.
        branch: usize,
        /// Its changes.
        changes: Vec<BranchChange>,
        /// Number of samples.
        samples: u64,
        /// Their digest.
        digest: String,
    },
    /// The run has come to where it was asked to; `None` if something was changed on the way.
    Reached(Option<String>),
    /// Digest of the first samples of a branch.
    Digest {
        /// Its index.
        branch: usize,
        /// How many.
        samples: u64,
        /// Their digest.
        digest: String,
    },
    /// The run is paused; the reason, if it stopped by itself.
    Stopped(Option<String>),
    /// A request failed, and why.
    Refused(String),
}
