//! Checks of the laws that a scheduler can break, for custom schedulers.
//!
//! A wrong order of events does not crash; it gives a wrong trajectory. Therefore, a scheduler is tested
//! separately, against the plain [`LinearScan`], with scripts of operations that look random and are the same
//! on every run.

mod script;

use super::{EventScheduler, LinearScan, NOTHING_DUE};
use crate::Violation;
use crate::violation::require;
use script::{Operation, SCRIPTS, Script, Stage};

const PART: &str = "scheduler";

/// Numbers of changes of one disk after which counters of 8 and of 16 bits wrap around.
const COUNTS: [u32; 2] = [1 << 8, 1 << 16];

/// Checks that a scheduler keeps the contract of [`EventScheduler`].
///
/// The closure `make` returns a fresh scheduler without disks, and is called for every script. The scripts
/// have from none to tens of thousands of disks, and up to three million operations. They contain times that
/// advance, go back, or are before the last result; ties and times that differ only in their last bits, both
/// zeros, negative and infinite times; a single busy disk among many that wait; and resets to more, to fewer,
/// to the same number and to no disks. Counters of 8 and 16 bits overflow. Each query is made twice. At
/// intervals, the scripts call [`upcoming`](EventScheduler::upcoming) disks, which must not change the order.
/// The page "Validation" says which planted faults the check finds. The scripts never change within a
/// version.
///
/// # Errors
/// The first broken law. A panic of the scheduler is not caught.
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
/// assert_eq!(violation.law(), "earliest");
/// # Ok::<(), granular_edmd::Violation>(())
/// ```
pub fn check<S: EventScheduler>(mut make: impl FnMut() -> S) -> Result<(), Violation> {
    SCRIPTS.iter().try_for_each(|script| {
        script.disks.iter().try_for_each(|&disks| Performance::new(script, disks, make()).run())
    })?;
    COUNTS.iter().try_for_each(|&count| check_counters(make(), count))
}

/// Checks that a scheduler forgets the first time of a disk after `count` changes, while another disk is due
/// earlier. A scheduler that numbers its entries may use the same number twice.
fn check_counters(mut scheduler: impl EventScheduler, count: u32) -> Result<(), Violation> {
    scheduler.reset(&[5.0, 0.5]);
    scheduler.set(0, 1.0);
    for later in 1..=count {
        scheduler.set(0, 20.0 + f64::from(later));
    }
    scheduler.set(1, 1e6);
    let (expected, found) = ((0, 20.0 + f64::from(count)), scheduler.earliest());
    require!(PART, "earliest", found == expected;
        "after disk 0 is set {count} times, the earliest is {}, not {}", told(expected), told(found));
    Ok(())
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
        let mut operation = self.script.start(&mut self.stage, self.disks);
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

    /// Checks the scheduler's earliest event. The closure `after` describes the last operation.
    fn compare(&self, after: impl FnOnce() -> String) -> Result<(), Violation> {
        let expected = self.oracle.earliest();
        let (given, again) = (self.scheduler.earliest(), self.scheduler.earliest());
        if (expected, expected) == (given, again) {
            return Ok(());
        }
        let Self { script, disks, step, .. } = *self;
        let (name, after, right) = (script.name, after(), told(expected));
        let wrong = told(if given == expected { again } else { given });
        let sentence = "the earliest is";
        let found = format!(
            "script \"{name}\" of {disks} disks, step {step}, {after}: {sentence} {right}, not {wrong}"
        );
        Err(Violation::new(PART, "earliest", found))
    }

    /// Queries upcoming disks, as the engine does in large systems.
    fn look_ahead(&mut self) -> Result<(), Violation> {
        // Arbitrary numbers serve as the disks that the engine has collected already.
        let kept = [usize::MAX, usize::MAX, 0, 1];
        let mut named = kept.to_vec();
        self.scheduler.upcoming(&mut named);
        let Self { script, disks, step, .. } = *self;
        let (name, sentence) = (script.name, "`upcoming` changes disks that the list held already");
        require!(PART, "hint", named.starts_with(&kept);
            "script \"{name}\" of {disks} disks, step {step}: {sentence}");
        self.compare(|| "after a look at upcoming disks".to_owned())
    }
}

/// Returns a scheduler's result as text.
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
