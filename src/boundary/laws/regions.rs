//! Checks that a boundary admits touches in the regions in which they happen.

use glam::DVec2;

use super::trial::{PART, Trial};
use crate::Violation;
use crate::boundary::{Boundary, Domain, Region, Touch};
use crate::violation::require;

/// Sizes of the regions around a touch, relative to the radius. The smallest region is a point, up to
/// rounding.
const REGIONS: [f64; 3] = [0.0, 0.5, 5.0];

/// Checks that `may_touch` and `may_meet` are true for regions that contain the position of a touch.
pub(super) fn check_regions(trial: &Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    for size in REGIONS.map(|size| size * trial.radius) {
        let [low, high] = [0.0, size].map(|size| DVec2::splat(size + trial.rounding()));
        for [low, high] in [[low, low], [high, high], [low, high], [high, low]] {
            let around = Region::new(place - low, place + high);
            check_region(trial, touch, around)?;
            check_region(trial, touch, open_at_edges(trial, around))?;
        }
    }
    let Region { min, max } = trial.rectangle();
    check_region(trial, touch, Region::new(min.min(place), max.max(place)))
}

fn check_region(trial: &Trial<'_>, Touch { time, wall, .. }: Touch, region: Region) -> Result<(), Violation> {
    for radius in [trial.radius, 1.5 * trial.radius] {
        let may = trial.boundary.may_touch(&region, radius);
        require!(PART, "may_touch", may;
            "a disk of radius {radius:?} touches in {region:?}, where it is denied");
        for until in [time, time + trial.crossing()] {
            let may = trial.boundary.may_meet(wall, &region, radius, until);
            require!(PART, "may_meet", may;
                "a disk meets wall {wall} in {region:?} at {time:?}, where it is denied up to {until:?}");
        }
    }
    Ok(())
}

/// Returns the region as the engine extends it: to infinity where it is near an edge of the domain.
fn open_at_edges(trial: &Trial<'_>, Region { min, max }: Region) -> Region {
    let Domain { periodic_sides, periodic_ends, .. } = trial.domain;
    let (near, domain) = (2.0 * trial.radius, trial.domain.region());
    let open = |is_near: bool, edge: f64, end: f64| if is_near { end } else { edge };
    let low =
        |periodic: bool, edge: f64, end: f64| open(!periodic && edge < end + near, edge, f64::NEG_INFINITY);
    let high =
        |periodic: bool, edge: f64, end: f64| open(!periodic && edge > end - near, edge, f64::INFINITY);
    Region::new(
        DVec2::new(low(periodic_sides, min.x, domain.min.x), low(periodic_ends, min.y, domain.min.y)),
        DVec2::new(high(periodic_sides, max.x, domain.max.x), high(periodic_ends, max.y, domain.max.y)),
    )
}
