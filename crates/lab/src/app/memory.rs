//! What the window remembers between starts.

use crate::panes::Pane;
use egui_tiles::Tree;
use std::path::PathBuf;

/// What the window remembers between starts.
#[derive(serde::Serialize, serde::Deserialize, Default)]
pub(super) struct Memory {
    pub(super) tree: Option<Tree<Pane>>,
    pub(super) recent: Vec<PathBuf>,
    pub(super) hints_seen: bool,
    pub(super) scale: Option<f32>,
}
