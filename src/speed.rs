//! The speed of runs, and the cost of their parts.
//!
//! A [`Meter`] is started before a run and makes a [`RunReport`] after it. [`dilute`] and [`dense`] are
//! standard states in which to compare a custom part with the built-in one. Insert the part with
//! [`Simulation::with_rule`](crate::Simulation::with_rule),
//! [`with_boundary`](crate::Simulation::with_boundary) or
//! [`with_scheduler`](crate::Simulation::with_scheduler); a [`Comparison`] shows whether a difference exceeds
//! the noise. For benchmarks with criterion, [`measure`] measures one run alone instead of two runs
//! alternately.
//!
//! All times are processor times ([`RunReport::seconds`]). Measure builds with `--release` only.
//!
//! ```no_run
//! use granular_edmd::collision::{CollisionRule, Contact, ContactDuration, Friction, Impulse};
//! use granular_edmd::observable::EnergyChange;
//! use granular_edmd::scheduler::TournamentTree;
//! use granular_edmd::speed::{self, Comparison};
//!
//! #[derive(Clone)]
//! struct Own(Friction);
//!
//! impl CollisionRule for Own {
//!     fn impulse(&self, contact: &Contact) -> Impulse {
//!         let restitution = 1.0 / (1.0 + 0.1 * contact.closing_speed());
//!         self.0.impulse(contact, contact.normal_impulse(restitution))
//!     }
//! }
//!
//! let built_in = speed::dense()?;
//! let bare = || speed::measure(&built_in, 10_000, &mut ());
//! // The state has a contact duration, so the custom rule gets the same: only the rules differ.
//! let own = Own(Friction::from_inelasticity(0.05, 0.1)?);
//! let rule = ContactDuration::new(own, built_in.rule().duration())?;
//! let own = built_in.clone().with_rule(rule);
//! println!("{}", Comparison::between(bare, || speed::measure(&own, 10_000, &mut ()))?);
//!
//! let tree = built_in.clone().with_scheduler(TournamentTree::new());
//! println!("{}", Comparison::between(bare, || speed::measure(&tree, 10_000, &mut ()))?);
//!
//! let mut observer = EnergyChange::default();
//! println!("{}", Comparison::between(bare, || speed::measure(&built_in, 10_000, &mut observer))?);
//! # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
//! ```

mod states;

pub use states::{PaperBox, StateError, dense, dilute};

use std::time::{Duration, Instant};
use std::{fmt, fs};

use crate::Simulation;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::Observer;
use crate::scheduler::EventScheduler;
use crate::simulation::{Counters, Limits, RunError};

/// A meter that is started before a run and read after it. The meter does not slow the run.
///
/// ```
/// use granular_edmd::speed::Meter;
/// # use granular_edmd::{Simulation, boundary::Container, collision::Elastic, initial};
/// # let container = Container::closed(20.0, 20.0)?;
/// # let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 1)?;
/// # let mut simulation = Simulation::builder(Elastic, container).disks(disks).build()?;
/// let meter = Meter::start(&simulation);
/// simulation.run_until(50.0, &mut ())?;
/// let report = meter.report(&simulation);
/// println!("{report}");
/// assert_eq!(report.counters.disk_collisions, simulation.counters().disk_collisions);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Meter {
    wall: Instant,
    /// Seconds of the thread at the start, where they are known.
    thread: Option<f64>,
    counters: Counters,
    time: f64,
}

impl Meter {
    /// Starts a meter of the simulation, for runs in this thread.
    pub fn start<R: CollisionRule, B: Boundary, S: EventScheduler>(run: &Simulation<R, B, S>) -> Self {
        let (counters, time) = (*run.counters(), run.time());
        Self { counters, time, thread: seconds_of_thread(), wall: Instant::now() }
    }

    /// Returns the report of the simulation since the meter was started.
    pub fn report<R: CollisionRule, B: Boundary, S: EventScheduler>(
        &self,
        run: &Simulation<R, B, S>,
    ) -> RunReport {
        let wall = self.wall.elapsed().as_secs_f64();
        let seconds = seconds_of_thread().zip(self.thread).map_or(wall, |(now, start)| now - start);
        let (counters, disks) = (run.counters().since(&self.counters), run.len());
        RunReport {
            disks,
            simulated_time: run.time() - self.time,
            seconds,
            nanoseconds_per_collision: 1e9 * seconds / counters.disk_collisions as f64,
            collisions_per_second: counters.disk_collisions as f64 / seconds,
            events_per_second: counters.events() as f64 / seconds,
            events_per_collision: counters.events() as f64 / counters.disk_collisions as f64,
            counters,
        }
    }
}

