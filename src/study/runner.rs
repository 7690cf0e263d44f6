//! Doing what is not done yet.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use super::control::{Control, Meter, Summary};
use super::errors::StudyError;
use super::experiment::Experiment;
use super::file;
use super::measurement::{Active, Partial, Value};
use super::record::{Contents, Origin, Record};
use super::refinement::Step;
use super::{CRATE_VERSION, Study};
use crate::simulation::{RunEnd, RunError};

/// Time between two looks at ramps that others do.
const PATIENCE: Duration = Duration::from_millis(100);

/// What all threads of a running study share.
struct Shift<'a, E: Experiment> {
    study: &'a Study<E>,
    control: &'a Control<'a>,
    meter: Meter<'a>,
    finished: AtomicUsize,
    /// Values that refinements have added.
    more: AtomicUsize,
    redone: Mutex<Vec<PathBuf>>,
    /// Ramps that others do.
    elsewhere: Mutex<Vec<usize>>,
    /// A thread has met an error: the others stop as if interrupted.
    broken: AtomicBool,
}

impl<E: Experiment> Study<E> {
    /// Does all values that have no record yet, and writes the tables.
    ///
    /// Any number of processes may do this at the same time, and [`Self::run_ramp`]: each ramp is done by one of them.
    /// Ramps that others do are waited for, and taken over from a process that was killed. Ramps are done in parallel with
    /// the feature `rayon`, in the pool that this is called from. Interrupted, it returns with all that was done saved; run
    /// again, it goes on, with the same result.
    ///
    /// # Errors
    /// If the plan of the folder has changed, files cannot be read or written, records were made by another version, or a value
    /// cannot be started.
    pub fn run(&self, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.run_ramps((0..self.plan().ramps()).collect(), control)
    }

    /// Does the values of one ramp that have no record yet, and writes the tables if all other ramps are done.
    ///
    /// # Errors
    /// As [`Self::run`]; also if there is no such ramp.
    pub fn run_ramp(&self, ramp: usize, control: &Control<'_>) -> Result<Summary, StudyError> {
        let ramps = self.plan().ramps();
        if ramp >= ramps {
            return Err(StudyError::NoSuchRamp { ramp, ramps });
        }
        self.run_ramps(vec![ramp], control)
    }

    fn run_ramps(&self, ramps: Vec<usize>, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.check_plan()?;
        let total = ramps.len() * self.plan().values();
        let last = ramps.last().copied().unwrap_or(0);
        let is_whole = ramps.len() == self.plan().ramps();
        let shift = Shift::new(self, control, ramps.len());
        let elsewhere = shift.all(ramps)?;
        // A run of the whole study brings back lost tables; one of many tasks that finds all done leaves them.
        if elsewhere.is_empty() && self.is_done(last) && (is_whole || !self.folder.is_complete()) {
            self.write_tables()?;
            self.folder.mark_complete()?;
        }
        let mut redone = shift.redone.into_inner().unwrap_or_else(PoisonError::into_inner);
        redone.sort();
        let total = total + shift.more.into_inner();
        Ok(Summary { finished: shift.finished.into_inner(), total, elsewhere, redone })
    }

    /// Returns whether all ramps are done. Those after `first` are looked at first: they are the last to be done.
    fn is_done(&self, first: usize) -> bool {
        let ramps = self.plan().ramps();
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
        let steps = (ramps * study.plan().values()) as u64 * study.plan().protocol().steps();
        Self {
            study,
            control,
            meter: Meter::new(control, steps),
            finished: AtomicUsize::new(0),
            more: AtomicUsize::new(0),
            redone: Mutex::default(),
            elsewhere: Mutex::default(),
            broken: AtomicBool::new(false),
        }
    }

    /// Does ramps until each is done, by somebody; returns those that others do, if they are not to be waited for.
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

