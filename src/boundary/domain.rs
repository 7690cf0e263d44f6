//! Rectangles in which the centers of disks can be.

use glam::DVec2;

/// The rectangle that holds the centers of all disks. Its left and right sides may be the same line.
///
/// ```
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::glam::DVec2;
/// let domain = Domain::new(0.0, 60.0, -0.1, f64::INFINITY).with_periodic_sides();
/// assert_eq!(domain.width(), 60.0);
/// assert_eq!(domain.separation(DVec2::new(59.0, 0.0), DVec2::new(1.0, 0.0)).x, 2.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Domain {
    /// Left end.
    pub left: f64,
    /// Right end.
    pub right: f64,
    /// Lower end.
    pub bottom: f64,
    /// Upper end; infinite without a lid.
    pub top: f64,
    /// True if a disk that leaves on one side enters on the other.
    pub periodic: bool,
}

impl Domain {
    /// Creates a rectangle with walls at its sides; the top may be infinite.
    #[inline]
    pub const fn new(left: f64, right: f64, bottom: f64, top: f64) -> Self {
        Self { left, right, bottom, top, periodic: false }
    }

    /// Returns the same rectangle with periodic sides: a disk that leaves on one side enters on the other.
    #[must_use]
    pub const fn with_periodic_sides(self) -> Self {
        Self { periodic: true, ..self }
    }

    /// Returns the width, `$L_x$`.
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Returns the height; infinite without a lid.
    pub fn height(&self) -> f64 {
        self.top - self.bottom
    }

    /// Returns the vector from `from` to `to`, by the shortest way if the sides are periodic.
    pub fn separation(&self, from: DVec2, to: DVec2) -> DVec2 {
        let mut separation = to - from;
        if self.periodic {
            separation.x -= self.width() * (separation.x / self.width()).round();
        }
        separation
    }
}

/// A rectangle inside the domain. Its edges may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Region {
    /// Lower left corner.
    pub min: DVec2,
    /// Upper right corner.
    pub max: DVec2,
}

impl Region {
    /// Creates a rectangle from its lower left and upper right corners.
    #[inline]
    pub const fn new(min: DVec2, max: DVec2) -> Self {
        Self { min, max }
    }
}
