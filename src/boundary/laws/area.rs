//! The check of free areas by overlaps at points all over a region.

use glam::DVec2;

use super::Random;
use super::trial::{PART, Trial};
use crate::Violation;
use crate::boundary::{Boundary, Region};
use crate::violation::require;

/// Number of points along a side of a region: a random point in each cell of a grid.
const PLACES: u32 = 128;

/// Largest error of an area, relative to the region: ten times the scatter in the worst case.
const SCATTER: f64 = 5e-3;

/// Checks the free areas of the domain and of a random region.
pub(super) fn check_areas(trial: &Trial<'_>, time: f64, random: &mut Random) -> Result<(), Violation> {
    let (low, high) = trial.rectangle();
    let any = |random: &mut Random| DVec2::new(random.between(low.x, high.x), random.between(low.y, high.y));
    let (one, other) = (any(random), any(random));
    for region in [Region::new(low, high), Region::new(one.min(other), one.max(other))] {
        check_area(trial, &region, time, random)?;
    }
    Ok(())
}

fn check_area(trial: &Trial<'_>, region: &Region, time: f64, random: &mut Random) -> Result<(), Violation> {
    let Some(area) = trial.boundary.area(region, trial.radius, time) else { return Ok(()) };
    let size = region.max - region.min;
    let mut free = 0_u32;
    for cell in 0..PLACES * PLACES {
        let corner = DVec2::new(f64::from(cell % PLACES), f64::from(cell / PLACES));
        let within = DVec2::new(random.between(0.0, 1.0), random.between(0.0, 1.0));
        let place = region.min + size * (corner + within) / f64::from(PLACES);
        free += u32::from(trial.depth(place, 0.0, time).is_none());
    }
    let whole = size.x * size.y;
    let found = whole * f64::from(free) / f64::from(PLACES * PLACES);
    let (radius, slack) = (trial.radius, SCATTER * whole);
    require!(PART, "area", (area - found).abs() <= slack;
        "the area for centers of disks of radius {radius:?} in {region:?} at {time:?} is {area:?}, but \
         {found:?} is free");
    Ok(())
}
