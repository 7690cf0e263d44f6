//! Runs of a study, which compute the missing values.

mod active;
pub(super) mod control;
mod earlier;
mod queue;
mod ramp;
mod session;
mod sliced;

use std::ops::Range;
use std::sync::atomic::Ordering;
use std::time::Duration;

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::store::blocks;
use super::{Experiment, Study, StudyError};
use control::{Control, Summary};
use queue::Queue;
use session::Session;

/// Shortest and longest time between two checks of the work of other processes. It doubles from check to
/// check, since a process that waits must not burden a file system that others need.
const PATIENCE: [Duration; 2] = [Duration::from_millis(50), Duration::from_secs(5)];

/// Largest number of blocks of other processes that one check tries to take over.
const TRIED: usize = 8;

impl<E: Experiment> Study<E> {
    /// Runs all values that have no record yet, and writes the tables.
    ///
    /// Any number of processes may call this and [`Self::run_ramp`] at the same time; each ramp is run by one
    /// of them. A run waits for ramps of other processes, and takes over the ramps of a process that was
    /// killed. It runs ramps in parallel, in the thread pool of `rayon` from which it is called. A run that
    /// is interrupted returns with all work saved. The next run continues from there, with the same result.
    ///
    /// # Errors
    /// If the plan or the code of the study has changed, files cannot be read or written, or a value cannot
    /// be started.
    pub fn run(&self, control: &Control<'_>) -> Result<Summary, StudyError> {
        let ramps = self.plan().ramp_count();
        self.run_blocks(0..ramps, blocks(ramps), control)
    }

    /// Runs the values of one ramp that have no record yet, and writes the tables if all other ramps are
    /// done.
    ///
    /// It is for engines that give each ramp to one process: if many of them run at a time, two runs of one
    /// ramp may both do it, with the same result.
    ///
    /// # Errors
    /// The same as for [`Self::run`], and if there is no such ramp.
    pub fn run_ramp(&self, ramp: usize, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.check_ramp(ramp)?;
        self.run_blocks(ramp..ramp + 1, std::iter::once(ramp..ramp + 1), control)
    }

    fn run_blocks(
        &self,
        ramps: Range<usize>,
        blocks: impl Iterator<Item = Range<usize>>,
        control: &Control<'_>,
    ) -> Result<Summary, StudyError> {
        self.check_unchanged()?;
        let is_whole = ramps.len() == self.plan().ramp_count();
        let session = Session::new(self, control, ramps)?;
        let elsewhere = all(&session, &Queue::new(blocks))?;
        self.store.sync()?;
        let summary = session.summary(elsewhere)?;
        if control.writes_tables && summary.is_complete() && self.is_done()? {
            self.write_tables_once(is_whole)?;
        }
        Ok(summary)
    }

    /// Writes the tables, unless another process has written them meanwhile. A run of the whole study also
    /// writes lost tables again. If one of many tasks finds everything done, it leaves the tables unchanged.
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

/// Runs blocks until each block is finished, in this process or another. If it need not wait, it returns the
/// ramps of other processes.
fn all<E: Experiment>(session: &Session<'_, E>, queue: &Queue) -> Result<Vec<usize>, StudyError> {
    session.strike_done(queue)?;
    let mut patience = PATIENCE[0];
    loop {
        let threads = (0..rayon::current_num_threads()).into_par_iter().with_max_len(1);
        threads.try_for_each(|_| work(session, queue))?;
        session.strike_done(queue)?;
        let elsewhere = queue.elsewhere();
        if elsewhere.is_empty() || !session.control.waits || session.must_stop() {
            return Ok(elsewhere);
        }
        session.sleep(patience);
        patience = PATIENCE[1].min(2 * patience);
        // The process of these blocks may have been killed.
        queue.retry(TRIED);
    }
}

/// Runs blocks of the queue until it is empty.
fn work<E: Experiment>(session: &Session<'_, E>, queue: &Queue) -> Result<(), StudyError> {
    while !session.must_stop()
        && let Some(ramps) = queue.next()
    {
        if !ramp::attempt(session, &ramps).inspect_err(|_| session.broken.store(true, Ordering::Relaxed))? {
            queue.leave(ramps);
        }
    }
    Ok(())
}
