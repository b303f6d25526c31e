//! Laws that are functions in Python: asked once a sample for all of their followers.
//!
//! What belongs to Python, the names of observations, memory and checks of what comes back, is in `python/echelon/_law.py`.

use crate::error::{call_package, of_scene};
use crate::numbers::matrix;
use laws::{BatchInput, BatchLaw, Fault, INPUTS, Knowledge};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::cell::RefCell;
use std::fmt;
use studies::SceneRun;
use vocabulary::Command;

thread_local! {
    /// What a law raised on this thread, on its way through the core.
    static RAISED: RefCell<Option<PyErr>> = const { RefCell::new(None) };
}

/// Takes what a law raised on this thread, if one did.
pub(crate) fn raised() -> Option<PyErr> {
    RAISED.take()
}

/// What a law may know of the leaders, by the words for it.
pub(crate) const KNOWLEDGE: [(&str, Knowledge); 3] =
    [("output", Knowledge::Output), ("rates", Knowledge::Rates), ("motion", Knowledge::Motion)];

/// What a law raised and broke a run off with, to be raised now, and what to raise whenever the run is to go on after that.
pub(crate) fn again(py: Python<'_>, raised: PyErr, sample: u64, time: f64) -> (PyErr, PyErr) {
    let error = raised.clone_ref(py).into_value(py);
    let pair = call_package(py, ["_law", "again"], (error, sample, time)).and_then(|pair| pair.extract());
    pair.map_or_else(
        |failed| (failed, raised),
        |(now, then): (Bound<'_, PyAny>, Bound<'_, PyAny>)| (PyErr::from_value(now), PyErr::from_value(then)),
    )
}

/// Every number that a law is told: its name, its unit, and one line about it.
pub(crate) fn inputs() -> Vec<(&'static str, String, &'static str)> {
    INPUTS.iter().map(|(_, name, unit, about)| (*name, unit.to_string(), *about)).collect()
}

/// Attaches what the user gave as a law to a run.
///
/// # Errors
/// Where it is no law, or the run cannot have it.
pub(crate) fn attach(law: &Bound<'_, PyAny>, run: &mut SceneRun) -> PyResult<()> {
    let py = law.py();
    let names: Vec<String> = run.simulation.fleet().robots.iter().map(|robot| robot.name.clone()).collect();
    let followers: Vec<&str> = run.scene.followers().map(|(name, _)| name).collect();
    let caller = call_package(py, ["_law", "caller"], (law, &names, followers, run.scene.time.period))?;
    let knows: String = caller.getattr("knows")?.extract()?;
    let known = KNOWLEDGE.iter().find(|(word, _)| *word == knows).map(|(_, knowledge)| *knowledge);
    let knows = known.ok_or_else(|| PyValueError::new_err(format!("a law does not know \"{knows}\"")))?;
    let followers: Vec<usize> = caller.getattr("followers")?.extract()?;
    let name = caller.getattr("name")?.extract()?;
    let law = Box::new(PythonLaw { name, knows, caller: caller.unbind() });
    run.simulation.attach_law(law, &followers).map_err(of_scene)
}

/// A law in Python, with its memory.
struct PythonLaw {
    name: String,
    knows: Knowledge,
    /// An `echelon._law.Caller`.
    caller: Py<PyAny>,
}

impl fmt::Debug for PythonLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PythonLaw")
            .field("name", &self.name)
            .field("knows", &self.knows)
            .finish_non_exhaustive()
    }
}

impl PythonLaw {
    fn call(&self, py: Python<'_>, inputs: &[BatchInput<'_>]) -> PyResult<Vec<Command>> {
        // One row per quantity, so that each is an array without gaps.
        let numbers = INPUTS.iter().flat_map(|(kind, ..)| inputs.iter().map(|one| one.input.value(0, *kind)));
        let told = matrix(py, numbers.collect(), inputs.len())?;
        let robots: Vec<usize> = inputs.iter().map(|one| one.robot).collect();
        let meets: Vec<bool> = inputs.iter().map(|one| one.meets).collect();
        let input = &inputs[0].input;
        let commands = self.caller.bind(py).call1((told, robots, meets, input.time, input.noise.sample))?;
        let commands: PyReadonlyArray2<'_, f64> = commands.extract()?;
        if commands.shape() != [inputs.len(), 2] {
            return Err(PyValueError::new_err("a law returns one command per follower"));
        }
        let rows = commands.as_array();
        let command =
            |row: numpy::ndarray::ArrayView1<'_, f64>| Command { acceleration: row[0], turn_rate: row[1] };
        Ok(rows.rows().into_iter().map(command).collect())
    }
}

impl BatchLaw for PythonLaw {
    fn name(&self) -> &str {
        &self.name
    }

    fn knows(&self) -> Knowledge {
        self.knows
    }

    fn decide(&mut self, inputs: &[BatchInput<'_>]) -> Result<Vec<Command>, Fault> {
        Python::attach(|py| self.call(py, inputs)).map_err(|error| {
            let message = error.to_string();
            RAISED.set(Some(error));
            Fault { place: None, message }
        })
    }

    fn fork(&self) -> Box<dyn BatchLaw> {
        Python::attach(|py| {
            let caller = self.caller.bind(py).call_method0("fork").map_or_else(
                |error| {
                    // Whoever asked for the copy hears of it.
                    RAISED.set(Some(error));
                    self.caller.clone_ref(py)
                },
                Bound::unbind,
            );
            Box::new(Self { name: self.name.clone(), knows: self.knows, caller })
        })
    }
}
