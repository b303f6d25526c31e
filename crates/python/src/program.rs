//! The program `echelon`, which the module holds: so a wheel has everything once.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the program `echelon` with these arguments, of which the first is its name, and returns its exit code.
///
/// Help, and arguments that are none, end the process.
#[pyfunction]
pub(crate) fn program(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cli::program(arguments))
}
