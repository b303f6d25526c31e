//! Why a file cannot be written.

use std::path::{Path, PathBuf};
use thiserror::Error;

/// A file or folder could not be written.
#[derive(Debug, Error)]
pub enum Error {
    /// The disk or its permissions.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was being done.
        action: &'static str,
        /// To which file or folder.
        path: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// Another place has to be named.
    #[error("{} {what}", path.display())]
    Place {
        /// What was named.
        path: PathBuf,
        /// What is wrong with it, and what helps.
        what: &'static str,
    },
    /// The folder holds something already.
    #[error("{} {}", path.display(), occupied(*what))]
    Occupied {
        /// The folder.
        path: PathBuf,
        /// What it holds; other things than ours if `None`.
        what: Option<&'static str>,
    },
    /// Another program writes the same folder.
    #[error("{} is being written by another program: wait for it, or choose another folder with --out", .0.display())]
    Busy(PathBuf),
}

impl Error {
    /// Whether another place would mend it; otherwise the machine is to blame.
    pub fn is_usage(&self) -> bool {
        !matches!(self, Self::Io { .. })
    }

    /// For `map_err`: an i/o error met while doing `action` to `path`.
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }

    pub(crate) fn place(path: &Path, what: &'static str) -> Self {
        Self::Place { path: path.to_owned(), what }
    }
}

/// What can be done about a folder that holds something: only what is ours is replaced.
fn occupied(what: Option<&str>) -> String {
    what.map_or_else(
        || "holds other files: choose another folder with --out".to_owned(),
        |what| {
            format!("already holds {what}: choose another folder with --out, or give --force to replace it")
        },
    )
}
