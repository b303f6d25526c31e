//! Everything that runs a scene to learn something.
//!
//! [`run`] steps, records, certifies and judges one run; [`verdict`] holds its metrics against what the scene expects.
//! [`tune`] searches gains, [`certify`] examines the theorems along a run, [`budget`] finds where errors come from,
//! [`accuracy`] and [`dataset`] look at what cameras see, [`replay`], [`diff`] and
//! [`likeness`] hold runs, scenes and pictures against each other. [`pace`] measures how fast this machine is.
//!
//! Nothing here prints, draws or reads a clock: functions report how far they are to a callback, which says whether they go
//! on, and pictures come from a [`CameraRenderer`](vocabulary::CameraRenderer) that the caller makes.

pub mod accuracy;
pub mod budget;
pub mod certify;
pub mod dataset;
pub mod diff;
mod error;
pub mod likeness;
pub mod pace;
mod record_source;
pub mod replay;
pub mod run;
mod scene_run;
pub mod tune;
pub mod verdict;

pub use error::Error;
pub use record_source::RecordSource;
pub use scene_run::{COMMIT, PROGRAM, RendererFactory, SceneRun, run_options};
pub use simulation::{Fault, caption};
