//! The clock that sets the sampling times of observers, the system that they measure, and the intervals
//! between their samples.

use super::Snapshot;
use super::snapshot::Mark;
use crate::ParameterError;
use crate::quantity::{accept, finite, positive};

/// Relative rounding error of the start time of a run, and of a sampling time. Each is the sum of an offset
/// and an origin, rounded a few times.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Rounding error of a start time and of a sampling time, relative to the interval. Before time 0, for
/// example, the origin may be far larger than the time, and the time then has the origin's rounding error.
const PART: f64 = 1e-9;

/// Powers of ten, for the decimal places of an interval whose multiples are computed as decimal numbers.
const POWERS_OF_TEN: [f64; 10] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];

/// Smallest ratio of the interval to the time. Rounding then moves a sampling time by at most a sixteenth of
/// the interval.
const COARSEST: f64 = 16.0 * f64::EPSILON;

/// A clock for observers: equally spaced times of samples, or times at equal ratios.
///
/// The sampling times are the multiples of the interval, counted from time 0 ([`Self::every`]) or from a
/// first time ([`Self::starting_at`]). Each time is a multiple, not a sum, so the thousandth is as exact as
/// the first. If the interval and the first time are decimal numbers of at most nine places, so are the
/// sampling times: the third multiple of 0.1 is 0.3. [`Self::at_ratio`] gives times that are equally spaced
/// on a logarithmic scale, and [`ByCollisions`](super::ByCollisions) samples by the number of collisions.
///
/// # The start of a run
/// An observer passes the start of each run to [`Self::start_at`]. Sampling times before the start are left
/// out, and so is a sampling time at the start, within rounding. A run of $`n`$ intervals therefore gives
/// $`n`$ samples, the first after one interval. This holds for a run from time 0, from another start, from a
/// checkpoint, or after a settling run. There are two exceptions:
/// - A run that starts exactly at the first time of `starting_at` takes a sample there.
/// - A clock that has run before continues. If the next run starts at the upcoming sampling time, within
///   rounding, it takes the sample there, since the previous run ended just before it. A run in pieces thus
///   has the same samples as a run in one piece.
///
/// If a run starts before the last sampling time, it counts as another run, and the clock begins anew.
///
/// To sample at a fixed phase of a vibrating base, take a whole number of its periods as the interval, and a
/// time of that phase as the first time.
///
/// # The end of a run
/// A time that rounding puts just after the end of a run counts as the end: the run then ends at that time, a
/// few roundings later, and has its sample. The same holds for kicks and for the openings of inlets.
///
/// # Two clocks
/// Times of two clocks are the same only to the bit. A sample, a kick and the opening of an inlet at times
/// that differ by a rounding come in the order of the bits, now one first and now the other. Where their
/// order matters, take decimal intervals, or put the first time of one clock between two times of the other
/// ([`Self::starting_at`]).
///
/// ```
/// use granular_edmd::observable::SampleTimes;
/// let mut times = SampleTimes::every(2.0)?;
/// assert_eq!(times.upcoming(), 2.0);
/// times.start_at(11.5);
/// assert_eq!(times.upcoming(), 12.0);
/// times.advance_past(12.0);
/// assert_eq!(times.upcoming(), 14.0);
///
/// let mut times = SampleTimes::every(2.0)?.starting_at(10.5)?;
/// times.start_at(0.0);
/// assert_eq!(times.upcoming(), 10.5);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SampleTimes {
    /// The interval, or for times at equal ratios the ratio.
    interval: f64,
    is_ratio: bool,
    /// The first sampling time.
    ///
    /// If it is `None`, sampling times are counted from time 0 in both directions.
    first: Option<f64>,
    /// Number of the upcoming sampling time.
    beat: i64,
    /// The upcoming sampling time, which runs read after each collision.
    #[cfg_attr(feature = "serde", serde(skip))]
    upcoming: f64,
    /// The first sampling time and the interval, times `places`: whole numbers if both are decimal.
    #[cfg_attr(feature = "serde", serde(skip))]
    steps: [f64; 2],
    /// A power of ten, or 1 for numbers that are not decimal.
    #[cfg_attr(feature = "serde", serde(skip))]
    places: f64,
    /// True once a run has started.
    started: bool,
}

impl SampleTimes {
    /// Creates a clock with a sampling time after each interval.
    ///
    /// # Errors
    /// If the interval is not finite and positive.
    pub fn every(interval: f64) -> Result<Self, ParameterError> {
        let interval = positive("sampling interval", interval)?;
        Ok(Self::new(interval, false, None, 1))
    }

