//! A sweep of the present scene: its plan, how far it is, and its rows.

use super::sweep_plan::SweepPlan;
use crate::session::sweep_job::SweepJob;
use crate::session::sweeper::SweepRequest;
use std::cell::RefCell;
use std::sync::Arc;
use sweeps::{CellSummary, RunRow};
use web_time::{Duration, Instant};

/// How far a sweep is.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum SweepProgress {
    /// Nobody has asked for one.
    #[default]
    Idle,
    /// It is being seen whether it can be made.
    Checking,
    /// Its runs are made.
    Running,
    /// The user has stopped it.
    Stopped,
    /// All its runs have ended.
    Complete,
    /// It cannot be made, and why.
    Refused(String),
}

/// A sweep of the present scene.
#[derive(Default)]
pub struct SweepState {
    /// What the user wants to vary; `None` for the usual keys of the scene.
    pub plan: Option<SweepPlan>,
    /// How far the newest sweep is.
    pub progress: SweepProgress,
    /// The rows of the newest sweep that could be made.
    pub result: Option<SweepResult>,
    /// Requests to the threads of sweeps.
    pub requests: Vec<SweepRequest>,
    /// Sweeps that were asked for.
    pub(crate) number: u64,
    /// Text of the scene of the newest.
    pub(crate) text: String,
}

/// The rows of a sweep.
pub struct SweepResult {
    /// What is run.
    pub job: Arc<SweepJob>,
    /// What the rows of each cell say.
    pub cells: Vec<CellSummary>,
    /// Text of the scene.
    pub(crate) text: String,
    rows: Vec<Vec<RunRow>>,
    /// Rows that have come.
    pub done: u64,
    began: Instant,
    /// The text of a later scene, and what in it makes the rows those of another.
    pub(crate) compared: RefCell<Option<(String, Option<String>)>>,
}

impl SweepResult {
    /// Without rows.
    pub(crate) fn new(job: Arc<SweepJob>, text: String) -> Self {
        let cells = job.experiment.study().cells();
        Self {
            cells: (0..cells).map(|cell| CellSummary::of(cell, [], job.experiment.design())).collect(),
            rows: vec![vec![]; cells as usize],
            done: 0,
            began: Instant::now(),
            compared: RefCell::default(),
            text,
            job,
        }
    }

    /// Takes in a row.
    pub(crate) fn push(&mut self, row: RunRow) {
        let cell = row.point.cell;
        let Some(rows) = self.rows.get_mut(cell as usize) else { return };
        rows.push(row);
        self.done += 1;
        self.cells[cell as usize] = CellSummary::of(cell, &*rows, self.job.experiment.design());
    }

    /// The rows of a cell, as they came.
    pub fn rows(&self, cell: u64) -> &[RunRow] {
        self.rows.get(cell as usize).map_or(&[], Vec::as_slice)
    }

    /// All its runs.
    pub fn runs(&self) -> u64 {
        self.job.experiment.study().runs()
    }

    /// How long the rest will take, from how long the rows took that have come; `None` without rows.
    pub fn left(&self) -> Option<Duration> {
        let left = self.runs().saturating_sub(self.done);
        (self.done > 0).then(|| self.began.elapsed().mul_f64(left as f64 / self.done as f64))
    }
}
