//! The free area, against overlaps at places all over a region.

use glam::DVec2;

use super::Random;
use super::trial::{PART, Trial};
use crate::Violation;
use crate::boundary::{Boundary, Region};
use crate::violation::require;

/// Number of times that a region is halved where a wall goes through.
const HALVINGS: u32 = 16;

/// Largest error of an area, relative to the region: a few corners of the smallest cells.
const SLACK: f64 = 5e-5;

/// Checks the free areas of the domain, and of a region at random.
pub(super) fn check_areas(trial: &Trial<'_>, time: f64, random: &mut Random) -> Result<(), Violation> {
    let (low, high) = trial.rectangle();
    let any = |random: &mut Random| DVec2::new(random.between(low.x, high.x), random.between(low.y, high.y));
    let (one, other) = (any(random), any(random));
    for region in [Region::new(low, high), Region::new(one.min(other), one.max(other))] {
        check_area(trial, region, time)?;
    }
    Ok(())
}

fn check_area(trial: &Trial<'_>, region: Region, time: f64) -> Result<(), Violation> {
    let Some(area) = trial.boundary.area(&region, trial.radius, time) else { return Ok(()) };
    let found = free_area(trial, region, time, HALVINGS);
    let (radius, slack) = (trial.radius, SLACK * region.area());
    require!(PART, "area", (area - found).abs() <= slack;
        "the area for centers of disks of radius {radius:?} in {region:?} at {time:?} is {area:?}, but \
         {found:?} is free");
    Ok(())
}

/// Returns the free area of a region by the gaps to the walls: a wall that is further from the middle than
/// the corners are does not go through.
fn free_area(trial: &Trial<'_>, region: Region, time: f64, halvings: u32) -> f64 {
    let (size, middle) = (region.max - region.min, 0.5 * (region.min + region.max));
    let reach = 0.5 * size.length();
    let gap = |place| reach - trial.depth(place, reach, time).map_or(0.0, |found| found.depth);
    let wide = gap(middle);
    if wide.abs() >= reach {
        return if wide > 0.0 { region.area() } else { 0.0 };
    }
    if halvings == 0 {
        // The share beside a straight wall, which is exact if the wall goes along an edge of the cell.
        let steps = 0.01 * size;
        let change = DVec2::new(gap(middle + steps * DVec2::X), gap(middle + steps * DVec2::Y)) - wide;
        let across = (change / steps).abs().dot(size);
        return region.area() * (0.5 + wide / across).clamp(0.0, 1.0);
    }
    let half =
        if size.x > size.y { DVec2::new(middle.x, region.max.y) } else { DVec2::new(region.max.x, middle.y) };
    let halves = [Region::new(region.min, half), Region::new(region.min + region.max - half, region.max)];
    halves.into_iter().map(|half| free_area(trial, half, time, halvings - 1)).sum()
}
