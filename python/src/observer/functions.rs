//! Functions in Python as observers.

use std::ops::ControlFlow;

use edmd::observable::{Collision, Observer, ObserverError, Partner, SampleTimes, Series, Snapshot, Verdict};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{PyObserver, Watch};
use crate::arguments::{Every, to_array};
use crate::errors::call;
use crate::observable::{PyObservable, PySnapshot};
use crate::rule::PyContact;

/// Use of what a function returns.
enum Use {
    Keep { times: Vec<f64>, values: Vec<Py<PyAny>> },
    Stop,
    Nothing,
}

/// A function of snapshots.
struct OnSamples {
    function: Py<PyAny>,
    clock: SampleTimes,
    answers: Use,
    verdict: Option<Result<(), ObserverError>>,
}

/// Returns the error that ends the run. The run raises the exception itself.
fn raised() -> ObserverError {
    ObserverError::new("a function in Python raised an exception")
}

impl OnSamples {
    fn of(function: Bound<'_, PyAny>, every: Every, answers: Use) -> PyResult<PyObserver> {
        if !function.is_callable() {
            return Err(PyTypeError::new_err(format!(
                "{}: a function of a snapshot is needed",
                function.repr()?
            )));
        }
        let function = function.unbind();
        Ok(PyObserver::of(Self { function, clock: every.0, answers, verdict: None }))
    }
}

impl Observer for OnSamples {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.clock.start_at(start.time());
        Ok(())
    }
    fn next_sample(&self) -> f64 {
        self.clock.upcoming()
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.clock.advance_past(snapshot.time());
        let seen = PySnapshot::of(snapshot);
        let answer = call(|py| {
            let answer = self.function.call1(py, (seen,))?;
            let stops = matches!(self.answers, Use::Stop) && answer.is_truthy(py)?;
            Ok((answer, stops))
        });
        let Some((answer, stops)) = answer else {
            self.verdict = Some(Err(raised()));
            return;
        };
        if let Use::Keep { times, values } = &mut self.answers {
            times.push(snapshot.time());
            values.push(answer);
        }
        self.verdict = stops.then_some(Ok(()));
    }
    fn verdict(&mut self) -> Verdict {
        self.verdict.take().map_or(Ok(ControlFlow::Continue(())), |stop| stop.map(ControlFlow::Break))
    }
}

impl Watch for OnSamples {
    /// Returns the times, and the values as arrays: by key if they are dictionaries, and otherwise as
    /// "value".
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Use::Keep { times, values } = &self.answers else {
            return Err(PyTypeError::new_err("this observer has no table"));
        };
        let columns = PyDict::new(py);
        columns.set_item("time", to_array(py, times.iter().copied()))?;
        let asarray = py.import("numpy")?.getattr("asarray")?;
        let Some(first) = values.first().and_then(|value| value.bind(py).cast::<PyDict>().ok()) else {
            let values: Vec<_> = values.iter().map(|value| value.bind(py)).collect();
            columns.set_item("value", asarray.call1((values,))?)?;
            return Ok(columns);
        };
        for key in first.keys() {
            let column = values.iter().map(|value| value.bind(py).get_item(&key));
            columns.set_item(&key, asarray.call1((column.collect::<PyResult<Vec<_>>>()?,))?)?;
        }
        Ok(columns)
    }
}

/// Returns a series: an observable, several in a list, or the values of a function of a `Snapshot`, over
/// time.
///
/// The table of a function has the columns `time` and `value`, or the keys of the dictionaries that it
/// returns. A sample by a function takes some 10 µs.
#[pyfunction]
#[pyo3(name = "Series")]
pub(crate) fn series(observable: Bound<'_, PyAny>, every: Every) -> PyResult<PyObserver> {
    if let Some(observable) = PyObservable::extract(&observable) {
        return Ok(PyObserver::of(Series::new(observable, every.0)));
    }
    OnSamples::of(observable, every, Use::Keep { times: Vec::new(), values: Vec::new() })
}

/// Returns an observer that calls a function of a `Snapshot` at set times.
#[pyfunction]
#[pyo3(name = "OnSample")]
pub(crate) fn on_sample(function: Bound<'_, PyAny>, every: Every) -> PyResult<PyObserver> {
    OnSamples::of(function, every, Use::Nothing)
}

/// Returns an observer that stops the run once a function of a `Snapshot` returns true at a set time.
#[pyfunction]
#[pyo3(name = "StopWhen")]
pub(crate) fn stop_when(function: Bound<'_, PyAny>, every: Every) -> PyResult<PyObserver> {
    OnSamples::of(function, every, Use::Stop)
}

/// A collision that has just happened.
#[pyclass(name = "Collision", module = "granular_edmd", frozen)]
pub(crate) struct PyCollision(pub(crate) Collision);

#[pymethods]
impl PyCollision {
    /// The time.
    #[getter]
    fn time(&self) -> f64 {
        self.0.time
    }
    /// The index of the disk.
    #[getter]
    fn disk(&self) -> usize {
        self.0.disk
    }
    /// The index of the other disk, or `None` for a wall.
    #[getter]
    fn partner(&self) -> Option<usize> {
        if let Partner::Disk(partner) = self.0.partner { Some(partner) } else { None }
    }
    /// The index of the wall, or `None` for a disk.
    #[getter]
    fn wall(&self) -> Option<usize> {
        if let Partner::Wall(wall) = self.0.partner { Some(wall) } else { None }
    }
    /// The id of the disk, and the id of the other disk, or `None` for a wall.
    #[getter]
    fn ids(&self) -> (u64, Option<u64>) {
        let [disk, partner] = self.0.ids;
        (disk, matches!(self.0.partner, Partner::Disk(_)).then_some(partner))
    }
    /// The contact before the collision.
    #[getter]
    fn contact(&self) -> PyContact {
        PyContact(self.0.contact)
    }
    /// The position of the disk (length).
    #[getter]
    fn position(&self) -> (f64, f64) {
        self.0.position.into()
    }
    /// The unit vector from the partner to the disk.
    #[getter]
    fn normal(&self) -> (f64, f64) {
        self.0.normal.into()
    }
    /// The normal and the tangential impulse (mass length/time).
    #[getter]
    fn impulse(&self) -> (f64, f64) {
        (self.0.impulse.normal(), self.0.impulse.tangential())
    }
    /// The change of the kinetic energy; negative if it is lost.
    #[getter]
    fn energy_change(&self) -> f64 {
        self.0.energy_change
    }
    fn __repr__(&self) -> String {
        let partner = self.partner().map_or_else(
            || format!("wall {}", self.wall().unwrap_or_default()),
            |partner| format!("disk {partner}"),
        );
        format!("<Collision of disk {} with {partner} at time {}>", self.0.disk, self.0.time)
    }
}

/// A function of each collision.
struct OnCollisions {
    function: Py<PyAny>,
    has_raised: bool,
}

impl Observer for OnCollisions {
    fn on_collision(&mut self, collision: &Collision) {
        let called = call(|py| self.function.call1(py, (PyCollision(*collision),)));
        self.has_raised |= called.is_none();
    }
    fn verdict(&mut self) -> Verdict {
        if std::mem::take(&mut self.has_raised) { Err(raised()) } else { Ok(ControlFlow::Continue(())) }
    }
}

impl Watch for OnCollisions {}

/// Returns an observer that calls a function of each `Collision`, which takes about 0.2 µs more for each.
#[pyfunction]
#[pyo3(name = "OnCollision")]
pub(crate) fn on_collision(function: Py<PyAny>) -> PyObserver {
    PyObserver::of(OnCollisions { function, has_raised: false })
}
