//! Matrices of the core as NumPy arrays.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use vocabulary::Picture;

/// Numbers row by row as an array of so many columns.
pub(crate) fn matrix(
    py: Python<'_>,
    numbers: Vec<f64>,
    columns: usize,
) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let rows = numbers.len().checked_div(columns).unwrap_or(0);
    PyArray1::from_vec(py, numbers).reshape([rows, columns])
}

/// A picture as height × width × [red, green, blue].
pub(crate) fn pixels<'py>(py: Python<'py>, picture: &Picture) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let rgb = picture.rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    PyArray1::from_vec(py, rgb).reshape([picture.height as usize, picture.width as usize, 3])
}

/// Numbers row by row as an array of three axes.
pub(crate) fn cube(
    py: Python<'_>,
    numbers: Vec<f64>,
    shape: [usize; 3],
) -> PyResult<Bound<'_, PyArray3<f64>>> {
    PyArray1::from_vec(py, numbers).reshape(shape)
}
