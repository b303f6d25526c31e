//! Requests of the window to the thread of the run.

use super::checked_scene::CheckedScene;
use scene::Scene;
use std::sync::Arc;

/// A request to the thread of the run.
pub enum RunRequest {
    /// Open a scene and simulate it from time 0 to `until` s at once.
    Open {
        /// The scene.
        scene: Arc<Scene>,
        /// s.
        until: f64,
    },
    /// Open a recorded run: all its records are sent at once, and nothing is simulated.
    #[cfg(not(target_family = "wasm"))]
    Recorded(Box<recording::log::Log>),
    /// Simulate the scene of the recorded run to the end of the recording, so that it can continue and branch.
    ResumeRecording(Arc<Scene>),
    /// Play or pause.
    Play(bool),
    /// Simulated seconds per second.
    Pace(f64),
    /// Simulate one sample, then pause.
    Step,
    /// Apply the parameters of this scene from the next sample on.
    Change(Box<CheckedScene>),
    /// Fork a branch before a sample and continue the new one.
    Fork {
        /// The branch to fork.
        from: usize,
        /// The control sample.
        sample: u64,
        /// Name of the new branch.
        name: String,
    },
    /// Continue another branch.
    Switch(usize),
    /// Prediction horizon, s; 0 turns predictions off.
    Ahead(f64),
    /// Simulate to this time as fast as can be, s, and report the digest there.
    Reach(f64),
    /// Request the digest of the first samples of a branch.
    Digest {
        /// Its index.
        branch: usize,
        /// How many.
        samples: u64,
    },
    /// Request the summary of a branch.
    Summarize(usize),
}