/// The report of a run, for people ([`Display`](fmt::Display)) and as data (feature `serde`).
///
/// Only collisions of two disks count as collisions here. In a run without such collisions, numbers per
/// collision are infinite or NaN.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct RunReport {
    /// Number of disks at the end.
    pub disks: usize,
    /// Simulated time.
    pub simulated_time: f64,
    /// Seconds on the processor: on Linux, time of other programs does not count; elsewhere, by the wall
    /// clock.
    pub seconds: f64,
    /// Processor time per collision, including all other events.
    pub nanoseconds_per_collision: f64,
    /// Collisions in a second.
    pub collisions_per_second: f64,
    /// Events of all kinds in a second.
    pub events_per_second: f64,
    /// Events of all kinds for each collision.
    pub events_per_collision: f64,
    /// Events by kind.
    pub counters: Counters,
}

impl fmt::Display for RunReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { disks, seconds, counters, .. } = self;
        let per_collision = |events: u64| events as f64 / counters.disk_collisions as f64;
        let (million, nanoseconds) = (1e-6 * self.collisions_per_second, self.nanoseconds_per_collision);
        writeln!(formatter, "{disks} disks, {:.6} units of time in {seconds:.3} s", self.simulated_time)?;
        writeln!(formatter, "{million:.3} million collisions a second, {nanoseconds:.1} ns each")?;
        write!(
            formatter,
            "{:.3} million events a second; with each collision {:.3} with walls, {:.3} passages, \
             {:.3} predicted anew, {:.3} horizons",
            1e-6 * self.events_per_second,
            per_collision(counters.wall_collisions),
            per_collision(counters.cell_crossings),
            per_collision(counters.repredictions),
            per_collision(counters.horizons),
        )
    }
}

/// Returns the processor time of this thread, in seconds.
fn seconds_of_thread() -> Option<f64> {
    // The kernel records the time of a task when the task gives up the processor, or some milliseconds later.
    std::thread::sleep(Duration::from_nanos(1));
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

/// Number of pairs of measured intervals.
const ROUNDS: usize = 201;

/// Number of ratios outside the interval on each side. In 201 tosses of a coin, fewer than 79 or more than
/// 122 heads have a probability of 0.0018.
const OUTSIDE: usize = 78;

/// Runs a copy of the simulation until it has had `collisions` collisions, of disks and with walls together,
/// and returns the report.
///
/// Equal calls do the same work, from the same state. In a benchmark with criterion, too, take a fixed number
/// of collisions: in a longer run, a rule with other physics would leave the state. Each iteration of the
/// benchmark is one call.
///
/// ```no_run
/// # use criterion_stand_in::Bencher;
/// # mod criterion_stand_in {
/// #     pub struct Bencher;
/// #     impl Bencher { pub fn iter_custom(&mut self, _: impl FnMut(u64) -> std::time::Duration) {} }
/// # }
/// # fn bench(bencher: &mut Bencher) {
/// use granular_edmd::speed;
///
/// let run = speed::dense().expect("a standard state");
/// let seconds = || speed::measure(&run, 10_000, &mut ()).expect("the run goes on").seconds;
/// bencher.iter_custom(|times| std::time::Duration::from_secs_f64((0..times).map(|_| seconds()).sum()));
/// # }
/// ```
///
/// Criterion does not alternate two benches; use a [`Comparison`] for a difference of a few percent.
///
/// # Errors
/// The same as for [`Simulation::run`].
pub fn measure<R: CollisionRule + Clone, B: Boundary + Clone, S: EventScheduler + Clone>(
    simulation: &Simulation<R, B, S>,
    collisions: u64,
    observer: &mut (impl Observer + ?Sized),
) -> Result<RunReport, RunError> {
    let mut run = simulation.clone();
    let limits = Limits::collisions(collisions);
    let meter = Meter::start(&run);
    run.run(&limits, observer)?;
    Ok(meter.report(&run))
}

/// The ratio of the times per collision in two runs, from alternating intervals.
///
/// Intervals of the two runs follow each other in pairs, and each pair gives a ratio, so anything that slows
/// both cancels. Intervals of one run do the same work each time, from the same state. A rule with other
/// physics leads to other states, in which a collision may take more events. The numbers of events are given
/// with the times: if they agree, the ratio is the cost of the rule itself. To include the cost of the state
/// to which the rule leads, take a run that has settled under it.
///
/// ```no_run
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::speed::{self, Comparison};
///
/// let built_in = speed::dilute()?;
/// let own = built_in.clone().with_rule(Frictional::from_inelasticity(0.0, 0.0, 0.03)?);
/// let collisions = 10_000;
/// let comparison = Comparison::between(
///     || speed::measure(&built_in, collisions, &mut ()),
///     || speed::measure(&own, collisions, &mut ()),
/// )?;
/// println!("{comparison}");
/// assert!(comparison.ratio().median < 1.0);
/// # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    ratio: Quartiles,
    interval: [f64; 2],
    nanoseconds: [Quartiles; 2],
    events: [f64; 2],
}

