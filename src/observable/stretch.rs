//! Continuity: the system that an observer measures, and the intervals between its samples.

use super::snapshot::Mark;
use super::{SampleTimes, Snapshot};
use crate::ParameterError;
use crate::quantity::accept;

/// Rounding of the times of a run, relative to the largest of them.
const ROUNDING: f64 = 1e-12;

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
        let requirement = "not before the end of the previous one; clear the observer for another run";
        let goes_on = time >= end - ROUNDING * end.abs().max(time.abs());
        accept(goes_on, "start of the run", requirement, time).map(drop)
    }

    /// Notes the system of a run, which may start at any time. Returns an error if it is another system than
    /// before.
    pub(super) fn is_same(&mut self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        let is_same = !self.mark.is_other(start.system_mark());
        let requirement = "of the same system; clear the observer for another system, or take a new one";
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
