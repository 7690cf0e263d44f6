//! Playback of runs.

use edmd::boundary::Container;
use edmd::replay::{Replay, Replayed};
use edmd::scheduler::BySize;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{RunError, invalid, or_raised, sentence};
use crate::observer::PyCollision;
use crate::rule::{PyRule, SharedRule};
use crate::simulation::{Engine, PySimulation};

/// A collision with its number, counted from 1.
type Numbered = (u64, PyCollision);

fn numbered(replayed: Replayed) -> Numbered {
    (replayed.number, PyCollision(replayed.collision))
}

/// Returns the result of a run, or the exception that ended it.
fn ran<T>(result: Result<T, edmd::simulation::RunError>) -> PyResult<T> {
    or_raised(result.map_err(|error| RunError::new_err(sentence(&error))))
}

/// A run that can be played back: it keeps copies of the state at intervals `every` (time), and everything in
/// between follows from them, bit for bit.
///
/// It begins with a copy of the simulation. If there are more than 64 copies, it drops every second one.
#[pyclass(name = "Replay", module = "granular_edmd")]
pub(crate) struct PyReplay {
    replay: Replay<SharedRule, Container, BySize>,
    rule: PyRule,
    every: f64,
}

impl PyReplay {
    fn simulation(&self, run: Option<Engine>) -> Option<PySimulation> {
        run.map(|run| PySimulation { run, rule: self.rule.clone() })
    }
}

#[pymethods]
impl PyReplay {
    #[new]
    fn new(simulation: &PySimulation, every: f64) -> PyResult<Self> {
        let replay = Replay::new(simulation.run.clone(), every).map_err(invalid)?;
        Ok(Self { replay, rule: simulation.rule.clone(), every })
    }
    /// Continues the run until an absolute time. Ctrl-C acts between two intervals.
    fn run_until(&mut self, py: Python<'_>, time: f64) -> PyResult<()> {
        loop {
            let next = (self.replay.present().time() + self.every).min(time);
            ran(py.detach(|| self.replay.run_until(next)))?;
            py.check_signals()?;
            if next == time {
                return Ok(());
            }
        }
    }
    /// Returns a simulation with the state at an absolute time, or `None` if the run does not cover it.
    fn at(&self, py: Python<'_>, time: f64) -> PyResult<Option<PySimulation>> {
        Ok(self.simulation(ran(py.detach(|| self.replay.at(time)))?))
    }
    /// Returns a simulation in the state just before the collision with this number, counted from 1, or
    /// `None` if the run had no such collision.
    fn before_collision(&self, py: Python<'_>, number: u64) -> PyResult<Option<PySimulation>> {
        Ok(self.simulation(ran(py.detach(|| self.replay.before_collision(number)))?))
    }
    /// Returns the collisions after `start`, up to and including `end` (absolute times): their numbers and
    /// the collisions.
    fn collisions(&self, py: Python<'_>, start: f64, end: f64) -> PyResult<Vec<Numbered>> {
        let collisions = ran(py.detach(|| self.replay.collisions(start, end)))?;
        Ok(collisions.into_iter().map(numbered).collect())
    }
    /// Returns the last collisions of a disk up to an absolute time, at most `count` of them, in order. The
    /// disk is named by its `id`.
    fn last_collisions_of(
        &self,
        py: Python<'_>,
        id: u64,
        until: f64,
        count: usize,
    ) -> PyResult<Vec<Numbered>> {
        let collisions = ran(py.detach(|| self.replay.last_collisions_of(id, until, count)))?;
        Ok(collisions.into_iter().map(numbered).collect())
    }
    /// Returns the first differences from another run: under "partners", the id of the first disk that meets
    /// different partners, and its collision in each run; under "apart", the id of the first disk that is
    /// farther from its position in the other run than `tolerance` (length), the time and the distance.
    ///
    /// `None` stands for no difference of a kind. The runs must have kept states at the same times.
    fn differences<'py>(
        &self,
        py: Python<'py>,
        other: &Self,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let found = ran(py.detach(|| self.replay.differences(&other.replay, tolerance)))?;
        let found =
            found.ok_or_else(|| RunError::new_err("the two runs kept no states at the same times"))?;
        let differences = PyDict::new(py);
        let partners = found.partners.map(|other| (other.id, other.collisions.map(numbered)));
        differences.set_item("partners", partners)?;
        differences.set_item("apart", found.apart.map(|apart| (apart.id, apart.time, apart.distance)))?;
        Ok(differences)
    }
    fn __repr__(&self) -> String {
        format!("<Replay until time {}>", self.replay.present().time())
    }
}
