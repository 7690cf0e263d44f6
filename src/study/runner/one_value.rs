//! One value of a run: it is read if it is finished, continued if it was begun, and else done from its start.

use std::path::Path;
use std::sync::PoisonError;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use super::Shift;
use crate::simulation::{RunEnd, RunError};
use crate::study::errors::StudyError;
use crate::study::experiment::Experiment;
use crate::study::measurement::{Active, Partial, Value};
use crate::study::record::{Contents, Origin, Record};
use crate::study::refinement::Step;
use crate::study::{CRATE_VERSION, file};

/// The reason why the steps of a value came to an end.
enum Pause {
    Done,
    Interrupted,
    Stopped,
    Failed(RunError),
}

impl<E: Experiment> Shift<'_, E> {
    /// Returns the record of a value; `None` if the value is not finished.
    pub(super) fn known(
        &self,
        ramp: usize,
        value: usize,
        step: Step,
    ) -> Result<Option<Record<E>>, StudyError> {
        let read = self.study.record(ramp, value).and_then(|record| self.on_the_way(record, step));
        let record = self.if_sound(ramp, read)?;
        if let Some(record) = &record {
            check_version(&record.contents.origin, &self.study.folder.record(ramp, value))?;
            self.meter.advance(ramp, value, self.study.plan().protocol().steps());
            // A process that was killed just after finishing a value may have left this behind.
            file::remove(&self.study.folder.partial(ramp, value))?;
        }
        Ok(record)
    }

    /// Checks that a record belongs to this step. It may not, if a record before it has been done again
    /// since.
    fn on_the_way(&self, record: Option<Record<E>>, step: Step) -> Result<Option<Record<E>>, StudyError> {
        match record {
            Some(record) if (record.leg(), record.ramped_value()) != (step.leg, step.at) => {
                let path = self.study.folder.record(record.ramp_index(), record.value_index());
                Err(file::damaged(&path, "it is of another value"))
            }
            record => Ok(record),
        }
    }

    /// Returns the contents of a file. It logs a damaged file and returns `None`.
    fn if_sound<T>(&self, ramp: usize, read: Result<Option<T>, StudyError>) -> Result<Option<T>, StudyError> {
        match read {
            Err(StudyError::Damaged { path, reason }) => {
                let folder = &self.study.folder;
                folder.mark_undone(ramp)?;
                folder.log(&format!(r#"{{"damaged":"{}","reason":"{}"}}"#, name(&path), in_json(&reason)))?;
                self.redone.lock().unwrap_or_else(PoisonError::into_inner).push(path);
                Ok(None)
            }
            other => other,
        }
    }

    /// Does a value; `None` if it was interrupted.
    pub(super) fn value(
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

    /// Returns an unfinished value as it was saved, if there is one.
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
        let reason = record.outcome().reason().map(|reason| format!(r#","reason":"{}""#, in_json(reason)));
        self.study.folder.log(&format!(
            r#"{{"ramp":{},"value":{},"outcome":"{}"{},"collisions":{},"seconds":{:.3},"unix_time":{unix_time}}}"#,
            record.ramp_index(),
            record.value_index(),
            record.outcome().name(),
            reason.unwrap_or_default(),
            record.counters().disk_collisions,
            started.elapsed().as_secs_f64(),
        ))
    }
}

/// Checks that this version made a file, since one version does a whole study.
fn check_version(origin: &Origin, path: &Path) -> Result<(), StudyError> {
    if origin.version == CRATE_VERSION {
        return Ok(());
    }
    Err(StudyError::Version { path: path.to_owned(), found: origin.version.clone(), known: CRATE_VERSION })
}

/// Returns a reason as JSON can hold it: one line of text, in which characters that have a meaning in JSON
/// are replaced.
fn in_json(reason: &str) -> String {
    reason.replace(['"', '\\'], "'").replace(char::is_control, " ")
}

/// Returns the name of a file after the name of its folder.
fn name(path: &Path) -> String {
    let parts: Vec<_> = path.iter().rev().take(2).map(|part| part.to_string_lossy()).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}
