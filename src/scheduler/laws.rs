//! Checks of the laws that a scheduler can break, for custom schedulers.
//!
//! A wrong order of events does not crash; it gives a wrong trajectory. Therefore, a scheduler is tested
//! separately, against the plain [`LinearScan`], with scripts of operations that look random and are the same
//! on every run.

use std::fmt;

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{EventScheduler, LinearScan, NOTHING_DUE};
use crate::Violation;
use crate::error::require;
use crate::random::uniform;
use crate::scheduler::LARGE_SYSTEM;

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
        let mut operation = reset(&mut self.stage, self.disks, self.script.time);
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

/// A call of a scheduler.
#[derive(Debug, Clone)]
enum Operation {
    Reset(Vec<f64>),
    Set(usize, f64),
}

impl fmt::Display for Operation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reset(due) => write!(formatter, "a reset to {} disks", due.len()),
            Self::Set(disk, due) => write!(formatter, "disk {disk} was set to {due:?}"),
        }
    }
}

/// A script: a kind of operations, repeated for some steps.
struct Script {
    name: &'static str,
    /// Numbers of disks at the start.
    disks: &'static [usize],
    steps: usize,
    /// Generates the times of the first operation, a reset.
    time: fn(&mut Stage) -> f64,
    /// Makes the next operation from the earliest disk and its time. It is called only while there are disks.
    /// If there is no such function, the first disk or a random one gets another time.
    next: Option<fn(&mut Stage, usize, f64) -> Operation>,
}

/// Zero, a few, and powers of two and of four with their neighbors.
const FEW: &[usize] = &[0, 1, 2, 3, 4, 5, 15, 16, 17, 63, 64, 65, 130];

/// Enough disks that a scheduler which works in batches goes through several batches within the steps of a
/// script.
const SOME: &[usize] = &[600];

/// More disks than [`LARGE_SYSTEM`], above which schedulers may work differently, and more than 16 bits can
/// count.
const MANY: &[usize] = &[LARGE_SYSTEM + 40_000];

const SCRIPTS: [Script; 13] = [
    script("a run", FEW, 300, Stage::spread_time, Some(run)),
    script("to and fro", FEW, 300, Stage::spread_time, None),
    script("ties", FEW, 300, Stage::tied_time, None),
    script("extremes", FEW, 300, Stage::extreme_time, None),
    script("near ties", FEW, 300, Stage::near_time, None),
    script("ties of a few", FEW, 300, Stage::late_time, None),
    script("one busy disk", FEW, 300, |_| f64::INFINITY, Some(one_busy)),
    script("resets", FEW, 300, Stage::spread_time, Some(reset_often)),
    script("resets to as many", &[1, 2, 20], 4000, Stage::spread_time, Some(reset_to_as_many)),
    script("a long run", SOME, 8000, Stage::spread_time, Some(run)),
    script("a longer run", &[17], 3_000_000, Stage::spread_time, Some(run)),
    script("a large run", MANY, 200, Stage::spread_time, Some(run)),
    script("large and small", MANY, 12, Stage::spread_time, Some(reset_to_few)),
];

const fn script(
    name: &'static str,
    disks: &'static [usize],
    steps: usize,
    time: fn(&mut Stage) -> f64,
    next: Option<fn(&mut Stage, usize, f64) -> Operation>,
) -> Script {
    Script { name, disks, steps, time, next }
}

/// Random numbers, and the present and previous times of the disks.
struct Stage {
    generator: Xoshiro256PlusPlus,
    due: Vec<f64>,
    before: Vec<f64>,
}

impl Stage {
    fn new(seed: u64) -> Self {
        let generator = Xoshiro256PlusPlus::seed_from_u64(seed);
        Self { generator, due: Vec::new(), before: Vec::new() }
    }

    /// Notes an operation.
    fn note(&mut self, operation: &Operation) {
        match operation {
            Operation::Reset(due) => (self.due, self.before) = (due.clone(), due.clone()),
            Operation::Set(disk, due) => self.before[*disk] = std::mem::replace(&mut self.due[*disk], *due),
        }
    }

    /// Returns the next operation of a script. Without disks, only a reset is possible.
    fn next(&mut self, script: &Script, (first, now): (usize, f64)) -> Operation {
        match script.next {
            _ if self.due.is_empty() => few(self),
            Some(next) => next(self, first, now),
            None => self.any(first, script.time),
        }
    }

