//! Tables of a run as Arrow streams: pandas, polars, DuckDB and pyarrow take them as they are.

use crate::error::not_pickled;
use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{
    ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray,
};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};
use recording::{Column, NamedColumn};
use std::ffi::CStr;
use std::sync::Arc;

/// The name that the Arrow PyCapsule interface gives to streams.
const STREAM: &CStr = c"arrow_array_stream";

/// A table of a run, an Arrow stream: ``polars.DataFrame(table)``, ``pyarrow.table(table)`` and, from pandas 3 on,
/// ``pandas.DataFrame.from_arrow(table)`` take it as it is; ``table["x_m"]`` is a column.
#[pyclass(name = "Table", module = "echelon", frozen)]
pub(crate) struct PyTable {
    name: &'static str,
    /// All batches are of one schema.
    first: RecordBatch,
    rest: Vec<RecordBatch>,
}

impl PyTable {
    pub(crate) fn new(name: &'static str, first: RecordBatch, rest: Vec<RecordBatch>) -> Self {
        Self { name, first, rest }
    }

    fn batches(&self) -> impl Iterator<Item = &RecordBatch> {
        std::iter::once(&self.first).chain(&self.rest)
    }
}

/// Rows as Arrow holds them.
///
/// # Errors
/// [`ArrowError`] where the columns differ in length.
pub(crate) fn batch(columns: Vec<NamedColumn>) -> Result<RecordBatch, ArrowError> {
    let array = |NamedColumn { name, column }| {
        let array: ArrayRef = match column {
            Column::Text(texts) => Arc::new(StringArray::from(texts)),
            Column::Number(numbers) => Arc::new(Float64Array::from(numbers)),
            Column::Whole(numbers) => Arc::new(Int64Array::from(numbers)),
            Column::Flag(flags) => Arc::new(BooleanArray::from(flags)),
        };
        (Field::new(name, array.data_type().clone(), false), array)
    };
    let (fields, arrays): (Vec<_>, _) = columns.into_iter().map(array).unzip();
    RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays)
}

/// An error of Arrow as an exception.
pub(crate) fn of_arrow(error: &ArrowError) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

#[pymethods]
impl PyTable {
    /// The Arrow PyCapsule interface: pandas, polars, DuckDB and pyarrow take the table by it without a copy.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // A wish only: the protocol lets a producer keep its own types.
        drop(requested_schema);
        let batches: Vec<_> = self.batches().cloned().map(Ok).collect();
        let reader = RecordBatchIterator::new(batches, self.first.schema());
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(reader)), STREAM)
    }

    /// Names of the columns, which end in their units.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.first.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    /// A column: an array of float64, int64 or bool, or a list of str.
    fn __getitem__<'py>(&self, py: Python<'py>, column: &str) -> PyResult<Bound<'py, PyAny>> {
        let schema = self.first.schema();
        let Ok(index) = schema.index_of(column) else {
            let text = format!(
                "table `{}` has no column `{column}`; it has {}",
                self.name,
                self.columns().join(", ")
            );
            return Err(PyKeyError::new_err(text));
        };
        let arrays = self.batches().map(|batch| batch.column(index));
        Ok(match schema.field(index).data_type() {
            DataType::Float64 => {
                let values = arrays.flat_map(|a| a.as_primitive::<Float64Type>().values().iter().copied());
                PyArray1::from_vec(py, values.collect()).into_any()
            }
            DataType::Int64 => {
                let values = arrays.flat_map(|a| a.as_primitive::<Int64Type>().values().iter().copied());
                PyArray1::from_vec(py, values.collect()).into_any()
            }
            DataType::Boolean => {
                let values = arrays.flat_map(|array| array.as_boolean().values().iter());
                PyArray1::from_vec(py, values.collect()).into_any()
            }
            _ => {
                let values = arrays.flat_map(|array| array.as_string::<i32>().iter());
                PyList::new(py, values.collect::<Vec<_>>())?.into_any()
            }
        })
    }

    #[expect(clippy::unused_self, reason = "pickle asks an object")]
    fn __reduce__(&self) -> PyResult<()> {
        Err(not_pickled("a Table", "send `pyarrow.table(table)` or another library's table of it"))
    }

    /// Number of rows.
    fn __len__(&self) -> usize {
        self.batches().map(RecordBatch::num_rows).sum()
    }

    fn __repr__(&self) -> String {
        format!(
            "<echelon.Table {:?}: {} rows, columns {}>",
            self.name,
            self.__len__(),
            self.columns().join(", ")
        )
    }
}
