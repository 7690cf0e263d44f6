//! One ramp, value after value.

use super::shift::Shift;
use super::value;
use crate::study::errors::StudyError;
use crate::study::experiment::Experiment;
use crate::study::experiment::record::Record;
use crate::study::folder::Lock;
use crate::study::plan::refinement::{Seen, Step};

/// Runs a ramp, unless it is done, until it is done or must stop. Returns false if another process runs it.
pub(super) fn attempt<E: Experiment>(shift: &Shift<'_, E>, ramp: usize) -> Result<bool, StudyError> {
    let folder = &shift.study.folder;
    // This costs less than the lock, which somebody else may need.
    if !shift.control.verifies() && folder.is_done(ramp) {
        shift.count_done(1);
        return Ok(true);
    }
    let Some((lock, is_fresh)) = folder.take(ramp)? else { return Ok(false) };
    let mut walk = Walk { shift, ramp, is_fresh, lock, seen: Vec::new(), last: None, failed: Vec::new() };
    while let Some(step) = shift.study.plan().next(&walk.seen) {
        if !walk.take(step)? {
            return Ok(true);
        }
    }
    folder.mark_done(ramp, &walk.failed)?;
    Ok(true)
}

/// The way through a ramp.
struct Walk<'a, 's, E: Experiment> {
    shift: &'a Shift<'s, E>,
    ramp: usize,
    /// True if nothing was ever run here, so no file need be looked for.
    is_fresh: bool,
    lock: Lock,
    seen: Vec<Seen>,
    last: Option<Record<E>>,
    /// Indices of the values that the engine could not finish.
    failed: Vec<usize>,
}

impl<E: Experiment> Walk<'_, '_, E> {
    /// Runs a step; returns false if its value was interrupted.
    fn take(&mut self, step: Step) -> Result<bool, StudyError> {
        let (plan, value) = (self.shift.study.plan(), self.seen.len());
        if value >= plan.value_count() {
            self.shift.count_more();
        }
        let known = if self.is_fresh {
            None
        } else {
            value::known(self.shift, &mut self.lock, self.ramp, value, step)?
        };
        let found = match known {
            Some(record) => Some(record),
            None if self.shift.must_stop() => None,
            None => self.new_value(value, step)?,
        };
        let Some(record) = found else { return Ok(false) };
        let is_failed = record.outcome().reason().is_some();
        self.failed.extend(is_failed.then_some(value));
        self.shift.count_finished(is_failed, !record.counters().warnings().is_empty());
        self.seen.push(Seen::of(&record));
        self.last = Some(record);
        Ok(true)
    }

    /// Runs a value that starts from the last one, or from an earlier one in a bisection.
    fn new_value(&mut self, value: usize, step: Step) -> Result<Option<Record<E>>, StudyError> {
        let before = match step.before {
            Some(before) if before + 1 < value => self.shift.study.record(self.ramp, before)?,
            _ => self.last.take(),
        };
        let task =
            value::Task { ramp: self.ramp, value, step, before: before.as_ref(), is_fresh: self.is_fresh };
        value::done(self.shift, &mut self.lock, &task)
    }
}
