//! Why a file cannot be written: the facts. What helps, whoever asks says in the words of its options or arguments.

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
    /// The folder holds something already. What is ours is replaced where that is asked for, and nothing else.
    #[error("{} {}", path.display(), what.map_or_else(|| "holds other files".to_owned(), |what| format!("already holds {what}")))]
    Occupied {
        /// The folder.
        path: PathBuf,
        /// What it holds; other things than ours if `None`.
        what: Option<&'static str>,
    },
    /// Another program writes the same file or folder.
    #[error("{} is being written by another program", .0.display())]
    Busy(PathBuf),
}

impl Error {
    /// Whether another place would mend it; otherwise the machine is to blame.
    pub fn is_usage(&self) -> bool {
        !matches!(self, Self::Io { .. })
    }

    /// The file or folder.
    pub fn path(&self) -> &Path {
        match self {
            Self::Io { path, .. }
            | Self::Place { path, .. }
            | Self::Occupied { path, .. }
            | Self::Busy(path) => path,
        }
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
