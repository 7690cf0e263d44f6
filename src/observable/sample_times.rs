//! The clock that sets the sampling times of observers.

use crate::ParameterError;
use crate::quantity::{finite, positive};

/// Relative rounding error of the start time of a run, and of a sampling time. Each is the sum of an offset
/// and an origin, rounded a few times.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Rounding error of a start time and of a sampling time, relative to the interval. Before time 0, for
/// example, the origin may be far larger than the time, and the time then has the origin's rounding error.
const PART: f64 = 1e-9;

/// Smallest ratio of the interval to the time. Rounding then moves a sampling time by at most a sixteenth of
/// the interval.
const COARSEST: f64 = 16.0 * f64::EPSILON;

/// A clock for observers, with equally spaced times of samples.
///
/// The sampling times are the multiples of the interval, counted from time 0 ([`Self::every`]) or from a
/// first time ([`Self::starting_at`]). Each time is a multiple, not a sum, so the thousandth is as exact as
/// the first.
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
/// time of that phase as the first time. Compute the end of a run as a multiple, too
/// (`count as f64 * interval`). Otherwise, rounding may put the last sample just after the end.
///
/// # Two clocks
/// Times of two clocks are the same only to the bit: 3 times 0.1 is 0.30000000000000004, which is later than
/// 0.3. A sample, a kick and the opening of an inlet at such times come in the order of the bits, now one
/// first and now the other. Where their order matters, take intervals whose multiples are exact, such as 0.25
/// and 0.5, or put the first time of one clock between two times of the other ([`Self::starting_at`]).
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
    interval: f64,
    /// The first sampling time.
    ///
    /// If it is `None`, sampling times are counted from time 0 in both directions.
    first: Option<f64>,
    /// Number of the upcoming sampling time.
    beat: i64,
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
        Ok(Self { interval, first: None, beat: 1, started: false })
    }

    /// Returns the same clock with its first sampling time at this absolute time.
    ///
    /// # Errors
    /// If the time is not finite.
    pub fn starting_at(self, first: f64) -> Result<Self, ParameterError> {
        let first = Some(finite("first sampling time", first)?);
        Ok(Self { first, beat: 0, started: false, ..self })
    }

    /// Returns the interval between two sampling times.
    pub const fn interval(&self) -> f64 {
        self.interval
    }

    /// Returns the upcoming sampling time.
    ///
    /// It is NaN where times are too coarse for the interval, which ends a run with an error: samples would
    /// be unevenly spaced there, or missing.
    pub fn upcoming(&self) -> f64 {
        let beat = self.time_of(self.beat);
        if self.interval < COARSEST * beat.abs() { f64::NAN } else { beat }
    }

    /// Advances to the first sampling time after this absolute time.
    ///
    /// Call this with the time of each sample.
    pub fn advance_past(&mut self, time: f64) {
        // Each further attempt skips twice the number of sampling times, so that the clock passes the time
        // soon even where rounding swallows single intervals.
        let mut more = 1_i64;
        while self.beat < i64::MAX && self.time_of(self.beat) <= time {
            let skipped = ((time - self.time_of(self.beat)) / self.interval).floor().max(0.0);
            self.beat = self.beat.saturating_add(more).saturating_add(skipped as i64);
            more = more.saturating_mul(2);
        }
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
        self.started = true;
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
        ROUNDING * time.abs() + PART * self.interval
    }

    fn time_of(&self, beat: i64) -> f64 {
        if beat == i64::MAX {
            return f64::INFINITY;
        }
        self.first.unwrap_or(0.0) + beat as f64 * self.interval
    }
}

crate::gate::from_file! {
    SampleTimes { interval: f64, first: Option<f64>, beat: i64, started: bool } => {
        positive("sampling interval", interval)?;
        finite("first sampling time", first.unwrap_or(0.0))?;
        let counted = first.is_none() || beat >= 0;
        crate::quantity::accept(counted, "number of the next sample", "not negative", beat as f64)?;
        Ok(Self { interval, first, beat, started })
    }
}
