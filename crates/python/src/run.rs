//! A run to its end: its tables, its metrics, what became of its expectations.

use crate::error::{call_package, not_pickled, of_recording, of_study};
use crate::table::{PyTable, batch, of_arrow};
use crate::watch::detached;
use metrics::{JudgedExpectation, Metrics};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use recording::{Recorder, RunOptions, Status, TableBuilder, TableKind, metrics_text};
use scene::Scene;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use studies::run::{JudgedRun, run_through};
use studies::{SceneRun, run_options};
use vocabulary::{FleetInfo, StepRecord, Word};

/// How manifests say how a run ended.
fn word(status: Status) -> String {
    let value = serde_json::to_value(status).unwrap_or_default();
    value.as_str().unwrap_or_default().to_owned()
}

/// Samples whose rows make a batch of a table.
const SAMPLES_PER_BATCH: usize = 4096;

/// A run of a scene, all of it in memory. Its tables have the columns of those in a run folder, and are Arrow streams.
#[pyclass(name = "Run", module = "echelon", frozen)]
pub(crate) struct PyRun {
    scene: Scene,
    fleet: FleetInfo,
    records: Vec<StepRecord>,
    status: Status,
    metrics: Metrics,
    digest: String,
    findings: Vec<JudgedExpectation>,
    /// Tables that were asked for.
    tables: Mutex<HashMap<&'static str, Py<PyTable>>>,
}

impl PyRun {
    /// Runs a scene to its end.
    pub(crate) fn of(
        py: Python<'_>,
        mut run: SceneRun,
        progress: Option<Py<PyAny>>,
        adapter: &str,
    ) -> PyResult<Self> {
        crate::cameras::attach(py, &mut run, adapter)?;
        let (scene, fleet) = (run.scene.clone(), run.simulation.fleet().clone());
        let total = run.simulation.len();
        let mut records = vec![];
        let kept = &mut records;
        let judged = detached(py, progress, total, |watch| {
            run_through(run, None, None, |record, steps| {
                kept.push(record.clone());
                watch.goes_on(steps)
            })
        })?;
        let JudgedRun { status, metrics, digest, findings, closed, .. } =
            judged.map_err(|error| of_study(&error))?;
        records.push(StepRecord { contacts: closed, ..StepRecord::default() });
        Ok(Self { scene, fleet, records, status, metrics, digest, findings, tables: Mutex::default() })
    }

    fn table(&self, py: Python<'_>, kind: TableKind) -> PyResult<Py<PyTable>> {
        // The lock is not held while the interpreter is released.
        let tables = || self.tables.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(table) = tables().get(kind.word()) {
            return Ok(table.clone_ref(py));
        }
        let built = py.detach(|| {
            let mut table = TableBuilder::new(kind);
            let mut batches = vec![];
            for part in self.records.chunks(SAMPLES_PER_BATCH) {
                for record in part {
                    table.push(&self.fleet, record);
                }
                batches.push(batch(table.take())?);
            }
            let first = if batches.is_empty() { batch(table.take())? } else { batches.remove(0) };
            Ok(PyTable::new(kind.word(), first, batches))
        });
        let table = Py::new(py, built.map_err(|error| of_arrow(&error))?)?;
        tables().insert(kind.word(), table.clone_ref(py));
        Ok(table)
    }

    /// The moments of the run, without the one that closes contacts.
    fn moments(&self) -> &[StepRecord] {
        self.records.split_last().map_or(&[], |(_, moments)| moments)
    }
}

#[pymethods]
impl PyRun {
    /// Poses and speeds: a row per robot and sample.
    #[getter]
    fn robots(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        self.table(py, TableKind::Robots)
    }

    /// Set points, errors, commands and estimates: a row per edge and sample.
    #[getter]
    fn edges(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        self.table(py, TableKind::Edges)
    }

    /// Contacts, a row each.
    #[getter]
    fn contacts(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        self.table(py, TableKind::Contacts)
    }

    /// Where the props are that can move: a row per prop and sample.
    #[getter]
    fn props(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        self.table(py, TableKind::Props)
    }

    /// What followers measured, a row per measurement.
    #[getter]
    fn measurements(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        self.table(py, TableKind::Measurements)
    }

    /// What safety filters did: a row per robot that has one and sample.
    #[getter]
    fn safety(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        self.table(py, TableKind::Safety)
    }

