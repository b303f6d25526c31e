//! Studies of many runs: one run shows that a law can work, a claim needs a thousand.
//!
//! A [`Study`](scene::Study) says what varies. With its scene it is an [`Experiment`]; its [`Design`] says which run has which
//! values and which seed, and [`run_all`] makes runs on all cores. Every run is a [`RunRow`], which a [`StudyFolder`] puts on the
//! disk as it ends. A [`StudySummary`] tells what all rows say, cell by cell.
//!
//! On a page there are neither files nor threads: there runs are made piece by piece, each an [`ExperimentRun`].
//!
//! Rows do not depend on cores, order or machine: a run's values and seed are functions of the study and the run's index.

mod boundary;
mod chart;
mod design;
mod error;
mod experiment;
mod experiment_run;
#[cfg(not(target_family = "wasm"))]
mod folder;
mod index_set;
mod interval;
mod measure;
mod row;
#[cfg(not(target_family = "wasm"))]
mod row_table;
#[cfg(not(target_family = "wasm"))]
mod runner;
mod sampling;
mod summary;
#[cfg(not(target_family = "wasm"))]
mod theory;

pub use boundary::BoundarySearch;
pub use chart::{ChartQuantity, StudyCurve, StudyFigure, charts, curve, edge_line, heat_map, key_label};
pub use design::{Design, DesignAxis, RunPoint};
pub use error::Error;
pub use experiment::{CAMERAS, Experiment, GoOn};
pub use experiment_run::ExperimentRun;
#[cfg(not(target_family = "wasm"))]
pub use folder::{
    StudyFolder, StudyManifest, for_every_row, joined, merge, part_bytes, row_files, write_rows,
};
pub use index_set::IndexSet;
pub use measure::{MEASURES, RunMeasure};
pub use row::{RowStatus, RunRow};
#[cfg(not(target_family = "wasm"))]
pub use row_table::RowTable;
#[cfg(not(target_family = "wasm"))]
pub use runner::{Progressed, THREAD, run_all};
pub use summary::{CellSummary, StudySummary, SummaryBuilder};
#[cfg(not(target_family = "wasm"))]
pub use theory::{TheoryCell, TheoryClaim, agreement, theory, theory_lines};
