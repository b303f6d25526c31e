//! A recorded run made again from its scene: does it come out the same, bit for bit?

use crate::run::STRIDE;
use crate::{Error, SceneRun};
use metrics::Digest;
use recording::log::{Log, Moments};
use simulation::Simulation;
use vocabulary::StepRecord;

/// Samples of a run and their digest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunDigest {
    /// How many.
    pub samples: u64,
    /// Of motions and commands.
    pub digest: String,
}

/// A run as it was recorded, and as it came out again.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// As it was recorded.
    pub recorded: RunDigest,
    /// Digest of the records in its log, where there is a log.
    pub log: Option<String>,
    /// As it is now.
    pub now: RunDigest,
    /// When the records of log and run first differ, in anything at all, s.
    pub apart: Option<f64>,
}

impl Replay {
    /// Whether nothing differs.
    pub fn same(&self) -> bool {
        self.now == self.recorded && self.log_agrees()
    }

    /// Whether the log holds the run that was recorded.
    pub fn log_agrees(&self) -> bool {
        self.apart.is_none() && self.log.as_ref().is_none_or(|log| *log == self.recorded.digest)
    }
}

/// Samples and digest of the records in a log. `go_on` gets the number of samples now and then; `None` where it says no,
/// with the samples that were read in `Err`.
///
/// # Errors
/// [`Error::Recording`] where the log is damaged.
pub fn digest_of(log: &Log, mut go_on: impl FnMut(u64) -> bool) -> Result<Result<RunDigest, u64>, Error> {
    let (mut digest, mut samples) = (Digest::default(), 0);
    for record in log.records() {
        digest.push(&record?);
        samples += 1;
        if samples % STRIDE == 0 && !go_on(samples) {
            return Ok(Err(samples));
        }
    }
    Ok(Ok(RunDigest { samples, digest: digest.text() }))
}

/// Runs a scene again, `most` samples at most, beside the records of `log`: what came out, and when the two first differ, s.
/// The inner `Err` holds the number of samples at which `go_on` said no.
///
/// # Errors
/// [`Error`] where the run breaks off with a fault, or the log is damaged.
pub fn run_again(
    run: &mut SceneRun,
    most: u64,
    log: Option<&Log>,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<Result<(RunDigest, Option<f64>), u64>, Error> {
    let (mut digest, mut samples, mut apart) = (Digest::default(), 0, None);
    let mut logged = log.map(Log::records);
    while samples < most {
        let Some(record) = run.simulation.next_record() else { break };
        digest.push(record);
        // The digest is that of motions and commands; this is everything.
        if let (None, Some(logged)) = (apart, &mut logged)
            && let Some(then) = logged.next().transpose()?
            && then != *record
        {
            apart = Some(record.snapshot.time);
        }
        samples += 1;
        if samples % STRIDE == 0 && !go_on(samples) {
            return Ok(Err(samples));
        }
    }
    match run.simulation.fault() {
        Some(fault) => Err(fault.into()),
        None => Ok(Ok((RunDigest { samples, digest: digest.text() }, apart))),
    }
}

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
