//! Overlaps with the parts of a container, and the area that the parts leave free.
//!
//! The nearest brick of a part decides whether a position is behind the part. If the disk reaches a brick of
//! the part, the nearest one is among the bricks near the disk. If all bricks of a part at rest are far away,
//! a table decides: it lists, for each cell of the index, the parts that fill the cell.

use glam::DVec2;

use super::index::Index;
use super::{Parts, Placed, PlacedBrick};
use crate::boundary::area::{Curve, Field};
use crate::boundary::brick::Nearest;
use crate::boundary::{Overlap, Part, Probe, Region};

/// The number of a part, the index of one of its walls, and the nearest point of this wall.
type Seen = (usize, usize, Nearest);

impl Parts {
    /// Returns the wall of a part that a disk penetrates most deeply, and the depth.
    pub(in crate::boundary) fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let (position, radius, time) = (probe.position(), probe.radius(), probe.time());
        let filled = self.filled.get(self.index.cell(position)).into_iter().flatten();
        let whole = self.moving.iter().chain(filled);
        let stops = |part: usize| self.placed[part].part.stops(probe.kind());
        let whole = whole.filter(|&&part| stops(part as usize));
        let whole = whole.filter_map(|&part| self.depth(part as usize, position, radius, time));
        let near = self.near_at_rest(position, radius).filter(|(part, ..)| stops(*part));
        let mut near: Vec<Seen> = near.collect();
        near.sort_by_key(|(part, ..)| *part);
        let beside = near.chunk_by(|a, b| a.0 == b.0).filter_map(|seen| {
            let nearest = |a: Seen, b: Seen| if b.2.is_better_than(&a.2) { b } else { a };
            // If the disk does not reach the nearest brick of these cells, a nearer brick may lie in other
            // cells.
            match seen.iter().copied().reduce(nearest)? {
                (_, wall, nearest) if nearest.distance <= radius => {
                    Some(Overlap::new(wall, radius - nearest.signed_distance))
                }
                (part, ..) => self.depth(part, position, radius, time),
            }
        });
        Overlap::deepest(whole.chain(beside))
    }

    /// Returns the bricks at rest in the cells around a disk, as seen from its center.
    fn near_at_rest(&self, position: DVec2, radius: f64) -> impl Iterator<Item = Seen> {
        self.index.near(&Region::around(position, radius)).filter_map(move |entry| {
            let number = entry.brick as usize;
            let PlacedBrick { part, brick } = &self.bricks[number];
            let blocks = |part: &Part| part.travel().is_at_rest() && !part.takes_centers();
            let seen = || (*part, number + self.first, brick.nearest(position - entry.image));
            blocks(&self.placed[*part].part).then(seen)
        })
    }

    /// Returns the nearest wall of a part, and the depth to which a disk reaches into it.
    fn depth(&self, part: usize, position: DVec2, radius: f64, time: f64) -> Option<Overlap> {
        let placed = &self.placed[part];
        let pose = placed.part.travel().pose(placed.phase.after(time));
        let depths = self.domain.images_of(&placed.bounds).filter_map(|image| {
            let (brick, distance) = placed.part.nearest(pose.inward(position - image))?;
            Some(Overlap::new(placed.first + brick, radius - distance))
        });
        Overlap::deepest(depths)
    }

    /// Lists, for each cell, the parts at rest that fill it: they have no brick in the cell, and all of it is
    /// behind them.
    pub(super) fn filled_cells(&self) -> Vec<Vec<u32>> {
        let mut filled = vec![Vec::new(); self.index.len()];
        for (number, placed) in self.placed.iter().enumerate() {
            if placed.part.travel().is_at_rest() && placed.part.has_back() {
                for cell in self.cells_filled_by(number, placed) {
                    filled[cell].push(number as u32);
                }
            }
        }
        filled
    }

    /// Returns the cells that hold no brick of a part and are behind it.
    ///
    /// If two neighboring cells hold no brick of the part, either both are behind it or neither is. A cell is
    /// therefore examined only if its left and lower neighbors do not decide.
    fn cells_filled_by(&self, number: usize, placed: &Placed) -> Vec<usize> {
        let Index { columns, .. } = self.index;
        let has_brick = |cell: usize| {
            self.index.within(cell).any(|entry| self.bricks[entry.brick as usize].part == number)
        };
        let is_behind = |cell: usize| self.depth(number, self.index.middle(cell), 0.0, 0.0).is_some();
        // The results so far for cells without a brick of the part: true if the cell is behind the part.
        let mut known: Vec<Option<bool>> = vec![None; self.index.len()];
        for cell in self.cells_to_look_at(placed) {
            if has_brick(cell) {
                continue;
            }
            let left = if cell % columns > 0 { known[cell - 1] } else { None };
            let below = if cell >= columns { known[cell - columns] } else { None };
            known[cell] = Some(left.or(below).unwrap_or_else(|| is_behind(cell)));
        }
        (0..known.len()).filter(|&cell| known[cell] == Some(true)).collect()
    }

    /// Returns the cells that may be behind a part: the cells of its rectangle if disks are free outside it,
    /// otherwise all cells.
    fn cells_to_look_at(&self, placed: &Placed) -> Vec<usize> {
        let bounds = placed.bounds;
        let is_walled = self.domain.periods() == DVec2::ZERO;
        // This point is far enough from the part to stay outside after rounding, whatever the part's size.
        let outside = bounds.min - (bounds.max - bounds.min) - DVec2::ONE;
        let is_free_outside = is_walled && placed.part.signed_distance(outside) > 0.0;
        if is_free_outside { self.index.cells(&bounds).collect() } else { (0..self.index.len()).collect() }
    }
}

