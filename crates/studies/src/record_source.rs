//! Where the records of a run come from: a simulation or a log, read alike.

use crate::Error;
use recording::log::Moments;
use simulation::Simulation;
use vocabulary::StepRecord;

/// Where the records of a run come from: they are made, or they were recorded.
pub enum RecordSource {
    /// They are made.
    Run(Box<Simulation>),
    /// They were recorded.
    Log(Box<Moments>),
}

impl RecordSource {
    /// Puts the next record into `record`; whether there was one.
    ///
    /// # Errors
    /// [`Error`] where the run breaks off with a fault, or the log is damaged.
    pub fn next_into(&mut self, record: &mut StepRecord) -> Result<bool, Error> {
        match self {
            Self::Run(simulation) => match simulation.next_record() {
                Some(next) => {
                    record.clone_from(next);
                    Ok(true)
                }
                None => simulation.fault().map_or(Ok(false), |fault| Err(fault.into())),
            },
            Self::Log(records) => match records.next() {
                Some(next) => {
                    *record = next?;
                    Ok(true)
                }
                None => Ok(false),
            },
        }
    }
}
