//! Everything that runs a scene to learn something.
//!
//! [`run`] steps, records, certifies and judges one run; [`verdict`] holds its metrics against what the scene expects.
//! [`tune`] searches gains, [`certify`] examines the theorems along a run, [`budget`] finds where errors come from,
//! [`copies`] are driven from outside, for learning; [`accuracy`] and [`dataset`] look at what cameras see, [`replay`], [`diff`] and
//! [`likeness`] hold runs, scenes and pictures against each other, [`link`] a run against the link to it. [`pace`] measures
//! how fast this machine is.
//!
//! Nothing here prints, draws or reads a clock: functions report how far they are to a callback, which says whether they go
//! on, and pictures come from a [`CameraRenderer`](vocabulary::CameraRenderer) that the caller makes.
//!
//! On a page there are no files: there it is certificates, links, and runs that are stepped piece by piece.

#[cfg(not(target_family = "wasm"))]
pub mod accuracy;
#[cfg(not(target_family = "wasm"))]
pub mod budget;
pub mod certify;
pub mod copies;
#[cfg(not(target_family = "wasm"))]
pub mod dataset;
#[cfg(not(target_family = "wasm"))]
pub mod diff;
mod error;
mod judged_run;
mod law_fault;
#[cfg(not(target_family = "wasm"))]
pub mod likeness;
pub mod link;
#[cfg(not(target_family = "wasm"))]
pub mod pace;
pub mod plans;
#[cfg(not(target_family = "wasm"))]
mod record_source;
#[cfg(not(target_family = "wasm"))]
pub mod replay;
#[cfg(not(target_family = "wasm"))]
pub mod run;
mod run_under_way;
mod scene_run;
#[cfg(not(target_family = "wasm"))]
pub mod tune;
pub mod verdict;

pub use error::Error;
pub use formation::closed_loop::{LoopEnd, Pole, SteadyLeaders, close};
pub use judged_run::JudgedRun;
pub use law_fault::law_fault_words;
#[cfg(not(target_family = "wasm"))]
pub use record_source::RecordSource;
pub use run_under_way::RunUnderWay;
#[cfg(not(target_family = "wasm"))]
pub use scene_run::run_options;
pub use scene_run::{COMMIT, PROGRAM, RendererFactory, STRIDE, SceneRun};
pub use simulation::{Fault, caption};