impl Parts {
    /// Returns the area of the part of a region in which the center of a disk is free of parts at a time, or
    /// `None` if it depends on the kind of the disk. The region is free of the container's own walls.
    pub(in crate::boundary) fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        if self.placed.iter().any(|placed| placed.part.is_full_for_some()) {
            return None;
        }
        let is_free = |place| self.overlap(&Probe::new(place, radius, time)).is_none();
        // Centers change between free and occupied at the surfaces of bricks only.
        let are_known =
            self.placed.iter().all(|placed| placed.part.takes_centers() || placed.part.is_closed());
        let is_near = self.may_touch(region, radius);
        let curves = if is_near { self.curves(region, radius, time) } else { Vec::new() };
        Some(Field { region: *region, curves, are_known, is_free: &is_free }.area())
    }

    /// Returns whether a disk with its center in a region can touch a part at any time.
    pub(in crate::boundary) fn may_touch(&self, region: &Region, radius: f64) -> bool {
        // The region holds centers of disks. The margin keeps rounding from hiding a touch at its edge.
        let reach = 1.001 * radius;
        self.index.near(&region.enlarged(reach)).any(|entry| {
            let (placed, brick) = self.owner(entry.brick as usize);
            placed.part.travel().may_reach(brick, &region.shifted(-entry.image), reach)
        })
    }

    /// Returns the curves in a region on which the center of a disk touches a part.
    fn curves(&self, region: &Region, radius: f64, time: f64) -> Vec<Curve> {
        let mut curves = Vec::new();
        for placed in self.placed.iter().filter(|placed| !placed.part.takes_centers()) {
            let pose = placed.part.travel().pose(placed.phase.after(time));
            let reach = placed.bounds.enlarged(radius);
            for image in self.domain.images_of(&placed.bounds) {
                if region.meets(&reach.shifted(image)) {
                    let bricks = placed.part.all_bricks().flat_map(|brick| brick.curves(radius));
                    curves.extend(bricks.map(|curve| curve.moved(|place| pose.outward(place) + image)));
                }
            }
        }
        curves
    }
}
