//! The parts of a container, and the index that finds them.

mod index;
mod overlap;
mod search;

use std::ops::Range;

use index::Index;

use super::brick::Brick;
use super::part::{Part, Phase};
use super::{Domain, Impact, Region, WallView};
use crate::wall::Motion;

/// Relative difference below which the radii of a disk and a hollow count as equal.
const TIGHT: f64 = 1e-9;

/// The parts of a container. Their walls come after the container's own walls: first the bricks, then the
/// corners of each part.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    /// The container's domain, and the number of its own walls.
    domain: Domain,
    first: usize,
    pub(super) placed: Vec<Placed>,
    bricks: Vec<PlacedBrick>,
    index: Index,
    /// The parts that move and that disks may not overlap.
    moving: Vec<u32>,
    /// True if a part treats disks differently from a plain wall.
    has_patches: bool,
    /// For each cell of the index, the parts at rest that fill it.
    filled: Vec<Vec<u32>>,
    /// The radii of all arcs with disks inside, in order, each with the index of its wall.
    hollows: Vec<(f64, usize)>,
}

/// A part with its name and its place among the walls.
#[derive(Debug, Clone)]
pub(super) struct Placed {
    pub(super) name: String,
    pub(super) part: Part,
    /// Index of the first wall.
    first: usize,
    /// Phase of the motion at the time origin.
    phase: Phase,
    /// A rectangle that holds the part at all times, and its largest coordinate, in magnitude.
    pub(super) bounds: Region,
    pub(super) size: f64,
}

impl Placed {
    pub(super) fn new(name: String, part: Part) -> Self {
        let bounds = part.swept_bounds();
        let size = bounds.min.abs().max(bounds.max.abs()).max_element();
        Self { name, part, first: 0, phase: Phase::default(), bounds, size }
    }

    /// Returns the indices of the part's walls.
    pub(super) fn walls(&self) -> Range<usize> {
        self.first..self.first + self.part.all_bricks().count()
    }
}

/// A brick, and the number of its part.
#[derive(Debug, Clone, Copy)]
struct PlacedBrick {
    part: usize,
    brick: Brick,
}

impl Parts {
    /// Returns parts in a container with this domain and this number of walls, or `None` without parts.
    pub(super) fn new(
        mut placed: Vec<Placed>,
        domain: Domain,
        first: usize,
        origin: f64,
    ) -> Option<Box<Self>> {
        if placed.is_empty() {
            return None;
        }
        let mut bricks = Vec::new();
        for (part, placed) in placed.iter_mut().enumerate() {
            placed.first = first + bricks.len();
            bricks.extend(placed.part.all_bricks().map(|&brick| PlacedBrick { part, brick }));
        }
        let (index, hollows) = (Index::new(&domain, &bricks, &placed), hollows(first, &bricks, &placed));
        let moves = |part: &Part| !part.travel().is_at_rest() && !part.takes_centers();
        let moving = (0..).zip(&placed).filter(|(_, placed)| moves(&placed.part)).map(|(part, _)| part);
        let (moving, has_patches) = (moving.collect(), placed.iter().any(|placed| placed.part.is_patch()));
        let filled = Vec::new();
        let mut parts = Self { domain, first, placed, bricks, index, moving, has_patches, filled, hollows };
        parts.set_time_origin(origin);
        parts.filled = parts.filled_cells();
        Some(Box::new(parts))
    }

    pub(super) fn wall_count(&self) -> usize {
        self.bricks.len()
    }

    pub(super) fn set_time_origin(&mut self, origin: f64) {
        for placed in &mut self.placed {
            placed.part.motion_mut().map(|motion| motion.change(|piston| piston.at_origin(origin)));
            placed.phase = placed.part.phase(origin);
        }
    }

    /// Returns the part of a brick, and the brick of this number among all.
    fn owner(&self, number: usize) -> (&Placed, &Brick) {
        let PlacedBrick { part, brick } = &self.bricks[number];
        (&self.placed[*part], brick)
    }

    /// Returns the view of a wall.
    pub(super) fn view(&self, wall: usize, time: f64) -> WallView<'_> {
        let (placed, brick) = self.owner(wall - self.first);
        let (part, phase) = (&placed.part, placed.phase.after(time));
        let (count, number, pose) = (part.bricks().len(), wall - placed.first, part.travel().pose(phase));
        let (anchor, aside) = brick.anchor();
        let which = if number < count { ("brick", number) } else { ("corner", number - count) };
        let mut view = WallView::new(placed.name.as_str()).with_point(pose.outward(anchor) + aside);
        view.brick = (number < count).then_some((*brick, pose));
        view.number = (count > 1).then_some(which);
        // The bricks of a part move together.
        view.motion = part.travel().moved(phase).filter(|_| number == 0);
        view.energy = part.travel().piston().map(|piston| piston.energy(time));
        view
    }

    pub(super) fn tight_fit(&self, radius: f64) -> Option<usize> {
        let first = self.hollows.partition_point(|&(hollow, _)| hollow < radius * (1.0 - TIGHT));
        let &(hollow, wall) = self.hollows.get(first)?;
        (hollow <= radius * (1.0 + TIGHT)).then_some(wall)
    }

    /// Changes the motion of the part of a wall by an impact. Returns whether the part has a mass.
    pub(super) fn take(&mut self, impact: &Impact) -> bool {
        let part = self.bricks[impact.wall - self.first].part;
        self.placed[part].part.take(impact.impulse, impact.time)
    }

    /// Returns whether a disk with its center in a region may touch the part of a wall up to this time.
    pub(super) fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        let (placed, _) = self.owner(wall - self.first);
        let travel = placed.part.travel();
        let Some(piston) = travel.piston() else { return self.may_touch(region, radius) };
        let (reach, range) = (1.001 * radius, piston.range_until(until));
        self.domain.images_of(&placed.bounds).any(|image| {
            let region = region.shifted(-image);
            placed.part.all_bricks().any(|brick| travel.may_reach_in(range, brick, &region, reach))
        })
    }

    /// Returns the motions along directions, in the order of their parts.
    pub(super) fn motions(&mut self) -> impl Iterator<Item = &mut Motion> {
        self.placed.iter_mut().filter_map(|placed| placed.part.motion_mut())
    }
}

/// Returns the radii of all arcs with disks inside, in order, each with the index of its wall.
fn hollows(first: usize, bricks: &[PlacedBrick], placed: &[Placed]) -> Vec<(f64, usize)> {
    let stops = |of: &PlacedBrick| !placed[of.part].part.takes_centers();
    let hollow = |(wall, of): (usize, &PlacedBrick)| Some((of.brick.hollow().filter(|_| stops(of))?, wall));
    let mut hollows: Vec<_> = (first..).zip(bricks).filter_map(hollow).collect();
    hollows.sort_by(|a, b| a.0.total_cmp(&b.0));
    hollows
}
