//! The parts of a container, and the index that finds them.

mod index;
mod overlap;
mod search;

use std::ops::Range;

use index::Index;

use super::brick::Brick;
use super::part::{Part, Phase};
use super::{Domain, Impact, Region, WallView};
use crate::ParameterError;
use crate::wall::Stroke;

/// Relative difference below which the radii of a disk and a hollow count as equal.
const TIGHT: f64 = 1e-9;

/// The parts of a container. Their walls come after the container's own walls: first the bricks, then the
/// corners of each part.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    /// The container's domain, and the number of its own walls.
    domain: Domain,
    first: usize,
    placed: Vec<Placed>,
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
    pub(super) fn new(placed: Vec<Placed>, domain: Domain, first: usize, origin: f64) -> Option<Box<Self>> {
        if placed.is_empty() {
            return None;
        }
        let (index, bricks, moving, filled, hollows) = (Index::EMPTY, vec![], vec![], vec![], vec![]);
        let has_patches = placed.iter().any(|placed| placed.part.is_patch());
        let mut parts = Self { domain, first, placed, bricks, index, moving, has_patches, filled, hollows };
        parts.set_time_origin(origin);
        parts.number();
        Some(Box::new(parts))
    }

    /// Numbers the walls, and builds their index.
    fn number(&mut self) {
        for (number, placed) in self.placed.iter_mut().enumerate() {
            placed.first = self.first + self.bricks.len();
            let bricks = placed.part.all_bricks();
            self.bricks.extend(bricks.map(|&brick| PlacedBrick { part: number, brick }));
        }
        let part = |number: usize| &self.placed[number].part;
        self.index = Index::new(
            &self.domain,
            &self.bricks,
            |of| part(of.part).travel().bounds(&of.brick),
            |of, region| part(of.part).travel().may_reach(&of.brick, region, 0.0),
        );
        let moves = |&number: &u32| {
            let part = part(number as usize);
            !part.travel().is_at_rest() && !part.takes_centers()
        };
        self.moving = (0..self.placed.len() as u32).filter(moves).collect();
        let hollows = (self.first..).zip(&self.bricks).filter_map(|(wall, of)| {
            let hollow = of.brick.hollow().filter(|_| !part(of.part).takes_centers())?;
            Some((hollow, wall))
        });
        self.hollows = hollows.collect();
        self.hollows.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.filled = self.filled_cells();
    }

    pub(super) fn placed(&self) -> &[Placed] {
        &self.placed
    }

    pub(super) fn into_placed(self) -> Vec<Placed> {
        self.placed
    }

    pub(super) fn wall_count(&self) -> usize {
        self.bricks.len()
    }

    pub(super) fn set_time_origin(&mut self, origin: f64) {
        for placed in &mut self.placed {
            placed.part.set_time_origin(origin);
            placed.phase = placed.part.phase(origin);
        }
    }

    /// Returns the part to which a wall belongs and its brick, if there is such a wall.
    fn owner(&self, wall: usize) -> Option<(&Placed, &Brick)> {
        let PlacedBrick { part, brick } = self.bricks.get(wall.checked_sub(self.first)?)?;
        Some((&self.placed[*part], brick))
    }

    /// Returns the view of a wall, if there is such a wall.
    pub(super) fn view(&self, wall: usize, time: f64) -> Option<WallView<'_>> {
        let (placed, brick) = self.owner(wall)?;
        let (part, phase) = (&placed.part, placed.phase.after(time));
        let (count, number, pose) = (part.bricks().len(), wall - placed.first, part.travel().pose(phase));
        let (anchor, aside) = brick.anchor();
        let mut view = WallView::new(placed.name.as_str()).with_point(pose.outward(anchor) + aside);
        if number < count {
            view = view.with_brick((count > 1).then_some(number), *brick, pose);
        } else {
            view = view.with_corner((count > 1).then_some(number - count));
        }
        // The bricks of a part move together.
        if let Some((displacement, phase)) = part.travel().moved(phase).filter(|_| number == 0) {
            view = view.with_motion(displacement, phase);
        }
        if let Some(piston) = part.travel().piston() {
            view = view.with_energy(piston.energy(time));
        }
        Some(view)
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
        let placed = &self.placed[self.bricks[wall - self.first].part];
        let travel = placed.part.travel();
        let Some(piston) = travel.piston() else { return self.may_touch(region, radius) };
        let (reach, range) = (1.001 * radius, piston.range_until(until));
        self.domain.images_of(&placed.bounds).any(|image| {
            let region = region.shifted(-image);
            placed.part.all_bricks().any(|brick| travel.may_reach_in(range, brick, &region, reach))
        })
    }

    /// Returns the pistons, in the order of their parts.
    pub(super) fn pistons(&self) -> impl Iterator<Item = &Stroke> {
        self.placed.iter().filter_map(|placed| placed.part.travel().piston())
    }

    /// Sets the states of the pistons, in this order.
    pub(super) fn set_pistons(&mut self, numbers: &[[f64; 3]]) -> Result<(), ParameterError> {
        let pistons = self.placed.iter_mut().filter(|placed| placed.part.travel().piston().is_some());
        pistons.zip(numbers).try_for_each(|(placed, &numbers)| placed.part.set_piston(numbers))
    }
}
