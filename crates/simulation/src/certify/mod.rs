//! Certificates of runs: what the theorems say of every edge, and what lies beyond them.
//!
//! An [`Examiner`] goes along with a run. [`sensitivity`] runs a scene again with every gain a little larger and smaller;
//! [`reach`] says which set points followers can hold; [`chain`] how disturbances go down a chain.

pub mod chain;
mod examiner;
mod past;
pub mod reach;
pub mod sensitivity;

pub use examiner::{Certificate, Examiner};
pub use formation::certificate::chain::NotLinear;
pub use formation::certificate::discretisation::{ChannelSensitivity, Discretisation, LongestPeriod};
pub use formation::certificate::{
    Constants, Premise, Statement, StatementFinding, StatementOutcome, WitnessRow,
};
pub use formation::feasible::Infeasible;
pub use past::{rows, so_far};