    /// Creates a clock whose sampling times are `first`, `first * ratio`, `first * ratio²` and so on, as for
    /// a gas that cools.
    ///
    /// Observers of intervals, such as [`WallStress`](super::WallStress), and white noise need equally spaced
    /// times, and refuse others.
    ///
    /// # Errors
    /// If the first time is not finite and positive, or the ratio is not in (1, 1e9].
    ///
    /// ```
    /// use granular_edmd::observable::SampleTimes;
    /// let mut times = SampleTimes::at_ratio(0.5, 2.0)?;
    /// times.start_at(0.0);
    /// let next = |times: &mut SampleTimes| {
    ///     let next = times.upcoming();
    ///     times.advance_past(next);
    ///     next
    /// };
    /// assert_eq!([0; 4].map(|_| next(&mut times)), [0.5, 1.0, 2.0, 4.0]);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    pub fn at_ratio(first: f64, ratio: f64) -> Result<Self, ParameterError> {
        let first = Some(positive("first sampling time", first)?);
        let interval = accept(ratio > 1.0 && ratio <= 1e9, "ratio of sampling times", "in (1, 1e9]", ratio)?;
        Ok(Self::new(interval, true, first, 0))
    }

    /// Returns the same clock with its first sampling time at this absolute time.
    ///
    /// # Errors
    /// If the time is not finite, or not positive for times at equal ratios.
    pub fn starting_at(self, first: f64) -> Result<Self, ParameterError> {
        if self.is_ratio {
            return Self::at_ratio(first, self.interval);
        }
        let first = Some(finite("first sampling time", first)?);
        Ok(Self::new(self.interval, false, first, 0))
    }

    /// Returns the interval between two sampling times, or NaN for times at equal ratios.
    pub const fn interval(&self) -> f64 {
        if self.is_ratio { f64::NAN } else { self.interval }
    }

    /// Returns the same clock if its times are equally spaced.
    pub(crate) fn equally_spaced(self) -> Result<Self, ParameterError> {
        accept(
            !self.is_ratio,
            "ratio of sampling times",
            "absent: equal intervals are needed",
            self.interval,
        )?;
        Ok(self)
    }

    /// Returns the upcoming sampling time.
    ///
    /// It is NaN where times are too coarse for the interval, which ends a run with an error: samples would
    /// be unevenly spaced there, or missing.
    #[inline]
    pub const fn upcoming(&self) -> f64 {
        self.upcoming
    }

    fn new(interval: f64, is_ratio: bool, first: Option<f64>, beat: i64) -> Self {
        let times = [first.unwrap_or(0.0), interval];
        let is_whole = |places: &f64| times.iter().all(|time| (time * places).round() / places == *time);
        let decimal = POWERS_OF_TEN.into_iter().find(is_whole);
        let (steps, places) =
            decimal.map_or((times, 1.0), |places| (times.map(|time| (time * places).round()), places));
        Self { interval, is_ratio, first, beat, upcoming: 0.0, steps, places, started: false }.at_beat()
    }

    fn at_beat(self) -> Self {
        let time = self.time_of(self.beat);
        let is_coarse = self.spacing(time) < COARSEST * time.abs();
        Self { upcoming: if is_coarse { f64::NAN } else { time }, ..self }
    }

    /// Advances to the first sampling time after this absolute time.
    ///
    /// Call this with the time of each sample.
    pub fn advance_past(&mut self, time: f64) {
        // Each further attempt skips twice the number of sampling times, so that the clock passes the time
        // soon even where rounding swallows single intervals.
        let mut more = 1_i64;
        while self.beat < i64::MAX && self.time_of(self.beat) <= time {
            let next = self.time_of(self.beat);
            let skipped = if self.is_ratio {
                libm::log(time / next) / libm::log(self.interval)
            } else {
                (time - next) / self.interval
            };
            self.beat = self.beat.saturating_add(more).saturating_add(skipped.floor().max(0.0) as i64);
            more = more.saturating_mul(2);
        }
        *self = self.at_beat();
    }

    /// Notes that a run starts at this absolute time.
    ///
    /// Call this from [`Observer::on_start`](super::Observer::on_start).
    pub fn start_at(&mut self, time: f64) {
        if !time.is_finite() {
            return;
        }
        let rounding = self.rounding(time);
        if !self.started || time < self.time_of(self.beat.saturating_sub(1)) - rounding {
            self.begin_anew(time, rounding);
        } else if self.time_of(self.beat) < time - rounding {
            self.advance_past(time + rounding);
        }
        *self = Self { started: true, ..self.at_beat() };
    }

    /// Sets the first sampling time of a run that has no sample yet.
    fn begin_anew(&mut self, time: f64, rounding: f64) {
        let Some(first) = self.first else {
            // The cast saturates. The rounding error of a large quotient may change the number by one, which
            // `rounding` allows for.
            self.beat = (time / self.interval).floor() as i64;
            return self.advance_past(time + rounding);
        };
        self.beat = 0;
        if first < time - rounding {
            self.advance_past(time + rounding);
        }
    }

    /// Returns the difference up to which times near this one count as the same.
    pub(super) fn rounding(&self, time: f64) -> f64 {
        ROUNDING * time.abs() + PART * self.spacing(time)
    }

    /// Returns the time between the sampling times near this time.
    fn spacing(&self, time: f64) -> f64 {
        if self.is_ratio { (self.interval - 1.0) * time.abs() } else { self.interval }
    }

    fn time_of(&self, beat: i64) -> f64 {
        let beat_number = beat as f64;
        if beat == i64::MAX {
            f64::INFINITY
        } else if self.is_ratio {
            near_decimal(self.first.unwrap_or(0.0) * libm::pow(self.interval, beat_number))
        } else {
            // Products of whole numbers are exact, so that only the quotient is rounded.
            (self.steps[0] + beat_number * self.steps[1]) / self.places
        }
    }
}

