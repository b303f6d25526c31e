//! What can go wrong with a run folder.

use std::path::{Path, PathBuf};
use thiserror::Error;

/// A run folder could not be written or read.
#[derive(Debug, Error)]
pub enum Error {
    /// A file or folder could not be written or read.
    #[error(transparent)]
    Output(#[from] output::Error),
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
        let error = output::Error::io(action, path);
        move |source| Self::Output(error(source))
    }

    /// That the log at `path` is none, is of another layout, or is damaged.
    pub(crate) fn log(path: &Path, message: impl Into<String>) -> Self {
        Self::Log { path: path.to_owned(), message: message.into() }
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
