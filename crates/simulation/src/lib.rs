//! The loop itself: the only place that knows the order of a step.
//!
//! [`build`] turns a checked scene into a [`Setup`]; [`Simulation`] runs it, one [`StepRecord`](vocabulary::StepRecord) per
//! control sample; [`verdict`] holds what was measured against what the scene expects.

mod build;
mod caption;
pub mod certify;
mod continuous;
mod drivable;
mod error;
mod fault;
mod parameters;
mod reins;
mod sensing;
mod stage;
mod step;
pub mod tune;
pub mod verdict;

pub use build::build;
pub use caption::caption;
pub use drivable::Undrivable;
pub use error::BuildError;
pub use fault::{Fault, NotFinite};
pub use parameters::{ParameterSet, ScheduledChange};
pub use step::{ObserverStart, Setup, Simulation, Timing};
