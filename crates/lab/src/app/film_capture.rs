//! A film that is being taken of the run.

use std::path::PathBuf;
use vocabulary::counted;

/// A film under way.
pub(crate) struct FilmCapture {
    pub(super) path: PathBuf,
    /// Time of the next frame, s, and the branch.
    pub(super) next: f64,
    pub(super) branch: usize,
    /// Records up to this time have been sent, s.
    pub(super) sent: f64,
    pub(super) frames: u64,
}

impl FilmCapture {
    /// How far it is, in words.
    pub(crate) fn words(&self, waiting: usize) -> String {
        format!("{}: {}, {waiting} waiting", self.path.display(), counted(self.frames, "frame"))
    }
}
