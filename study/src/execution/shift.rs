//! Data that all threads of a running study share.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::earlier::Earlier;
use super::queue::Queue;
use crate::{Control, Experiment, Progress, Study, StudyError, Summary};

/// Longest time until a thread checks whether it must stop.
pub(super) const LOOK: Duration = Duration::from_millis(200);

/// A run of a study.
pub(super) struct Shift<'a, E: Experiment> {
    pub(super) study: &'a Study<E>,
    pub(super) control: &'a Control<'a>,
    pub(super) earlier: Earlier<E>,
    /// Number of steps that are done, and of those in all values.
    steps: [AtomicU64; 2],
    /// The work that all threads have done.
    summary: Mutex<Summary>,
    /// True once a thread has met an error.
    ///
    /// The others then stop as if interrupted.
    broken: AtomicBool,
    /// True once this run has removed the mark that the study is complete.
    is_opened: AtomicBool,
}

impl<'a, E: Experiment> Shift<'a, E> {
    pub(super) fn new(
        study: &'a Study<E>,
        control: &'a Control<'a>,
        ramps: usize,
    ) -> Result<Self, StudyError> {
        let values = ramps * study.plan().value_count();
        Ok(Self {
            study,
            control,
            earlier: Earlier::open(control.earlier, study.plan())?,
            steps: [0, values as u64 * study.plan().protocol().steps()].map(AtomicU64::new),
            summary: Mutex::new(Summary { total: values, ..Summary::default() }),
            broken: AtomicBool::new(false),
            is_opened: AtomicBool::new(false),
        })
    }

    /// Strikes out the ramps of a queue that are done, and counts them as finished. A verification looks at
    /// all ramps, whatever their marks say.
    pub(super) fn strike_done(&self, queue: &Queue) -> Result<(), StudyError> {
        if self.control.verifies {
            return Ok(());
        }
        let plan = self.study.plan();
        let values = queue.strike(&self.study.folder.marks(queue.ramps.clone())?) * plan.value_count();
        self.count(|summary| summary.finished += values);
        self.steps[0].fetch_add(values as u64 * plan.protocol().steps(), Ordering::Relaxed);
        Ok(())
    }

    /// Counts a value that a refinement adds.
    pub(super) fn count_more(&self) {
        self.count(|summary| summary.total += 1);
        self.steps[1].fetch_add(self.study.plan().protocol().steps(), Ordering::Relaxed);
    }

    /// Counts steps of a value, and reports the progress.
    pub(super) fn advance(&self, ramp: usize, value: usize, steps: u64) {
        let done = self.steps[0].fetch_add(steps, Ordering::Relaxed) + steps;
        if let Some(progress) = self.control.progress {
            progress(&Progress { ramp, value, done, total: self.steps[1].load(Ordering::Relaxed) });
        }
    }

    /// Changes the summary.
    pub(super) fn count(&self, change: impl FnOnce(&mut Summary)) {
        change(&mut self.summary.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Removes the mark that the study is complete, once in a run, before the first value that may not be in
    /// the tables.
    pub(super) fn open_study(&self) -> Result<(), StudyError> {
        if self.is_opened.swap(true, Ordering::Relaxed) {
            return Ok(());
        }
        self.study.folder.mark_incomplete()
    }

    /// Lets all threads stop, since one has met an error.
    pub(super) fn break_off(&self) {
        self.broken.store(true, Ordering::Relaxed);
    }

    pub(super) fn must_stop(&self) -> bool {
        self.control.is_interrupted() || self.broken.load(Ordering::Relaxed)
    }

    /// Sleeps for this time, or until the run must stop.
    pub(super) fn sleep(&self, time: Duration) {
        let start = Instant::now();
        while start.elapsed() < time && !self.must_stop() {
            std::thread::sleep(LOOK.min(time.saturating_sub(start.elapsed())));
        }
    }

    /// Returns the summary of the run.
    pub(super) fn summary(self, elsewhere: Vec<usize>) -> Summary {
        let mut summary = self.summary.into_inner().unwrap_or_else(PoisonError::into_inner);
        summary.elsewhere = elsewhere;
        summary.redone.sort();
        summary
    }
}
