//! Closures as observables and observers, also as observers that stop a run.

use std::ops::ControlFlow;

use super::{
    Accumulator, Collision, Named, Observable, Observer, ObserverError, SampleTimes, Sampled, Snapshot,
    Verdict,
};
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

/// A closure that stops a run at a collision; made by [`stop_when`].
#[derive(Debug, Clone)]
pub struct StopWhen<F> {
    condition: F,
    holds: bool,
}

/// Makes an observer that stops a run at the first collision for which the closure returns true.
///
/// A later run with the same observer stops at the next collision that meets the condition.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse};
/// use granular_edmd::observable::{Collision, Observer, Partner, stop_when};
///
/// let mut observer = stop_when(|collision: &Collision| collision.impulse.normal() > 1.0);
/// let contact = Contact::new(2.0, 0.0, 0.5, 0.5 / 3.0);
/// observer.on_collision(&Collision::new(0.5, 0, Partner::Disk(1), contact, Impulse::new(1.0, 0.0)));
/// assert!(observer.verdict()?.is_continue());
/// observer.on_collision(&Collision::new(0.7, 0, Partner::Disk(1), contact, Impulse::new(1.5, 0.0)));
/// assert!(observer.verdict()?.is_break());
/// # Ok::<(), granular_edmd::observable::ObserverError>(())
/// ```
pub const fn stop_when<F: FnMut(&Collision) -> bool>(condition: F) -> StopWhen<F> {
    StopWhen { condition, holds: false }
}

impl<F: FnMut(&Collision) -> bool> Observer for StopWhen<F> {
    fn on_start(&mut self, _: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.holds = false;
        Ok(())
    }

    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.holds |= (self.condition)(collision);
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        Ok(stop_if(self.holds))
    }
}

/// A closure that stops a run at a sample; made by [`stop_when_sampled`].
#[derive(Debug, Clone)]
pub struct StopWhenSampled<F> {
    times: SampleTimes,
    condition: F,
    holds: bool,
}

/// Makes an observer that stops a run at the first of these times at which the closure returns true.
///
/// A later run with the same observer stops at the next sample that meets the condition.
///
/// ```
/// use granular_edmd::observable::{CenterOfMass, Observable, Observer, SampleTimes, Snapshot};
/// use granular_edmd::observable::stop_when_sampled;
///
/// // Until the center of mass has risen to 10.
/// let risen = |snapshot: &Snapshot<'_>| CenterOfMass.measure(snapshot).y > 10.0;
/// let observer = stop_when_sampled(SampleTimes::every(1.0)?, risen);
/// assert_eq!(observer.next_sample(), 1.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub const fn stop_when_sampled<F>(times: SampleTimes, condition: F) -> StopWhenSampled<F>
where
    F: FnMut(&Snapshot<'_>) -> bool,
{
    StopWhenSampled { times, condition, holds: false }
}

impl<F: FnMut(&Snapshot<'_>) -> bool> Observer for StopWhenSampled<F> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.holds = false;
        self.times.start_at(start.time());
        Ok(())
    }

    fn next_sample(&self) -> f64 {
        self.times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.holds |= (self.condition)(snapshot);
        self.times.advance_past(snapshot.time());
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        Ok(stop_if(self.holds))
    }
}

const fn stop_if(holds: bool) -> ControlFlow<()> {
    if holds { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
