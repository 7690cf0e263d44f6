//! Closures as observables and observers.

use super::{Accumulator, Collision, Named, Observable, Observer, SampleTimes, Sampled, Snapshot};
use crate::ParameterError;

/// A closure that measures a snapshot; made by [`measured_by`].
#[derive(Debug, Clone, Copy)]
pub struct MeasuredBy<F>(F);

/// Makes an observable from a closure that measures a snapshot.
///
/// ```
/// use granular_edmd::boundary::{Boundary, Container};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{Observable, Snapshot, measured_by};
/// use granular_edmd::Disk;
///
/// let fastest = |snapshot: &Snapshot<'_>| {
///     snapshot.disks().iter().map(|disk| disk.velocity().length()).fold(0.0, f64::max)
/// };
/// let disks = [Disk::new(DVec2::ONE, 0.5)?.with_velocity(DVec2::new(3.0, 4.0))?];
/// let domain = Container::closed(4.0, 6.0)?.domain();
/// assert_eq!(measured_by(fastest).measure(&Snapshot::new(0.0, &disks, domain, 0.0)), 5.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub const fn measured_by<F, V>(measure: F) -> MeasuredBy<F>
where
    F: Fn(&Snapshot<'_>) -> V,
{
    MeasuredBy(measure)
}

impl<F> MeasuredBy<F> {
    /// Returns the same observable with a name and a unit for its number, so that a [`Series`](super::Series)
    /// of it can be written as a table.
    ///
    /// ```
    /// use granular_edmd::observable::{SampleTimes, Series, Snapshot, Table, measured_by};
    /// let count = measured_by(|snapshot: &Snapshot<'_>| snapshot.disks().len() as f64).named("disks", "1");
    /// let mut table = Vec::new();
    /// Series::new(count, SampleTimes::every(1.0)?).write_csv(&mut table)?;
    /// assert_eq!(table, b"time [time],disks\n");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn named(self, name: impl Into<String>, unit: impl Into<String>) -> Named<Self> {
        Named::new(self, name, unit)
    }
}

impl<F, V> Observable for MeasuredBy<F>
where
    F: Fn(&Snapshot<'_>) -> V,
{
    type Value = V;

    fn measure(&self, snapshot: &Snapshot<'_>) -> V {
        (self.0)(snapshot)
    }
}

/// A closure that receives every collision; made by [`on_collision`].
#[derive(Debug, Clone)]
pub struct OnCollision<F>(F);

/// Makes an observer from a closure that receives every collision.
///
/// ```
/// use granular_edmd::observable::{Collision, Observer, on_collision};
/// let mut hardest = 0.0_f64;
/// let mut observer = on_collision(|c: &Collision| hardest = hardest.max(c.impulse.normal()));
/// assert_eq!(observer.next_sample(), f64::INFINITY);
/// ```
pub const fn on_collision<F: FnMut(&Collision)>(watch: F) -> OnCollision<F> {
    OnCollision(watch)
}

impl<F: FnMut(&Collision)> Observer for OnCollision<F> {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        (self.0)(collision);
    }
}

/// A closure that receives samples; made by [`on_sample`].
#[derive(Debug, Clone)]
pub struct OnSample<F>(F);

/// Makes an observer from a closure that receives a snapshot at each of these times.
///
/// ```
/// use granular_edmd::observable::{Observer, SampleTimes, Snapshot, on_sample};
/// let mut observer = on_sample(SampleTimes::every(0.5)?, |s: &Snapshot<'_>| println!("{}", s.time()));
/// assert_eq!(observer.next_sample(), 0.5);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub const fn on_sample<F: FnMut(&Snapshot<'_>)>(times: SampleTimes, watch: F) -> Sampled<OnSample<F>> {
    Sampled::new(OnSample(watch), times)
}

impl<F: FnMut(&Snapshot<'_>)> Accumulator for OnSample<F> {
    fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError> {
        (self.0)(snapshot);
        Ok(())
    }
}
