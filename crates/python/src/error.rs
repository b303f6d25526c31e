//! Errors of the core as exceptions of the package; the classes are in `python/echelon/_errors.py`.

use output::Error::{Busy, Io, Occupied};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::{PyErr, import_exception};
use scene::{Diagnostic, Diagnostics};
use std::path::Path;

import_exception!(echelon._errors, EchelonError);
import_exception!(echelon._errors, SceneError);
import_exception!(echelon._errors, RunError);
import_exception!(echelon._errors, OutputError);
import_exception!(echelon._errors, RenderingError);
import_exception!(echelon._errors, EndOfRunError);
import_exception!(echelon._errors, BusyError);
import_exception!(echelon._errors, ActionError);

/// Everything that is wrong with a scene.
pub(crate) fn of_diagnostics(faults: &Diagnostics) -> PyErr {
    let all = faults.all().iter().map(|fault| {
        let Diagnostic { origin, line, column, message, .. } = fault;
        let place = |number: usize| (number > 0).then_some(number);
        (origin.clone(), place(*line), place(*column), message.clone(), fault.suggestion().map(str::to_owned))
    });
    SceneError::new_err((faults.to_string(), all.collect::<Vec<_>>()))
}

/// A scene that reads well and cannot run, or a change that a scene or a run does not take.
pub(crate) fn of_scene<E: std::fmt::Display>(text: E) -> PyErr {
    SceneError::new_err((text.to_string(), Vec::<String>::new()))
}

/// A run that broke off; what Python code raised meanwhile comes first.
pub(crate) fn of_study(error: &studies::Error) -> PyErr {
    if let Some(raised) = crate::law::raised() {
        return raised;
    }
    match error {
        studies::Error::Usage(_) | studies::Error::Build(_) => of_scene(error),
        studies::Error::Output(error) => of_output(error, None),
        studies::Error::Recording(error) => of_recording(error),
        studies::Error::NotFinite(_)
        | studies::Error::Camera(_)
        | studies::Error::Law(_)
        | studies::Error::Interrupted { .. } => RunError::new_err(error.to_string()),
    }
}

/// A file or folder that could not be written, with what helps and with what is there all the same.
pub(crate) fn of_output(error: &output::Error, kept: Option<&str>) -> PyErr {
    let mut text = match error {
        Occupied { what: Some(_), .. } => {
            format!("{error}: choose another folder, or give `force=True` to replace it")
        }
        Occupied { what: None, .. } => format!("{error}: choose another folder"),
        Busy(_) => format!("{error}: wait for it, or choose another place"),
        _ => error.to_string(),
    };
    if let Some(kept) = kept {
        text = format!("{text}; {kept}");
    }
    let number = match error {
        Io { source, .. } => source.raw_os_error(),
        _ => None,
    };
    not_written(text, number, error.path())
}

/// A run folder that could not be written.
pub(crate) fn of_recording(error: &recording::Error) -> PyErr {
    match error {
        recording::Error::Output(error) => of_output(error, None),
        recording::Error::Log { path, .. } | recording::Error::Table { path, .. } => {
            not_written(error.to_string(), None, path)
        }
    }
}

fn not_written(text: String, number: Option<i32>, path: &Path) -> PyErr {
    OutputError::new_err((text, number, path.as_os_str().to_owned()))
}

/// Something that another thread is at work on.
pub(crate) fn busy() -> PyErr {
    BusyError::new_err(
        "another thread is at work on this object, or it is what calls this function: wait until it is done, or give each one \
         of its own (a simulation has fork())",
    )
}

/// `what` is of this process and cannot be sent to another one: `instead` says what can.
pub(crate) fn not_pickled(what: &str, instead: &str) -> PyErr {
    PyTypeError::new_err(format!(
        "{what} cannot be pickled, and so not be sent to another process: {instead}"
    ))
}

/// Calls a function of the package's own Python code.
pub(crate) fn call_package<'py, A>(
    py: Python<'py>,
    place: [&str; 2],
    arguments: A,
) -> PyResult<Bound<'py, PyAny>>
where
    A: pyo3::call::PyCallArgs<'py>,
{
    let [module, function] = place;
    py.import(format!("echelon.{module}"))?.getattr(function)?.call1(arguments)
}
