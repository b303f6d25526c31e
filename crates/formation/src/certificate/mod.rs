//! Certificates: what the theorems of section 4 say of a run, and whether their premises were met.
//!
//! A [`Witness`] goes along with an edge and notes the quantities of the theorems. From what its ledger holds of them
//! [`certify`] makes findings: each statement was met throughout, was violated at a time, or rests on a premise that
//! was not met; then it is told what the numbers say all the same.
//!
//! Read in the order of the data: [`premise`], [`boundary`], [`witness`], `tally`, `ledger`, [`constants`], [`finding`];
//! beyond the paper [`discretisation`] and [`chain`].

pub mod boundary;
pub mod chain;
pub mod constants;
pub mod discretisation;
pub mod finding;
mod ledger;
pub mod premise;
mod tally;
pub mod witness;

pub use boundary::BoundaryLayer;
pub use constants::Constants;
pub use finding::{Against, Circumstances, Statement, StatementFinding, StatementOutcome, certify};
pub use premise::{Premise, Spell};
pub use witness::{Instant, Witness, WitnessRow};
