//! The simulation as a Python class.

mod run;
mod samples;

pub(crate) use samples::PySamples;

use std::sync::Arc;

use edmd::boundary::Container;
use edmd::glam::DVec2;
use edmd::simulation::Checkpoint;
use edmd::{Disk, Gravity, Simulation};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arguments::{Every, Pair, vector};
use crate::boundary::PyContainer;
use crate::data::to_data;
use crate::disks::{Disks, disk_columns};
use crate::driving::{PyDriving, PyInlet};
use crate::errors::{ParameterError, invalid, unusable};
use crate::observable::{PyObservable, PySnapshot};
use crate::rule::{AnyRule, PyRule, SharedRule};
use run::{Observers, Wishes};

pub(crate) type Engine = Simulation<SharedRule, Container>;

/// The function `resume` and its arguments, as `pickle` takes them.
type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyBytes>, PyRule, PyContainer));

/// An argument that is gravity: a number, downward, or a vector.
struct AnyGravity(Gravity);

impl<'py> FromPyObject<'_, 'py> for AnyGravity {
    type Error = PyErr;

    fn extract(any: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let gravity = match (any.extract::<f64>(), any.extract::<[f64; 2]>()) {
            (Ok(downward), _) => Gravity::from(downward),
            (_, Ok(vector)) => Gravity::from(DVec2::from(vector)),
            _ => {
                let expected = "a number (downward) or a vector (x, y) is expected as gravity";
                return Err(PyTypeError::new_err(format!("{}: {expected}", any.repr()?)));
            }
        };
        gravity.checked().map(Self).map_err(invalid)
    }
}

/// A system of disks that moves from collision to collision.
///
/// `gravity` (length/time²) as a number points downward; as a vector (x, y) it points where it says, so that
/// `gravity=1.0` is `gravity=(0.0, -1.0)`. `seed` is for thermal walls. The simulation begins at the time
/// `time`.
#[pyclass(name = "Simulation", module = "granular_edmd")]
pub(crate) struct PySimulation {
    pub(crate) run: Engine,
    pub(crate) rule: PyRule,
}

impl PySimulation {
    /// Creates the simulation of parts of the library.
    pub(crate) fn known(
        rule: PyRule,
        boundary: Container,
        disks: Vec<Disk>,
        gravity: Gravity,
        seed: u64,
    ) -> PyResult<Self> {
        let builder = Simulation::builder(rule.rule.clone(), boundary).disks(disks).gravity(gravity);
        Ok(Self { run: builder.seed(seed).build().map_err(invalid)?, rule })
    }

    fn list(&self) -> Vec<Disk> {
        self.run.disks()
    }
}

disk_columns!(PySimulation);

