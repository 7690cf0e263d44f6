//! Watching and stopping a study.

use std::fmt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use granular_edmd::ParameterError;
use granular_edmd::quantity::positive;

/// Progress of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// Index of the ramp that has just made progress.
    pub ramp: usize,
    /// Index of the value in the ramp.
    pub value: usize,
    /// Number of finished steps in all ramps; a step is about one sampling interval.
    pub done: u64,
    /// Number of all steps, finished or not, of the ramps to be run.
    pub total: u64,
}

/// Means to watch and stop a study. None of them influences results.
///
/// ```
/// use granular_edmd_study::{Control, Progress};
/// use std::sync::atomic::AtomicBool;
///
/// let stop = AtomicBool::new(false);
/// let show = |progress: &Progress| eprintln!("{} of {}", progress.done, progress.total);
/// let control = Control::default().with_progress(&show).with_interrupt(&stop);
/// # let _ = control;
/// ```
#[derive(Clone, Copy)]
pub struct Control<'a> {
    pub(super) progress: Option<&'a (dyn Fn(&Progress) + Sync)>,
    interrupt: Option<&'a AtomicBool>,
    pub(super) earlier: &'a [PathBuf],
    pub(super) save_interval: Duration,
    pub(super) most_seconds: Option<f64>,
    pub(super) waits: bool,
    pub(super) writes_tables: bool,
    pub(super) verifies: bool,
}

impl Default for Control<'_> {
    /// Creates the control of a study that is neither watched nor stopped. The study saves unfinished values
    /// every minute, and waits for ramps that other processes run.
    fn default() -> Self {
        Self {
            progress: None,
            interrupt: None,
            earlier: &[],
            save_interval: Duration::from_secs(60),
            most_seconds: None,
            waits: true,
            writes_tables: true,
            verifies: false,
        }
    }
}

impl<'a> Control<'a> {
    /// Returns the same control, which calls `progress` after every step, in the thread that ran the step.
    pub fn with_progress(self, progress: &'a (dyn Fn(&Progress) + Sync)) -> Self {
        Self { progress: Some(progress), ..self }
    }

    /// Returns the same control, which saves all work and stops within a second after `interrupt` becomes
    /// true, however long a sampling interval takes.
    ///
    /// A very large system takes longer to be saved, and nothing stops it while it is set up.
    pub fn with_interrupt(self, interrupt: &'a AtomicBool) -> Self {
        Self { interrupt: Some(interrupt), ..self }
    }

    /// Returns the same control with reuse of the values that earlier studies in these folders have finished.
    ///
    /// In this way, a study grows into a new folder, or the parts of a sweep become one study. The plans may
    /// differ in the values of their axes and in repeats. A ramp may have more values at its end. If this
    /// plan has more samples, a value continues from its end, provided that its record keeps the state
    /// ([`Plan::with_end_states`](crate::Plan::with_end_states)). Anything else that differs is an error. The
    /// study gets the same bytes as without the earlier ones. Values from other code that an earlier study
    /// accepted are computed again.
    #[doc(alias("grow", "merge", "extend"))]
    pub fn with_earlier_studies(self, folders: &'a [PathBuf]) -> Self {
        Self { earlier: folders, ..self }
    }

    /// Returns the same control, which saves unfinished values after each interval of this length.
    ///
    /// A process that is killed loses no more than the work since the last save.
    #[doc(alias = "checkpoint")]
    pub fn with_save_interval(self, interval: Duration) -> Self {
        Self { save_interval: interval, ..self }
    }

    /// Returns the same control, which ends each value that takes more than this wall-clock time, with
    /// [`Outcome::Limited`](crate::Outcome::Limited).
    ///
    /// The values that end in this way depend on the machine. Such a value counts as failed: its record stays
    /// until [`Study::forget_failed`](crate::Study::forget_failed). A limit that gives the same result
    /// everywhere is [`Protocol::with_most_collisions`](crate::Protocol::with_most_collisions). The time of a
    /// value that was interrupted counts from its resumption.
    ///
    /// # Errors
    /// If the time is not positive.
    pub fn with_most_seconds(self, seconds: f64) -> Result<Self, ParameterError> {
        Ok(Self { most_seconds: Some(positive("most seconds for a value", seconds)?), ..self })
    }

    /// Returns the same control without waiting for ramps that other processes run.
    ///
    /// A run then returns as soon as only such ramps are left. [`Summary::elsewhere`] names them, since their
    /// processes may yet be killed.
    pub fn without_waiting(self) -> Self {
        Self { waits: false, ..self }
    }

    /// Returns the same control, which writes no tables when all ramps are done.
    ///
    /// [`Study::write_tables`](crate::Study::write_tables) writes them later.
    pub fn without_tables(self) -> Self {
        Self { writes_tables: false, ..self }
    }

    /// Returns the same control, which also reads the records of finished ramps, and runs damaged or lost
    /// ones again. The verification reads the whole study.
    pub fn with_verification(self) -> Self {
        Self { verifies: true, ..self }
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

/// The summary of a run of a study.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Summary {
    /// Number of values that have a record now.
    pub finished: usize,
    /// Number of values that were not finished: they stalled, failed, or reached a limit. They have fewer
    /// samples or none; [`Outcome::reason`](crate::Outcome::reason) says why.
    pub failed: usize,
    /// Number of values whose runs have [warnings](granular_edmd::Simulation::warnings). The files
    /// `logs/*.jsonl` of the study say of what.
    pub warned: usize,
    /// Number of values of the study, or of the ramps to be run.
    pub total: usize,
    /// Ramps that other processes are running.
    pub elsewhere: Vec<usize>,
    /// Files that were damaged and have been replaced.
    pub redone: Vec<PathBuf>,
}

impl Summary {
    /// Returns true if all ramps to be run are complete.
    pub const fn is_complete(&self) -> bool {
        self.finished == self.total
    }
}
