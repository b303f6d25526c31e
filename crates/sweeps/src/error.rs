//! Why a study did not come to its end.

use scene::{Diagnostics, StudyFault};
use thiserror::Error;

/// Why a study did not come to its end.
#[derive(Debug, Error)]
pub enum Error {
    /// The study is wrong.
    #[error("{}", .0.iter().map(|fault| fault.text.as_str()).collect::<Vec<_>>().join("\n"))]
    Study(Vec<StudyFault>),
    /// The scene is wrong.
    #[error(transparent)]
    Scene(Diagnostics),
    /// What is asked for does not fit what is there; the text says what does.
    #[error("{0}")]
    Usage(String),
    #[cfg(not(target_family = "wasm"))]
    /// A file or folder could not be written or read.
    #[error(transparent)]
    Output(#[from] output::Error),
    #[cfg(not(target_family = "wasm"))]
    /// Rows could not be written or read.
    #[error(transparent)]
    Recording(#[from] recording::Error),
    #[cfg(not(target_family = "wasm"))]
    /// The manifest of a study is none.
    #[error("{path}: {message}")]
    Manifest {
        /// The file.
        path: String,
        /// What is wrong with it.
        message: String,
    },
}
