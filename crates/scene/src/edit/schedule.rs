//! Changes of a run, written into the text of its scene.

use super::{EditError, SceneText, cut};
use crate::Change;
use toml_edit::Value;

/// What is set at a time, in the words of `--set`.
#[derive(Debug, Clone, PartialEq)]
pub struct ChangeText {
    /// s.
    pub at: f64,
    /// Overrides.
    pub set: Vec<String>,
}

impl SceneText {
    /// Writes changes into the text, whose own ones are `own`: these robot by robot, so that a value for all robots is not
    /// overruled by an earlier value of one, then `later`.
    ///
    /// # Errors
    /// Where the text has something else in the place of its changes.
    pub fn schedule(&mut self, own: &[Change], later: &[ChangeText]) -> Result<(), EditError> {
        if !own.is_empty() {
            cut::cut_items(&mut self.document, "changes")?;
        }
        let own = own.iter().map(|change| (change.at, &change.set));
        for (at, set) in own.chain(later.iter().map(|change| (change.at, &change.set))) {
            let set: Vec<String> =
                set.iter().map(|set| format!("    {},\n", Value::from(set.as_str()))).collect();
            self.add_table("changes", &format!("at = {at:?}\nset = [\n{}]\n", set.concat()))?;
        }
        Ok(())
    }
}