    fn is_time_to_look(&mut self) -> bool {
        self.below(4) == 0
    }

    fn below(&mut self, count: usize) -> usize {
        (uniform(&mut self.generator) * count as f64) as usize
    }

    /// Returns an operation that gives a new time to the first disk or to a random one.
    fn any(&mut self, first: usize, time: fn(&mut Self) -> f64) -> Operation {
        let other = self.any_disk();
        Operation::Set([first, other][self.below(2)], time(self))
    }

    fn any_disk(&mut self) -> usize {
        self.below(self.due.len())
    }

    /// Returns a waiting time: mostly up to 3, otherwise zero, very short or infinite.
    fn wait(&mut self) -> f64 {
        match self.below(40) {
            0 => f64::INFINITY,
            1..=3 => 0.0,
            4..=8 => 1e-3 * uniform(&mut self.generator),
            _ => 3.0 * uniform(&mut self.generator),
        }
    }

    fn spread_time(&mut self) -> f64 {
        200.0 * uniform(&mut self.generator) - 100.0
    }

    /// Returns one of seven times, among them both zeros, so that many disks get equal times.
    fn tied_time(&mut self) -> f64 {
        [-2.0, -1.0, -0.0, 0.0, 1.0, 2.0, f64::INFINITY][self.below(7)]
    }

    /// Returns a time from one of three groups, in each of which times differ only in their last bits.
    fn near_time(&mut self) -> f64 {
        let base = [1.0_f64, 1.0, 1000.0, 1e7][self.below(4)];
        f64::from_bits(base.to_bits() + self.below(12) as u64)
    }

    /// Returns one of a few late times.
    fn late_time(&mut self) -> f64 {
        [1e3, 1e3, 2e3, 1e9][self.below(4)]
    }

    fn extreme_time(&mut self) -> f64 {
        const EXTREMES: [f64; 10] = [
            f64::NEG_INFINITY,
            f64::MIN,
            -f64::MIN_POSITIVE,
            -5e-324,
            -0.0,
            0.0,
            5e-324,
            f64::MIN_POSITIVE,
            f64::MAX,
            f64::INFINITY,
        ];
        match self.below(12) {
            choice if choice < EXTREMES.len() => EXTREMES[choice],
            _ => self.spread_time(),
        }
    }
}

fn reset(stage: &mut Stage, disks: usize, time: fn(&mut Stage) -> f64) -> Operation {
    Operation::Reset((0..disks).map(|_| time(stage)).collect())
}

fn few(stage: &mut Stage) -> Operation {
    let disks = stage.below(70);
    reset(stage, disks, Stage::extreme_time)
}

/// Makes the operations of a run: the disk whose event is due gets a later time. At intervals, another disk
/// gets a later time, or returns to its previous time.
fn run(stage: &mut Stage, first: usize, now: f64) -> Operation {
    if !now.is_finite() {
        return stage.any(first, Stage::spread_time);
    }
    let wait = stage.wait();
    let other = stage.any_disk();
    match stage.below(10) {
        0..=6 => Operation::Set(first, now + wait),
        7 | 8 => Operation::Set(other, now + wait),
        _ => Operation::Set(other, stage.before[other]),
    }
}

/// Gives one disk many events, far apart, while all others wait forever.
fn one_busy(stage: &mut Stage, first: usize, now: f64) -> Operation {
    if now < f64::INFINITY {
        Operation::Set(first, now + 1e6)
    } else {
        Operation::Set(stage.due.len() / 2, 0.0)
    }
}

fn reset_often(stage: &mut Stage, first: usize, now: f64) -> Operation {
    if stage.below(4) == 0 { few(stage) } else { run(stage, first, now) }
}

fn reset_to_as_many(stage: &mut Stage, first: usize, now: f64) -> Operation {
    let disks = stage.due.len();
    if stage.below(3) == 0 { reset(stage, disks, Stage::spread_time) } else { run(stage, first, now) }
}

/// Resets to few disks after many, and back to many.
fn reset_to_few(stage: &mut Stage, first: usize, now: f64) -> Operation {
    match stage.below(4) {
        0 => few(stage),
        1 => reset(stage, MANY[0], Stage::spread_time),
        _ => run(stage, first, now),
    }
}
