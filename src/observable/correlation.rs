//! Correlations in time: means over pairs of samples by the time between them, displacements, and functions
//! of values of disks.

use std::collections::VecDeque;

use glam::DVec2;

use super::table::table;
use super::{Observable, Observer, ObserverError, SampleTimes, Snapshot};
use crate::disk::numbered;
use crate::quantity::accept;
use crate::statistics::{BlockedMean, Estimate};
use crate::{Disk, ParameterError};

/// A value for each disk of a snapshot.
///
/// Values at two times are matched by the ids of the disks. Only disks with a value at both times count, so
/// disks may be inserted, removed or sorted in between.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{InnerProduct, PerDisk};
/// use granular_edmd::Disk;
///
/// let at_rest = Disk::new(DVec2::ZERO, 0.5)?;
/// let disk = |id: u64, speed: f64| at_rest.with_velocity(DVec2::X * speed)?.with_id(id);
/// let before = PerDisk::of(&[disk(1, 2.0)?, disk(2, 3.0)?], |disk| disk.velocity().x);
/// let after = PerDisk::of(&[disk(7, 9.0)?, disk(2, 5.0)?], |disk| disk.velocity().x);
/// assert_eq!(before.inner_product(&after), 15.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "Vec<(u64, T)>"))]
// Ids and values, in the order of the ids.
pub struct PerDisk<T>(Vec<(u64, T)>);

impl<T> PerDisk<T> {
    /// Evaluates a quantity of each disk.
    ///
    /// If some of them have no id, all are identified by their index in the list.
    pub fn of(disks: &[Disk], quantity: impl Fn(&Disk) -> T) -> Self {
        numbered(disks).map(|(id, disk)| (id, quantity(disk))).collect::<Vec<_>>().into()
    }

    /// Iterates over the ids and values, in the order of the ids.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (u64, &T)> {
        self.0.iter().map(|(id, value)| (*id, value))
    }

    /// Returns whether there is a value for the disk with this id.
    pub(super) fn has(&self, id: u64) -> bool {
        self.0.binary_search_by_key(&id, |(id, _)| *id).is_ok()
    }

    /// Returns the mean of a function of a disk's two values, over the disks that have both, or NaN if no
    /// disk has both.
    pub fn mean_with(&self, other: &Self, function: impl Fn(&T, &T) -> f64) -> f64 {
        let (mut sum, mut count) = (0.0, 0);
        let mut others = other.0.iter().peekable();
        for (id, value) in &self.0 {
            while others.next_if(|(other, _)| other < id).is_some() {}
            if let Some((_, of_other)) = others.next_if(|(other, _)| other == id) {
                sum += function(value, of_other);
                count += 1;
            }
        }
        sum / f64::from(count)
    }
}

impl<T> From<Vec<(u64, T)>> for PerDisk<T> {
    /// Creates the values from ids and values in any order.
    fn from(mut entries: Vec<(u64, T)>) -> Self {
        // While the disks of a run stay the same, their ids are in order already.
        entries.sort_by_key(|(id, _)| *id);
        Self(entries)
    }
}

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
struct Lags<V> {
    sample_times: SampleTimes,
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
    fn new(times: SampleTimes, longest: usize) -> Result<Self, ParameterError> {
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
    const fn longest(&self) -> usize {
        self.means.len() - 1
    }

    /// Notes the start of a run. If a disk is no longer where the previous run left it, or comes back, the
    /// samples so far are forgotten.
    fn begin(&mut self, start: &Snapshot<'_>) {
        self.sample_times.start_at(start.time());
        let Some(places) = self.places.take() else { return };
        let (now, rounding) = (places_in(start), ROUNDING * start.mean(Disk::radius));
        let is_elsewhere = |before: &DVec2, now: &DVec2| f64::from(before.distance(*now) > rounding);
        // A disk whose id is not larger than all earlier ids is not new: it has come back after runs without
        // it.
        let comes_back = now.iter().any(|(id, _)| id <= self.largest_id && !places.has(id));
        if comes_back || places.mean_with(&now, is_elsewhere) > 0.0 {
            self.past.clear();
        }
    }

    /// Notes the end of a run.
    fn pause(&mut self, end: &Snapshot<'_>) {
        let places = places_in(end);
        self.largest_id = places.iter().map(|(id, _)| id).fold(self.largest_id, u64::max);
        self.places = Some(places);
    }

    /// Adds a sample and its pairs with the earlier ones. Pairs whose value is NaN are left out.
    fn push(&mut self, time: f64, sample: V, pair: impl Fn(&V, &V) -> f64) {
        let interval = self.sample_times.interval();
        let rounding = self.sample_times.rounding(time);
        if self.latest.is_none_or(|latest| (time - latest - interval).abs() > rounding) {
            self.past.clear();
        }
        self.latest = Some(time);
        self.sample_times.advance_past(time);
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

    /// Iterates over the lags as times, with the means.
    fn iter(&self) -> impl ExactSizeIterator<Item = (f64, Estimate)> {
        let interval = self.sample_times.interval();
        self.means.iter().enumerate().map(move |(lag, mean)| (lag as f64 * interval, mean.estimate()))
    }
}

/// Returns the unwrapped positions of all disks.
fn places_in(snapshot: &Snapshot<'_>) -> PerDisk<DVec2> {
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

    /// Returns the slope over the second half of the lags, up to the latest sample.
    fn slope(&self) -> Option<f64> {
        let (longest, half) = (self.lags.longest(), self.lags.longest() / 2);
        let [latest, middle, earliest] = [0, half, longest].map(|lag| self.lags.past.get(lag));
        let (latest, middle, earliest) = (latest?, middle?, earliest?);
        let gain = squared_displacement(earliest, latest) - squared_displacement(middle, latest);
        Some(gain / ((longest - half) as f64 * self.lags.sample_times.interval()))
    }
}

/// Returns the mean squared distance between two positions of each disk.
fn squared_displacement(from: &PerDisk<DVec2>, to: &PerDisk<DVec2>) -> f64 {
    from.mean_with(to, |from, to| from.distance_squared(*to))
}

/// Writes the methods that an observer leaves to its lags: starts, ends, and the time of the next sample.
macro_rules! left_to_lags {
    () => {
        fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
            self.lags.begin(start);
            Ok(())
        }

        fn next_sample(&self) -> f64 {
            self.lags.sample_times.upcoming()
        }

        fn on_end(&mut self, end: &Snapshot<'_>) {
            self.lags.pause(end);
        }
    };
}

impl Observer for MeanSquaredDisplacement {
    left_to_lags!();

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let (periods, places) = (snapshot.domain().periods(), places_in(snapshot));
        if self.periods != periods {
            self.periods = periods;
            self.lags.past.clear();
        }
        self.lags.push(snapshot.time(), places, squared_displacement);
        if let Some(slope) = self.slope().filter(|slope| !slope.is_nan()) {
            self.diffusion.push(0.25 * slope);
        }
    }
}

table! { MeanSquaredDisplacement, this: for (time, value) in this.iter();
    "time" ["time"]: time;
    "squared_displacement" ["length^2"]: value
}

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
}

impl<Q: Observable<Value: InnerProduct>> Observer for TimeCorrelation<Q> {
    left_to_lags!();

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let value = self.observable.measure(snapshot);
        self.lags.push(snapshot.time(), value, InnerProduct::inner_product);
    }
}

table! { TimeCorrelation<Q: Observable>, this: for (time, value) in this.iter();
    "time" ["time"]: time;
    "correlation" ["observable^2"]: value
}
