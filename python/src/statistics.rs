//! Means with errors.

use edmd::statistics::{Estimate, block_average};
use pyo3::prelude::*;

use crate::arguments::Column;
use crate::data::{Data, data_class, from_data, to_data};
use crate::errors::{ParameterError, invalid};

/// A mean and its standard error, which accounts for correlated samples.
#[pyclass(name = "Estimate", module = "granular_edmd", frozen)]
#[derive(Clone)]
pub(crate) struct PyEstimate(pub(crate) Estimate);

impl Data for PyEstimate {
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_data(py, &self.0)
    }
    fn of_data(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        from_data(data).map(Self)
    }
}

data_class!(PyEstimate);

#[pymethods]
impl PyEstimate {
    /// The mean.
    #[getter]
    fn mean(&self) -> f64 {
        self.0.mean()
    }
    /// The standard error; a lower bound if `is_converged` is false.
    #[getter]
    fn error(&self) -> f64 {
        self.0.standard_error()
    }
    /// The number of samples.
    #[getter]
    fn samples(&self) -> u64 {
        self.0.samples()
    }
    /// The number of independent samples that would have this error.
    #[getter]
    fn independent_samples(&self) -> f64 {
        self.0.independent_samples()
    }
    /// Whether there were enough samples for the error.
    #[getter]
    fn is_converged(&self) -> bool {
        self.0.is_converged()
    }
    fn __float__(&self) -> f64 {
        self.0.mean()
    }
    fn __repr__(&self) -> String {
        self.0.to_string()
    }
}

/// Returns the mean of a series of correlated numbers at equal intervals, with its error from blocks.
#[pyfunction]
#[pyo3(name = "block_average")]
pub(crate) fn averaged(numbers: Column<'_>) -> PyResult<PyEstimate> {
    let numbers = numbers.as_array();
    if numbers.ndim() != 1 {
        let message = format!("numbers: an array of shape {:?}; needed is one dimension", numbers.shape());
        return Err(ParameterError::new_err(message));
    }
    let numbers: Vec<f64> = numbers.iter().copied().collect();
    block_average(&numbers).map(PyEstimate).map_err(invalid)
}
