//! Correlation functions in time.

use glam::DVec2;

use super::lags::Lags;
use super::table::{Table, headings, row};
use super::{Heading, Observable, Observer, ObserverError, PerDisk, SampleTimes, Snapshot};
use crate::ParameterError;
use crate::statistics::Estimate;

/// A value that can be correlated with another value of the same type.
///
/// Implement it for the value of a custom observable. Return NaN if two values have no product.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::InnerProduct;
/// assert_eq!(2.0.inner_product(&3.0), 6.0);
/// assert_eq!(DVec2::new(1.0, 2.0).inner_product(&DVec2::new(3.0, 4.0)), 11.0);
/// ```
pub trait InnerProduct {
    /// Returns the product of two values.
    fn inner_product(&self, other: &Self) -> f64;
}

impl InnerProduct for f64 {
    fn inner_product(&self, other: &Self) -> f64 {
        self * other
    }
}

impl InnerProduct for DVec2 {
    fn inner_product(&self, other: &Self) -> f64 {
        self.dot(*other)
    }
}

/// The product is the mean of the products of each disk's two values, over the disks that have both.
impl<T: InnerProduct> InnerProduct for PerDisk<T> {
    fn inner_product(&self, other: &Self) -> f64 {
        self.mean_with(other, T::inner_product)
    }
}

/// The velocity of each disk.
///
/// The [`TimeCorrelation`] of these velocities is the velocity autocorrelation function.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Velocities;

impl Observable for Velocities {
    type Value = PerDisk<DVec2>;

    fn measure(&self, snapshot: &Snapshot<'_>) -> PerDisk<DVec2> {
        PerDisk::of(snapshot.disks(), crate::Disk::velocity)
    }
}

/// An observer of the correlation function of an observable in time.
///
/// ```math
/// C(t) = \langle A(0)\cdot A(t)\rangle
/// ```
///
/// Every sample is a time origin, and the lags are whole numbers of intervals. The product is defined by
/// [`InnerProduct`]: the dot product of vectors, and the mean over the disks for values of disks. No mean is
/// subtracted. To correlate fluctuations, subtract the mean in the observable if the mean is known.
/// Otherwise, subtract the square of the mean from the correlation. After a gap in time, or if disks were put
/// elsewhere between two runs, the observer begins with new origins. Pairs without a product, such as samples
/// that have no disk in common, are left out. The errors come from blocks of origins.
///
/// A sample costs time and memory in proportion to the number of lags.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::observable::{SampleTimes, Temperatures, TimeCorrelation, Velocities};
/// use granular_edmd::{Simulation, initial};
///
/// let container = Container::periodic(20.0, 20.0)?;
/// let disks = initial::scattered(&container, 100, 0.5, 20.0, 1)?;
/// let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
/// let mut correlation = TimeCorrelation::new(Velocities, 10, SampleTimes::every(0.5)?)?;
/// let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
/// run.run_until(100.0, &mut correlation)?;
/// let values: Vec<f64> = correlation.iter().map(|(_, value)| value.mean()).collect();
/// // Twice the temperature at a lag of 0, and less at later lags.
/// let temperature = run.measure(&Temperatures).translational();
/// assert!((values[0] - 2.0 * temperature).abs() < 1e-9 && values[1] < 0.9 * values[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        deny_unknown_fields,
        bound(
            serialize = "Q: serde::Serialize, Q::Value: serde::Serialize",
            deserialize = "Q: serde::Deserialize<'de>, Q::Value: serde::Deserialize<'de>"
        )
    )
)]
pub struct TimeCorrelation<Q: Observable> {
    observable: Q,
    lags: Lags<Q::Value>,
}

impl<Q: Observable> TimeCorrelation<Q> {
    /// Creates the correlation function of `observable` over 0 to `lags` intervals of the sample times.
    ///
    /// # Errors
    /// If the number of lags is not in `1..=2^20`.
    pub fn new(observable: Q, lags: usize, times: SampleTimes) -> Result<Self, ParameterError> {
        Ok(Self { observable, lags: Lags::new(times, lags)? })
    }

    /// Iterates over the lags as times, with the correlations.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, Estimate)> {
        self.lags.iter()
    }

    /// Forgets all samples so far.
    pub fn clear(&mut self) {
        self.lags.clear();
    }
}

impl<Q: Observable<Value: InnerProduct>> Observer for TimeCorrelation<Q> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.lags.begin(start);
        Ok(())
    }

    fn next_sample(&self) -> f64 {
        self.lags.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let value = self.observable.measure(snapshot);
        self.lags.push(snapshot.time(), value, InnerProduct::inner_product);
        self.lags.sample_times.advance_past(snapshot.time());
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.lags.pause(end);
    }
}

impl<Q: Observable> Table for TimeCorrelation<Q> {
    fn headings(&self) -> Vec<Heading> {
        headings(&[("time", "time")], &[("correlation", "observable^2")])
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        Box::new(self.iter().map(|(time, value)| row(&[time], &[value])))
    }
}
