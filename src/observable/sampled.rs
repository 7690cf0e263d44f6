//! Accumulators, and the adapter that gives them a clock.

use std::ops::{Deref, DerefMut};

use super::{Collision, Observer, ObserverError, SampleTimes, Snapshot, Verdict, contract};
use crate::ParameterError;

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
pub trait Accumulator {
    /// Adds a snapshot.
    ///
    /// # Errors
    /// If this snapshot cannot be measured. The run then ends with this error.
    fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError>;

    /// Receives a collision that has just happened.
    fn on_collision(&mut self, collision: &Collision) {
        let _ = collision;
    }

    /// Checks, at the start of a run, whether its snapshots can be measured.
    ///
    /// # Errors
    /// If the snapshots cannot be measured, for example because a region is not inside the domain. The run
    /// then ends with this error.
    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        let _ = start;
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

impl<A> DerefMut for Sampled<A> {
    fn deref_mut(&mut self) -> &mut A {
        &mut self.accumulator
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
