//! Runs as iterators over samples.

use edmd::observable::SampleTimes;
use pyo3::prelude::*;

use super::PySimulation;
use super::run::{self, Observers, Wishes};
use crate::driving::PyDriving;
use crate::observable::PySnapshot;

/// Relative rounding error of the end of a run, which then counts as the time of the last sample.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The samples of a run, as `sample` of a simulation returns them. Each step runs to the next sample.
#[pyclass(name = "Samples", module = "granular_edmd")]
pub(crate) struct PySamples {
    simulation: Py<PySimulation>,
    times: SampleTimes,
    until: f64,
    wishes: Wishes,
}

impl PySamples {
    pub(super) fn new(
        simulation: Bound<'_, PySimulation>,
        mut times: SampleTimes,
        until: f64,
        observe: Option<Observers>,
        drive: Option<Py<PyDriving>>,
    ) -> PyResult<Self> {
        times.start_at(simulation.try_borrow()?.run.time());
        let wishes =
            Wishes { time: until, observe, drive, max_collisions: None, max_seconds: None, progress: None };
        Ok(Self { simulation: simulation.unbind(), times, until, wishes })
    }
}

#[pymethods]
impl PySamples {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }
    /// Runs to the next sample and returns it. After the last one, the run continues to its end.
    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<PySnapshot>> {
        let mut simulation = self.simulation.bind(py).try_borrow_mut()?;
        let next = self.times.upcoming();
        let is_last = next > self.until + ROUNDING * self.until.abs();
        self.wishes.time = if is_last { self.until } else { next };
        let end = run::run(&mut simulation, py, &self.wishes)?;
        if is_last || end != "time" {
            self.times.advance_past(f64::MAX);
            return Ok(None);
        }
        self.times.advance_past(next);
        Ok(Some(PySnapshot::of(&simulation.run.snapshot())))
    }
}