    /// What law files carry and show: a row per quantity and sample.
    #[getter]
    fn laws(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        self.table(py, TableKind::Laws)
    }

    /// What happened to the formation, a row per event.
    #[getter]
    fn events(&self, py: Python<'_>) -> PyResult<Py<PyTable>> {
        self.table(py, TableKind::Events)
    }

    /// Errors, effort, clearance, contacts, certificates and expectations: what ``metrics.json`` holds.
    #[getter]
    fn metrics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = metrics_text(&self.metrics, &self.findings).map_err(PyRuntimeError::new_err)?;
        py.import("json")?.getattr("loads")?.call1((text,))
    }

    /// What became of the expectations of the scene.
    #[getter]
    fn expectations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows = self.findings.iter().map(|finding| {
            let JudgedExpectation { key, wanted, found, met } = finding;
            (*key, wanted.clone(), found.clone(), *met)
        });
        call_package(py, ["_run", "expectations"], (rows.collect::<Vec<_>>(),))
    }

    /// Whether no expectation was missed.
    #[getter]
    fn passed(&self) -> bool {
        self.status != Status::Interrupted && !self.findings.iter().any(JudgedExpectation::failed)
    }

    /// Of the trajectory: the same for runs that are the same bit for bit, whatever ran them.
    #[getter]
    fn digest(&self) -> &str {
        &self.digest
    }

    /// ``"complete"``, ``"stopped"`` before its time, or ``"interrupted"``.
    #[getter]
    fn status(&self) -> String {
        word(self.status)
    }

    /// Time of the last sample, s.
    #[getter]
    fn duration(&self) -> f64 {
        self.metrics.duration
    }

    /// The title of the scene.
    #[getter]
    fn title(&self) -> &str {
        &self.fleet.title
    }

    /// Plots the errors of every edge over time. It needs matplotlib.
    ///
    /// Parameters
    /// ----------
    /// axes : pair of matplotlib axes, optional
    ///     For distance and bearing; new ones by default.
    ///
    /// Returns
    /// -------
    /// pair of matplotlib axes
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(slf: &Bound<'py, Self>, axes: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        call_package(slf.py(), ["_plot", "errors"], (slf, axes))
    }

    fn _repr_png_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call_package(slf.py(), ["_plot", "png"], (slf,))
    }

    /// Writes the run folder that ``echelon run`` writes.
    ///
    /// Parameters
    /// ----------
    /// folder : path
    ///     A new or empty folder.
    /// csv : bool, optional
    ///     Also writes the tables as CSV.
    /// log : bool, optional
    ///     Writes ``log.mcap``, which other tools open.
    /// force : bool, optional
    ///     Replaces an earlier run in the folder.
    ///
    /// Raises
    /// ------
    /// OutputError
    ///     Where the folder holds something, or cannot be written.
    #[pyo3(signature = (folder, *, csv=false, log=true, force=false))]
    fn save(&self, py: Python<'_>, folder: PathBuf, csv: bool, log: bool, force: bool) -> PyResult<()> {
        let total = self.moments().len() as u64;
        let written = detached(py, None, total, move |watch| {
            let options = RunOptions { csv, no_log: !log, force, ..run_options(&self.scene) };
            let mut recorder = Recorder::create(&folder, &self.fleet, options)?;
            for (index, record) in self.moments().iter().enumerate() {
                recorder.push(record)?;
                if !watch.goes_on(index as u64) {
                    recorder.abandon();
                    return Ok(());
                }
            }
            let certificates = self.metrics.certificates.clone();
            recorder.conclude(self.status, certificates, &self.findings).written.map(drop)
        })?;
        written.map_err(|error| of_recording(&error))
    }

    #[expect(clippy::unused_self, reason = "pickle asks an object")]
    fn __reduce__(&self) -> PyResult<()> {
        Err(not_pickled(
            "a Run",
            "`save` it and send the folder, or send what is needed of it, such as `run.metrics` or `run.digest`",
        ))
    }

    fn __repr__(&self) -> String {
        let met = if self.passed() { "expectations met" } else { "an expectation failed" };
        format!(
            "<echelon.Run of {}: {} at {:.2} s, {met}, digest {}>",
            self.fleet.title,
            word(self.status),
            self.metrics.duration,
            self.digest
        )
    }
}
