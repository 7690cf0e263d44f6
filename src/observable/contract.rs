//! The traits [`Observable`] and [`Observer`], the promises of both sides of each trait, and the collisions
//! that observers see.

use std::ops::ControlFlow;

use glam::DVec2;
use thiserror::Error;

use super::Snapshot;
use crate::collision::{Contact, Impulse};
use crate::{Disk, ParameterError};

/// The partner of a disk in a collision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Partner {
    /// Another disk, by its index.
    Disk(usize),
    /// A wall, by its index in the boundary.
    Wall(usize),
}

/// A collision that has just happened.
///
/// At a thermal wall, the contact describes the arriving disk, and the impulse is the whole impulse on that
/// disk. The wall also draws a new spin for the disk; only [`Self::energy_change`] includes the energy of
/// this spin.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{Collision, EnergyChange, Observer, Partner};
///
/// // An observer sees a collision of two disks, without a simulation.
/// let (contact, impulse) = (Contact::new(2.0, 0.0, 1.0, 1.0 / 3.0), Impulse::new(3.0, 0.0));
/// let mut energy_change = EnergyChange::default();
/// energy_change.on_collision(&Collision::new(0.5, 7, Partner::Disk(8), contact, impulse));
/// assert_eq!(energy_change.disks().mean(), -1.5);
///
/// let mut collision = Collision::new(0.5, 7, Partner::Disk(8), contact, impulse);
/// collision.position = DVec2::new(2.0, 3.0);
/// assert_eq!(collision.partner_position(), DVec2::new(2.0, 2.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Collision {
    /// Absolute time of the collision. A run until this time includes the collision.
    pub time: f64,
    /// Index of the disk among all disks of the run, at this time. In a snapshot of some of the disks, or of
    /// another time if disks come and go, its index may be another one; its [id](Self::ids) is the same.
    pub disk: usize,
    /// [Ids](crate::Disk::id) of the disk and of its partner; 0 for a wall.
    pub ids: [u64; 2],
    /// Partner of the disk.
    pub partner: Partner,
    /// Unit vector from the partner to the disk.
    pub normal: DVec2,
    /// Position of the disk's center.
    pub position: DVec2,
    /// Distance between the centers, or between the center and the wall.
    pub distance: f64,
    /// The contact in which the surfaces met, before the impulse.
    pub contact: Contact,
    /// The impulse on the disk.
    pub impulse: Impulse,
    /// Velocities of the disk and of its partner after the collision; for a wall, the velocity of its
    /// surface.
    pub velocities: [DVec2; 2],
    /// Change of the kinetic energy of the disk, and of its partner if that is a disk.
    ///
    /// A moving wall gives energy to the disk or takes energy from it. [`Impulse::energy_change`] is the
    /// change in the frame of the wall.
    pub energy_change: f64,
}

impl Collision {
    /// Creates a collision for tests of observers.
    ///
    /// The engine fills all fields itself.
    ///
    /// The fields without an argument have simple values; set the fields that matter. The normal points up,
    /// the position is the origin, the velocities and the ids are 0, and the disks have radius 1/2 (a
    /// `distance` of 1, or of 1/2 to a wall). The `energy_change` follows from the impulse, which is right
    /// for two disks and for a wall at rest.
    pub fn new(time: f64, disk: usize, partner: Partner, contact: Contact, impulse: Impulse) -> Self {
        let distance = match partner {
            Partner::Disk(_) => 1.0,
            Partner::Wall(_) => 0.5,
        };
        let energy_change = impulse.energy_change(&contact);
        let (normal, position) = (DVec2::Y, DVec2::ZERO);
        let (ids, velocities) = ([0; 2], [DVec2::ZERO; 2]);
        Self {
            time,
            disk,
            ids,
            partner,
            normal,
            position,
            distance,
            contact,
            impulse,
            velocities,
            energy_change,
        }
    }

    /// Adds the impulse and the work of a push along the normal that changes the disk's velocity from
    /// `before` to `after`.
    pub(crate) fn add_push(&mut self, before: DVec2, after: DVec2, inverse_mass: f64) {
        self.velocities[0] = after;
        let momentum = (after - before) / inverse_mass;
        self.energy_change += momentum.dot(0.5 * (before + after));
        let normal = self.impulse.normal() + momentum.dot(self.normal);
        self.impulse = self.impulse.with_normal(normal);
    }

    /// Returns the position of the partner: the center of a disk, or the point where a wall is touched.
    ///
    /// At periodic sides, the disk may touch an image of the partner. The image's position is then returned.
    pub fn partner_position(&self) -> DVec2 {
        self.position - self.normal * self.distance
    }
}

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
/// 4. The value of `next_sample` changes only in `on_start` and `on_sample`, and in `on_collision` to the
///    time of the collision. The engine calls `next_sample` only after these three, and would notice a change
///    at any other time too late.
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
#[expect(unused_variables, reason = "what is shown need not be looked at")]
pub trait Observer {
    /// Receives the start of a run, which may continue an earlier run, and the disks after each kick of a
    /// driving.
    ///
    /// # Errors
    /// If the observer cannot measure this run, for example because a wall is missing. The run then ends with
    /// this error, and no event happens.
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        Ok(())
    }

    /// Receives a collision that has just happened.
    fn on_collision(&mut self, collision: &Collision) {}

    /// Returns the time of the next sample that the observer requests, or infinity if it requests none.
    fn next_sample(&self) -> f64 {
        f64::INFINITY
    }

    /// Receives the requested sample.
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {}

    /// Receives a disk that an inlet has let in during the run.
    fn on_insert(&mut self, disk: &Disk, time: f64) {}

    /// Receives a disk that a sink takes out during the run, after the collision with the sink. The disk has
    /// the motion with which it arrived at the sink.
    ///
    /// The last disk then gets the index of this disk.
    fn on_remove(&mut self, disk: &Disk, time: f64) {}

    /// Receives the end of a run, even of a run that fails, and the disks before each kick of a driving.
    fn on_end(&mut self, end: &Snapshot<'_>) {}

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
