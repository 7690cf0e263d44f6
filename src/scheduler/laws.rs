//! Checks of the laws that a scheduler can break, for schedulers of your own.
//!
//! A wrong order of events does not crash; it gives a wrong trajectory. Therefore, a scheduler is tested
//! separately, against the plain [`LinearScan`], with scripts of operations that look random and are the same
//! on every run.

mod script;

use thiserror::Error;

use super::{EventScheduler, LinearScan, NOTHING_DUE};
use script::{Operation, SCRIPTS, Script, Stage};

/// A law that a scheduler breaks, and the step of a script at which it does.
///
/// The scripts never change within a version, so the same scheduler breaks the same law at the same step
/// again.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Violation {
    /// The scheduler names an event that is not the earliest.
    #[error(
        "script \"{script}\" of {disks} disks, step {step}, {after}: the earliest is {}, but {} is named",
        told(*expected), told(*given)
    )]
    NotEarliest {
        /// Name of the script.
        script: &'static str,
        /// Number of disks at the start of the script.
        disks: usize,
        /// Index of the step in the script.
        step: usize,
        /// The last operation.
        after: String,
        /// The right answer of [`EventScheduler::earliest`].
        expected: (usize, f64),
        /// The answer that was given.
        given: (usize, f64),
    },
    /// [`EventScheduler::upcoming`] changes disks that it should only add to.
    #[error("script \"{script}\" of {disks} disks, step {step}: the look at upcoming disks removes others")]
    Removed {
        /// Name of the script.
        script: &'static str,
        /// Number of disks at the start of the script.
        disks: usize,
        /// Index of the step in the script.
        step: usize,
    },
}

/// Checks that a scheduler keeps the contract of [`EventScheduler`].
///
/// The closure `make` returns a fresh scheduler without disks, and is called for every script. The scripts
/// have from none to some ten thousand disks. They contain times that advance, go back, or are before the
/// last answer; ties, both zeros, negative and infinite times; a single busy disk among many that wait; and
/// resets to more, fewer and no disks. Now and then they ask for [`upcoming`](EventScheduler::upcoming)
/// disks, which must not change the order.
///
/// # Errors
/// The first law that is broken. A scheduler that panics is not caught.
///
/// ```
/// use granular_edmd::scheduler::{BySize, EventScheduler, laws};
///
/// laws::check(BySize::new)?;
/// laws::check(|| Box::new(BySize::new()) as Box<dyn EventScheduler>)?;
///
/// /// Forgets disk 3.
/// #[derive(Default)]
/// struct Forgetful(BySize);
///
/// impl EventScheduler for Forgetful {
///     fn reset(&mut self, due: &[f64]) {
///         self.0.reset(due);
///     }
///     fn set(&mut self, disk: usize, due: f64) {
///         if disk != 3 {
///             self.0.set(disk, due);
///         }
///     }
///     fn earliest(&self) -> (usize, f64) {
///         self.0.earliest()
///     }
///     fn upcoming(&mut self, disks: &mut Vec<usize>) {
///         self.0.upcoming(disks);
///     }
/// }
/// let violation = laws::check(Forgetful::default).unwrap_err();
/// assert!(matches!(violation, laws::Violation::NotEarliest { .. }));
/// # Ok::<(), laws::Violation>(())
/// ```
pub fn check<S: EventScheduler>(mut make: impl FnMut() -> S) -> Result<(), Violation> {
    SCRIPTS.iter().try_for_each(|script| {
        script.disks.iter().try_for_each(|&disks| Performance::new(script, disks, make()).run())
    })
}

/// A script in progress, and the scheduler that is checked.
struct Performance<S> {
    script: &'static Script,
    disks: usize,
    step: usize,
    stage: Stage,
    oracle: LinearScan,
    scheduler: S,
}

impl<S: EventScheduler> Performance<S> {
    fn new(script: &'static Script, disks: usize, scheduler: S) -> Self {
        Self { script, disks, step: 0, stage: Stage::new(disks as u64), oracle: LinearScan::new(), scheduler }
    }

    fn run(mut self) -> Result<(), Violation> {
        self.compare(|| "before the first reset".to_owned())?;
        let mut operation = (self.script.start)(&mut self.stage, self.disks);
        for step in 0..self.script.steps {
            self.step = step;
            self.stage.note(&operation);
            operation.perform(&mut self.oracle);
            operation.perform(&mut self.scheduler);
            self.compare(|| format!("after {operation}"))?;
            if self.stage.is_time_to_look() {
                self.look_ahead()?;
            }
            operation = self.stage.next(self.script, self.oracle.earliest());
        }
        Ok(())
    }

    /// Checks the answer. The closure `after` describes the last operation.
    fn compare(&self, after: impl FnOnce() -> String) -> Result<(), Violation> {
        let (expected, given) = (self.oracle.earliest(), self.scheduler.earliest());
        if expected == given {
            return Ok(());
        }
        let Self { script, disks, step, .. } = *self;
        Err(Violation::NotEarliest { script: script.name, disks, step, after: after(), expected, given })
    }

    /// Asks for upcoming disks, as the engine does in large systems.
    fn look_ahead(&mut self) -> Result<(), Violation> {
        // Any numbers will do for the disks that the engine has collected already.
        let mut named = vec![usize::MAX, 0];
        self.scheduler.upcoming(&mut named);
        if !named.starts_with(&[usize::MAX, 0]) {
            let Self { script, disks, step, .. } = *self;
            return Err(Violation::Removed { script: script.name, disks, step });
        }
        self.compare(|| "after a look at upcoming disks".to_owned())
    }
}

/// Returns an answer of a scheduler in words.
fn told((disk, due): (usize, f64)) -> String {
    if (disk, due) == NOTHING_DUE { "nothing".to_owned() } else { format!("disk {disk} at {due:?}") }
}

impl Operation {
    fn perform(&self, scheduler: &mut impl EventScheduler) {
        match *self {
            Self::Reset(ref due) => scheduler.reset(due),
            Self::Set(disk, due) => scheduler.set(disk, due),
        }
    }
}
