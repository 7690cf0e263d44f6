//! Rectangles: where the centres of disks can be.

use glam::DVec2;

/// The rectangle that holds the centres of all disks, and whether its left and right sides are the same line.
///
/// ```
/// use granular_edmd::boundary::Domain;
/// let domain = Domain { left: 0.0, right: 60.0, bottom: -0.1, top: f64::INFINITY, periodic: true };
/// assert_eq!(domain.width(), 60.0);
/// assert_eq!(domain.separation(glam::DVec2::new(59.0, 0.0), glam::DVec2::new(1.0, 0.0)).x, 2.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Domain {
    /// Left end.
    pub left: f64,
    /// Right end.
    pub right: f64,
    /// Lower end.
    pub bottom: f64,
    /// Upper end; infinite without a lid.
    pub top: f64,
    /// Whether what leaves on one side enters on the other.
    pub periodic: bool,
}

impl Domain {
    /// Width, `$L_x$`.
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Height; infinite without a lid.
    pub fn height(&self) -> f64 {
        self.top - self.bottom
    }

    /// Vector from `from` to `to`, by the shortest way if the sides are periodic.
    pub fn separation(&self, from: DVec2, to: DVec2) -> DVec2 {
        let mut separation = to - from;
        if self.periodic {
            separation.x -= self.width() * (separation.x / self.width()).round();
        }
        separation
    }
}

/// A rectangle inside the domain; its edges may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Lower left corner.
    pub min: DVec2,
    /// Upper right corner.
    pub max: DVec2,
}
