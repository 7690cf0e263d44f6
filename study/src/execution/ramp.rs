//! One ramp, value after value.

use super::earlier::SameRamps;
use super::shift::Shift;
use crate::folder::{Lock, Mark};
use crate::plan::refinement::{Seen, Step};
use crate::{Experiment, Record, StudyError};

/// The way through a ramp.
pub(super) struct Walk<'a, 's, E: Experiment> {
    pub(super) shift: &'a Shift<'s, E>,
    pub(super) ramp: usize,
    /// True if nothing was ever run here, so no file need be looked for.
    pub(super) is_fresh: bool,
    pub(super) lock: Lock,
    pub(super) earlier: SameRamps<'a, E>,
    pub(super) seen: Vec<Seen>,
    last: Option<Record<E>>,
    /// [`Mark::Failed`] once the engine could not finish a value.
    mark: Mark,
}

/// Runs a ramp until it is done or must stop. Returns false if another process runs it or has done it.
pub(super) fn attempt<E: Experiment>(shift: &Shift<'_, E>, ramp: usize) -> Result<bool, StudyError> {
    let (folder, plan) = (&shift.study.folder, shift.study.plan());
    let Some((lock, is_fresh)) = folder.take(ramp)? else { return Ok(false) };
    if !is_fresh && !shift.control.verifies && folder.marks(ramp..ramp + 1)? != [Mark::Open] {
        return Ok(false);
    }
    let earlier = shift.earlier.ramps(plan.ramp_seed(ramp));
    let (seen, mark) = (Vec::new(), Mark::Done);
    let mut walk = Walk { shift, ramp, is_fresh, lock, earlier, seen, last: None, mark };
    while let Some(step) = plan.next(&walk.seen) {
        if !walk.take(step)? {
            return Ok(true);
        }
    }
    folder.mark(ramp, walk.mark)?;
    Ok(true)
}

impl<E: Experiment> Walk<'_, '_, E> {
    /// Takes a step; returns false if its value was interrupted.
    fn take(&mut self, step: Step) -> Result<bool, StudyError> {
        let value = self.seen.len();
        if value >= self.shift.study.plan().value_count() {
            self.shift.count_more();
        }
        let found = match self.known(step)? {
            None if self.shift.must_stop() => None,
            None => {
                let before = match step.before {
                    // A bisection starts from an earlier value.
                    Some(before) if before + 1 < value => self.shift.study.record(self.ramp, before)?,
                    _ => self.last.take(),
                };
                self.new_value(step, before.as_ref())?
            }
            known => known,
        };
        let Some(record) = found else { return Ok(false) };
        let is_failed = record.outcome().reason().is_some();
        self.mark = if is_failed { Mark::Failed } else { self.mark };
        self.shift.count(|summary| {
            summary.finished += 1;
            summary.failed += usize::from(is_failed);
            summary.warned += usize::from(!record.counters().warnings().is_empty());
        });
        self.seen.push(self.shift.study.plan().seen(&record));
        self.last = Some(record);
        Ok(true)
    }
}