/// The result of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finding {
    /// The other run is faster.
    Faster,
    /// The difference is within the noise.
    Noise,
    /// The other run is slower.
    Slower,
    /// No two disks collided in one of the runs, so the time of a collision is not defined.
    Unknown,
}

impl Comparison {
    /// Compares two runs over 201 intervals of each. Intervals of a few milliseconds are best, such as 10 000
    /// collisions.
    ///
    /// # Errors
    /// The errors of the two closures.
    pub fn between<E>(
        mut first: impl FnMut() -> Result<RunReport, E>,
        mut other: impl FnMut() -> Result<RunReport, E>,
    ) -> Result<Self, E> {
        // The first interval of each run fills the caches and does not count.
        let events = [first()?.events_per_collision, other()?.events_per_collision];
        let (mut firsts, mut others) = (Vec::with_capacity(ROUNDS), Vec::with_capacity(ROUNDS));
        for round in 0..ROUNDS {
            // The order alternates, so that neither run always starts with the caches that the other leaves.
            if round % 2 == 0 {
                firsts.push(first()?.nanoseconds_per_collision);
                others.push(other()?.nanoseconds_per_collision);
            } else {
                others.push(other()?.nanoseconds_per_collision);
                firsts.push(first()?.nanoseconds_per_collision);
            }
        }
        let mut ratios: Vec<f64> = firsts.iter().zip(&others).map(|(first, other)| other / first).collect();
        ratios.sort_by(f64::total_cmp);
        Ok(Self {
            ratio: Quartiles::of(ratios.iter().copied()),
            interval: [ratios[OUTSIDE], ratios[ROUNDS - 1 - OUTSIDE]],
            nanoseconds: [Quartiles::of(firsts), Quartiles::of(others)],
            events,
        })
    }

    /// Returns the ratio of the times per collision: the time of the other run divided by the time of the
    /// first.
    pub const fn ratio(&self) -> Quartiles {
        self.ratio
    }

    /// Returns the 99.8 % confidence interval of the median ratio, for independent ratios of any
    /// distribution.
    ///
    /// The interval holds for this pair of trajectories only. A rule with other physics leads to another
    /// trajectory, which alone makes a difference of up to 2 % in a dilute gas: compare from several states,
    /// with `run_until` between them, and take the spread. The compiler places equal code at different
    /// addresses, which makes a further difference of 1 or 2 %.
    pub const fn interval(&self) -> [f64; 2] {
        self.interval
    }

    /// Returns whether 1 is outside the [interval](Self::interval), and on which side.
    pub fn finding(&self) -> Finding {
        match self.interval {
            _ if !self.nanoseconds.iter().all(|time| time.high.is_finite()) => Finding::Unknown,
            [low, _] if low > 1.0 => Finding::Slower,
            [_, high] if high < 1.0 => Finding::Faster,
            _ => Finding::Noise,
        }
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { ratio: Quartiles { low, median, high }, interval, nanoseconds, events } = self;
        let finding = match self.finding() {
            Finding::Faster => "faster",
            Finding::Noise => "no difference beyond the noise",
            Finding::Slower => "slower",
            Finding::Unknown => "not known, as no two disks collided",
        };
        write!(formatter, "{median:.4} (quartiles {low:.4}–{high:.4}) ")?;
        writeln!(formatter, "times as long per collision: {finding}")?;
        write!(formatter, "the median lies in {:.4}–{:.4}; ", interval[0], interval[1])?;
        writeln!(formatter, "equal code at another address alone makes 1 or 2 %")?;
        let [first, other] = nanoseconds.map(|quartiles| quartiles.median);
        write!(formatter, "{first:.1} and {other:.1} ns a collision; ")?;
        write!(formatter, "{:.3} and {:.3} events a collision", events[0], events[1])
    }
}

/// The median and the quartiles of a few measurements.
///
/// ```
/// use granular_edmd::speed::Quartiles;
/// let quartiles = Quartiles::of([3.0, 1.0, 2.0, 100.0, 4.0]);
/// assert_eq!(quartiles.to_string(), "3.00 (2.00–4.00)");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Quartiles {
    /// A quarter of the values are below this one.
    pub low: f64,
    /// Half of the values are below this one.
    pub median: f64,
    /// A quarter of the values are above this one.
    pub high: f64,
}

impl Quartiles {
    /// Computes the quartiles of these values; NaN without values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let [low, median, high] = [0.25, 0.5, 0.75].map(|share| quantile(&values, share));
        Self { low, median, high }
    }
}

/// Returns a quantile, by linear interpolation between neighbors.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let (before, part) = (place.floor() as usize, place.fract());
    sorted[before] + part * (sorted[(before + 1).min(last)] - sorted[before])
}

impl fmt::Display for Quartiles {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:.2} ({:.2}–{:.2})", self.median, self.low, self.high)
    }
}
