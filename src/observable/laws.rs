//! Checks of an observer's contract, for custom observers.
//!
//! An observer can never change a trajectory, since the engine gives it copies of the disks, but the observer
//! is responsible for its clock. A wrong clock can hang a run, or ask for samples that never come.

use glam::DVec2;

use super::{Collision, Observer, Partner, Snapshot};
use crate::boundary::Domain;
use crate::collision::{Contact, Impulse, Regime};
use crate::error::require;
use crate::{Disk, ParameterError, Violation};

const PART: &str = "observer";

/// Largest numbers of samples: in a short run of the script, and in the last run.
const SAMPLES: usize = 50;
const MANY_SAMPLES: usize = 10_000;

/// Number of disks in the script.
const DISKS: usize = 3;
const WALLS: usize = 4;
const DOMAIN: Domain = Domain::new(0.0, 10.0, 0.0, 10.0);
const GRAVITY: f64 = 1.0;

/// Rounding of a start time, relative to the time.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Checks that an observer keeps its contract in a few runs of a made-up system.
///
/// The runs have three disks and four walls, collisions with each partner and in all regimes, a fourth disk
/// that comes in and is taken out before each sample, and up to fifty samples each, at the times that the
/// observer requests. The first run starts at time 0 and is cut twice: once partway between two samples, and
/// once right after a sample. A run that continues it must ask for the same next sample as before the cut.
/// Further runs start later and between two sampling times, at a late time, and before 0; the last one has
/// ten thousand samples. A run ends early if the observer stops it or fails. The observer keeps what it has
/// collected in the check, so make a new one for a measurement. The page "Validation" says which planted
/// faults the check finds.
///
/// # Errors
/// Returns the first broken promise.
///
/// ```
/// use granular_edmd::observable::laws::check;
/// use granular_edmd::observable::{Observer, OrderParameters, SampleTimes, Series};
///
/// check(&mut Series::new(OrderParameters, SampleTimes::every(0.1)?))?;
///
/// /// Wants a sample at time 1, again and again.
/// struct Stuck;
/// impl Observer for Stuck {
///     fn next_sample(&self) -> f64 {
///         1.0
///     }
/// }
/// assert_eq!(check(&mut Stuck).unwrap_err().law(), "later");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check<O: Observer + ?Sized>(observer: &mut O) -> Result<(), Violation> {
    let next = observer.next_sample();
    require!(PART, "number", !next.is_nan(); "before the first run, the next sample is at NaN");
    let first = Script::new(observer, 0.0).run(0.5, None)?;
    let second = Script::new(observer, first.now).run(0.0, first.wanted())?;
    let third = Script::new(observer, second.now).run(0.0, second.wanted())?;
    let start = third.now + 0.37 * (1.0 + third.now);
    Script::new(observer, start).run(0.0, None)?;
    Script::new(observer, 1e4 + start).run(0.0, None)?;
    let last = Script::new(observer, -0.73 * (1.0 + first.now));
    Script { samples: MANY_SAMPLES, ..last }.run(0.0, None).map(drop)
}

/// The state of the clock at the end of a run.
struct End {
    now: f64,
    /// Time of the next sample that the observer requested.
    next: f64,
    goes_on: bool,
}

impl End {
    /// Returns the time of the next sample that a continuation of the run must take.
    fn wanted(&self) -> Option<f64> {
        Some(self.next).filter(|_| self.goes_on)
    }
}

/// A run that follows the requests of an observer, as the engine does.
struct Script<'a, O: ?Sized> {
    observer: &'a mut O,
    now: f64,
    /// Time of the next sample, as the engine knows it.
    wanted: f64,
    collisions: usize,
    /// Largest number of samples.
    samples: usize,
}

impl<'a, O: Observer + ?Sized> Script<'a, O> {
    fn new(observer: &'a mut O, start: f64) -> Self {
        Self { observer, now: start, wanted: f64::INFINITY, collisions: 0, samples: SAMPLES }
    }

    /// Runs the script, then continues for a share of the time to the next sample. A run that continues
    /// another one must ask for the sample `kept`.
    fn run(mut self, share: f64, kept: Option<f64>) -> Result<End, Violation> {
        let is_accepted = self.observer.on_start(&snapshot(self.now, &disks(0))).is_ok();
        self.wanted = self.next_sample()?;
        let (start, next, rounding) = (self.now, self.wanted, ROUNDING * self.now.abs());
        require!(PART, "start", next >= start - rounding;
            "the run starts at {start:?}, and asks for a sample at {next:?}");
        let kept = kept.unwrap_or(next);
        let is_kept = next == kept || (next - kept).abs() <= rounding;
        require!(PART, "cut", is_kept;
            "a run that is cut at {start:?} asks for a sample at {next:?}; without the cut, it was {kept:?}");
        let mut goes_on = self.goes_on()? && is_accepted;
        for _ in 0..self.samples {
            goes_on = goes_on && self.collide()? && self.sample()?;
        }
        if self.wanted.is_finite() && goes_on {
            self.now += share * (self.wanted - self.now);
        }
        self.observer.on_end(&snapshot(self.now, &disks(self.collisions)));
        self.goes_on()?;
        Ok(End { now: self.now, next: self.wanted, goes_on })
    }

