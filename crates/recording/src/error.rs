//! What can go wrong with a run folder.

use std::path::{Path, PathBuf};
use thiserror::Error;

/// A run folder could not be written or read.
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
    /// The folder holds something already.
    #[error("{} {what}: choose another folder with --out{}", path.display(), advice(what))]
    Occupied {
        /// The folder.
        path: PathBuf,
        /// What it holds.
        what: &'static str,
    },
    /// A log is none, is of another layout, or is damaged.
    #[error("{} {message}", path.display())]
    Log {
        /// The file.
        path: PathBuf,
        /// What it is instead.
        message: String,
    },
    /// A table could not be encoded or decoded.
    #[error("{}: {message}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What the library said.
        message: String,
    },
}

impl Error {
    /// For `map_err`: an i/o error met while doing `action` to `path`.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }

    pub(crate) fn table<E: std::fmt::Display>(path: &Path) -> impl FnOnce(E) -> Self {
        let path = path.to_owned();
        // The library's word for errors of the system says nothing to a user.
        move |error| Self::Table {
            path,
            message: error.to_string().trim_start_matches("External: ").to_owned(),
        }
    }
}

/// What else can be done about a folder that holds something: only what is ours is replaced.
fn advice(what: &str) -> &'static str {
    if what.contains("other files") || what.contains("being written") {
        ""
    } else {
        ", or give --force to replace it"
    }
}
