//! The scripts with which schedulers are checked.

use std::fmt;

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::random::uniform;
use crate::scheduler::LARGE_SYSTEM;

/// A call of a scheduler.
#[derive(Debug, Clone)]
pub(super) enum Operation {
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
pub(super) struct Script {
    pub(super) name: &'static str,
    /// Numbers of disks at the start.
    pub(super) disks: &'static [usize],
    pub(super) steps: usize,
    /// Generates the times of the first operation, a reset.
    time: fn(&mut Stage) -> f64,
    /// Makes the next operation from the earliest disk and its time. It is called only while there are disks.
    /// If there is no such function, the first disk or a random one gets another time.
    next: Option<fn(&mut Stage, usize, f64) -> Operation>,
}

impl Script {
    pub(super) fn start(&self, stage: &mut Stage, disks: usize) -> Operation {
        reset(stage, disks, self.time)
    }
}

/// Zero, a few, and powers of two and of four with their neighbors.
const FEW: &[usize] = &[0, 1, 2, 3, 4, 5, 15, 16, 17, 63, 64, 65, 130];

/// Enough disks that a scheduler which works in batches goes through several batches within the steps of a
/// script.
const SOME: &[usize] = &[600];

/// More disks than [`LARGE_SYSTEM`], above which schedulers may work differently, and more than 16 bits can
/// count.
const MANY: &[usize] = &[LARGE_SYSTEM + 40_000];

pub(super) const SCRIPTS: [Script; 13] = [
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
pub(super) struct Stage {
    generator: Xoshiro256PlusPlus,
    due: Vec<f64>,
    before: Vec<f64>,
}

impl Stage {
    pub(super) fn new(seed: u64) -> Self {
        let generator = Xoshiro256PlusPlus::seed_from_u64(seed);
        Self { generator, due: Vec::new(), before: Vec::new() }
    }

    /// Notes an operation.
    pub(super) fn note(&mut self, operation: &Operation) {
        match operation {
            Operation::Reset(due) => (self.due, self.before) = (due.clone(), due.clone()),
            Operation::Set(disk, due) => self.before[*disk] = std::mem::replace(&mut self.due[*disk], *due),
        }
    }

    /// Returns the next operation of a script. Without disks, only a reset is possible.
    pub(super) fn next(&mut self, script: &Script, (first, now): (usize, f64)) -> Operation {
        match script.next {
            _ if self.due.is_empty() => few(self),
            Some(next) => next(self, first, now),
            None => self.any(first, script.time),
        }
    }

    pub(super) fn is_time_to_look(&mut self) -> bool {
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
