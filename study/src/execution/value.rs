//! One value of a run: read if it is finished, continued if it was begun, and otherwise run from its start.

use std::path::Path;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use granular_edmd::simulation::{RunEnd, RunError};

use super::active::{Active, Partial, Value};
use super::ramp::Walk;
use super::shift::LOOK;
use crate::experiment::record::{Contents, Record};
use crate::folder::{Mark, sealed};
use crate::json::Object;
use crate::plan::refinement::Step;
use crate::{Experiment, StudyError};

/// Shortest piece of a run, so that it advances even if it is saved all the time.
const SHORTEST: Duration = Duration::from_millis(20);

/// Time below which a value is done again in less time than a disk takes to sync its record.
const CHEAP: Duration = Duration::from_millis(20);

/// The reason why a value stopped.
enum Pause {
    Done,
    Interrupted,
    Stopped,
    Failed(RunError),
}

impl<E: Experiment> Walk<'_, '_, E> {
    /// Returns the record of the next value; `None` if the value is not finished.
    pub(super) fn known(&mut self, step: Step) -> Result<Option<Record<E>>, StudyError> {
        if self.is_fresh {
            return Ok(None);
        }
        let (study, ramp, value) = (self.shift.study, self.ramp, self.seen.len());
        let read = study.record(ramp, value).and_then(|record| match record {
            // It may belong to another step, if an earlier value was run again since.
            Some(record) if (record.leg(), record.ramped_value()) != (step.leg, step.at) => {
                Err(sealed::damaged(&study.folder.record(ramp, value), "it is of another value"))
            }
            record => Ok(record),
        });
        let record = self.if_sound(read)?;
        if record.is_some() {
            self.advance(study.plan().protocol().steps());
            // A process that was killed just after it had finished a value may have left this file.
            sealed::remove(&study.folder.partial(ramp, value))?;
        }
        Ok(record)
    }

    /// Runs the next value from a record; `None` if it was interrupted.
    pub(super) fn new_value(
        &mut self,
        step: Step,
        before: Option<&Record<E>>,
    ) -> Result<Option<Record<E>>, StudyError> {
        let (study, started, value) = (self.shift.study, Instant::now(), self.seen.len());
        // A plan of many values has not tried all of them.
        let experiment = study.plan.sound_experiment(&study.plan.parameters_at(self.ramp, step.at))?;
        let origin = study.origin(self.ramp, value);
        let work = Value { plan: &study.plan, origin, experiment, step, before };
        // A damaged one is still there.
        let mut has_partial = !self.is_fresh;
        let mut earlier = self.earlier.next(&study.plan, &self.seen, step)?;
        let taken =
            earlier.take_if(|record| work.is_finished_by(record)).map(|record| work.taken_over(record));
        let is_taken = taken.is_some();
        let record = if let Some(record) = taken {
            self.advance(study.plan.protocol().steps());
            record
        } else {
            let active = match self.saved(&work)? {
                Some(active) => active,
                None => work.begin(earlier)?,
            };
            let Some(record) = self.finished(active, &mut has_partial)? else { return Ok(None) };
            record
        };
        self.shift.open_study()?;
        let path = study.folder.record(self.ramp, value);
        let is_cheap = started.elapsed() < CHEAP;
        sealed::write_sealed::<Contents<E::Sample, E::Observer>>(&path, &record.contents, is_cheap)?;
        if has_partial {
            sealed::remove(&study.folder.partial(self.ramp, value))?;
        }
        self.log(&record, started.elapsed(), is_taken);
        Ok(Some(record))
    }

    /// Returns an unfinished value as it was saved, if there is one.
    fn saved<'v>(&mut self, value: &'v Value<'_, E>) -> Result<Option<Active<'v, E>>, StudyError> {
        if self.is_fresh {
            return Ok(None);
        }
        let (study, index) = (self.shift.study, self.seen.len());
        let path = study.folder.partial(self.ramp, index);
        let read = sealed::read_sealed::<Partial<E>>(&path).and_then(|partial| {
            let Some(partial) = partial else { return Ok(None) };
            study.check_origin(&partial.0, self.ramp, index, &path)?;
            value.go_on(partial).map(Some).map_err(|reason| sealed::damaged(&path, reason))
        });
        self.if_sound(read)
    }

