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
    let (mut found, mut uncertain) = (0.0, 0.0);
    let Region { min, max } = region.within(&trial.domain.region());
    let mut cells = vec![Cell { middle: 0.5 * (min + max), half: 0.5 * (max - min), halvings: 0 }];
    while let Some(cell) = cells.pop() {
        match cell.free_share(trial, radius, time) {
            Some(share) => found += share * cell.area(),
            None if cell.halvings < MOST => cells.extend(cell.halves()),
            None => uncertain += cell.area(),
        }
    }
    let slack = SLACK * region.area();
    require!(PART, "area", (found - slack..=found + uncertain + slack).contains(&area);
        "the area for centers of disks of radius {radius:?} in {region:?} at {time:?} is {area:?}, but \
         {found:?} is free");
    Ok(())
}

/// A rectangle in a region.
struct Cell {
    middle: DVec2,
    half: DVec2,
    halvings: u32,
}

impl Cell {
    fn area(&self) -> f64 {
        4.0 * self.half.x * self.half.y
    }

    /// Returns both halves across the longer side.
    fn halves(&self) -> [Self; 2] {
        let is_wide = self.half.x > self.half.y;
        let step = 0.5 * if is_wide { DVec2::new(self.half.x, 0.0) } else { DVec2::new(0.0, self.half.y) };
        [-step, step].map(|step| Self {
            middle: self.middle + step,
            half: self.half - step.abs(),
            halvings: self.halvings + 1,
        })
    }

    /// Returns the share of the cell in which the center of a disk is free, or `None` if it is unknown.
    fn free_share(&self, trial: &Trial<'_>, radius: f64, time: f64) -> Option<f64> {
        let reach = self.half.length();
        let of_disk = Gap { boundary: &*trial.boundary, radius, kind: Kind::DEFAULT };
        let gap =
            |x: f64, y: f64, reach: f64| of_disk.at(self.middle + DVec2::new(x, y) * self.half, reach, time);
        let middle = gap(0.0, 0.0, reach);
        if middle.abs() >= reach {
            return Some(if middle > 0.0 { 1.0 } else { 0.0 });
        }
        let is_large = self.halvings < FEWEST || self.half.max_element() > FINE * trial.radius;
        if is_large && self.halvings < MOST {
            return None;
        }
        let corner = |x: f64, y: f64| gap(x, y, 2.0 * reach);
        let [one, two, three, four] =
            [corner(-1.0, -1.0), corner(1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)];
        let bends = [one + four - 2.0 * middle, two + three - 2.0 * middle];
        let change = 0.25 * DVec2::new(two + four - one - three, three + four - one - two);
        let slope = (change / self.half).length();
        let is_straight =
            bends.iter().all(|bend| bend.abs() <= 2.0 * BEND * reach) && (slope - 1.0).abs() <= BEND;
        // The mean of a gap that is quadratic in the coordinates.
        let mean = middle + (bends[0] + bends[1]) / 12.0;
        is_straight.then(|| share_beside_line(mean, change))
    }
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
