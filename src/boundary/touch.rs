//! Touches of walls by disks.

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
