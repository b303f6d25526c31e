//! One run of a study, as a row of its table.

use crate::design::RunPoint;
use crate::measure::MEASURES;
use studies::JudgedRun;
use vocabulary::words;

words! {
    /// How a run ended.
    pub enum RowStatus = Complete {
        /// It came to its end.
        Complete = "complete",
        /// Its scene ended it before its time, or a number was none.
        Stopped = "stopped",
        /// Its scene cannot run.
        Refused = "refused",
        /// It could not go on.
        Broken = "broken",
        /// The program met a fault of its own.
        Panicked = "panicked",
        /// It took too long.
        Expired = "expired",
    }
}

/// A run of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct RunRow {
    /// Which run, its values and its seed.
    pub point: RunPoint,
    /// How it ended.
    pub status: RowStatus,
    /// Whether it came to an end and met everything that its scene expects.
    pub met: bool,
    /// The first expectation that it did not meet, by the time of that; empty if there is none.
    pub failed: String,
    /// When, s; the end of the run for what is judged there, NaN if there is none.
    pub failed_time: f64,
    /// Why, in words.
    pub reason: String,
    /// Contacts of robots with each other, with props and with the ground.
    pub contacts: u64,
    /// The numbers of [`MEASURES`].
    pub measures: Vec<f64>,
    /// Of the trajectory; empty where there is none.
    pub digest: String,
    /// How long the run took, s.
    pub wall_time: f64,
}

impl RunRow {
    /// A row of a run that has not been made.
    pub(crate) fn of(point: RunPoint, status: RowStatus, reason: String) -> Self {
        Self {
            point,
            status,
            met: false,
            failed: String::new(),
            failed_time: f64::NAN,
            reason,
            contacts: 0,
            measures: vec![f64::NAN; MEASURES.len()],
            digest: String::new(),
            wall_time: 0.0,
        }
    }

    /// With the numbers of a run.
    pub(crate) fn measured(self, judged: &JudgedRun) -> Self {
        let measures = MEASURES.iter().map(|measure| measure.of(&judged.metrics)).collect();
        Self { contacts: judged.metrics.contacts as u64, measures, ..self }
    }
}
