//! Touches of walls by disks.

use crate::wall::FirstTouch;

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
