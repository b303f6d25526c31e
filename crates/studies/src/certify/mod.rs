//! Certificates of runs: what the theorems say of every edge, and what lies beyond them.
//!
//! An [`Examiner`] goes along with a run. [`sensitivity`] runs a scene again with every gain a little larger and smaller;
//! [`reach`] says which set points followers can hold; [`chain`] how disturbances go down a chain.

pub mod beyond;
pub mod chain;
mod examiner;
mod measured;
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
pub use measured::MeasuredTracking;
pub use past::{rows, so_far};

use crate::{Error, STRIDE, SceneRun};

/// The certificates of every edge over a whole run; `None` where `go_on`, which gets the number of steps, says no.
///
/// # Errors
/// [`Error`] where the run breaks off with a fault.
pub fn certificates(
    mut run: SceneRun,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<Option<Vec<Certificate>>, Error> {
    let mut examiner = Examiner::new(&run.scene, &run.simulation, true);
    let mut on = true;
    run.step_through(|simulation, step| {
        examiner.push(simulation);
        on = step % STRIDE != 0 || go_on(step);
        on
    })?;
    Ok(on.then(|| examiner.finish(&run.simulation)))
}