    /// Runs collisions until the next sample, or a few collisions if no sample is requested. Between the
    /// collisions, a disk comes in and is taken out.
    fn collide(&mut self) -> Result<bool, Violation> {
        let wait = if self.wanted.is_finite() { (self.wanted - self.now).max(0.0) } else { 1.0 };
        let guest = disk(0, self.collisions).and_then(|disk| disk.with_id(1 + self.collisions as u64)).ok();
        for step in 0..3 {
            self.now += 0.25 * wait;
            match (step, &guest) {
                (1, Some(guest)) => self.observer.on_insert(guest, self.now),
                (2, Some(guest)) => self.observer.on_remove(guest, self.now),
                _ => {}
            }
            self.collisions += 1;
            let collision = collision(self.now, self.collisions);
            self.observer.on_collision(&collision);
            if self.next_sample()? == self.now {
                // A collision may ask for a sample immediately.
                self.wanted = self.now;
                return self.goes_on();
            }
            if !self.goes_on()? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Takes the sample that is due, if the clock names a time.
    fn sample(&mut self) -> Result<bool, Violation> {
        if !self.wanted.is_finite() {
            return Ok(true);
        }
        // The engine does the same: if rounding has put the sampling time before the present, it takes the
        // sample now.
        self.now = self.wanted.max(self.now);
        self.observer.on_sample(&snapshot(self.now, &disks(self.collisions)));
        let next = self.next_sample()?;
        let sample = self.now;
        require!(PART, "later", next > sample;
            "after the sample at {sample:?} the next one is not later, at {next:?}");
        self.wanted = next;
        self.goes_on()
    }

    fn next_sample(&self) -> Result<f64, Violation> {
        let next = self.observer.next_sample();
        require!(PART, "number", !next.is_nan(); "after the time {:?} the next sample is at NaN", self.now);
        Ok(next)
    }

    /// Asks for the verdict, and checks that the clock has not moved since it was last read.
    fn goes_on(&mut self) -> Result<bool, Violation> {
        let goes_on = self.observer.verdict().is_ok_and(|verdict| verdict.is_continue());
        let (before, next) = (self.wanted, self.next_sample()?);
        require!(PART, "clock", next == before;
            "between two samples the next one moved from {before:?} to {next:?}");
        Ok(goes_on)
    }
}

fn snapshot(time: f64, disks: &[Disk]) -> Snapshot<'_> {
    Snapshot::new(time, disks, DOMAIN, GRAVITY).with_wall_count(WALLS)
}

fn disks(round: usize) -> Vec<Disk> {
    (0..DISKS).filter_map(|index| disk(index, round).ok()).collect()
}

/// Returns one of three disks, at one of a few positions.
fn disk(index: usize, round: usize) -> Result<Disk, ParameterError> {
    let (place, turn) = ((1 + 3 * index) as f64, (round % 7) as f64);
    Disk::new(DVec2::new(place, 1.0 + turn), 0.5)?
        .with_velocity(DVec2::new(turn - 3.0, place - 4.0))?
        .with_angular_velocity(turn - 2.0)
}

/// Returns a collision, with a different partner each time.
fn collision(time: f64, number: usize) -> Collision {
    use Regime::{ContactDuration, ElasticBelow, LeastRebound, Sliding, Sticking, Unspecified};
    // Partners repeat after six collisions. With seven entries, each of them meets all regimes.
    const REGIMES: [Regime; 7] =
        [Sticking, Sliding, ContactDuration, ElasticBelow, LeastRebound, Unspecified, Unspecified];
    let disk = number % DISKS;
    let partner = match number % (WALLS + 2) {
        wall if wall < WALLS => Partner::Wall(wall),
        _ => Partner::Disk((disk + 1) % DISKS),
    };
    let contact = Contact::new(1.0, 0.5, 0.5, 0.5 / 3.0);
    let impulse = Impulse::new(0.9, 0.05).with_regime(REGIMES[number % REGIMES.len()]);
    Collision::new(time, disk, partner, contact, impulse)
}
