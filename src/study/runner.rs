//! Runs of a study, which do the values that are missing.

mod one_value;

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::Study;
use super::control::{Control, Meter, Summary};
use super::errors::StudyError;
use super::experiment::Experiment;
use super::record::Record;
use super::refinement::Step;

/// Time between two looks at ramps that other processes do.
const PATIENCE: Duration = Duration::from_millis(100);

/// Data that all threads of a running study share.
struct Shift<'a, E: Experiment> {
    study: &'a Study<E>,
    control: &'a Control<'a>,
    meter: Meter<'a>,
    finished: AtomicUsize,
    /// Number of values that the engine could not finish.
    failed: AtomicUsize,
    /// Number of values that refinements have added.
    more: AtomicUsize,
    redone: Mutex<Vec<PathBuf>>,
    /// Ramps that other processes do.
    elsewhere: Mutex<Vec<usize>>,
    /// True once a thread has met an error.
    ///
    /// The others then stop as if interrupted.
    broken: AtomicBool,
}

impl<E: Experiment> Study<E> {
    /// Does all values that have no record yet, and writes the tables.
    ///
    /// Any number of processes may call this and [`Self::run_ramp`] at the same time; one of them does each
    /// ramp. A run waits for ramps that other processes do, and takes over the ramps of a process that was
    /// killed. With the feature `rayon`, it does ramps in parallel, in the thread pool from which it is
    /// called. A run that is interrupted returns with all work saved. The next run goes on from there, with
    /// the same result.
    ///
    /// # Errors
    /// If the plan of the folder has changed, files cannot be read or written, records were made by another
    /// version, or a value cannot be started.
    pub fn run(&self, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.run_ramps((0..self.plan().ramp_count()).collect(), control)
    }

    /// Does the values of one ramp that have no record yet, and writes the tables if all other ramps are
    /// done.
    ///
    /// # Errors
    /// The same as for [`Self::run`], and if there is no such ramp.
    pub fn run_ramp(&self, ramp: usize, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.check_ramp(ramp)?;
        self.run_ramps(vec![ramp], control)
    }

    fn run_ramps(&self, ramps: Vec<usize>, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.check_plan()?;
        let total = ramps.len() * self.plan().value_count();
        let last = ramps.last().copied().unwrap_or(0);
        let is_whole = ramps.len() == self.plan().ramp_count();
        let shift = Shift::new(self, control, ramps.len());
        let elsewhere = shift.all(ramps)?;
        // A run of the whole study writes lost tables again. One of many tasks that finds everything done
        // leaves the tables as they are.
        if elsewhere.is_empty() && self.is_done(last) && (is_whole || !self.folder.is_complete()) {
            self.write_tables()?;
            self.folder.mark_complete()?;
        }
        let mut redone = shift.redone.into_inner().unwrap_or_else(PoisonError::into_inner);
        redone.sort();
        let total = total + shift.more.into_inner();
        let [finished, failed] = [shift.finished, shift.failed].map(AtomicUsize::into_inner);
        Ok(Summary { finished, failed, total, elsewhere, redone })
    }

    /// Returns whether all ramps are done. It looks first at the ramps after `first`, which are the last to
    /// be done.
    fn is_done(&self, first: usize) -> bool {
        let ramps = self.plan().ramp_count();
        (1..=ramps).map(|step| (first + step) % ramps).all(|ramp| self.folder.is_done(ramp))
    }
}

#[cfg(feature = "rayon")]
fn for_each_ramp<F>(ramps: &[usize], work: F) -> Result<(), StudyError>
where
    F: Fn(usize) -> Result<(), StudyError> + Send + Sync,
{
    use rayon::prelude::*;
    ramps.par_iter().with_max_len(1).try_for_each(|&ramp| work(ramp))
}

#[cfg(not(feature = "rayon"))]
fn for_each_ramp<F: Fn(usize) -> Result<(), StudyError>>(ramps: &[usize], work: F) -> Result<(), StudyError> {
    ramps.iter().try_for_each(|&ramp| work(ramp))
}

impl<'a, E: Experiment> Shift<'a, E> {
    fn new(study: &'a Study<E>, control: &'a Control<'a>, ramps: usize) -> Self {
        let steps = (ramps * study.plan().value_count()) as u64 * study.plan().protocol().steps();
        Self {
            study,
            control,
            meter: Meter::new(control, steps),
            finished: AtomicUsize::new(0),
            failed: AtomicUsize::new(0),
            more: AtomicUsize::new(0),
            redone: Mutex::default(),
            elsewhere: Mutex::default(),
            broken: AtomicBool::new(false),
        }
    }

    /// Does ramps until each of them is done, here or elsewhere. If it need not wait, it returns the ramps
    /// that other processes do.
    fn all(&self, mut ramps: Vec<usize>) -> Result<Vec<usize>, StudyError> {
        loop {
            for_each_ramp(&ramps, |ramp| {
                self.ramp(ramp).inspect_err(|_| self.broken.store(true, Ordering::Relaxed))
            })?;
            ramps = std::mem::take(&mut *self.elsewhere.lock().unwrap_or_else(PoisonError::into_inner));
            ramps.sort_unstable();
            if ramps.is_empty() || !self.control.waits() || self.must_stop() {
                return Ok(ramps);
            }
            std::thread::sleep(PATIENCE);
        }
    }

    /// Does a ramp, value after value, until it is done or must stop.
    fn ramp(&self, ramp: usize) -> Result<(), StudyError> {
        if self.must_stop() {
            return Ok(());
        }
        let folder = &self.study.folder;
        let Some(_lock) = folder.take(ramp)? else {
            self.elsewhere.lock().unwrap_or_else(PoisonError::into_inner).push(ramp);
            return Ok(());
        };
        let (mut seen, mut last) = (Vec::new(), None);
        while let Some(step) = self.study.plan.next(&seen) {
            let value = seen.len();
            if value >= self.study.plan.value_count() {
                self.more.fetch_add(1, Ordering::Relaxed);
                self.meter.extend(self.study.plan.protocol().steps());
            }
            let found = match self.known(ramp, value, step)? {
                Some(record) => Some(record),
                None if self.must_stop() => None,
                None => self.next(ramp, value, step, last)?,
            };
            let Some(record) = found else { return Ok(()) };
            self.finished.fetch_add(1, Ordering::Relaxed);
            self.failed.fetch_add(usize::from(record.outcome().reason().is_some()), Ordering::Relaxed);
            seen.push(record.seen());
            last = Some(record);
        }
        folder.mark_done(ramp)
    }

    /// Does a value that starts from the last one, or from the one to which a bisection goes back.
    fn next(
        &self,
        ramp: usize,
        value: usize,
        step: Step,
        last: Option<Record<E>>,
    ) -> Result<Option<Record<E>>, StudyError> {
        let before = match step.before {
            Some(before) if before + 1 < value => self.study.record(ramp, before)?,
            _ => last,
        };
        self.value(ramp, value, step, before.as_ref())
    }

    fn must_stop(&self) -> bool {
        self.control.is_interrupted() || self.broken.load(Ordering::Relaxed)
    }
}
