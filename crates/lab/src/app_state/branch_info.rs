//! A branch as the window knows it: its name, its changes, and the text of its scene at every sample.

use crate::session::branches::BranchChange;

/// A branch as the window knows it.
#[derive(Debug, Clone)]
pub struct BranchInfo {
    /// What it is called.
    pub name: String,
    /// Branch and time at which it leaves its parent, s.
    pub parent: Option<(usize, f64)>,
    /// What was changed on it, from time 0 on.
    pub changes: Vec<BranchChange>,
    /// The scene's text from a sample on.
    pub(super) texts: Vec<(u64, String)>,
}

impl BranchInfo {
    /// The first.
    pub(crate) fn trunk() -> Self {
        Self { name: "main".to_owned(), parent: None, changes: Vec::new(), texts: Vec::new() }
    }

    /// The scene's text as it held before a sample.
    pub(super) fn text_at(&self, sample: u64, base: &str) -> String {
        let last = self.texts.iter().filter(|(at, _)| *at < sample).max_by_key(|(at, _)| *at);
        last.map_or_else(|| base.to_owned(), |(_, text)| text.clone())
    }
}
