//! Adaptors of observers: to the disks of a kind, to the collisions between two kinds, and to samples by
//! collisions.

use std::num::NonZeroU64;

use super::{Collision, Heading, Observable, Observer, ObserverError, Partner, Snapshot, Tabular, Verdict};
use crate::quantity::accept;
use crate::{Disk, Kind, ParameterError};

/// A filter: an observable or observer that sees only disks of one kind.
///
/// The snapshots that it passes on hold only these disks, in unchanged order. It also passes on the
/// collisions in which a disk of the kind takes part. The snapshots at the start and at the end of a run hold
/// only disks of the kind, too. Collisions keep the indices of the whole run, which are not those of these
/// snapshots: [`Collision::ids`] name the same disks in both.
///
/// In a collision with a disk of another kind, only one disk of the kind takes part, so a rate per disk that
/// counts both partners is too high. Instead, add up the collisions [between](super::BetweenKinds) each pair
/// of kinds, and count two disks of the kind for a collision within it, and one for a collision with another
/// kind.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::{CenterOfMass, Observable, OfKind, Snapshot};
/// use granular_edmd::{Disk, Kind};
///
/// const INTRUDER: Kind = Kind::new(1);
/// let disks = [
///     Disk::new(DVec2::new(1.0, 1.0), 0.5)?,
///     Disk::new(DVec2::new(3.0, 5.0), 0.5)?.with_kind(INTRUDER),
/// ];
/// let snapshot = Snapshot::new(0.0, &disks, Domain::new(0.0, 4.0, 0.0, 6.0), 1.0);
/// assert_eq!(OfKind::new(INTRUDER, CenterOfMass).measure(&snapshot).y, 5.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct OfKind<T> {
    kind: Kind,
    inner: T,
}

impl<T> OfKind<T> {
    /// Creates a filter that shows `inner` only disks of this kind.
    pub const fn new(kind: Kind, inner: T) -> Self {
        Self { kind, inner }
    }

    /// Returns the inner observable or observer.
    pub const fn inner(&self) -> &T {
        &self.inner
    }

    fn chosen(&self, snapshot: &Snapshot<'_>) -> Vec<Disk> {
        snapshot.disks().iter().filter(|disk| disk.kind() == self.kind).copied().collect()
    }
}

impl<T: Observable> Observable for OfKind<T> {
    type Value = T::Value;

    fn measure(&self, snapshot: &Snapshot<'_>) -> T::Value {
        self.inner.measure(&snapshot.with_disks(&self.chosen(snapshot)))
    }
}

/// The inner observable defines the columns, with the kind at the end of their names: `center_y_of_kind_1`.
impl<T: Tabular> Tabular for OfKind<T> {
    fn headings(&self) -> Vec<Heading> {
        let of_kind = |heading: &Heading| format!("{}_of_kind_{}", heading.name(), self.kind.number());
        self.inner.headings().iter().map(|heading| Heading::new(of_kind(heading), heading.unit())).collect()
    }

    fn add_numbers(&self, value: &T::Value, row: &mut Vec<f64>) {
        self.inner.add_numbers(value, row);
    }
}

impl<T: Observer> Observer for OfKind<T> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.inner.on_start(&start.with_disks(&self.chosen(start)))
    }
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        let [disk, partner] = collision.contact.kinds();
        // A wall may be of the same kind as disks.
        let is_disk = matches!(collision.partner, Partner::Disk(_));
        if disk == self.kind || (is_disk && partner == self.kind) {
            self.inner.on_collision(collision);
        }
    }
    fn next_sample(&self) -> f64 {
        self.inner.next_sample()
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.inner.on_sample(&snapshot.with_disks(&self.chosen(snapshot)));
    }
    fn on_insert(&mut self, disk: &Disk, time: f64) {
        if disk.kind() == self.kind {
            self.inner.on_insert(disk, time);
        }
    }
    fn on_remove(&mut self, disk: &Disk, time: f64) {
        if disk.kind() == self.kind {
            self.inner.on_remove(disk, time);
        }
    }
    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.inner.on_end(&end.with_disks(&self.chosen(end)));
    }
    #[inline]
    fn verdict(&mut self) -> Verdict {
        self.inner.verdict()
    }
}

/// An observer that sees only collisions between two kinds, in either order, of two disks or of a disk and a
/// wall.
///
/// It passes samples on unchanged.
///
/// ```
/// use granular_edmd::Kind;
/// use granular_edmd::collision::{Contact, Impulse};
/// use granular_edmd::observable::{BetweenKinds, Collision, EnergyChange, Observer, Partner};
///
/// let (small, large) = (Kind::new(0), Kind::new(1));
/// let mut mixed = BetweenKinds::new(small, large, EnergyChange::default());
/// for kinds in [[small, small], [large, small], [small, large]] {
///     let contact = Contact::new(2.0, 0.0, 0.5, 0.5 / 3.0).with_kinds(kinds);
///     mixed.on_collision(&Collision::new(0.5, 7, Partner::Disk(8), contact, Impulse::new(1.5, 0.0)));
/// }
/// assert_eq!(mixed.inner().disks().count(), 2);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct BetweenKinds<T> {
    kinds: [Kind; 2],
    inner: T,
}

impl<T> BetweenKinds<T> {
    /// Creates a filter that shows `inner` only collisions between these kinds, which may be the same.
    pub const fn new(first: Kind, second: Kind, inner: T) -> Self {
        Self { kinds: [first, second], inner }
    }

    /// Returns the inner observer.
    pub const fn inner(&self) -> &T {
        &self.inner
    }
}

/// Writes the methods that an adaptor leaves to the inner observer: starts, ends, changes of disks, verdicts.
macro_rules! left_to_inner {
    () => {
        fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
            self.inner.on_start(start)
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
    };
}

impl<T: Observer> Observer for BetweenKinds<T> {
    left_to_inner!();
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        if collision.contact.is_between(self.kinds[0], self.kinds[1]) {
            self.inner.on_collision(collision);
        }
    }
    fn next_sample(&self) -> f64 {
        self.inner.next_sample()
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.inner.on_sample(snapshot);
    }
}

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
    every: NonZeroU64,
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
        let every = NonZeroU64::new(count);
        accept(every.is_some(), "number of collisions between samples", "positive", count as f64)?;
        Ok(Self { inner, every: every.unwrap_or(NonZeroU64::MIN), count: 0, due: None })
    }

    /// Returns the inner observer.
    pub const fn inner(&self) -> &O {
        &self.inner
    }
}

impl<O: Observer> Observer for ByCollisions<O> {
    left_to_inner!();
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.inner.on_collision(collision);
        self.count += 1;
        if self.count >= self.every.get() {
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
}
