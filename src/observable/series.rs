//! Values of an observable at set times.

use super::{Observable, Observer, Snapshot};
use crate::ParameterError;
use crate::quantity::{finite, positive};

/// Equally spaced times: a start, and a sample after each interval.
///
/// The times are multiples, not sums, of the interval: the thousandth is as exact as the first. To sample at a fixed
/// phase of a vibrating base take a number of its periods as interval and the phase as start. Compute the end of a run
/// the same way (`count as f64 * interval`), or its last sample may lie one rounding behind the end.
///
/// ```
/// use granular_edmd::observable::SampleTimes;
/// let times = SampleTimes::every(2.0)?.starting_at(10.5)?;
/// assert_eq!(times.next(), 10.5);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleTimes {
    start: f64,
    interval: f64,
    /// Intervals from the start to the next sample.
    intervals: u64,
}

impl SampleTimes {
    /// A sample after each interval, the first at the end of the first one.
    ///
    /// # Errors
    /// If the interval is not finite and positive.
    pub fn every(interval: f64) -> Result<Self, ParameterError> {
        let interval = positive("sampling interval", interval)?;
        Ok(Self { start: 0.0, interval, intervals: 1 })
    }

    /// The same interval with the first sample at `start`.
    ///
    /// # Errors
    /// If the start is not finite.
    pub fn starting_at(self, start: f64) -> Result<Self, ParameterError> {
        Ok(Self { start: finite("first sampling time", start)?, intervals: 0, ..self })
    }

    /// The time of the next sample; infinite once the interval is lost in rounding.
    pub fn next(&self) -> f64 {
        if self.intervals == u64::MAX {
            return f64::INFINITY;
        }
        self.start + self.intervals as f64 * self.interval
    }

    /// On to the first time after `time`.
    pub(super) fn advance_past(&mut self, time: f64) {
        while self.next() <= time {
            let skipped = ((time - self.next()) / self.interval).floor().max(0.0);
            self.intervals = self.intervals.saturating_add(1).saturating_add(skipped as u64);
        }
    }
}

/// An observer that keeps the values of an observable at set times.
///
/// ```
/// use granular_edmd::observable::{OrderParameters, SampleTimes, Series};
/// let series = Series::new(OrderParameters, SampleTimes::every(62.8)?);
/// assert!(series.values().is_empty());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Series<Q: Observable> {
    observable: Q,
    sample_times: SampleTimes,
    times: Vec<f64>,
    values: Vec<Q::Value>,
}

impl<Q: Observable> Series<Q> {
    /// A series of `observable` at these times.
    pub const fn new(observable: Q, times: SampleTimes) -> Self {
        Self { observable, sample_times: times, times: Vec::new(), values: Vec::new() }
    }

    /// The times of the samples.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The values, one a time.
    pub fn values(&self) -> &[Q::Value] {
        &self.values
    }

    /// Times and values together.
    pub fn iter(&self) -> impl Iterator<Item = (f64, &Q::Value)> {
        self.times.iter().copied().zip(&self.values)
    }

    /// Forgets all samples so far.
    pub fn clear(&mut self) {
        self.times.clear();
        self.values.clear();
    }
}

impl<Q: Observable> Observer for Series<Q> {
    fn next_sample(&self) -> f64 {
        self.sample_times.next()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.times.push(snapshot.time());
        self.values.push(self.observable.measure(snapshot));
        self.sample_times.advance_past(snapshot.time());
    }
}
