//! A branch as the window knows it: its name, its changes, and the text of its scene at every sample.

use crate::session::branches::BranchChange;

/// A branch as the window knows it.
#[derive(Debug, Clone)]
pub struct BranchInfo {
    /// Its name.
    pub name: String,
    /// Parent branch and the time of the fork, s.
    pub parent: Option<(usize, f64)>,
    /// Its changes since time 0.
    pub changes: Vec<BranchChange>,
    /// Texts of the scene, each with the first sample it holds for.
    pub(super) texts: Vec<(u64, String)>,
}

impl BranchInfo {
    /// The first branch.
    pub(crate) fn trunk() -> Self {
        Self { name: "main".to_owned(), parent: None, changes: Vec::new(), texts: Vec::new() }
    }

    /// The scene's text that holds before a sample.
    pub(super) fn text_at(&self, sample: u64, base: &str) -> String {
        let last = self.texts.iter().filter(|(at, _)| *at < sample).max_by_key(|(at, _)| *at);
        last.map_or_else(|| base.to_owned(), |(_, text)| text.clone())
    }
}
