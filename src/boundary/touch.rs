//! Queries to a boundary about one position at one time, touches of walls, and the reactions of walls that
//! have a mass.

use glam::DVec2;

use crate::wall::FirstTouch;
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

/// The first touch of a flight with a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Touch {
    /// Time of the touch, as an offset from the boundary's origin.
    pub time: f64,
    /// Index of the wall, less than [`Boundary::wall_count`](super::Boundary::wall_count).
    pub wall: usize,
}

impl Touch {
    /// Creates a touch of this wall at this time.
    #[inline]
    pub const fn new(time: f64, wall: usize) -> Self {
        Self { time, wall }
    }
}

impl FirstTouch<Touch> {
    /// Returns the time of the touch or, if none was found, the time up to which there is none.
    #[inline]
    pub fn time(&self) -> f64 {
        match self {
            Self::At(touch) => touch.time,
            Self::NotBefore(time) => *time,
        }
    }

    /// Returns the earlier of two results for the same flight.
    ///
    /// If both touches happen at the same time, the wall with the smaller index counts. A boundary that adds
    /// walls to another boundary combines the results in this way.
    #[inline]
    pub fn or(self, other: Self) -> Self {
        let is_first = match (&self, &other) {
            (Self::At(touch), Self::At(next)) if touch.time == next.time => touch.wall <= next.wall,
            (Self::NotBefore(open), Self::At(next)) => *open < next.time,
            _ => self.time() <= other.time(),
        };
        if is_first { self } else { other }
    }
}

/// The impact of a disk on a wall, as the wall receives it.
///
/// ```
/// use granular_edmd::boundary::Impact;
/// use granular_edmd::glam::DVec2;
/// let impact = Impact::new(3, DVec2::new(0.0, 2.0), DVec2::new(4.0, 9.0), 0.5);
/// assert_eq!((impact.wall, impact.impulse.y, impact.point.x), (3, 2.0, 4.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Impact {
    /// Index of the wall.
    pub wall: usize,
    /// Impulse on the wall.
    pub impulse: DVec2,
    /// Point at which the disk touches the wall.
    pub point: DVec2,
    /// Time, as an offset from the boundary's origin.
    pub time: f64,
}

impl Impact {
    /// Creates an impact that gives this impulse to a wall at a point, at this offset from the time origin.
    #[inline]
    pub const fn new(wall: usize, impulse: DVec2, point: DVec2, time: f64) -> Self {
        Self { wall, impulse, point, time }
    }
}

/// The reaction of a boundary to an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Reaction {
    /// All walls move as before.
    #[default]
    None,
    /// The motion of the wall has changed.
    Moved,
}
