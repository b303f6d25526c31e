//! Studies of many runs.

use crate::error::{EchelonError, RunError, of_diagnostics, of_output, of_recording, of_scene};
use crate::scene::{PyScene, SceneSource};
use crate::table::{PyTable, batch, of_arrow};
use crate::values::toml_text;
use crate::watch::detached;
use pyo3::exceptions::{PyIndexError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyMapping, PyString, PyType};
use scene::{FollowerScatter, Sampling, Study, StudyParameter, Values};
use std::path::PathBuf;
use sweeps::{Error, Experiment, Progressed, RowTable, RunRow, run_all};
use vocabulary::Word;

/// Many runs of a scene that differ. It does not change, and can be pickled.
#[pyclass(name = "Study", module = "echelon", frozen)]
pub(crate) struct PyStudy {
    experiment: Experiment,
}

/// What makes a study again: a function and its arguments.
type Pickled<'py> = (Bound<'py, PyAny>, (String, String, PathBuf));

fn of_sweep(error: &Error) -> PyErr {
    match error {
        Error::Study(faults) => PyValueError::new_err(
            faults.iter().map(|fault| fault.text.as_str()).collect::<Vec<_>>().join("\n"),
        ),
        Error::Scene(faults) => of_diagnostics(faults),
        Error::Output(error) => of_output(error, None),
        Error::Recording(error) => of_recording(error),
        Error::Usage(_) | Error::Manifest { .. } => EchelonError::new_err(error.to_string()),
    }
}

impl PyStudy {
    fn checked(experiment: Experiment) -> PyResult<Self> {
        let faults = experiment.faults();
        if !faults.is_empty() {
            return Err(of_sweep(&Error::Study(faults)));
        }
        let scene = experiment.scene(&experiment.design().point(0)).map_err(of_scene)?;
        let run = studies::SceneRun::new(scene).map_err(of_scene)?;
        if run.simulation.needs_cameras() {
            return Err(of_scene(format!("this scene is none for many runs: {}", sweeps::CAMERAS)));
        }
        Ok(Self { experiment })
    }

