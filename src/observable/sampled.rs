//! Series of the values of an observable, and accumulators, with the clock that both have.

use std::ops::Deref;

use super::sample_times::System;
use super::{Collision, Observable, Observer, ObserverError, SampleTimes, Snapshot, Verdict, contract};
use crate::ParameterError;
use crate::quantity::accept;
use crate::statistics::{Estimate, block_average};

/// A measurement that accumulates snapshots.
///
/// In a run, [`Sampled`] gives it the snapshots at set times. A program that takes snapshots itself, such as
/// the samples of a study, calls [`add`](Self::add).
///
/// ```
/// use granular_edmd::boundary::{Boundary, Container};
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::observable::{Accumulator, SampleTimes, Sampled, Snapshot};
/// use granular_edmd::{ParameterError, Simulation, initial};
///
/// /// The largest speed ever seen.
/// #[derive(Default)]
/// struct Fastest(f64);
///
/// impl Accumulator for Fastest {
///     fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError> {
///         let speeds = snapshot.disks().iter().map(|disk| disk.velocity().length());
///         self.0 = speeds.fold(self.0, f64::max);
///         Ok(())
///     }
/// }
///
/// let container = Container::closed(10.0, 10.0)?;
/// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 20, 0.5)?, 1.0, 1)?;
/// let mut fastest = Sampled::new(Fastest::default(), SampleTimes::every(1.0)?);
/// Simulation::builder(Elastic, container).disks(disks).build()?.run_until(10.0, &mut fastest)?;
/// assert!(fastest.0 > 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not add up snapshots",
    label = "an `Accumulator` is expected here",
    note = "an observer with its own clock, such as a `Series`, needs no `Sampled` around it"
)]
#[expect(unused_variables, reason = "what is shown need not be looked at")]
pub trait Accumulator {
    /// Adds a snapshot.
    ///
    /// # Errors
    /// If this snapshot cannot be measured. The run then ends with this error.
    fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError>;

    /// Receives a collision that has just happened.
    fn on_collision(&mut self, collision: &Collision) {}

    /// Checks, at the start of a run, whether its snapshots can be measured.
    ///
    /// # Errors
    /// If the snapshots cannot be measured, for example because a region is not inside the domain. The run
    /// then ends with this error.
    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        Ok(())
    }
}

/// An observer that gives an [`Accumulator`] snapshots at set times.
///
/// It dereferences to the accumulator, from which the results are read.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::observable::{HeightProfile, SampleTimes, Sampled};
/// use granular_edmd::{Simulation, initial};
///
/// let container = Container::closed(10.0, 10.0)?;
/// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 20, 0.5)?, 1.0, 1)?;
/// let mut profile = Sampled::new(HeightProfile::new(0.0, 10.0, 5)?, SampleTimes::every(0.5)?);
/// Simulation::builder(Elastic, container).disks(disks).build()?.run_until(20.0, &mut profile)?;
/// assert_eq!(profile.samples(), 40);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Sampled<A> {
    accumulator: A,
    sample_times: SampleTimes,
    /// The reason why the latest snapshot could not be measured.
    #[cfg_attr(feature = "serde", serde(skip))]
    fault: Option<ParameterError>,
}

impl<A> Sampled<A> {
    /// Creates an observer that adds a snapshot to the accumulator at each of these times.
    pub const fn new(accumulator: A, times: SampleTimes) -> Self {
        Self { accumulator, sample_times: times, fault: None }
    }

    /// Unwraps the accumulator.
    pub fn into_inner(self) -> A {
        self.accumulator
    }
}

impl<A> Deref for Sampled<A> {
    type Target = A;

    fn deref(&self) -> &A {
        &self.accumulator
    }
}

impl<A: Accumulator> Observer for Sampled<A> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.accumulator.check(start)?;
        self.sample_times.start_at(start.time());
        Ok(())
    }

    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.accumulator.on_collision(collision);
    }

    fn next_sample(&self) -> f64 {
        self.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.fault = self.accumulator.add(snapshot).err();
        self.sample_times.advance_past(snapshot.time());
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        contract::verdict(&mut self.fault)
    }
}

