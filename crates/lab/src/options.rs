//! What the lab opens with.

use std::path::PathBuf;

/// What the lab opens with.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// A scene file; a scene that comes with the program if there is none.
    pub scene: Option<PathBuf>,
    /// Changes to it, as `--set` has them.
    pub set: Vec<scene::Override>,
    /// Adapter to draw with: `auto`, a backend, or part of a name.
    pub adapter: String,
    /// Whether the run stands at first.
    pub paused: bool,
    /// Width and height of the window, points.
    pub size: Option<[f32; 2]>,
    /// Whether what happens is printed, and figures of speed when the window is closed.
    pub timings: bool,
    /// Asked again and again; the window closes when it says so.
    pub stop: Option<fn() -> bool>,
    /// Gets the reason where the window library is about to abort the process; may end it in a better way.
    pub abandon: Option<fn(&str)>,
}
