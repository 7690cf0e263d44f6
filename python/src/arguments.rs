//! Arguments that Python may write in several ways: points, numbers for each disk, times of samples.

use edmd::Kind;
use edmd::boundary::Region;
use edmd::glam::DVec2;
use edmd::observable::SampleTimes;
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLike2, PyArrayLikeDyn, PyArrayMethods};
use pyo3::prelude::*;

use crate::errors::{ParameterError, invalid};

/// A point or a vector: a pair of numbers.
pub(crate) type Pair = (f64, f64);

/// A number for all disks, or an array with a number for each disk.
pub(crate) type Column<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// An array with a row of two numbers for each disk.
pub(crate) type Rows<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;

pub(crate) fn vector((x, y): Pair) -> DVec2 {
    DVec2::new(x, y)
}

pub(crate) fn region((low, high): (Pair, Pair)) -> Region {
    Region::new(vector(low), vector(high))
}

/// Returns the numbers of a column for `count` disks.
pub(crate) fn column(name: &str, column: &Column<'_>, count: usize) -> PyResult<Vec<f64>> {
    let numbers = column.as_array();
    match numbers.shape() {
        [] => Ok(vec![numbers.first().copied().unwrap_or_default(); count]),
        [length] if *length == count => Ok(numbers.iter().copied().collect()),
        shape => {
            let message =
                format!("{name}: an array of shape {shape:?}; needed are {count} numbers, or one for all");
            Err(ParameterError::new_err(message))
        }
    }
}

/// Returns the rows of an array of shape (count, 2).
pub(crate) fn rows(name: &str, rows: &Rows<'_>) -> PyResult<Vec<DVec2>> {
    let numbers = rows.as_array();
    if numbers.ncols() != 2 {
        let message =
            format!("{name}: an array of shape {:?}; needed is (number of disks, 2)", numbers.shape());
        return Err(ParameterError::new_err(message));
    }
    Ok(numbers.rows().into_iter().map(|row| DVec2::new(row[0], row[1])).collect())
}

/// Returns a kind from a number of an array.
pub(crate) fn kind(number: f64) -> PyResult<Kind> {
    if number.fract() != 0.0 || !(0.0..=f64::from(u16::MAX)).contains(&number) {
        return Err(ParameterError::new_err(format!(
            "kind {number}: a whole number from 0 to 65535 is needed"
        )));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above")]
    Ok(Kind::new(number as u16))
}

/// Returns numbers as an array.
pub(crate) fn to_array<T: numpy::Element>(
    py: Python<'_>,
    numbers: impl IntoIterator<Item = T>,
) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, numbers.into_iter().collect())
}

/// Returns vectors as an array of shape (count, 2).
pub(crate) fn to_rows(
    py: Python<'_>,
    vectors: impl IntoIterator<Item = DVec2>,
) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let flat: Vec<f64> = vectors.into_iter().flat_map(|vector| vector.to_array()).collect();
    let count = flat.len() / 2;
    PyArray1::from_vec(py, flat).reshape([count, 2])
}

/// Times of samples, kicks or openings: after each interval, from a first time, or at equal ratios.
///
/// A number in place of it means `SampleTimes(number)`.
#[pyclass(name = "SampleTimes", module = "granular_edmd", frozen)]
#[derive(Clone, Copy)]
pub(crate) struct PySampleTimes(SampleTimes);

#[pymethods]
impl PySampleTimes {
    /// Creates the times after each interval `every`, counted from time 0 or from `start`.
    #[new]
    #[pyo3(signature = (every, *, start=None))]
    fn new(every: f64, start: Option<f64>) -> PyResult<Self> {
        let times = SampleTimes::every(every).map_err(invalid)?;
        start.map_or(Ok(times), |start| times.starting_at(start)).map(Self).map_err(invalid)
    }
    /// Returns the times `first`, `first * ratio`, `first * ratio**2` and so on, as for a gas that cools.
    #[staticmethod]
    fn at_ratio(first: f64, ratio: f64) -> PyResult<Self> {
        SampleTimes::at_ratio(first, ratio).map(Self).map_err(invalid)
    }
    fn __repr__(&self) -> String {
        format!("SampleTimes(every={}, upcoming={})", self.0.interval(), self.0.upcoming())
    }
}

/// An argument `every`: an interval, or `SampleTimes`.
#[derive(Clone, Copy)]
pub(crate) struct Every(pub(crate) SampleTimes);

impl<'py> FromPyObject<'_, 'py> for Every {
    type Error = PyErr;

    fn extract(any: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(times) = any.cast::<PySampleTimes>() {
            return Ok(Self(times.get().0));
        }
        Ok(Self(SampleTimes::every(any.extract()?).map_err(invalid)?))
    }
}
