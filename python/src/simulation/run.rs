//! Runs in slices, between which Python handles signals.

use std::time::{Duration, Instant};

use edmd::simulation::{Limits, RunEnd};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use super::{Engine, PySimulation};
use crate::driving::{BoxedDriving, PyDriving};
use crate::errors::{ParameterError, RunError, or_raised, sentence};
use crate::observer::{PyObserver, Watch, absent};

/// Wall-clock time of a slice.
const SLICE: Duration = Duration::from_millis(50);

/// An observer, or several.
pub(super) enum Observers {
    One(Py<PyObserver>),
    Several(Vec<Py<PyObserver>>),
}

impl<'py> FromPyObject<'_, 'py> for Observers {
    type Error = PyErr;

    fn extract(any: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(one) = any.extract() {
            return Ok(Self::One(one));
        }
        let expected =
            "an observer or a list of them is expected; Series(…, every=…) makes one of an observable";
        let expected = format!("{}: {expected} or a function", any.repr()?);
        any.extract().map(Self::Several).map_err(|_| PyTypeError::new_err(expected))
    }
}

impl Observers {
    fn list(&self) -> &[Py<PyObserver>] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Several(several) => several,
        }
    }
}

/// The arguments of a run.
pub(super) struct Wishes {
    pub(super) time: f64,
    pub(super) observe: Option<Observers>,
    pub(super) drive: Option<Py<PyDriving>>,
    pub(super) max_collisions: Option<u64>,
    pub(super) max_seconds: Option<f64>,
    pub(super) progress: Option<Py<PyAny>>,
}

/// The observers and the driving of a run, taken out of their objects. They are put back in the end.
#[derive(Default)]
struct Lent<'py> {
    observers: Vec<Bound<'py, PyObserver>>,
    watches: Vec<Box<dyn Watch>>,
    driver: Option<Bound<'py, PyDriving>>,
    driving: Option<BoxedDriving>,
}

impl<'py> Lent<'py> {
    fn take(&mut self, py: Python<'py>, wishes: &Wishes) -> PyResult<()> {
        for observer in wishes.observe.iter().flat_map(Observers::list) {
            let observer = observer.bind(py);
            let watch = observer.try_borrow_mut()?.0.take().ok_or_else(absent)?;
            self.observers.push(observer.clone());
            self.watches.push(watch);
        }
        if let Some(driver) = wishes.drive.as_ref().map(|driver| driver.bind(py)) {
            self.driving = Some(driver.try_borrow_mut()?.0.take().ok_or_else(absent)?);
            self.driver = Some(driver.clone());
        }
        Ok(())
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        for (observer, watch) in self.observers.iter().zip(self.watches.drain(..)) {
            observer.borrow_mut().0 = Some(watch);
        }
        if let Some(driver) = &self.driver {
            driver.borrow_mut().0 = self.driving.take();
        }
    }
}

/// Runs a simulation, and returns the name of what ended the run.
pub(super) fn run(simulation: &mut PySimulation, py: Python<'_>, wishes: &Wishes) -> PyResult<&'static str> {
    let mut lent = Lent::default();
    lent.take(py, wishes)?;
    let deadline = wishes.max_seconds.map(|seconds| {
        let seconds = Duration::try_from_secs_f64(seconds);
        seconds.map_err(|_| ParameterError::new_err("max_seconds: a number that is not negative is needed"))
    });
    let (start, deadline) = (Instant::now(), deadline.transpose()?);
    let first = simulation.run.counters().collisions();
    loop {
        let left = deadline.map_or(SLICE, |deadline| deadline.saturating_sub(start.elapsed()));
        let done = simulation.run.counters().collisions() - first;
        let limits = Limits::until(wishes.time)
            .with_wall_clock(left.min(SLICE))
            .with_most_collisions(wishes.max_collisions.map_or(u64::MAX, |most| most.saturating_sub(done)));
        let end = slice(&mut simulation.run, py, &limits, &mut lent)?;
        py.check_signals()?;
        if let Some(progress) = &wishes.progress {
            progress.call1(py, (simulation.run.time(),))?;
        }
        if end != RunEnd::WallClock || left < SLICE {
            return Ok(name(end));
        }
    }
}

fn slice(run: &mut Engine, py: Python<'_>, limits: &Limits<'_>, lent: &mut Lent<'_>) -> PyResult<RunEnd> {
    let Lent { watches, driving, .. } = lent;
    let end = py.detach(|| match driving {
        Some(driving) => run.run_driven(limits, &mut **driving, watches),
        None if watches.is_empty() => run.run(limits, &mut ()),
        None => run.run(limits, watches),
    });
    or_raised(end.map_err(|error| RunError::new_err(sentence(&error))))
}

fn name(end: RunEnd) -> &'static str {
    match end {
        RunEnd::Time => "time",
        RunEnd::Collisions => "collisions",
        RunEnd::WallClock => "wall_clock",
        RunEnd::Observer => "observer",
        _ => "interrupted",
    }
}
