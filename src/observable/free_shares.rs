//! The shares of regions that walls leave free.

use glam::DVec2;

use super::Snapshot;
use super::snapshot::Mark;
use crate::ParameterError;
use crate::boundary::Region;
use crate::quantity::accept;

/// The free shares of several regions. They are kept as long as no wall has moved.
///
/// They are not part of the measurement: no file holds them, and any two values of this type compare equal.
#[derive(Debug, Clone, Default)]
pub(super) struct FreeShares {
    walls: Mark,
    time: f64,
    points: Option<Vec<DVec2>>,
    shares: Vec<f64>,
}

impl FreeShares {
    /// Returns the share of each region that matter can fill at the time of a snapshot, or NaN where the
    /// share is not known. All calls must pass the same regions.
    pub(super) fn of(&mut self, snapshot: &Snapshot<'_>, regions: impl Iterator<Item = Region>) -> &[f64] {
        let walls = 0..snapshot.wall_count();
        let points: Option<Vec<DVec2>> = walls.map(|wall| snapshot.wall_point(wall)).collect();
        let stays = self.time == snapshot.time() || points.is_some() && points == self.points;
        if !(stays && self.walls.is_same(snapshot.walls_mark())) {
            (self.walls, self.points) = (snapshot.walls_mark(), points);
            self.shares = regions.map(|region| snapshot.free_share(&region).unwrap_or(f64::NAN)).collect();
        }
        self.time = snapshot.time();
        &self.shares
    }

    /// Checks that all shares are known at the time of a snapshot.
    ///
    /// # Errors
    /// If one is unknown. The error says what to use instead.
    pub(super) fn check(
        &mut self,
        snapshot: &Snapshot<'_>,
        regions: impl Iterator<Item = Region>,
    ) -> Result<(), ParameterError> {
        known(!self.of(snapshot, regions).iter().any(|share| share.is_nan()))
    }
}

/// Checks that the free area is known for a region, or else for each part of it.
///
/// # Errors
/// If the area is unknown. The error says what to use instead.
pub(super) fn check_area(
    region: &Region,
    parts: impl IntoIterator<Item = Region>,
    start: &Snapshot<'_>,
) -> Result<(), ParameterError> {
    let is_known = |region: &Region| start.free_share(region).is_some();
    known(is_known(region) || parts.into_iter().all(|part| is_known(&part)))
}

fn known(all_are_known: bool) -> Result<(), ParameterError> {
    let requirement = "known: implement Boundary::area, let parts with an inside stop all kinds of disks, or \
                       measure in a region that no wall enters";
    accept(all_are_known, "free area between the walls of the boundary", requirement, f64::NAN).map(drop)
}

impl PartialEq for FreeShares {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
