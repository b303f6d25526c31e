//! What crosses between the window and the thread of the run.

use super::branches::Change;
use super::checked_scene::CheckedScene;
use recording::log::Log;
use rendering::Gpu;
use scene::Scene;
use std::sync::Arc;
use vocabulary::{FleetInfo, StepRecord};

/// What the window asks for.
pub enum Order {
    /// Another scene, from time 0; its run is brought to `until` s at once.
    Open {
        /// What to run.
        scene: Arc<Scene>,
        /// Draws for cameras on robots.
        gpu: Option<Gpu>,
        /// s.
        until: f64,
    },
    /// A run that was recorded: all of it is told at once, and nothing goes on.
    Recorded(Box<Log>),
    /// The scene of the run that was recorded: it runs unseen as far as that came, and can go on and branch from there.
    TakeUp {
        /// What to run.
        scene: Arc<Scene>,
        /// Draws for cameras on robots.
        gpu: Option<Gpu>,
    },
    /// Run on, or stand.
    Play(bool),
    /// Simulated seconds per second.
    Pace(f64),
    /// One sample, then stand.
    Step,
    /// The parameters of this scene hold from the next sample on.
    Change(Box<CheckedScene>),
    /// A new branch that leaves another before a sample, and goes on by itself.
    Fork {
        /// The branch that is left.
        from: usize,
        /// Where.
        sample: u64,
        /// What the new one is called.
        name: String,
    },
    /// Go on with another branch.
    Switch(usize),
    /// How far to look ahead, s; 0 for not at all.
    Ahead(f64),
    /// What it takes to write the run of a branch down.
    Tell(usize),
}

/// What the window is told.
pub enum News {
    /// A scene was opened.
    Opened {
        /// Who is on stage.
        fleet: Arc<FleetInfo>,
        /// Control period, s.
        period: f64,
    },
    /// A branch was made and is the one that goes on.
    Forked {
        /// Its index.
        branch: usize,
        /// The branch it leaves.
        from: usize,
        /// The first sample that is its own.
        sample: u64,
        /// What it is called.
        name: String,
        /// Changes it shares with the branch it leaves.
        changes: Vec<Change>,
    },
    /// The run that was recorded was taken up: whether it is the same bit for bit.
    TakenUp(bool),
    /// Samples of a branch.
    Moments(usize, Vec<StepRecord>),
    /// Parameters of a branch were changed, or, where nothing is set, are as before again.
    Changed(usize, Change),
    /// All there is to know of a branch so far.
    Told {
        /// Its index.
        branch: usize,
        /// What was changed.
        changes: Vec<Change>,
        /// Samples so far.
        samples: u64,
        /// Their digest.
        digest: String,
    },
    /// The run stands, and why, where it was not asked to.
    Stands(Option<String>),
    /// Something cannot be done.
    Refused(String),
}
