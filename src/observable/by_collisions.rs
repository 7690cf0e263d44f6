//! Samples by the number of collisions.

use super::{Collision, Observer, ObserverError, Snapshot, Verdict};
use crate::quantity::accept;
use crate::{Disk, ParameterError};

/// An adapter that shows an observer a sample after each number of collisions, of disks with disks or walls,
/// in place of the observer's own sampling times.
///
/// A gas that cools has ever fewer collisions per unit of time; its state changes with the number of
/// collisions. Collisions at the same time come before the sample. Observers of equal intervals, such as
/// [`WallStress`](super::WallStress), measure nothing here.
///
/// ```
/// use granular_edmd::observable::{ByCollisions, Temperatures};
/// use granular_edmd::prelude::*;
///
/// let container = Container::periodic(20.0, 20.0)?;
/// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 1)?;
/// let mut run = Simulation::builder(Smooth::from_restitution(0.9)?, container).disks(disks).build()?;
/// // The interval is not used.
/// let series = Series::new(Temperatures, SampleTimes::every(1.0)?);
/// let mut cooling = ByCollisions::new(100, series)?;
/// run.run(&Limits::collisions(1000), &mut cooling)?;
/// assert_eq!(cooling.inner().values().len(), 10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ByCollisions<O> {
    inner: O,
    every: u64,
    /// Number of collisions since the latest sample.
    count: u64,
    /// Time of the collision after which a sample is due.
    due: Option<f64>,
}

impl<O> ByCollisions<O> {
    /// Creates an observer that shows `inner` a sample after every `count` collisions.
    ///
    /// # Errors
    /// If the number is 0.
    pub fn new(count: u64, inner: O) -> Result<Self, ParameterError> {
        accept(count > 0, "number of collisions between samples", "positive", count as f64)?;
        Ok(Self { inner, every: count, count: 0, due: None })
    }

    /// Returns the inner observer.
    pub const fn inner(&self) -> &O {
        &self.inner
    }

    /// Unwraps the inner observer.
    pub fn into_inner(self) -> O {
        self.inner
    }
}

impl<O: Observer> Observer for ByCollisions<O> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.inner.on_start(start)
    }
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.inner.on_collision(collision);
        self.count += 1;
        if self.count >= self.every {
            self.due = Some(collision.time);
        }
    }
    #[inline]
    fn next_sample(&self) -> f64 {
        self.due.unwrap_or(f64::INFINITY)
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.inner.on_sample(snapshot);
        (self.count, self.due) = (0, None);
    }
    fn on_insert(&mut self, disk: &Disk, time: f64) {
        self.inner.on_insert(disk, time);
    }
    fn on_remove(&mut self, disk: &Disk, time: f64) {
        self.inner.on_remove(disk, time);
    }
    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.inner.on_end(end);
    }
    #[inline]
    fn verdict(&mut self) -> Verdict {
        self.inner.verdict()
    }
}