    /// Rows of runs, in order.
    fn rows(
        &self,
        py: Python<'_>,
        [start, stop]: [u64; 2],
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<RunRow>> {
        let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let threads = threads.unwrap_or_else(cores).clamp(1, 1024);
        let count = stop - start;
        let rows = detached(py, progress, count, |watch| {
            let mut rows: Vec<RunRow> = vec![];
            let clock = || watch.seconds();
            run_all(&self.experiment, start..stop, threads, &clock, |event| {
                if let Progressed::Ended(row) = event {
                    rows.push(row);
                }
                Ok::<bool, std::convert::Infallible>(watch.goes_on(rows.len() as u64))
            })
            .map(|()| rows)
        })?;
        let Ok(mut rows) = rows;
        if rows.len() as u64 != count {
            return Err(RunError::new_err("the system gave no threads to make runs"));
        }
        rows.sort_by_key(|row| row.point.index);
        Ok(rows)
    }

    fn range(&self, start: u64, stop: Option<u64>) -> PyResult<[u64; 2]> {
        let runs = self.experiment.study().runs();
        let stop = stop.unwrap_or(runs);
        if start > stop || stop > runs {
            return Err(PyIndexError::new_err(format!(
                "the study has runs 0 to {runs}: there is no range {start} to {stop}"
            )));
        }
        Ok([start, stop])
    }
}

/// Values of a key: a text, or a list of values.
fn values(key: &str, given: &Bound<'_, PyAny>) -> PyResult<Values> {
    let text = if let Ok(text) = given.cast::<PyString>() {
        text.to_str()?.to_owned()
    } else if let Ok(items) = given.try_iter() {
        let items = items.map(|item| toml_text(&item?)).collect::<PyResult<Vec<String>>>()?;
        items.join(",")
    } else {
        toml_text(given)?
    };
    text.parse().map_err(|error: scene::ValuesError| PyValueError::new_err(format!("`{key}`: {error}")))
}

#[pymethods]
impl PyStudy {
    /// Makes a study of a scene.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene
    ///     What runs.
    /// vary : dict, optional
    ///     Keys and their values: a list, or a text such as ``"1..10/19"``, ``"log:0.001..0.1/13"``, ``"zip:1,2,5"``,
    ///     ``"uniform:0..1"``, ``"log-uniform:0.001..0.1"``, ``"normal:5,0.5"`` or ``"=law.k"``.
    /// seeds : int
    ///     Runs of every combination, each with a seed of its own.
    /// samples : int
    ///     How often numbers with a distribution are drawn for every combination of the others.
    /// sampling : {"independent", "latin-hypercube", "sobol"}
    ///     How they are drawn.
    /// seed : int
    ///     Seed of everything that differs from run to run.
    /// scatter : (float, float)
    ///     How far followers start from where the scene puts them, m, and how far they are turned, rad.
    /// title : str, optional
    ///     Title of figures.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     Where keys or values are none, or contradict each other.
    #[new]
    #[pyo3(signature = (scene, vary=None, *, seeds=1, samples=1, sampling="independent", seed=1, scatter=[0.0, 0.0], title=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn __new__(
        scene: &PyScene,
        vary: Option<&Bound<'_, PyMapping>>,
        seeds: u64,
        samples: u64,
        sampling: &str,
        seed: u64,
        scatter: [f64; 2],
        title: Option<String>,
    ) -> PyResult<Self> {
        let known = Sampling::WORDS.iter().find(|(word, ..)| *word == sampling);
        let (_, sampling, _) = known.ok_or_else(|| {
            PyValueError::new_err("sampling is \"independent\", \"latin-hypercube\" or \"sobol\"")
        })?;
        let [position, heading] = scatter;
        let finite = [position, heading].iter().all(|number| (0.0..=1000.0).contains(number));
        if !finite || seeds == 0 || samples == 0 || i64::try_from(seed).is_err() {
            return Err(PyValueError::new_err(
                "seeds and samples are 1 or more, a seed is below 2⁶³, and a scatter is two numbers from 0 on",
            ));
        }
        let mut parameters = vec![];
        let items = vary.map(PyMappingMethods::items).transpose()?;
        for item in items.iter().flat_map(PyListMethods::iter) {
            let (key, given): (String, Bound<'_, PyAny>) =
                item.extract().map_err(|_| PyTypeError::new_err("keys of a scene are texts"))?;
            let values = values(&key, &given)?;
            parameters.push(StudyParameter { key, values });
        }
        let SceneSource { text, path } = scene.source()?;
        let study = Study {
            seed,
            seeds,
            samples,
            sampling: *sampling,
            set: scene.sets().to_vec(),
            parameters,
            scatter: FollowerScatter { position, heading },
            ..Study::of_scene(
                &path.display().to_string(),
                &title.unwrap_or_else(|| scene.scene().title.clone()),
            )
        };
        Self::checked(Experiment::of_text(study, &text, path).map_err(|error| of_sweep(&error))?)
    }

    /// Reads a study file.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     The file.
    #[classmethod]
    fn load(_class: &Bound<'_, PyType>, path: &Bound<'_, PyAny>) -> PyResult<Self> {
        let study = Study::load(&path.extract::<PathBuf>()?).map_err(|faults| of_diagnostics(&faults))?;
        Self::checked(Experiment::new(study).map_err(|error| of_sweep(&error))?)
    }

    #[classmethod]
    fn _restore(_class: &Bound<'_, PyType>, study: &str, text: &str, path: PathBuf) -> PyResult<Self> {
        let study = Study::parse(study, &path).map_err(|faults| of_diagnostics(&faults))?;
        Ok(Self { experiment: Experiment::of_text(study, text, path).map_err(|error| of_sweep(&error))? })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Pickled<'py>> {
        let restore = py.get_type::<Self>().getattr("_restore")?;
        let (experiment, path) = (&self.experiment, self.experiment.path());
        let path = if path.is_file() { std::path::absolute(path)? } else { path.to_owned() };
        Ok((restore, (experiment.study().to_toml(), experiment.scene_text().to_owned(), path)))
    }

    /// Runs of the study.
    #[getter]
    fn runs(&self) -> u64 {
        self.experiment.study().runs()
    }

    /// Runs of the study.
    fn __len__(&self) -> usize {
        usize::try_from(self.runs()).unwrap_or(usize::MAX)
    }

    /// 32 hexadecimal digits that are others where the study, its scene or the program is another.
    #[getter]
    fn fingerprint(&self) -> &str {
        self.experiment.fingerprint()
    }

    /// The study as a file has it.
    fn to_toml(&self) -> String {
        self.experiment.study().to_toml()
    }

    /// What one run has that others have not.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     The run, from 0.
    ///
    /// Returns
    /// -------
    /// dict
    ///     ``index``, ``cell``, ``sample``, ``seed``, and ``set``: the overrides that make the run again, as lines of
    ///     ``echelon run --set``.
    fn point<'py>(&self, py: Python<'py>, index: u64) -> PyResult<Bound<'py, PyDict>> {
        self.range(index, Some(index + 1))?;
        let point = self.experiment.design().point(index);
        let set = self.experiment.overrides(&point).map_err(of_scene)?;
        let dictionary = PyDict::new(py);
        dictionary.set_item("index", point.index)?;
        dictionary.set_item("cell", point.cell)?;
        dictionary.set_item("sample", point.sample)?;
        dictionary.set_item("seed", point.seed)?;
        dictionary.set_item("set", set.iter().map(ToString::to_string).collect::<Vec<_>>())?;
        Ok(dictionary)
    }

    /// Makes runs and returns their rows: see `echelon.sweep`, which makes those of a cluster, too.
    ///
    /// Parameters
    /// ----------
    /// start, stop : int, optional
    ///     The first run, and the one before which to end; by default all.
    /// threads : int, optional
    ///     By default one for each core.
    /// progress : callable or bool, optional
    ///     Called with runs that have been made and in all; True is a bar.
    ///
    /// Returns
    /// -------
    /// Table
    ///     A row for every run, by index.
    #[pyo3(signature = (start=0, stop=None, *, threads=None, progress=None))]
    fn run(
        &self,
        py: Python<'_>,
        start: u64,
        stop: Option<u64>,
        threads: Option<usize>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<PyTable> {
        let range = self.range(start, stop)?;
        let progress = match progress {
            Some(wish) => {
                let made = crate::error::call_package(py, ["_progress", "as_progress"], (wish, "runs"))?;
                (!made.is_none()).then(|| made.unbind())
            }
            None => None,
        };
        let rows = self.rows(py, range, threads, progress)?;
        let mut table = RowTable::new(self.experiment.design());
        for row in &rows {
            table.push(row);
        }
        made(table)
    }

    /// Makes runs and returns their rows as the bytes of a Parquet file.
    ///
    /// Parameters
    /// ----------
    /// start, stop : int
    ///     The first run, and the one before which to end.
    /// threads : int, optional
    ///     By default one for each core.
    #[pyo3(signature = (start, stop, *, threads=None))]
    fn part<'py>(
        &self,
        py: Python<'py>,
        start: u64,
        stop: u64,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let rows = self.rows(py, self.range(start, Some(stop))?, threads, None)?;
        let bytes = py.detach(|| sweeps::part_bytes(&self.experiment, &rows));
        bytes.map(|bytes| PyBytes::new(py, &bytes)).map_err(|error| of_sweep(&error))
    }

    /// Joins the bytes of Parquet files of rows.
    ///
    /// Parameters
    /// ----------
    /// parts : list of bytes
    ///     As `part` returns them, in any order.
    ///
    /// Returns
    /// -------
    /// Table
    ///     A row for every run in them, by index.
    ///
    /// Raises
    /// ------
    /// EchelonError
    ///     Where one is of another study, or a run is there twice.
    fn joined(&self, py: Python<'_>, parts: &Bound<'_, PyList>) -> PyResult<PyTable> {
        let parts = parts.iter().map(|part| part.extract::<Vec<u8>>()).collect::<PyResult<Vec<_>>>()?;
        let rows = py.detach(|| sweeps::joined(&self.experiment, &parts));
        made(rows.map_err(|error| of_sweep(&error))?)
    }
}

/// A table for Python.
fn made(mut table: RowTable) -> PyResult<PyTable> {
    let columns = table.columns_mut().iter_mut().map(|named| recording::NamedColumn {
        name: named.name.clone(),
        column: std::mem::replace(&mut named.column, recording::Column::Flag(vec![])),
    });
    let batch = batch(columns.collect()).map_err(|error| of_arrow(&error))?;
    Ok(PyTable::new("runs", batch, vec![]))
}
