//! Queries to a boundary about one position at one time, and their results.

use glam::DVec2;

use crate::{Disk, Kind};

/// A disk at a position and a time, with which a boundary is queried.
///
/// ```
/// use granular_edmd::boundary::{Boundary, Container, Probe};
/// use granular_edmd::glam::DVec2;
///
/// let container = Container::closed(10.0, 20.0)?;
/// let probe = Probe::new(DVec2::new(0.125, 5.0), 0.5, 0.0);
/// let overlap = container.overlap(&probe).ok_or("the disk is inside")?;
/// assert_eq!((overlap.with, overlap.depth), (1, 0.375));
/// assert!(container.overlap(&probe.with_radius(0.125)).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    position: DVec2,
    radius: f64,
    kind: Kind,
    time: f64,
}

impl Probe {
    /// Creates a probe of the default kind, with its center at this position, at this offset from the
    /// boundary's time origin.
    #[inline]
    pub const fn new(position: DVec2, radius: f64, time: f64) -> Self {
        Self { position, radius, kind: Kind::DEFAULT, time }
    }

    /// Creates a probe with the position, radius and kind of a disk.
    #[inline]
    pub const fn of(disk: &Disk, time: f64) -> Self {
        Self { position: disk.position(), radius: disk.radius(), kind: disk.kind(), time }
    }

    /// Returns the same probe at another position.
    #[must_use]
    #[inline]
    pub const fn with_position(self, position: DVec2) -> Self {
        Self { position, ..self }
    }

    /// Returns the same probe with another kind.
    #[must_use]
    #[inline]
    pub const fn with_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// Returns the same probe with another radius.
    #[must_use]
    #[inline]
    pub const fn with_radius(self, radius: f64) -> Self {
        Self { radius, ..self }
    }

    /// Returns the same probe at another time.
    #[must_use]
    #[inline]
    pub const fn with_time(self, time: f64) -> Self {
        Self { time, ..self }
    }

    /// Returns the position of the center.
    #[inline]
    pub const fn position(&self) -> DVec2 {
        self.position
    }

    /// Returns the radius.
    #[inline]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the kind of the disk.
    #[inline]
    pub const fn kind(&self) -> Kind {
        self.kind
    }

    /// Returns the time, as an offset from the boundary's origin.
    #[inline]
    pub const fn time(&self) -> f64 {
        self.time
    }
}

/// The deepest overlap of a disk, with its partner: a wall by its index for a [`Boundary`](super::Boundary),
/// a [`Partner`](crate::observable::Partner) for a [`Simulation`](crate::Simulation::overlap).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Overlap<T = usize> {
    /// The partner that the disk overlaps.
    pub with: T,
    /// Depth to which the disk reaches into its partner, positive.
    pub depth: f64,
}

impl<T> Overlap<T> {
    /// Creates an overlap of this depth.
    #[inline]
    pub const fn new(with: T, depth: f64) -> Self {
        Self { with, depth }
    }

    /// Returns the deepest overlap, or `None` if no depth is positive.
    #[inline]
    pub(crate) fn deepest(all: impl Iterator<Item = Self>) -> Option<Self> {
        all.filter(|overlap| overlap.depth > 0.0).max_by(|one, other| one.depth.total_cmp(&other.depth))
    }
}
