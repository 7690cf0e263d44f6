//! Watching and stopping a study.

use std::fmt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// Progress of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// Index of the ramp that has just got on.
    pub ramp: usize,
    /// Index of its value.
    pub value: usize,
    /// Steps done in all: about as many as sampling intervals.
    pub done: u64,
    /// Steps of the whole study.
    pub total: u64,
}

/// Means to watch and stop a study; nothing here has an influence on results.
///
/// ```
/// use granular_edmd::study::{Control, Progress};
/// use std::sync::atomic::AtomicBool;
///
/// let stop = AtomicBool::new(false);
/// let show = |progress: &Progress| eprintln!("{} of {}", progress.done, progress.total);
/// let control = Control::default().with_progress(&show).with_interrupt(&stop);
/// # let _ = control;
/// ```
#[derive(Clone, Copy)]
pub struct Control<'a> {
    progress: Option<&'a (dyn Fn(&Progress) + Sync)>,
    interrupt: Option<&'a AtomicBool>,
    save_interval: Duration,
    waits: bool,
}

impl Default for Control<'_> {
    /// Makes the control of a study that nobody watches or stops: values half done are saved every minute,
    /// and ramps that other processes do are waited for.
    fn default() -> Self {
        Self { progress: None, interrupt: None, save_interval: Duration::from_secs(60), waits: true }
    }
}

impl<'a> Control<'a> {
    /// Tells `progress` of every step, from whatever thread did it.
    pub fn with_progress(self, progress: &'a (dyn Fn(&Progress) + Sync)) -> Self {
        Self { progress: Some(progress), ..self }
    }

    /// Stops soon after `interrupt` becomes true, with all that was done saved.
    pub fn with_interrupt(self, interrupt: &'a AtomicBool) -> Self {
        Self { interrupt: Some(interrupt), ..self }
    }

    /// Saves values half done after each interval of this length: that much is lost at most when the process
    /// is killed.
    pub fn with_save_interval(self, interval: Duration) -> Self {
        Self { save_interval: interval, ..self }
    }

    /// Returns at once when all that is left is done by other processes, which may yet be killed;
    /// [`Summary::elsewhere`] names it.
    pub fn without_waiting(self) -> Self {
        Self { waits: false, ..self }
    }

    pub(super) const fn waits(&self) -> bool {
        self.waits
    }

    pub(super) const fn save_interval(&self) -> Duration {
        self.save_interval
    }

    pub(super) fn is_interrupted(&self) -> bool {
        self.interrupt.is_some_and(|interrupt| interrupt.load(Ordering::Relaxed))
    }
}

impl fmt::Debug for Control<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = formatter.debug_struct("Control");
        debug.field("interrupt", &self.interrupt).field("save_interval", &self.save_interval);
        debug.finish_non_exhaustive()
    }
}

/// The outcome of a run of a study.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Summary {
    /// Values that have a record now.
    pub finished: usize,
    /// Values of the study, or of the ramps that were to be run.
    pub total: usize,
    /// Ramps that other processes are doing.
    pub elsewhere: Vec<usize>,
    /// Files that were damaged and have been replaced.
    pub redone: Vec<PathBuf>,
}

impl Summary {
    /// Returns whether all that was to be run is complete.
    pub const fn is_complete(&self) -> bool {
        self.finished == self.total
    }
}

/// Counts the steps of all threads.
pub(super) struct Meter<'a> {
    control: &'a Control<'a>,
    done: AtomicU64,
    total: AtomicU64,
}

impl<'a> Meter<'a> {
    pub(super) const fn new(control: &'a Control<'a>, total: u64) -> Self {
        Self { control, done: AtomicU64::new(0), total: AtomicU64::new(total) }
    }

    /// Takes note of steps that are to be done, too.
    pub(super) fn extend(&self, steps: u64) {
        self.total.fetch_add(steps, Ordering::Relaxed);
    }

    /// Takes note of steps that were done.
    pub(super) fn advance(&self, ramp: usize, value: usize, steps: u64) {
        let done = self.done.fetch_add(steps, Ordering::Relaxed) + steps;
        if let Some(progress) = self.control.progress {
            progress(&Progress { ramp, value, done, total: self.total.load(Ordering::Relaxed) });
        }
    }
}
