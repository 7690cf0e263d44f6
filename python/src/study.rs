//! The paper's vibrated box by its parameters, and studies of it in this process.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use edmd_study::vibrated_box::VibratedBox;
use edmd_study::{Control, Experiment, Plan, Progress, Study, StudyError, Summary};
use pyo3::prelude::*;

use crate::data::from_data;
use crate::errors::{FileError, RunError, invalid, sentence};
use crate::rule::PyRule;
use crate::simulation::PySimulation;

/// Time between two looks for signals.
const PAUSE: Duration = Duration::from_millis(50);

/// Returns the simulation of the paper's box with these parameters, which are the fields of a plan's
/// experiment.
#[pyfunction]
#[pyo3(name = "_vibrated_box")]
pub(crate) fn vibrated_box(parameters: Bound<'_, PyAny>, seed: u64) -> PyResult<PySimulation> {
    let experiment: VibratedBox = from_data(&parameters)?;
    let rule = experiment.rule().map_err(invalid)?;
    let boundary = experiment.boundary().map_err(invalid)?;
    let disks = experiment.disks(seed).map_err(invalid)?;
    PySimulation::known(PyRule::of(rule), boundary, disks, experiment.gravity(), seed)
}

/// Runs the values of a study that are missing, and returns how many have a record and how many there are.
///
/// `progress` is a function of the finished and of all steps.
#[pyfunction]
#[pyo3(name = "_run_study")]
pub(crate) fn run_study(
    py: Python<'_>,
    plan: Bound<'_, PyAny>,
    out: PathBuf,
    progress: Option<Py<PyAny>>,
) -> PyResult<(usize, usize)> {
    let plan: Plan<VibratedBox> = match plan.extract::<String>() {
        Ok(text) => Plan::from_toml(&text).map_err(invalid)?,
        Err(_) => from_data(&plan)?,
    };
    let study = py.detach(|| Study::open_or_create(out, &plan)).map_err(unfinished)?;
    let summary = watched(py, &study, progress.as_ref())?;
    Ok((summary.finished, summary.total))
}

/// Runs a study in threads of its own, while this one looks for signals and tells the progress.
fn watched(py: Python<'_>, study: &Study<VibratedBox>, progress: Option<&Py<PyAny>>) -> PyResult<Summary> {
    let (stop, done, total) = (AtomicBool::new(false), AtomicU64::new(0), AtomicU64::new(0));
    let count = |progress: &Progress| {
        done.fetch_max(progress.done, Ordering::Relaxed);
        total.store(progress.total, Ordering::Relaxed);
    };
    let control = Control::default().with_interrupt(&stop).with_progress(&count);
    let look = || {
        py.check_signals()?;
        let steps = (done.load(Ordering::Relaxed), total.load(Ordering::Relaxed));
        progress.filter(|_| steps.1 > 0).map_or(Ok(()), |progress| progress.call1(py, steps).map(drop))
    };
    thread::scope(|scope| {
        let worker = scope.spawn(|| study.run(&control));
        let mut looked = Ok(());
        while !worker.is_finished() && looked.is_ok() {
            py.detach(|| thread::sleep(PAUSE));
            looked = look();
        }
        stop.store(looked.is_err(), Ordering::Relaxed);
        let summary = py.detach(|| worker.join());
        looked?;
        summary.map_err(|_| RunError::new_err("the study has failed"))?.map_err(unfinished)
    })
}

/// Returns the exception for a study that cannot be run.
fn unfinished(error: StudyError) -> PyErr {
    match error {
        StudyError::Plan(error) => invalid(error),
        error => FileError::new_err(sentence(&error)),
    }
}
