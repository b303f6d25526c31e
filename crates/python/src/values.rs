//! Values between Python and scene files.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use scene::Override;
use toml::{Table, Value};

/// Deepest nesting of a value: nothing in a scene lies deeper.
const DEEPEST: usize = 32;

/// A value as TOML has it. NumPy's scalars and arrays are taken, too.
pub(crate) fn to_toml(value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    if depth > DEEPEST {
        return Err(PyTypeError::new_err(format!("a value is nested more than {DEEPEST} deep")));
    }
    let listed = |items: Vec<Bound<'_, PyAny>>| {
        items.iter().map(|item| to_toml(item, depth + 1)).collect::<PyResult<_>>().map(Value::Array)
    };
    if value.is_instance_of::<PyBool>() {
        Ok(Value::Boolean(value.extract()?))
    } else if value.is_instance_of::<PyInt>() {
        Ok(Value::Integer(value.extract()?))
    } else if value.is_instance_of::<PyFloat>() {
        Ok(Value::Float(value.extract()?))
    } else if value.is_instance_of::<PyString>() {
        Ok(Value::String(value.extract()?))
    } else if let Ok(list) = value.cast::<PyList>() {
        listed(list.iter().collect())
    } else if let Ok(tuple) = value.cast::<PyTuple>() {
        listed(tuple.iter().collect())
    } else if let Ok(mapping) = value.cast::<PyMapping>() {
        table(mapping, depth).map(Value::Table)
    } else if let Ok(plain) = value.call_method0("tolist") {
        to_toml(&plain, depth + 1)
    } else {
        let kind = value.get_type().name()?;
        Err(PyTypeError::new_err(format!(
            "a scene has no value of type {kind}: give a number, text, bool, list or dictionary"
        )))
    }
}

/// A value as it stands in a scene.
pub(crate) fn toml_text(value: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(to_toml(value, 0)?.to_string())
}

/// A dictionary as a table. Keys whose value is `None` are left out.
pub(crate) fn table(mapping: &Bound<'_, PyMapping>, depth: usize) -> PyResult<Table> {
    let mut table = Table::new();
    for item in mapping.items()?.iter() {
        let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        let key: String = key.extract().map_err(|_| PyTypeError::new_err("keys of a scene are texts"))?;
        if !value.is_none() {
            table.insert(key, to_toml(&value, depth + 1)?);
        }
    }
    Ok(table)
}

/// A dictionary of dotted paths and values as overrides.
pub(crate) fn overrides(values: &Bound<'_, PyAny>) -> PyResult<Vec<Override>> {
    let wrong = || PyTypeError::new_err("values to set are a dictionary, such as {\"law.k\": 3}");
    let mapping = values.cast::<PyMapping>().map_err(|_| wrong())?;
    let mut overrides = vec![];
    for item in mapping.items()?.iter() {
        let (path, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        let path: String = path.extract().map_err(|_| wrong())?;
        let text = format!("{path}={}", to_toml(&value, 0)?);
        overrides.push(text.parse().map_err(crate::error::of_scene::<scene::OverrideError>)?);
    }
    Ok(overrides)
}

/// TOML as Python's own types.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Boolean(flag) => flag.into_pyobject(py)?.to_owned().into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Float(number) => number.into_pyobject(py)?.into_any(),
        Value::String(text) => text.into_pyobject(py)?.into_any(),
        Value::Datetime(time) => time.to_string().into_pyobject(py)?.into_any(),
        Value::Array(items) => {
            let items = items.iter().map(|item| to_python(py, item)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, items)?.into_any()
        }
        Value::Table(table) => {
            let dictionary = PyDict::new(py);
            for (key, item) in table {
                dictionary.set_item(key, to_python(py, item)?)?;
            }
            dictionary.into_any()
        }
    })
}
