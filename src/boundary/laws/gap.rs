//! The gap between a disk and the nearest wall, as overlaps show it.

use glam::DVec2;

use crate::Kind;
use crate::boundary::{Boundary, Probe};

/// The gap between a disk and the nearest wall: negative inside a wall.
///
/// All laws of walls follow from this function of place and time. A flight touches a wall at the first root
/// of the gap along the flight; the normal is its gradient, the velocity along the normal is its rate with
/// the opposite sign, the curvature its second derivative, and the free area is where it is positive.
#[derive(Clone, Copy)]
pub(super) struct Gap<'a> {
    pub(super) boundary: &'a dyn Boundary,
    pub(super) radius: f64,
    pub(super) kind: Kind,
}

impl Gap<'_> {
    /// Returns the nearest wall and the gap to it, or `None` if all walls are farther than `reach`. The reach
    /// may be negative: then the disk must be deeper in a wall.
    pub(super) fn nearest(&self, place: DVec2, reach: f64, time: f64) -> Option<(usize, f64)> {
        let probe = Probe::new(place, self.radius + reach, time).with_kind(self.kind);
        self.boundary.overlap(&probe).map(|found| (found.with, reach - found.depth))
    }

    /// Returns the gap, at most `reach`.
    pub(super) fn at(&self, place: DVec2, reach: f64, time: f64) -> f64 {
        self.nearest(place, reach, time).map_or(reach, |(_, gap)| gap)
    }

    /// Returns whether the gap is less than `slack`.
    pub(super) fn is_below(&self, slack: f64, place: DVec2, time: f64) -> bool {
        self.nearest(place, slack, time).is_some()
    }
}
