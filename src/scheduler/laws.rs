//! Checks of the laws that a scheduler can break, for custom schedulers.
//!
//! A wrong order of events does not crash; it gives a wrong trajectory. Therefore, a scheduler is tested
//! separately, against the plain [`LinearScan`], with scripts of operations that look random and are the same
//! on every run.

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
    for Script(name, disks, steps, time, next) in scripts() {
        for &disks in disks {
            Performance::new(name, disks, time, make()).run(steps, next)?;
        }
    }
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

/// A script, a kind of calls that are repeated for some steps: its name, the numbers of disks at its start,
/// the number of steps, a function for the times of the first call, a reset, and a function that makes the
/// next call, from the earliest disk and its time. Both functions are called only while there are disks.
struct Script<S>(&'static str, &'static [usize], usize, Time<S>, Next<S>);

type Time<S> = fn(&mut Performance<S>) -> f64;
type Next<S> = fn(&mut Performance<S>, usize, f64) -> Result<(), Violation>;

/// Zero, a few, and powers of two and of four with their neighbors.
const FEW: &[usize] = &[0, 1, 2, 3, 4, 5, 15, 16, 17, 63, 64, 65, 130];

/// Enough disks that a scheduler which works in batches goes through several batches within the steps of a
/// script.
const SOME: &[usize] = &[600];

/// More disks than [`LARGE_SYSTEM`], above which schedulers may work differently, and more than 16 bits can
/// count.
const MANY: &[usize] = &[LARGE_SYSTEM + 40_000];

fn scripts<S: EventScheduler>() -> [Script<S>; 13] {
    use Performance as P;
    [
        Script("a run", FEW, 300, P::spread_time, P::run_on),
        Script("to and fro", FEW, 300, P::spread_time, P::any),
        Script("ties", FEW, 300, P::tied_time, P::any),
        Script("extremes", FEW, 300, P::extreme_time, P::any),
        Script("near ties", FEW, 300, P::near_time, P::any),
        Script("ties of a few", FEW, 300, P::late_time, P::any),
        Script("one busy disk", FEW, 300, |_| f64::INFINITY, P::keep_one_busy),
        Script("resets", FEW, 300, P::spread_time, P::reset_often),
        Script("resets to as many", &[1, 2, 20], 4000, P::spread_time, P::reset_to_as_many),
        Script("a long run", SOME, 8000, P::spread_time, P::run_on),
        Script("a longer run", &[17], 3_000_000, P::spread_time, P::run_on),
        Script("a large run", MANY, 200, P::spread_time, P::run_on),
        Script("large and small", MANY, 12, P::spread_time, P::reset_to_few),
    ]
}

/// A script in progress: random numbers, the present and previous times of the disks, the scheduler that is
/// checked, and the plain one.
struct Performance<S> {
    script: &'static str,
    /// Number of disks at the start of the script.
    disks: usize,
    step: usize,
    time: Time<S>,
    generator: Xoshiro256PlusPlus,
    due: Vec<f64>,
    before: Vec<f64>,
    oracle: LinearScan,
    scheduler: S,
}

impl<S: EventScheduler> Performance<S> {
    fn new(script: &'static str, disks: usize, time: Time<S>, scheduler: S) -> Self {
        let generator = Xoshiro256PlusPlus::seed_from_u64(disks as u64);
        let (due, before, oracle) = (Vec::new(), Vec::new(), LinearScan::new());
        Self { script, disks, step: 0, time, generator, due, before, oracle, scheduler }
    }

    fn run(mut self, steps: usize, next: Next<S>) -> Result<(), Violation> {
        self.compare(|| "before the first reset".to_owned())?;
        self.reset(self.disks, self.time)?;
        for step in 1..steps {
            self.look_ahead()?;
            self.step = step;
            let (first, now) = self.oracle.earliest();
            // Without disks, only a reset is possible.
            if self.due.is_empty() { self.reset_to_any()? } else { next(&mut self, first, now)? }
        }
        self.look_ahead()
    }

    /// Checks the scheduler's earliest event. The closure `after` describes the last call.
    fn compare(&self, after: impl FnOnce() -> String) -> Result<(), Violation> {
        let expected = self.oracle.earliest();
        let answers = [self.scheduler.earliest(), self.scheduler.earliest()];
        let Some(wrong) = answers.into_iter().find(|&answer| answer != expected) else { return Ok(()) };
        let (place, after, right, wrong) = (self.place(), after(), told(expected), told(wrong));
        let found = format!("{place}, {after}: the earliest is {right}, not {wrong}");
        Err(Violation::new(PART, "earliest", found))
    }