crate::gate::from_file! {
    SampleTimes {
        interval: f64, is_ratio: bool, first: Option<f64>, beat: i64, started: bool
    } => {
        let first_time = first.unwrap_or(0.0);
        let clock = if is_ratio { Self::at_ratio(first_time, interval)? } else { Self::every(interval)? };
        finite("first sampling time", first_time)?;
        let counted = first.is_none() || beat >= 0;
        accept(counted, "number of the next sample", "not negative", beat as f64)?;
        Ok(Self { started, ..Self::new(clock.interval, is_ratio, first, beat) })
    }
}

/// Rounding of the times of a run, relative to the largest of them.
const EARLIER: f64 = 1e-12;

/// The system of the latest run, and the end of that run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(super) struct System {
    #[cfg_attr(feature = "serde", serde(skip))]
    mark: Mark,
    end: Option<f64>,
}

impl System {
    /// No system yet.
    pub(super) const NONE: Self = Self { mark: Mark::NONE, end: None };

    /// Notes the start of a run.
    ///
    /// # Errors
    /// If the run belongs to another system, or begins before the end of the previous one.
    pub(super) fn begin(&mut self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        self.is_same(start)?;
        let (time, end) = (start.time(), self.end.unwrap_or(f64::NEG_INFINITY));
        let requirement = "not before the end of the previous one; take a new observer for another run";
        let goes_on = time >= end - EARLIER * end.abs().max(time.abs());
        accept(goes_on, "start of the run", requirement, time).map(drop)
    }

    /// Notes the system of a run, which may start at any time. Returns an error if it is another system than
    /// before.
    pub(super) fn is_same(&mut self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        let is_same = !self.mark.is_other(start.system_mark());
        let requirement = "of the same system; take a new observer for another system";
        accept(is_same, "start of the run", requirement, start.time())?;
        self.mark = start.system_mark();
        Ok(())
    }

    /// Notes the end of a run.
    pub(super) fn pause(&mut self, end: &Snapshot<'_>) {
        self.end = Some(end.time());
    }
}

/// The interval of time since the latest sample, called a stretch.
///
/// A stretch counts if it is a complete interval between two sampling times. If a run begins between two
/// sampling times, its first stretch is shorter and does not count. A run that begins where the previous run
/// ended continues the stretch of that run.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(super) struct Stretch {
    pub(super) sample_times: SampleTimes,
    start: Option<f64>,
    /// End of the latest run.
    end: Option<f64>,
    /// The system of the latest run.
    #[cfg_attr(feature = "serde", serde(skip))]
    system: Mark,
}

impl Stretch {
    pub(super) const fn new(times: SampleTimes) -> Self {
        Self { sample_times: times, start: None, end: None, system: Mark::NONE }
    }

    fn is_near(&self, one: f64, other: f64) -> bool {
        (one - other).abs() <= self.sample_times.rounding(other)
    }

    /// Notes the start of a run, and returns true if the run begins a new stretch. A run of another system
    /// always does.
    ///
    /// # Errors
    /// If the intervals are not equal.
    pub(super) fn begin(&mut self, start: &Snapshot<'_>) -> Result<bool, ParameterError> {
        let time = start.time();
        self.sample_times.equally_spaced()?;
        self.sample_times.start_at(time);
        let is_same = !self.system.is_other(start.system_mark());
        let goes_on = is_same && self.start.is_some() && self.end.is_some_and(|end| self.is_near(end, time));
        if !goes_on {
            self.start = Some(time);
        }
        self.system = start.system_mark();
        Ok(!goes_on)
    }

    /// Forgets the start of the stretch, which then does not count.
    pub(super) const fn forget(&mut self) {
        self.start = None;
    }

    /// Notes that a run ends at this time.
    pub(super) fn pause(&mut self, time: f64) {
        self.end = Some(time);
    }

    /// Begins a new stretch at the time of a sample, and returns the length of the previous one if it counts.
    pub(super) fn finish(&mut self, time: f64) -> Option<f64> {
        let interval = self.sample_times.interval();
        let start = self.start.replace(time);
        self.sample_times.advance_past(time);
        start.filter(|start| self.is_near(start + interval, time)).map(|start| time - start)
    }
}

/// Returns the decimal number of ten digits of which a time is a rounded value, or else the time itself.
///
/// The ratio of ten samples a decade is rounded, and so are its powers: the tenth would be a little later
/// than a run that ends with the decade.
fn near_decimal(time: f64) -> f64 {
    let places = libm::pow(10.0, 9.0 - libm::floor(libm::log10(time)));
    let decimal = (time * places).round() / places;
    if (decimal - time).abs() <= 64.0 * f64::EPSILON * time { decimal } else { time }
}