/// An observer that keeps the values of an observable at set times.
///
/// The times increase. A run that starts before the last sample, or that belongs to another system, ends
/// immediately with an error. Clear the series before such a run, or use another series. A run that was
/// resumed from a checkpoint older than the series ends with an error, too.
///
/// With the feature `serde`, a series can be written to a file and read back if its observable and its values
/// can. JSON has no NaN, so a series with undefined values can be read back from a
/// [checkpoint](crate::simulation::Checkpoint::write_with), but not from JSON.
///
/// ```
/// use granular_edmd::observable::{OrderParameters, SampleTimes, Series};
/// let series = Series::new(OrderParameters, SampleTimes::every(62.8)?);
/// assert!(series.values().is_empty());
/// # Ok::<(), granular_edmd::ParameterError>(())
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
pub struct Series<Q: Observable> {
    observable: Q,
    sample_times: SampleTimes,
    times: Vec<f64>,
    values: Vec<Q::Value>,
    #[cfg_attr(feature = "serde", serde(skip))]
    system: System,
}

impl<Q: Observable> Series<Q> {
    /// Creates a series of `observable` at these times.
    pub const fn new(observable: Q, times: SampleTimes) -> Self {
        let (sample_times, system) = (times, System::NONE);
        Self { observable, sample_times, times: Vec::new(), values: Vec::new(), system }
    }

    /// Returns the observable.
    pub const fn observable(&self) -> &Q {
        &self.observable
    }

    /// Returns the absolute times of the samples.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the values, one for each time.
    pub fn values(&self) -> &[Q::Value] {
        &self.values
    }

    /// Iterates over times and values together.
    pub fn iter(&self) -> impl Iterator<Item = (f64, &Q::Value)> {
        self.times.iter().copied().zip(&self.values)
    }

    /// Returns the mean of a number that a closure computes from each value, with an error from blocks
    /// ([`block_average`]).
    ///
    /// # Errors
    /// If there are fewer than two samples, or one of the numbers is not finite or above 1e100 in magnitude.
    ///
    /// ```
    /// use granular_edmd::boundary::Container;
    /// use granular_edmd::collision::Smooth;
    /// use granular_edmd::observable::{CenterOfMass, SampleTimes, Series};
    /// use granular_edmd::{Simulation, initial};
    ///
    /// let container = Container::closed(10.0, 10.0)?;
    /// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 20, 0.5)?, 1.0, 1)?;
    /// let mut gas = Simulation::builder(Smooth::from_inelasticity(0.0)?, container).disks(disks).build()?;
    /// let mut series = Series::new(CenterOfMass, SampleTimes::every(1.0)?);
    /// gas.run_until(400.0, &mut series)?;
    /// let height = series.mean(|center| center.y)?;
    /// assert!((height.mean() - 5.0).abs() < 5.0 * height.standard_error());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mean(&self, number: impl Fn(&Q::Value) -> f64) -> Result<Estimate, ParameterError> {
        block_average(&self.values.iter().map(number).collect::<Vec<_>>())
    }
}

impl<Q: Observable> Observer for Series<Q> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        let time = start.time();
        // The previous run may have ended on the last sample, up to rounding.
        let rounding = self.sample_times.rounding(time);
        let goes_on = self.times.last().is_none_or(|&last| time >= last - rounding);
        let requirement = "not before the last sample of the series; take a new one for another run";
        accept(goes_on, "start of the run", requirement, time)?;
        self.system.is_same(start)?;
        self.sample_times.start_at(time);
        Ok(())
    }

    fn next_sample(&self) -> f64 {
        self.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.times.push(snapshot.time());
        self.values.push(self.observable.measure(snapshot));
        self.sample_times.advance_past(snapshot.time());
    }
}
