//! Runs of a study, which do the values that are missing.

mod active;
pub(super) mod control;
mod earlier;
mod queue;
mod ramp;
mod shift;
mod sliced;
mod value;

use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::folder::Mark;
use super::{Experiment, Study, StudyError};
use control::{Control, Summary};
use queue::Queue;
use shift::Shift;

/// Shortest and longest time between two looks at the ramps of other processes. It doubles from look to look,
/// since a process that waits must not burden a file system that others need.
const PATIENCE: [Duration; 2] = [Duration::from_millis(50), Duration::from_secs(5)];

/// Largest number of ramps of other processes that one look tries to take over.
const TRIED: usize = 8;

/// Number of marks that are read in the time that a vain try of a ramp takes.
const MARKS: usize = 10_000;

impl<E: Experiment> Study<E> {
    /// Runs all values that have no record yet, and writes the tables.
    ///
    /// Any number of processes may call this and [`Self::run_ramp`] at the same time; each ramp is run by one
    /// of them. A run waits for ramps of other processes, and takes over the ramps of a process that was
    /// killed. It runs ramps in parallel, in the thread pool from which it is
    /// called. A run that is interrupted returns with all work saved. The next run continues from there, with
    /// the same result.
    ///
    /// # Errors
    /// If plan or code of the study have changed, files cannot be read or written, or a value cannot be
    /// started.
    pub fn run(&self, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.run_ramps(0..self.plan().ramp_count(), control)
    }

    /// Runs the values of one ramp that have no record yet, and writes the tables if all other ramps are
    /// done.
    ///
    /// # Errors
    /// The same as for [`Self::run`], and if there is no such ramp.
    pub fn run_ramp(&self, ramp: usize, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.check_ramp(ramp)?;
        self.run_ramps(ramp..ramp + 1, control)
    }

    fn run_ramps(&self, ramps: Range<usize>, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.check_unchanged()?;
        let count = self.plan().ramp_count();
        let is_whole = ramps.len() == count;
        let shift = Shift::new(self, control, ramps.len())?;
        let elsewhere = all(&shift, ramps)?;
        let summary = shift.summary(elsewhere);
        if control.writes_tables
            && summary.is_complete()
            && !self.folder.marks(0..count)?.contains(&Mark::Open)
        {
            self.write_tables_once(is_whole)?;
        }
        Ok(summary)
    }

    /// Writes the tables, unless another process has done so meanwhile. A run of the whole study also writes
    /// lost tables again. If one of many tasks finds everything done, it leaves the tables as they are.
    fn write_tables_once(&self, is_whole: bool) -> Result<(), StudyError> {
        let is_there = || if is_whole { self.has_tables() } else { self.folder.is_complete() };
        if is_there() {
            return Ok(());
        }
        let _lock = self.folder.lock()?;
        if is_there() {
            return Ok(());
        }
        self.tables(self.folder())?;
        self.folder.mark_complete()
    }
}

/// Runs ramps until each of them is done, here or elsewhere. If it need not wait, it returns the ramps of
/// other processes.
fn all<E: Experiment>(shift: &Shift<'_, E>, ramps: Range<usize>) -> Result<Vec<usize>, StudyError> {
    let queue = Queue::new(ramps);
    shift.strike_done(&queue)?;
    let mut patience = PATIENCE[0];
    loop {
        work_in_parallel(shift, &queue)?;
        shift.strike_done(&queue)?;
        let elsewhere = queue.elsewhere();
        if elsewhere.is_empty() || !shift.control.waits || shift.must_stop() {
            return Ok(elsewhere);
        }
        shift.sleep(patience);
        patience = PATIENCE[1].min(2 * patience);
        // Their process may have been killed.
        queue.retry(TRIED);
    }
}

fn work_in_parallel<E: Experiment>(shift: &Shift<'_, E>, queue: &Queue) -> Result<(), StudyError> {
    let failed = Mutex::new(None);
    rayon::scope(|scope| {
        for _ in 0..rayon::current_num_threads() {
            scope.spawn(|_| {
                if let Err(error) = work(shift, queue) {
                    failed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                }
            });
        }
    });
    failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

/// Does ramps of the queue until it is empty. Where it meets other processes, it looks at what they have
/// done.
fn work<E: Experiment>(shift: &Shift<'_, E>, queue: &Queue) -> Result<(), StudyError> {
    let mut met = 0;
    while !shift.must_stop()
        && let Some(ramp) = queue.next()
    {
        if ramp::attempt(shift, ramp).inspect_err(|_| shift.break_off())? {
            continue;
        }
        queue.leave(ramp);
        met += 1;
        if met * MARKS >= queue.ramps.len() {
            shift.strike_done(queue)?;
            met = 0;
        }
    }
    Ok(())
}