    fn place(&self) -> String {
        let Self { script, disks, step, .. } = self;
        format!("script \"{script}\" of {disks} disks, step {step}")
    }

    /// Gives a disk this time.
    fn set(&mut self, disk: usize, due: f64) -> Result<(), Violation> {
        self.before[disk] = std::mem::replace(&mut self.due[disk], due);
        self.oracle.set(disk, due);
        self.scheduler.set(disk, due);
        self.compare(|| format!("after disk {disk} was set to {due:?}"))
    }

    /// Gives times to this number of disks.
    fn reset(&mut self, disks: usize, time: Time<S>) -> Result<(), Violation> {
        self.due = (0..disks).map(|_| time(self)).collect();
        self.before.clone_from(&self.due);
        self.oracle.reset(&self.due);
        self.scheduler.reset(&self.due);
        self.compare(|| format!("after a reset to {disks} disks"))
    }

    /// Queries upcoming disks now and then, as the engine does in large systems.
    fn look_ahead(&mut self) -> Result<(), Violation> {
        if self.below(4) != 0 {
            return Ok(());
        }
        // Arbitrary numbers serve as the disks that the engine has collected already.
        let kept = [usize::MAX, usize::MAX, 0, 1];
        let mut named = kept.to_vec();
        self.scheduler.upcoming(&mut named);
        require!(PART, "hint", named.starts_with(&kept);
            "{}: `upcoming` changes disks that the list held already", self.place());
        self.compare(|| "after a look at upcoming disks".to_owned())
    }

    fn below(&mut self, count: usize) -> usize {
        (uniform(&mut self.generator) * count as f64) as usize
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
        let sizes = [0.0, 5e-324, f64::MIN_POSITIVE, f64::MAX, f64::INFINITY];
        match self.below(12) {
            choice @ 0..5 => sizes[choice],
            choice @ 5..10 => -sizes[choice - 5],
            _ => self.spread_time(),
        }
    }

    /// Gives a new time to the first disk or to a random one.
    fn any(&mut self, first: usize, _: f64) -> Result<(), Violation> {
        let other = self.any_disk();
        let (disk, due) = ([first, other][self.below(2)], (self.time)(self));
        self.set(disk, due)
    }

    /// Goes on as a run does: the disk whose event is due gets a later time. At intervals, another disk gets
    /// a later time, or returns to its previous time.
    fn run_on(&mut self, first: usize, now: f64) -> Result<(), Violation> {
        if !now.is_finite() {
            return self.any(first, now);
        }
        let (wait, other) = (self.wait(), self.any_disk());
        match self.below(10) {
            0..=6 => self.set(first, now + wait),
            7 | 8 => self.set(other, now + wait),
            _ => self.set(other, self.before[other]),
        }
    }

    /// Gives one disk many events, far apart, while all others wait forever.
    fn keep_one_busy(&mut self, first: usize, now: f64) -> Result<(), Violation> {
        if now < f64::INFINITY { self.set(first, now + 1e6) } else { self.set(self.due.len() / 2, 0.0) }
    }

    fn reset_to_any(&mut self) -> Result<(), Violation> {
        let disks = self.below(70);
        self.reset(disks, Self::extreme_time)
    }

    fn reset_often(&mut self, first: usize, now: f64) -> Result<(), Violation> {
        if self.below(4) == 0 { self.reset_to_any() } else { self.run_on(first, now) }
    }

    fn reset_to_as_many(&mut self, first: usize, now: f64) -> Result<(), Violation> {
        let disks = self.due.len();
        if self.below(3) == 0 { self.reset(disks, Self::spread_time) } else { self.run_on(first, now) }
    }

    /// Resets to few disks after many, and back to many.
    fn reset_to_few(&mut self, first: usize, now: f64) -> Result<(), Violation> {
        match self.below(4) {
            0 => self.reset_to_any(),
            1 => self.reset(MANY[0], Self::spread_time),
            _ => self.run_on(first, now),
        }
    }
}

/// Returns a scheduler's result as text.
fn told((disk, due): (usize, f64)) -> String {
    if (disk, due) == NOTHING_DUE { "nothing".to_owned() } else { format!("disk {disk} at {due:?}") }
}