#[pymethods]
impl PySimulation {
    #[new]
    #[pyo3(signature = (rule, boundary, disks, *, gravity=None, seed=0, time=0.0))]
    fn new(
        py: Python<'_>,
        rule: AnyRule,
        boundary: &PyContainer,
        disks: &Disks,
        gravity: Option<AnyGravity>,
        seed: u64,
        time: f64,
    ) -> PyResult<Self> {
        let gravity = gravity.map_or(Gravity::NONE, |gravity| gravity.0);
        let builder = Simulation::builder(rule.0.rule.clone(), boundary.0.clone())
            .disks(disks.0.iter().copied())
            .gravity(gravity)
            .seed(seed)
            .starting_at(time);
        let run = py.detach(|| builder.build()).map_err(invalid)?;
        Ok(Self { run, rule: rule.0 })
    }
    /// Runs until an absolute time, and returns why it ended: "time", "collisions", "wall_clock" or
    /// "observer".
    ///
    /// `observe` is an observer or a list of them, `drive` a driving. `max_collisions` and `max_seconds` end
    /// the run earlier. `progress` is a function of the time, called about twenty times a second.
    ///
    /// Ctrl-C raises KeyboardInterrupt within 0.1 s, and exceptions in functions in Python come through. In
    /// all cases the next run continues with the bits that this one would have had. Other threads of Python
    /// work meanwhile, also on other simulations. Functions that the run calls cannot use this simulation:
    /// they get what they need as an argument.
    #[pyo3(signature = (
        time, *, observe=None, drive=None, max_collisions=None, max_seconds=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn run_until(
        &mut self,
        py: Python<'_>,
        time: f64,
        observe: Option<Observers>,
        drive: Option<Py<PyDriving>>,
        max_collisions: Option<u64>,
        max_seconds: Option<f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<&'static str> {
        run::run(self, py, &Wishes { time, observe, drive, max_collisions, max_seconds, progress })
    }
    /// Runs for a duration (time); otherwise like `run_until`.
    #[pyo3(signature = (
        duration, *, observe=None, drive=None, max_collisions=None, max_seconds=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn run_for(
        &mut self,
        py: Python<'_>,
        duration: f64,
        observe: Option<Observers>,
        drive: Option<Py<PyDriving>>,
        max_collisions: Option<u64>,
        max_seconds: Option<f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<&'static str> {
        let time = self.run.time() + duration;
        run::run(self, py, &Wishes { time, observe, drive, max_collisions, max_seconds, progress })
    }
    /// Runs from sample to sample: `for snapshot in simulation.sample(every=1.0, until=10.0)`.
    #[pyo3(signature = (*, every, until, observe=None, drive=None))]
    fn sample(
        slf: Bound<'_, Self>,
        every: Every,
        until: f64,
        observe: Option<Observers>,
        drive: Option<Py<PyDriving>>,
    ) -> PyResult<PySamples> {
        PySamples::new(slf, every.0, until, observe, drive)
    }
    /// Returns the present value of an observable as a dictionary.
    fn measure<'py>(&self, observable: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let py = observable.py();
        let observable = PyObservable::extract(&observable)
            .ok_or_else(|| PyTypeError::new_err("an observable is expected, such as Energies()"))?;
        observable.measured(py, &self.run.snapshot())
    }
    /// Returns the present state.
    fn snapshot(&self) -> PySnapshot {
        PySnapshot::of(&self.run.snapshot())
    }
    /// The present time.
    #[getter]
    fn time(&self) -> f64 {
        self.run.time()
    }
    /// The number of collisions, of disks with disks or walls, since the start.
    #[getter]
    fn collisions(&self) -> u64 {
        self.run.counters().collisions()
    }
    /// The counts of all kinds of events since the start.
    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_data(py, self.run.counters())
    }
    /// What is suspicious about the run so far, in sentences.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.run.warnings().iter().map(ToString::to_string).collect()
    }
    /// The rule between the disks. It can be set.
    #[getter]
    fn rule(&self) -> PyRule {
        self.rule.clone()
    }
    #[setter]
    fn set_rule(&mut self, rule: AnyRule) {
        self.run.set_rule(rule.0.rule.clone());
        self.rule = rule.0;
    }
    /// The container. It can be set: moving walls take the positions of their motions at the present time.
    #[getter]
    fn boundary(&self) -> PyContainer {
        PyContainer(self.run.boundary().clone())
    }
    #[setter]
    fn set_boundary(&mut self, boundary: PyContainer) -> PyResult<()> {
        self.run.set_boundary(boundary.0).map_err(invalid)
    }
    /// The gravity vector (length/time²). It can be set, to a number (downward) or a vector.
    #[getter]
    fn gravity(&self) -> Pair {
        self.run.gravity().acceleration().into()
    }
    #[setter]
    fn set_gravity(&mut self, gravity: AnyGravity) -> PyResult<()> {
        self.run.set_gravity(gravity.0).map_err(invalid)
    }
    /// The disks. They can be set to the same number of disks.
    #[getter]
    fn disks(&self) -> Disks {
        Disks(self.run.disks())
    }
    #[setter]
    fn set_disks(&mut self, disks: &Disks) -> PyResult<()> {
        let (given, present) = (disks.0.len(), self.run.len());
        if given != present {
            let message = format!("{given} disks for {present}: see insert and remove");
            return Err(ParameterError::new_err(message));
        }
        self.run.map_disks(|index, _| Ok(disks.0[index])).map_err(invalid)
    }
    /// Inserts disks. They have the largest indices.
    fn insert(&mut self, disks: &Disks) -> PyResult<()> {
        self.run.insert(disks.0.iter().copied()).map(drop).map_err(invalid)
    }
    /// Removes the disks where an array of booleans is true, and returns them.
    fn remove(&mut self, mask: Vec<bool>) -> PyResult<Disks> {
        if mask.len() != self.run.len() {
            let message = format!("a mask of {} for {} disks", mask.len(), self.run.len());
            return Err(ParameterError::new_err(message));
        }
        self.run.remove(|index, _| mask[index]).map(Disks).map_err(invalid)
    }
    /// Adds an inlet.
    fn add_inlet(&mut self, inlet: &PyInlet) -> PyResult<()> {
        self.run.add_inlet(inlet.0.clone()).map_err(invalid)
    }
    /// Removes all inlets, and returns them.
    fn remove_inlets(&mut self) -> Vec<PyInlet> {
        self.run.remove_inlets().into_iter().map(PyInlet).collect()
    }
    /// Returns the state as bytes, from which `resume` continues with the same bits.
    fn checkpoint<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.run.checkpoint().to_bytes().map_err(unusable)?))
    }
    /// Continues from a checkpoint, with the same rule and container.
    ///
    /// `seed` gives thermal walls and inlets another seed. Another rule or container must be allowed.
    #[staticmethod]
    #[pyo3(signature = (checkpoint, rule, boundary, *, seed=None, another_rule=false, another_boundary=false))]
    fn resume(
        checkpoint: &[u8],
        rule: AnyRule,
        boundary: &PyContainer,
        seed: Option<u64>,
        another_rule: bool,
        another_boundary: bool,
    ) -> PyResult<Self> {
        let checkpoint = Checkpoint::from_bytes(checkpoint).map_err(unusable)?;
        let mut resumption = Simulation::resume(&checkpoint, Arc::clone(&rule.0.rule), boundary.0.clone());
        if let Some(seed) = seed {
            resumption = resumption.seed(seed);
        }
        if another_rule {
            resumption = resumption.with_another_rule();
        }
        if another_boundary {
            resumption = resumption.with_another_boundary();
        }
        Ok(Self { run: resumption.build().map_err(unusable)?, rule: rule.0 })
    }
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let resume = py.get_type::<Self>().getattr("resume")?;
        Ok((resume, (self.checkpoint(py)?, self.rule.clone(), self.boundary())))
    }
    /// Returns how deeply a disk of this radius at a point would overlap a disk or a wall (length); 0 if
    /// there is room.
    fn overlap(&self, position: Pair, radius: f64) -> PyResult<f64> {
        let disk = Disk::new(vector(position), radius).map_err(invalid)?;
        Ok(self.run.overlap(&disk).map_or(0.0, |overlap| overlap.depth))
    }
    fn __repr__(&self) -> String {
        let (disks, time, collisions) = (self.run.len(), self.run.time(), self.collisions());
        format!("<Simulation of {disks} disks at time {time}, {collisions} collisions>")
    }
}
