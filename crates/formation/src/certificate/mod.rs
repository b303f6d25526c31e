//! Certificates: what the theorems of section 4 say of a run, and whether their premises were met.
//!
//! A [`Witness`] goes along with an edge and notes the quantities of the theorems. From its rows
//! [`certify`] makes findings: each statement was met throughout, was violated at a time, or rests on a premise that
//! was not met; then it is told what the numbers say all the same.
//!
//! Read in the order of the data: [`premise`], [`boundary`], [`witness`], [`constants`], [`finding`]; beyond the paper
//! [`discretisation`] and [`chain`].

pub mod boundary;
pub mod chain;
pub mod constants;
pub mod discretisation;
pub mod finding;
pub mod premise;
pub mod witness;

pub use boundary::BoundaryLayer;
pub use constants::Constants;
pub use finding::{Circumstances, Finding, Outcome, Statement, certify};
pub use premise::{Premise, Spell};
pub use witness::{Instant, Row, Witness};
