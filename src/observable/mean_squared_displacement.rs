//! Mean squared displacements and the diffusion coefficient.

use glam::DVec2;

use super::lags::{Lags, places_in};
use super::table::{Table, headings, row};
use super::{Heading, Observer, ObserverError, PerDisk, SampleTimes, Snapshot};
use crate::ParameterError;
use crate::statistics::{BlockedMean, Estimate};

/// An observer of the mean squared displacement of the disks, ⟨|r(t) − r(0)|²⟩, and of their coefficient of
/// self-diffusion.
///
/// Every sample is a time origin, and the lags are whole numbers of intervals. Positions are unwrapped at
/// periodic sides and ends. A drift of all disks counts as displacement. Each lag uses the disks that are
/// present at both of its ends. If the periods of the domain change, time jumps, or disks are put elsewhere
/// between two runs, the observer begins with new origins. The result is the mean over origins of the means
/// over disks; the errors come from blocks of origins.
///
/// A sample costs time and memory in proportion to the number of disks and of lags.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{MeanSquaredDisplacement, SampleTimes};
/// use granular_edmd::{Disk, Simulation};
///
/// let disk = Disk::new(DVec2::ONE, 0.5)?.with_velocity(DVec2::new(3.0, 4.0))?;
/// let mut displacement = MeanSquaredDisplacement::new(4, SampleTimes::every(1.0)?)?;
/// let container = Container::periodic(8.0, 8.0)?;
/// Simulation::builder(Elastic, container).disks(vec![disk]).build()?.run_until(20.0, &mut displacement)?;
/// // A free disk of speed 5.
/// let (time, squared) = displacement.iter().nth(3).unwrap();
/// assert_eq!(time, 3.0);
/// assert!((squared.mean() - 225.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MeanSquaredDisplacement {
    lags: Lags<PerDisk<DVec2>>,
    periods: DVec2,
    /// Slopes of the mean squared displacement over the second half of the lags, divided by four.
    diffusion: BlockedMean,
}

impl MeanSquaredDisplacement {
    /// Creates an observer of displacements over 0 to `lags` intervals of the sample times.
    ///
    /// # Errors
    /// If the number of lags is not in `1..=2^20`.
    pub fn new(lags: usize, times: SampleTimes) -> Result<Self, ParameterError> {
        Ok(Self { lags: Lags::new(times, lags)?, periods: DVec2::ZERO, diffusion: BlockedMean::new() })
    }

    /// Iterates over the lags as times, with the mean squared displacements.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, Estimate)> {
        self.lags.iter()
    }

    /// Returns the coefficient of self-diffusion, from the slope over the second half of the lags.
    ///
    /// In two dimensions (Einstein 1905),
    ///
    /// ```math
    /// D = \frac{\langle r^2(t)\rangle - \langle r^2(t/2)\rangle}{4\,(t - t/2)} .
    /// ```
    ///
    /// Both displacements end at the same samples, so the difference of the means in [`Self::iter`], which
    /// has more samples of $`t/2`$, differs within the error. The longest lag $`t`$ should be many times the
    /// mean free time. In two dimensions, the slope keeps growing slowly with $`t`$ (Alder and Wainwright
    /// 1970), so report $`t`$ together with the coefficient.
    pub fn diffusion_coefficient(&self) -> Estimate {
        self.diffusion.estimate()
    }

    /// Forgets all samples so far.
    pub fn clear(&mut self) {
        self.lags.clear();
        self.diffusion = BlockedMean::new();
    }

    /// Returns the slope over the second half of the lags, up to the latest sample.
    fn slope(&self) -> Option<f64> {
        let (longest, half) = (self.lags.longest(), self.lags.longest() / 2);
        let (latest, middle, earliest) =
            (self.lags.before(0)?, self.lags.before(half)?, self.lags.before(longest)?);
        let gain = squared_displacement(earliest, latest) - squared_displacement(middle, latest);
        Some(gain / ((longest - half) as f64 * self.lags.sample_times.interval()))
    }
}

/// Returns the mean squared distance between two positions of each disk.
fn squared_displacement(from: &PerDisk<DVec2>, to: &PerDisk<DVec2>) -> f64 {
    from.mean_with(to, |from, to| from.distance_squared(*to))
}

impl Observer for MeanSquaredDisplacement {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.lags.begin(start);
        Ok(())
    }

    fn next_sample(&self) -> f64 {
        self.lags.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let (periods, places) = (snapshot.domain().periods(), places_in(snapshot));
        if self.periods != periods {
            self.periods = periods;
            self.lags.forget_samples();
        }
        self.lags.push(snapshot.time(), places, squared_displacement);
        if let Some(slope) = self.slope().filter(|slope| !slope.is_nan()) {
            self.diffusion.push(0.25 * slope);
        }
        self.lags.sample_times.advance_past(snapshot.time());
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.lags.pause(end);
    }
}

impl Table for MeanSquaredDisplacement {
    fn headings(&self) -> Vec<Heading> {
        headings(&[("time", "time")], &[("squared_displacement", "length^2")])
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        Box::new(self.iter().map(|(time, value)| row(&[time], &[value])))
    }
}
