//! Impacts of disks on walls, and the reactions of walls that have a mass.

use glam::DVec2;

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
