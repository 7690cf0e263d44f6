//! Comparison of the speeds of two runs, which alternate; medians and quartiles. On a busy machine, the mean
//! of a few measurements says little.

use std::fmt;

use super::{Meter, RunReport};
use crate::Simulation;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::Observer;
use crate::scheduler::EventScheduler;
use crate::simulation::{Limits, RunError};

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

    /// Returns the time of a collision in nanoseconds, in the first run and in the other.
    pub const fn nanoseconds(&self) -> [Quartiles; 2] {
        self.nanoseconds
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
