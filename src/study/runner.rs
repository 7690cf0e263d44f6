//! Doing what is not done yet.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use super::control::{Control, Meter, Summary};
use super::errors::StudyError;
use super::file;
use super::lock::Lock;
use super::record::{Origin, Record};
use super::tables::Tables;
use super::value::{Active, Partial, Value};
use super::{CRATE_VERSION, Study};

/// What all threads of a running study share.
struct Shift<'a> {
    study: &'a Study,
    control: &'a Control<'a>,
    meter: Meter<'a>,
    redone: Mutex<Vec<PathBuf>>,
    /// A thread has met an error: the others stop as if interrupted.
    broken: AtomicBool,
}

impl Study {
    /// Does all values that have no record yet, and writes the tables.
    ///
    /// Ramps are done in parallel with the feature `rayon`, in the pool that this is called from. Interrupted, it returns
    /// with all that was done saved; run again, it goes on, with the same result.
    ///
    /// # Errors
    /// If another process runs the study, files cannot be read or written, records were made by another version, or a
    /// value cannot be started.
    pub fn run(&self, control: &Control<'_>) -> Result<Summary, StudyError> {
        let _lock = Lock::take(self.folder())?;
        let specification = self.specification();
        self.folder.prepare(specification.ramps())?;
        let values = specification.ramps() * specification.values();
        let meter = Meter::new(control, values as u64 * specification.protocol().steps());
        let shift =
            Shift { study: self, control, meter, redone: Mutex::default(), broken: AtomicBool::new(false) };
        for_each_ramp(specification.ramps(), |ramp| {
            shift.ramp(ramp).inspect_err(|_| shift.broken.store(true, Ordering::Relaxed))
        })?;
        let finished = self.write_tables()?;
        let mut redone = shift.redone.into_inner().unwrap_or_else(PoisonError::into_inner);
        redone.sort();
        Ok(Summary { finished, total: values, redone })
    }

    /// Writes the tables, and returns how many records there are.
    fn write_tables(&self) -> Result<usize, StudyError> {
        let mut tables = Tables::new(self.specification.varied().collect());
        let mut finished = 0;
        for record in self.records() {
            tables.add(&record?);
            finished += 1;
        }
        file::write(&self.folder.file("values.csv"), tables.values.as_bytes())?;
        file::write(&self.folder.file("samples.csv"), tables.samples.as_bytes())?;
        file::write(&self.folder.file("profiles.csv"), tables.profiles.as_bytes())?;
        Ok(finished)
    }
}

#[cfg(feature = "rayon")]
fn for_each_ramp<F>(ramps: usize, work: F) -> Result<(), StudyError>
where
    F: Fn(usize) -> Result<(), StudyError> + Send + Sync,
{
    use rayon::prelude::*;
    (0..ramps).into_par_iter().with_max_len(1).try_for_each(work)
}

#[cfg(not(feature = "rayon"))]
fn for_each_ramp<F: Fn(usize) -> Result<(), StudyError>>(ramps: usize, work: F) -> Result<(), StudyError> {
    (0..ramps).try_for_each(work)
}

impl Shift<'_> {
    /// Does a ramp, value after value, as far as it gets.
    fn ramp(&self, ramp: usize) -> Result<(), StudyError> {
        let mut before = None;
        for value in 0..self.study.specification.values() {
            before = match self.known(ramp, value)? {
                Some(record) => Some(record),
                None if self.must_stop() => None,
                None => self.value(ramp, value, before.as_ref())?,
            };
            if before.is_none() {
                return Ok(());
            }
        }
        Ok(())
    }

    fn must_stop(&self) -> bool {
        self.control.is_interrupted() || self.broken.load(Ordering::Relaxed)
    }

    /// The record of a value that is finished.
    fn known(&self, ramp: usize, value: usize) -> Result<Option<Record>, StudyError> {
        let record = self.if_sound(self.study.record(ramp, value))?;
        if let Some(record) = &record {
            check_version(&record.origin, &self.study.folder.record(ramp, value))?;
            self.meter.advance(ramp, value, self.study.specification.protocol().steps());
            // A process that was killed just after finishing a value has left this behind.
            file::remove(&self.study.folder.partial(ramp, value))?;
        }
        Ok(record)
    }

    /// What a file holds; nothing, if it is damaged.
    fn if_sound<T>(&self, read: Result<Option<T>, StudyError>) -> Result<Option<T>, StudyError> {
        match read {
            Err(StudyError::Damaged { path, reason }) => {
                self.study.folder.log(&format!(r#"{{"damaged":"{}","reason":"{reason}"}}"#, name(&path)))?;
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
        before: Option<&Record>,
    ) -> Result<Option<Record>, StudyError> {
        let study = self.study;
        let started = Instant::now();
        let system = study.specification.system(ramp, value)?;
        let origin = study.origin(ramp, value);
        let plan = Value { specification: &study.specification, origin, system, before };
        let mut active = self.if_sound(self.saved(&plan))?.map_or_else(|| plan.begin(), Ok)?;
        self.meter.advance(ramp, value, active.steps());
        let record = match self.steps(&mut active, ramp, value)? {
            Pause::Done => active.record(),
            Pause::Interrupted => return Ok(None),
            Pause::Failed(error) => active.failed(&error)?,
        };
        file::write_sealed(&study.folder.record(ramp, value), &record)?;
        file::remove(&study.folder.partial(ramp, value))?;
        self.log(&record, started)?;
        Ok(Some(record))
    }

    /// A value half done, as it was saved.
    fn saved<'v>(&self, plan: &'v Value<'_>) -> Result<Option<Active<'v>>, StudyError> {
        let Origin { ramp, value, .. } = plan.origin;
        let path = self.study.folder.partial(ramp, value);
        let Some(partial) = file::read_sealed::<Partial>(&path)? else { return Ok(None) };
        self.study.check_origin(&partial.origin, ramp, value, &path)?;
        check_version(&partial.origin, &path)?;
        plan.go_on(partial).map(Some).map_err(|reason| file::damaged(&path, reason))
    }

    /// Does the steps of a value until it is done, saving it now and then.
    fn steps(&self, active: &mut Active<'_>, ramp: usize, value: usize) -> Result<Pause, StudyError> {
        let path = self.study.folder.partial(ramp, value);
        let mut saved = Instant::now();
        while !active.is_done() {
            if self.must_stop() {
                file::write_sealed(&path, &active.partial())?;
                return Ok(Pause::Interrupted);
            }
            if saved.elapsed() > self.control.save_interval() {
                file::write_sealed(&path, &active.partial())?;
                saved = Instant::now();
            }
            if let Err(error) = active.step() {
                let rest = self.study.specification.protocol().steps() - active.steps();
                self.meter.advance(ramp, value, rest);
                return Ok(Pause::Failed(error));
            }
            self.meter.advance(ramp, value, 1);
        }
        Ok(Pause::Done)
    }

    fn log(&self, record: &Record, started: Instant) -> Result<(), StudyError> {
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

/// That a file was made by this version: a study is all of one.
fn check_version(origin: &Origin, path: &Path) -> Result<(), StudyError> {
    if origin.version == CRATE_VERSION {
        return Ok(());
    }
    Err(StudyError::Version { path: path.to_owned(), found: origin.version.clone(), known: CRATE_VERSION })
}

/// Why the steps of a value came to an end.
enum Pause {
    Done,
    Interrupted,
    Failed(crate::simulation::RunError),
}

/// A file by its name and that of its folder.
fn name(path: &Path) -> String {
    let parts: Vec<_> = path.iter().rev().take(2).map(|part| part.to_string_lossy()).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}
