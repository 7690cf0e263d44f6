//! Parts as data: dictionaries with the fields of their files, read through the same checks.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyList, PyString};
use pyo3::{PyClass, PyTypeInfo};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::errors::ParameterError;

/// Returns a value as dictionaries, lists, numbers and strings.
pub(crate) fn to_data<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    pythonize::pythonize(py, value).map_err(|error| ParameterError::new_err(error.to_string()))
}

/// Returns the value that such data describe.
pub(crate) fn from_data<T: DeserializeOwned>(data: &Bound<'_, PyAny>) -> PyResult<T> {
    pythonize::depythonize(data).map_err(|error| ParameterError::new_err(error.to_string()))
}

/// Returns data as text: a dictionary with one entry in `snake_case` is a name with its arguments.
pub(crate) fn described(data: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(name) = data.cast::<PyString>() {
        return Ok(format!("{}()", camel_case(name.to_cow()?.as_ref())));
    }
    if let Ok(list) = data.cast::<PyList>() {
        let parts: Vec<String> = list.iter().map(|part| described(&part)).collect::<PyResult<_>>()?;
        return Ok(format!("[{}]", parts.join(", ")));
    }
    let Ok(fields) = data.cast::<PyDict>() else { return Ok(data.repr()?.to_string()) };
    if fields.len() == 1
        && let Some((name, value)) = fields.iter().next()
        && (value.is_instance_of::<PyDict>() || value.is_instance_of::<PyFloat>())
    {
        return Ok(format!("{}({})", camel_case(&name.to_string()), arguments(&value)?));
    }
    Ok(format!("({})", arguments(data)?))
}

/// Returns the entries of a dictionary as arguments.
fn arguments(data: &Bound<'_, PyAny>) -> PyResult<String> {
    let Ok(fields) = data.cast::<PyDict>() else { return Ok(data.repr()?.to_string()) };
    let argument =
        |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| Ok(format!("{name}={}", described(&value)?));
    Ok(fields.iter().map(argument).collect::<PyResult<Vec<_>>>()?.join(", "))
}

fn camel_case(name: &str) -> String {
    let words = name.split('_').map(|word| word[..1].to_uppercase() + &word[1..]);
    words.collect()
}

/// A class whose values are data, as its files hold them.
pub(crate) trait Data: Sized {
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>>;
    fn of_data(data: &Bound<'_, PyAny>) -> PyResult<Self>;
}

/// Returns whether another object of the same class has the same data.
pub(crate) fn are_equal<T>(own: &T, other: &Bound<'_, PyAny>) -> PyResult<bool>
where
    T: Data + PyClass,
{
    let Ok(other) = other.cast::<T>() else { return Ok(false) };
    let py = other.py();
    own.data(py)?.eq(other.try_borrow()?.data(py)?)
}

/// Returns what `pickle` and `copy` need: `from_dict` and its argument.
pub(crate) fn reduced<'py, T>(own: &T, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))>
where
    T: Data + PyTypeInfo,
{
    Ok((py.get_type::<T>().getattr("from_dict")?, (own.data(py)?,)))
}

/// Adds `from_dict`, `to_dict`, `repr`, `==`, `copy` and `pickle` to a class of [`Data`].
macro_rules! data_class {
    ($class:ty) => {
        #[pyo3::pymethods]
        impl $class {
            /// Creates the object from its data, as `to_dict` returns them. The same checks are made.
            #[staticmethod]
            fn from_dict(data: &pyo3::Bound<'_, pyo3::PyAny>) -> pyo3::PyResult<Self> {
                crate::data::Data::of_data(data)
            }
            /// Returns the object as dictionaries, lists, numbers and strings, for example for JSON.
            fn to_dict<'py>(&self, py: pyo3::Python<'py>) -> pyo3::PyResult<pyo3::Bound<'py, pyo3::PyAny>> {
                crate::data::Data::data(self, py)
            }
            fn __eq__(&self, other: &pyo3::Bound<'_, pyo3::PyAny>) -> pyo3::PyResult<bool> {
                crate::data::are_equal(self, other)
            }
            fn __reduce__<'py>(
                &self,
                py: pyo3::Python<'py>,
            ) -> pyo3::PyResult<(pyo3::Bound<'py, pyo3::PyAny>, (pyo3::Bound<'py, pyo3::PyAny>,))> {
                crate::data::reduced(self, py)
            }
        }
    };
}

pub(crate) use data_class;
