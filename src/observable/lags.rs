//! Means over pairs of samples, by the time between the two samples.

use std::collections::VecDeque;

use glam::DVec2;

use super::{PerDisk, SampleTimes, Snapshot};
use crate::quantity::accept;
use crate::statistics::{BlockedMean, Estimate};
use crate::{Disk, ParameterError};

/// Largest displacement between two runs that counts as rounding, relative to the radius of a disk.
const ROUNDING: f64 = 1e-9;

/// Largest number of lags.
const MOST_LAGS: usize = 1 << 20;

/// The last samples of a run, and means over pairs of samples. Every sample is the origin of pairs with later
/// samples.
///
/// Samples are equally spaced. After a gap, or before a run that does not continue the last one, the samples
/// are forgotten and the means are kept.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub(super) struct Lags<V> {
    pub(super) sample_times: SampleTimes,
    /// Time of the latest sample.
    latest: Option<f64>,
    /// The samples, latest first.
    past: VecDeque<V>,
    /// Means for the lags of 0, 1, 2, … intervals.
    means: Vec<BlockedMean>,
    /// Unwrapped positions of the disks at the end of the latest run.
    places: Option<PerDisk<DVec2>>,
    /// Largest id of a disk at the end of any run so far.
    largest_id: u64,
}

impl<V> Lags<V> {
    /// Creates means for lags of 0 to `longest` intervals.
    pub(super) fn new(times: SampleTimes, longest: usize) -> Result<Self, ParameterError> {
        accept((1..=MOST_LAGS).contains(&longest), "number of lags", "in 1..=2^20", longest as f64)?;
        let means = vec![BlockedMean::new(); longest + 1];
        Ok(Self {
            sample_times: times.equally_spaced()?,
            latest: None,
            past: VecDeque::new(),
            means,
            places: None,
            largest_id: 0,
        })
    }

    /// Returns the longest lag, as a number of intervals.
    pub(super) const fn longest(&self) -> usize {
        self.means.len() - 1
    }

    /// Notes the start of a run. If a disk is no longer where the previous run left it, or comes back, the
    /// samples so far are forgotten.
    pub(super) fn begin(&mut self, start: &Snapshot<'_>) {
        self.sample_times.start_at(start.time());
        let Some(places) = self.places.take() else { return };
        let (now, rounding) = (places_in(start), ROUNDING * start.mean(Disk::radius));
        let is_elsewhere = |before: &DVec2, now: &DVec2| f64::from(before.distance(*now) > rounding);
        // A disk whose id is not larger than all earlier ids is not new: it has come back after runs without
        // it.
        let comes_back = now.iter().any(|(id, _)| id <= self.largest_id && !places.has(id));
        if comes_back || places.mean_with(&now, is_elsewhere) > 0.0 {
            self.forget_samples();
        }
    }

    /// Notes the end of a run.
    pub(super) fn pause(&mut self, end: &Snapshot<'_>) {
        let places = places_in(end);
        self.largest_id = places.iter().map(|(id, _)| id).fold(self.largest_id, u64::max);
        self.places = Some(places);
    }

    /// Adds a sample and its pairs with the earlier ones. Pairs whose value is NaN are left out.
    pub(super) fn push(&mut self, time: f64, sample: V, pair: impl Fn(&V, &V) -> f64) {
        let interval = self.sample_times.interval();
        let rounding = self.sample_times.rounding(time);
        if self.latest.is_none_or(|latest| (time - latest - interval).abs() > rounding) {
            self.forget_samples();
        }
        self.latest = Some(time);
        self.past.truncate(self.longest());
        self.past.push_front(sample);
        let latest = &self.past[0];
        for (mean, earlier) in self.means.iter_mut().zip(&self.past) {
            let value = pair(earlier, latest);
            if !value.is_nan() {
                mean.push(value);
            }
        }
    }

    /// Returns the sample taken `lag` intervals before the latest one.
    pub(super) fn before(&self, lag: usize) -> Option<&V> {
        self.past.get(lag)
    }

    /// Iterates over the lags as times, with the means.
    pub(super) fn iter(&self) -> impl ExactSizeIterator<Item = (f64, Estimate)> {
        let interval = self.sample_times.interval();
        self.means.iter().enumerate().map(move |(lag, mean)| (lag as f64 * interval, mean.estimate()))
    }

    /// Forgets the samples, so that the next sample is a new origin.
    pub(super) fn forget_samples(&mut self) {
        self.past.clear();
    }

    pub(super) fn clear(&mut self) {
        self.forget_samples();
        self.means.fill(BlockedMean::new());
    }
}

/// Returns the unwrapped positions of all disks.
pub(super) fn places_in(snapshot: &Snapshot<'_>) -> PerDisk<DVec2> {
    let domain = snapshot.domain();
    PerDisk::of(snapshot.disks(), |disk| domain.unwrapped(disk))
}

crate::gate::from_file! {
    Lags<V> {
        sample_times: SampleTimes,
        latest: Option<f64>,
        past: VecDeque<V>,
        means: Vec<BlockedMean>,
        #[serde(default)] places: Option<PerDisk<DVec2>>,
        #[serde(default)] largest_id: u64
    } => {
        crate::quantity::finite("time of the latest sample", latest.unwrap_or(0.0))?;
        let lags = means.len().saturating_sub(1);
        accept((1..=MOST_LAGS).contains(&lags), "number of lags", "in 1..=2^20", lags as f64)?;
        let fits = past.len() <= means.len();
        accept(fits, "number of samples that are kept", "at most the number of lags", past.len() as f64)?;
        Ok(Self { sample_times, latest, past, means, places, largest_id })
    }
}
