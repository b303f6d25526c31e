//! Errors of the core as exceptions of the package; the classes are in `python/echelon/_errors.py`.

use pyo3::prelude::*;
use pyo3::{PyErr, import_exception};
use scene::{Diagnostic, Diagnostics};

import_exception!(echelon._errors, EchelonError);
import_exception!(echelon._errors, SceneError);
import_exception!(echelon._errors, RunError);
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
        studies::Error::Output(_) | studies::Error::Recording(_) => {
            pyo3::exceptions::PyOSError::new_err(error.to_string())
        }
        studies::Error::NotFinite(_)
        | studies::Error::Camera(_)
        | studies::Error::Law(_)
        | studies::Error::Interrupted { .. } => RunError::new_err(error.to_string()),
    }
}

/// Something that another thread is at work on.
pub(crate) fn busy() -> PyErr {
    BusyError::new_err(
        "another thread is at work on this simulation, or it is what calls this function: wait until it is done, or give each a \
         fork() of its own",
    )
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
