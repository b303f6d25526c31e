//! What came of a run.

use metrics::{JudgedExpectation, Metrics, Status};
use vocabulary::Contact;

/// What came of a run.
pub struct JudgedRun {
    /// Complete, stopped before its time, or interrupted.
    pub status: Status,
    /// Samples that were taken.
    pub steps: u64,
    /// Errors, effort, clearance, contacts, certificates.
    pub metrics: Metrics,
    /// Of the trajectory.
    pub digest: String,
    /// Of the trajectory up to the time that was asked for, or to the end of the run if that is earlier.
    pub digest_then: Option<String>,
    /// The scene's expectations; none of a run that was interrupted.
    pub findings: Vec<JudgedExpectation>,
    /// The contacts that were open at the end, as if they ended then.
    pub closed: Vec<Contact>,
    /// Whether everything that was to be recorded is on the disk.
    #[cfg(not(target_family = "wasm"))]
    pub written: Result<(), recording::Error>,
}
