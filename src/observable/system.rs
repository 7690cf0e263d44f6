//! The system that an observer measures. A later run must have the same system.

use super::Snapshot;
use super::marks::Mark;
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
