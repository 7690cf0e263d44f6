//! The traits [`Observable`] and [`Observer`], and the promises of both sides of each trait.

use std::ops::ControlFlow;

use thiserror::Error;

use super::{Collision, Snapshot};
use crate::{Disk, ParameterError};

/// A quantity that a snapshot determines.
///
/// # Contract
/// `measure` depends on the snapshot alone: measured twice, the same snapshot gives the same value. It must
/// not panic for a snapshot without disks, or for a snapshot of a domain without a lid, whose height is
/// infinite. A value that is not defined is NaN.
///
/// The engine measures copies of the disks, so an observable cannot change the run.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an observable",
    label = "an `Observable` is expected here",
    note = "wrap a closure that takes a `&Snapshot` in `observable::measured_by`",
    note = "several observables make one as a tuple: `(OrderParameters, CenterOfMass)`"
)]
pub trait Observable {
    /// The type of the quantity.
    type Value;

    /// Returns the quantity at the time of the snapshot.
    fn measure(&self, snapshot: &Snapshot<'_>) -> Self::Value;
}

/// An error with which an observer makes a run fail: any error, or a string.
///
/// It is an error like any other, so `?` converts it into `Box<dyn Error>` and into the error types of other
/// crates.
///
/// ```
/// use granular_edmd::observable::ObserverError;
/// let full = ObserverError::new(std::io::Error::other("the disk is full"));
/// assert_eq!(full.to_string(), ObserverError::from("the disk is full").to_string());
/// ```
#[derive(Debug, Error)]
#[error(transparent)]
pub struct ObserverError(Box<dyn std::error::Error + Send + Sync>);

impl ObserverError {
    /// Creates an error from its cause.
    pub fn new(cause: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        Self(cause.into())
    }
}

crate::error::from_causes! { ObserverError from &str, String, std::io::Error, ParameterError }

/// An observer's decision on the run: continue, stop, or fail.
pub type Verdict = Result<ControlFlow<()>, ObserverError>;

/// An observer of a run. It receives every collision, and a sample at each time that it requests.
///
/// By default, all methods do nothing, and `next_sample` requests no sample. All times are absolute, as in
/// [`Simulation::time`](crate::Simulation::time).
///
/// # Guarantees of the engine
/// 1. Each call of `run_until` begins with `on_start` and ends with `on_end`, whether the run reaches its end
///    time, is stopped, or fails. [`run_driven`](crate::Simulation::run_driven) calls both at each kick, too:
///    `on_end` before it and `on_start` after it.
/// 2. `on_collision` is called once for each collision, in the order of time, after the disks have changed.
/// 3. `on_sample` is called at the time that `next_sample` returned, unless this time is after the end of the
///    run. The sample includes all events whose absolute times are not later. A time before the start of the
///    run is sampled at the start.
/// 4. `verdict` is called after `on_start`, and after each collision, each sample and `on_end`. If a verdict
///    stops the run or makes it fail, no further event happens.
/// 5. `on_insert` is called when an inlet lets a disk in, and `on_remove` when a sink takes a disk out, so an
///    observer knows all disks at all times.
/// 6. Whatever an observer does, the trajectory has the same bits as without the observer, as far as the run
///    goes.
///
/// [`Simulation::step_until`](crate::Simulation::step_until) reports collisions, insertions and removals, but
/// no start, samples or end. A verdict that fails ends the step with an error. A verdict that stops has no
/// effect, since the caller decides on each step.
///
/// # Guarantees of an observer
/// 1. `next_sample` is never NaN. Its value is infinite if no sample is requested.
/// 2. After a sample, `next_sample` returns a time later than the sample's.
/// 3. After `on_start`, the time of `next_sample` is at or after the start, up to rounding.
/// 4. The value of `next_sample` changes only in `on_start` and `on_sample`. The engine calls `next_sample`
///    only after these two, and would notice a change at any other time too late.
/// 5. Samples do not depend on how a run is cut into pieces: if a run starts at the time at which the
///    previous one ended, `next_sample` keeps its value.
///
/// If an observer breaks the first or the second promise, the run fails, since it would sample forever. If it
/// breaks another promise, it gets samples at times that it did not intend.
/// [`SampleTimes`](super::SampleTimes) keeps all five, and [`laws::check`](super::laws::check) tests them;
/// `docs/validation.md` says which planted faults the check finds.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an observer",
    label = "an `Observer` is expected here",
    note = "wrap a closure that takes a `&Collision` in `observable::on_collision`",
    note = "wrap a closure that takes a `&Snapshot` in `observable::on_sample`",
    note = "an observable is sampled by `Series::new(observable, times)`",
    note = "an accumulator, such as `HeightProfile`, is sampled by `Sampled::new(accumulator, times)`",
    note = "lend an observer to a run as `&mut observer`, two as `&mut (&mut first, &mut second)`, none as `&mut ()`"
)]
pub trait Observer {
    /// Receives the start of a run, which may continue an earlier run, and the disks after each kick of a
    /// driving.
    ///
    /// # Errors
    /// If the observer cannot measure this run, for example because a wall is missing. The run then ends with
    /// this error, and no event happens.
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        let _ = start;
        Ok(())
    }

    /// Receives a collision that has just happened.
    fn on_collision(&mut self, collision: &Collision) {
        let _ = collision;
    }

    /// Returns the time of the next sample that the observer requests, or infinity if it requests none.
    fn next_sample(&self) -> f64 {
        f64::INFINITY
    }

    /// Receives the requested sample.
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let _ = snapshot;
    }

    /// Receives a disk that an inlet has let in during the run.
    fn on_insert(&mut self, disk: &Disk, time: f64) {
        let _ = (disk, time);
    }

    /// Receives a disk that a sink takes out during the run, after the collision with the sink. The disk has
    /// the motion with which it arrived at the sink.
    ///
    /// The last disk then gets the index of this disk.
    fn on_remove(&mut self, disk: &Disk, time: f64) {
        let _ = (disk, time);
    }

    /// Receives the end of a run, even of a run that fails, and the disks before each kick of a driving.
    fn on_end(&mut self, end: &Snapshot<'_>) {
        let _ = end;
    }

    /// Decides whether the run continues, stops, or fails.
    ///
    /// # Errors
    /// If the observer cannot continue, for example because a file cannot be written or a quantity has left
    /// its range. The run then fails, too.
    fn verdict(&mut self) -> Verdict {
        Ok(ControlFlow::Continue(()))
    }
}

/// Returns the verdict of an observer, which makes the run fail if the observer has noted a fault.
#[inline]
pub(crate) fn verdict<E: Into<ObserverError>>(fault: &mut Option<E>) -> Verdict {
    // The engine asks for a verdict after each collision, so the usual verdict comes first and writes
    // nothing.
    if fault.is_none() {
        return Ok(ControlFlow::Continue(()));
    }
    fault.take().map_or(Ok(ControlFlow::Continue(())), |fault| Err(fault.into()))
}
