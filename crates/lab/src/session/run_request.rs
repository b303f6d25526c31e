//! What the window asks of the thread of the run.

use super::checked_scene::CheckedScene;
use recording::log::Log;
use scene::Scene;
use std::sync::Arc;

/// What the window asks for.
pub enum RunRequest {
    /// Another scene, from time 0; its run is brought to `until` s at once.
    Open {
        /// What to run.
        scene: Arc<Scene>,
        /// s.
        until: f64,
    },
    /// A run that was recorded: all of it is told at once, and nothing goes on.
    Recorded(Box<Log>),
    /// The scene of the run that was recorded: it runs unseen as far as that came, and can go on and branch from there.
    ResumeRecording(Arc<Scene>),
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
    Summarize(usize),
}
