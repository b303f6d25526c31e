//! A recorded run made again from its scene: does it come out the same, bit for bit?

use crate::{Error, STRIDE, SceneRun};
use metrics::Digest;
use recording::log::Log;

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

/// Samples and digest of the records in a log. `go_on` gets the number of samples every [`STRIDE`] samples and says whether
/// the work goes on.
///
/// # Errors
/// [`Error::Recording`] where the log is damaged, [`Error::Interrupted`] where `go_on` says no.
pub fn digest_of(log: &Log, mut go_on: impl FnMut(u64) -> bool) -> Result<RunDigest, Error> {
    let (mut digest, mut samples) = (Digest::default(), 0);
    for record in log.records() {
        digest.push(&record?);
        samples += 1;
        if samples % STRIDE == 0 && !go_on(samples) {
            return Err(Error::Interrupted { samples });
        }
    }
    Ok(RunDigest { samples, digest: digest.text() })
}

/// Runs a scene again, `most` samples at most, beside the records of `log`: what came out, and when the two first differ, s.
///
/// # Errors
/// [`Error`] where the run breaks off with a fault or the log is damaged, [`Error::Interrupted`] where `go_on` says no.
pub fn run_again(
    run: &mut SceneRun,
    most: u64,
    log: Option<&Log>,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<(RunDigest, Option<f64>), Error> {
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
            return Err(Error::Interrupted { samples });
        }
    }
    match run.simulation.fault() {
        Some(fault) => Err(fault.into()),
        None => Ok((RunDigest { samples, digest: digest.text() }, apart)),
    }
}
