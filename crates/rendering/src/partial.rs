//! Files and folders that appear under their name only when they are complete.

use crate::Error;
use std::path::{Path, PathBuf};

/// A file or folder under a temporary name beside its final one; removed unless it is renamed.
#[derive(Debug)]
pub(crate) struct Partial {
    pub(crate) path: PathBuf,
    pub(crate) goal: PathBuf,
}

impl Partial {
    pub(crate) fn new(goal: &Path) -> Self {
        // A link stays, and what it points at is replaced.
        let goal = &std::fs::canonicalize(goal).unwrap_or_else(|_| goal.to_owned());
        let part = |text: Option<&std::ffi::OsStr>| text.unwrap_or_default().to_string_lossy().into_owned();
        let (stem, ending) = (part(goal.file_stem()), part(goal.extension()));
        // The ending stays, since programs go by it.
        // The process id keeps two programs that write the same film apart.
        let name = format!(".{stem}.{}.part.{ending}", std::process::id());
        Self { path: goal.with_file_name(name.trim_end_matches('.')), goal: goal.to_owned() }
    }

    /// Gives it its name.
    pub(crate) fn rename(self) -> Result<(), Error> {
        // What is no file and no folder, such as a pipe or a device, takes it as it comes.
        let special = self.goal.exists() && !self.goal.is_file() && !self.goal.is_dir();
        let done = if special {
            std::fs::read(&self.path).and_then(|bytes| std::fs::write(&self.goal, bytes))
        } else {
            std::fs::rename(&self.path, &self.goal)
        };
        done.map_err(|e| Error::write(&self.goal, e))
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        // After a rename there is nothing left to remove.
        if self.path.is_dir() {
            let _ = std::fs::remove_dir_all(&self.path);
        } else {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}
