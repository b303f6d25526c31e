//! Arguments that people write in several ways; what is none of them is told with an example.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyAnyMethods, PyString};

/// The longest value that a message repeats, characters.
const LONGEST: usize = 60;

/// A value as a message names it.
fn shown(value: &Bound<'_, PyAny>) -> String {
    let text = value.repr().map(|text| text.to_string()).unwrap_or_default();
    let kind = || value.get_type().name().map(|name| name.to_string()).unwrap_or_default();
    if text.is_empty() || text.chars().count() > LONGEST { kind() } else { text }
}

/// Width and height in pixels: two numbers, or a text as `--size` takes it.
#[derive(Clone, Copy)]
pub(crate) struct Size(pub(crate) [u32; 2]);

impl<'py> FromPyObject<'_, 'py> for Size {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let wanted = || {
            format!(
                "size is width and height in pixels, such as (1280, 720) or \"1280x720\", not {}",
                shown(&value)
            )
        };
        if let Ok(text) = value.cast::<PyString>() {
            let size = footage::parse_size(text.to_str()?);
            return size.map(Self).ok_or_else(|| PyValueError::new_err(wanted()));
        }
        let sides = value.try_iter().and_then(|sides| sides.map(|side| side?.extract()).collect());
        let sides: Vec<i64> = sides.map_err(|_| PyTypeError::new_err(wanted()))?;
        let sides: Option<Vec<u32>> = sides.into_iter().map(|side| side.try_into().ok()).collect();
        let size = sides.and_then(|sides| sides.try_into().ok());
        size.map(Self).ok_or_else(|| PyValueError::new_err(wanted()))
    }
}

/// Times in s: one number, or any number of them.
pub(crate) struct Times(pub(crate) Vec<f64>);

impl<'py> FromPyObject<'_, 'py> for Times {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let several = value.try_iter().and_then(|times| times.map(|time| time?.extract()).collect());
        several.or_else(|_| value.extract().map(|time| vec![time])).map(Self).map_err(|_| {
            let shown = shown(&value);
            PyTypeError::new_err(format!("at is times in s, such as 5 or [0, 2.5, 5], not {shown}"))
        })
    }
}

/// Names: one, or any number of them.
pub(crate) struct Names(pub(crate) Vec<String>);

impl<'py> FromPyObject<'_, 'py> for Names {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(name) = value.cast::<PyString>() {
            return Ok(Self(vec![name.extract()?]));
        }
        let several = value.try_iter().and_then(|names| names.map(|name| name?.extract()).collect());
        several.map(Self).map_err(|_| {
            let shown = shown(&value);
            PyTypeError::new_err(format!(
                "without is elements to hide, such as \"labels\" or [\"labels\", \"inset\"], not {shown}"
            ))
        })
    }
}