    /// Does a ramp, value after value, as far as it gets.
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
            if value >= self.study.plan.values() {
                self.more.fetch_add(1, Ordering::Relaxed);
                self.meter.extend(self.study.plan.protocol().steps());
            }
            let found = match self.known(ramp, value, step)? {
                Some(record) => Some(record),
                None if self.must_stop() => None,
                None => self.next(ramp, value, step, last)?,
            };
            let Some(record) = found else { return Ok(()) };
            seen.push(record.seen());
            last = Some(record);
            self.finished.fetch_add(1, Ordering::Relaxed);
        }
        folder.mark_done(ramp)
    }

    /// Does a value, after that which it comes from: the last one, or one that a bisection goes back to.
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

    /// Returns the record of a value that is finished.
    fn known(&self, ramp: usize, value: usize, step: Step) -> Result<Option<Record<E>>, StudyError> {
        let read = self.study.record(ramp, value).and_then(|record| self.on_the_way(record, step));
        let record = self.if_sound(ramp, read)?;
        if let Some(record) = &record {
            check_version(&record.contents.origin, &self.study.folder.record(ramp, value))?;
            self.meter.advance(ramp, value, self.study.plan().protocol().steps());
            // A process that was killed just after finishing a value has left this behind.
            file::remove(&self.study.folder.partial(ramp, value))?;
        }
        Ok(record)
    }

    /// Returns a record that is of this step; a record before it may have been done again since.
    fn on_the_way(&self, record: Option<Record<E>>, step: Step) -> Result<Option<Record<E>>, StudyError> {
        match record {
            Some(record) if (record.leg(), record.at()) != (step.leg, step.at) => {
                let path = self.study.folder.record(record.ramp(), record.value());
                Err(file::damaged(&path, "it is of another value"))
            }
            record => Ok(record),
        }
    }

    /// Returns what a file holds; nothing, if it is damaged.
    fn if_sound<T>(&self, ramp: usize, read: Result<Option<T>, StudyError>) -> Result<Option<T>, StudyError> {
        match read {
            Err(StudyError::Damaged { path, reason }) => {
                let folder = &self.study.folder;
                folder.mark_undone(ramp)?;
                folder.log(&format!(r#"{{"damaged":"{}","reason":"{reason}"}}"#, name(&path)))?;
                self.redone.lock().unwrap_or_else(PoisonError::into_inner).push(path);
                Ok(None)
            }
            other => other,
        }
    }

    /// Does a value; `None` if it was interrupted.
    fn value(
        &self,
        ramp: usize,
        value: usize,
        step: Step,
        before: Option<&Record<E>>,
    ) -> Result<Option<Record<E>>, StudyError> {
        let study = self.study;
        let started = Instant::now();
        let experiment = study.plan.experiment_at(ramp, step.at)?;
        let origin = study.origin(ramp, value);
        let task = Value { plan: &study.plan, origin, experiment, step, before };
        let mut active = self.if_sound(ramp, self.saved(&task))?.map_or_else(|| task.begin(), Ok)?;
        self.meter.advance(ramp, value, active.steps());
        let record = match self.steps(&mut active, ramp, value)? {
            Pause::Done => active.record(),
            Pause::Interrupted => return Ok(None),
            Pause::Stopped => active.stopped(),
            Pause::Failed(error) => active.failed(&error)?,
        };
        let path = study.folder.record(ramp, value);
        study.folder.mark_incomplete()?;
        file::write_sealed::<Contents<E::Sample, E::Observer>>(&path, &record.contents)?;
        file::remove(&study.folder.partial(ramp, value))?;
        self.log(&record, started)?;
        Ok(Some(record))
    }

    /// Returns a value half done, as it was saved.
    fn saved<'v>(&self, task: &'v Value<'_, E>) -> Result<Option<Active<'v, E>>, StudyError> {
        let Origin { ramp, value, .. } = task.origin;
        let path = self.study.folder.partial(ramp, value);
        let Some(partial) = file::read_sealed::<Partial<E>>(&path)? else { return Ok(None) };
        self.study.check_origin(&partial.0, ramp, value, &path)?;
        check_version(&partial.0, &path)?;
        task.go_on(partial).map(Some).map_err(|reason| file::damaged(&path, reason))
    }

    /// Does the steps of a value until it is done, saving it now and then.
    fn steps(&self, active: &mut Active<'_, E>, ramp: usize, value: usize) -> Result<Pause, StudyError> {
        let path = self.study.folder.partial(ramp, value);
        let save = |active: &Active<'_, E>| file::write_sealed::<Partial<E>>(&path, &active.partial());
        let mut saved = Instant::now();
        while !active.is_done() {
            if self.must_stop() {
                save(active)?;
                return Ok(Pause::Interrupted);
            }
            if saved.elapsed() > self.control.save_interval() {
                save(active)?;
                saved = Instant::now();
            }
            let rest = self.study.plan.protocol().steps() - active.steps();
            let ended = active.step();
            self.meter.advance(ramp, value, if matches!(ended, Ok(RunEnd::Time)) { 1 } else { rest });
            match ended {
                Ok(RunEnd::Time) => {}
                Ok(_) => return Ok(Pause::Stopped),
                Err(error) => return Ok(Pause::Failed(error)),
            }
        }
        Ok(Pause::Done)
    }

    fn log(&self, record: &Record<E>, started: Instant) -> Result<(), StudyError> {
        let unix_time = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
        self.study.folder.log(&format!(
            r#"{{"ramp":{},"value":{},"outcome":"{}","collisions":{},"seconds":{:.3},"unix_time":{unix_time}}}"#,
            record.ramp(),
            record.value(),
            record.outcome().name(),
            record.counters().collisions,
            started.elapsed().as_secs_f64(),
        ))
    }
}

/// Checks that a file was made by this version: a study is all of one.
fn check_version(origin: &Origin, path: &Path) -> Result<(), StudyError> {
    if origin.version == CRATE_VERSION {
        return Ok(());
    }
    Err(StudyError::Version { path: path.to_owned(), found: origin.version.clone(), known: CRATE_VERSION })
}

/// Reason for which the steps of a value came to an end.
enum Pause {
    Done,
    Interrupted,
    Stopped,
    Failed(RunError),
}

/// Returns a file by its name and that of its folder.
fn name(path: &Path) -> String {
    let parts: Vec<_> = path.iter().rev().take(2).map(|part| part.to_string_lossy()).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}
