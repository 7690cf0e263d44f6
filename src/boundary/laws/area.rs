//! The check of free areas by the gaps between disks and walls.
//!
//! A region is halved until the gaps decide whether each of its cells is free. A wall that is farther from
//! the middle of a cell than its corners does not reach into the cell, since the gap grows by no more than
//! the disk moves. If the gaps in the middle and at the corners of a small cell fit one straight wall up to
//! `BEND`, the wall counts as straight, and the free share has a closed form. Cells at corners of the free
//! area, at thin walls and at tight arcs are halved further. The smallest cells count as uncertain if they
//! are still undecided.

use glam::DVec2;

use super::Random;
use super::trial::{Gap, PART, Trial};
use crate::boundary::{Boundary, Region};
use crate::error::require;
use crate::{Kind, Violation};

/// Smallest and largest number of halvings of a region that a wall crosses.
const FEWEST: u32 = 12;
const MOST: u32 = 24;

/// Largest half side of a cell in which a wall may count as straight, relative to the radius. The curve that
/// bounds the centers of disks has no features smaller than the radius.
const FINE: f64 = 0.125;

/// Largest deviation of a gap from the gap to a straight wall, relative to the half diagonal of the cell.
const BEND: f64 = 0.01;

/// Largest error of an area, relative to the region.
///
/// The deviation of a bent wall from the straight line grows with the square of the distance along the line.
/// The mean of this square is subtracted, so the errors of the cells have both signs and a zero mean: at most
/// 1e-3 of a cell, in about a hundred cells of 1/4096 of the region. Together, they are of the order of 5e-6
/// of the region.
const SLACK: f64 = 2e-5;

/// Checks the free areas of the domain and of a random region, for centers of disks and for matter. Both
/// regions may extend beyond the walls of the domain, where no area is free.
pub(super) fn check_areas(trial: &Trial<'_>, time: f64, random: &mut Random) -> Result<(), Violation> {
    let Region { min, max } = trial.rectangle();
    let has_walls = trial.domain.periods().cmpeq(DVec2::ZERO);
    let beyond = DVec2::select(has_walls, DVec2::splat(trial.radius), DVec2::ZERO);
    let (low, high) = (min - beyond, max + beyond);
    let mut any = || DVec2::new(random.between(low.x, high.x), random.between(low.y, high.y));
    let (one, other) = (any(), any());
    for radius in [trial.radius, 0.0] {
        for region in [Region::new(low, high), Region::new(one.min(other), one.max(other))] {
            check_area(trial, &region, radius, time)?;
        }
    }
    Ok(())
}

fn check_area(trial: &Trial<'_>, region: &Region, radius: f64, time: f64) -> Result<(), Violation> {
    let Some(area) = trial.boundary.area(region, radius, time) else { return Ok(()) };
    let gap = Gap { boundary: &*trial.boundary, radius, kind: Kind::DEFAULT };
    let (mut found, mut uncertain) = (0.0, 0.0);
    let mut cells = vec![(region.within(&trial.domain.region()), 0)];
    while let Some((cell, halvings)) = cells.pop() {
        let is_small = halvings >= FEWEST && (cell.max - cell.min).max_element() <= 2.0 * FINE * trial.radius;
        match free_share(gap, cell, time, is_small || halvings == MOST) {
            Some(share) => found += share * cell.area(),
            None if halvings < MOST => cells.extend(halves(cell).map(|half| (half, halvings + 1))),
            None => uncertain += cell.area(),
        }
    }
    let slack = SLACK * region.area();
    require!(PART, "area", (found - slack..=found + uncertain + slack).contains(&area);
        "the area for centers of disks of radius {radius:?} in {region:?} at {time:?} is {area:?}, but \
         {found:?} is free");
    Ok(())
}

/// Returns both halves of a cell across its longer side.
fn halves(Region { min, max }: Region) -> [Region; 2] {
    let size = max - min;
    let half = 0.5 * if size.x > size.y { DVec2::new(size.x, 0.0) } else { DVec2::new(0.0, size.y) };
    [Region::new(min, max - half), Region::new(min + half, max)]
}

/// Returns the share of a cell in which the center of a disk is free, or `None` if it is unknown. In a small
/// cell, a wall may count as straight.
fn free_share(of_disk: Gap<'_>, cell: Region, time: f64, is_small: bool) -> Option<f64> {
    let (middle, half) = (0.5 * (cell.min + cell.max), 0.5 * (cell.max - cell.min));
    let reach = half.length();
    let gap = |x: f64, y: f64| of_disk.at(middle + DVec2::new(x, y) * half, 2.0 * reach, time);
    let here = gap(0.0, 0.0);
    if here.abs() >= reach {
        return Some(if here > 0.0 { 1.0 } else { 0.0 });
    }
    if !is_small {
        return None;
    }
    let [one, two, three, four] = [gap(-1.0, -1.0), gap(1.0, -1.0), gap(-1.0, 1.0), gap(1.0, 1.0)];
    let change = 0.25 * DVec2::new(two + four - one - three, three + four - one - two);
    let bends = [one + four - 2.0 * here, two + three - 2.0 * here];
    let is_straight = bends.iter().all(|bend| bend.abs() <= 2.0 * BEND * reach);
    // The mean of a gap that is quadratic in the coordinates.
    let mean = here + (bends[0] + bends[1]) / 12.0;
    let slope = (change / half).length();
    (is_straight && (slope - 1.0).abs() <= BEND).then(|| share_beside_line(mean, change))
}

/// Returns the share of the square [-1, 1]² in which a linear function is positive, from its value in the
/// middle and its change to the sides.
fn share_beside_line(middle: f64, change: DVec2) -> f64 {
    let across = change.abs().max_element();
    // For a function that hardly changes along a side, the difference below would lose its digits.
    let along = change.abs().min_element().max(1e-4 * across);
    let square = |from: f64| from.max(0.0) * from.max(0.0);
    let integral = |value: f64| (square(value + across) - square(value - across)) / (4.0 * across);
    ((integral(middle + along) - integral(middle - along)) / (2.0 * along)).clamp(0.0, 1.0)
}
