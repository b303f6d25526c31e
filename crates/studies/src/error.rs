//! Why a study did not come to a result.

use simulation::{BuildError, Fault, NotFinite};
use thiserror::Error;

/// Why a study did not come to a result.
#[derive(Debug, Error)]
pub enum Error {
    /// The scene, or what is asked of it, does not allow the study; the text says what to change.
    #[error("{0}")]
    Usage(String),
    /// The scene reads well but cannot run.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A run came to a quantity that is not a finite number.
    #[error(transparent)]
    NotFinite(NotFinite),
    /// Nobody could draw what cameras see.
    #[error("{0}")]
    Camera(String),
    /// A law for many followers gave no commands.
    #[error("{0}")]
    Law(String),
    /// The caller said that the work is not to go on.
    #[error("interrupted after {samples} samples")]
    Interrupted {
        /// Samples that were done.
        samples: u64,
    },
    /// A file or folder could not be written.
    #[cfg(not(target_family = "wasm"))]
    #[error(transparent)]
    Output(#[from] output::Error),
    /// A recorded run could not be read or written.
    #[cfg(not(target_family = "wasm"))]
    #[error(transparent)]
    Recording(#[from] recording::Error),
}

impl From<&Fault> for Error {
    fn from(fault: &Fault) -> Self {
        match fault {
            Fault::CameraRenderer(text) => Self::Camera(text.clone()),
            Fault::NotFinite(what) => Self::NotFinite(what.clone()),
            Fault::Law(text) => Self::Law(text.clone()),
        }
    }
}
