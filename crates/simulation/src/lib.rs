//! The loop itself: the only place that knows the order of a step.
//!
//! [`build`] turns a checked scene into a [`Setup`]; [`Simulation`] runs it, one [`Moment`](vocabulary::Moment) per
//! control sample; [`verdict`] holds what was measured against what the scene expects.

mod build;
mod continuous;
mod stage;
mod step;
pub mod tune;
pub mod verdict;

pub use build::{BuildError, build, caption};
pub use step::{ObserverStart, Setup, Simulation, Timing};