    /// Returns the contents of a file. It logs a damaged file and returns `None`.
    fn if_sound<T>(&mut self, read: Result<Option<T>, StudyError>) -> Result<Option<T>, StudyError> {
        match read {
            Err(StudyError::Damaged { path, reason }) => {
                self.shift.study.folder.mark(self.ramp, Mark::Open)?;
                let line = Object::default().text("damaged", &name(&path)).text("reason", &reason);
                self.lock.append(&line.line());
                self.shift.count(|summary| summary.redone.push(path));
                Ok(None)
            }
            other => other,
        }
    }

    /// Runs a value until it is finished, and returns its record; `None` if it was interrupted.
    fn finished(
        &self,
        mut active: Active<'_, E>,
        has_partial: &mut bool,
    ) -> Result<Option<Record<E>>, StudyError> {
        self.advance(active.steps());
        Ok(Some(match self.steps(&mut active, has_partial)? {
            Pause::Done => active.record(),
            Pause::Interrupted => return Ok(None),
            Pause::Stopped => active.stopped(),
            Pause::Failed(error) => active.failed(&error)?,
        }))
    }

    /// Runs the steps of a value until it is finished, piece by piece, and saves it now and then.
    fn steps(&self, active: &mut Active<'_, E>, has_partial: &mut bool) -> Result<Pause, StudyError> {
        let (control, path) =
            (self.shift.control, self.shift.study.folder.partial(self.ramp, self.seen.len()));
        let mut save = |active: &Active<'_, E>| {
            *has_partial = true;
            sealed::write_sealed::<Partial<E>>(&path, &active.partial(), false)
        };
        let mut saved = Instant::now();
        while !active.is_done() {
            if self.shift.must_stop() {
                save(active)?;
                return Ok(Pause::Interrupted);
            }
            if saved.elapsed() > control.save_interval {
                save(active)?;
                saved = Instant::now();
            }
            let rest = self.shift.study.plan.protocol().steps() - active.steps();
            let until_save = control.save_interval.saturating_sub(saved.elapsed());
            match active.step(until_save.clamp(SHORTEST, LOOK)) {
                Ok(RunEnd::Time) => self.advance(1),
                Ok(RunEnd::WallClock) => {}
                ended => {
                    self.advance(rest);
                    return Ok(ended.map_or_else(Pause::Failed, |_| Pause::Stopped));
                }
            }
        }
        Ok(Pause::Done)
    }

    /// Counts steps of the next value.
    fn advance(&self, steps: u64) {
        self.shift.advance(self.ramp, self.seen.len(), steps);
    }

    fn log(&mut self, record: &Record<E>, time: Duration, is_taken: bool) {
        let unix_time = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
        let line = Object::default().with("ramp", record.ramp_index()).with("value", record.value_index());
        let line = line.text("outcome", record.outcome().name());
        let line =
            record.outcome().reason().into_iter().fold(line, |line, reason| line.text("reason", reason));
        let warnings: Vec<String> = record.counters().warnings().iter().map(ToString::to_string).collect();
        let line = if warnings.is_empty() { line } else { line.text("warnings", &warnings.join("; ")) };
        let line = line.with("collisions", record.counters().disk_collisions);
        let line = if is_taken {
            line.with("taken_over", true)
        } else {
            line.with("seconds", format_args!("{:.3}", time.as_secs_f64()))
        };
        self.lock.append(&line.with("unix_time", unix_time).line());
    }
}

/// Returns the name of a file after the name of its folder.
fn name(path: &Path) -> String {
    let parts: Vec<_> = path.iter().rev().take(2).map(|part| part.to_string_lossy()).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}
