//! Neighbour cells: a disk can only collide with disks in its own cell and the eight around it.

use glam::DVec2;

use super::block::{Block, SLOTS};
use super::event::Exit;
use super::grid::{Grid, Layout, Mesh, Place};
use crate::boundary::Boundary;
#[cfg(feature = "serde")]
use crate::boundary::Domain;
use crate::prefetch::prefetch;


/// The disks in the cells of a grid.
///
/// Ghosts are empty beyond walls; at periodic sides they mirror the cells of the opposite side. Every cell has the same
/// number of blocks, filled from the first on.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    grid: Grid,
    /// The blocks of all cells.
    blocks: Vec<Block>,
    /// How many there are in each cell.
    depth: usize,
    /// Column and row of each disk.
    places: Vec<Place>,
}

/// The grid and where the disks are in it: what a checkpoint keeps.
#[cfg(feature = "serde")]
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct GridState {
    layout: Layout,
    places: Vec<Place>,
}

#[cfg(feature = "serde")]
impl GridState {
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    pub(super) fn layout(&self) -> Layout {
        self.layout
    }

    pub(super) fn places(&self) -> &[Place] {
        &self.places
    }

    /// Whether the grid is one for this domain and disks of at most this diameter, and every disk is in it.
    pub(super) fn suits(&self, domain: &Domain, diameter: f64) -> bool {
        self.layout.suits(domain, diameter, self.places.len())
            && self.places.iter().all(|&place| self.layout.contains(place))
    }
}

impl Cells {
    /// Cells for disks of at most this diameter at these positions; `None` if the domain is too small for them.
    pub(super) fn new<B: Boundary + ?Sized>(
        boundary: &B,
        diameter: f64,
        mesh: Mesh,
        positions: &[DVec2],
    ) -> Option<Self> {
        let domain = boundary.domain();
        let highest = positions.iter().map(|p| p.y).fold(domain.bottom, f64::max);
        let layout = Layout::new(&domain, diameter, mesh, positions.len(), highest)?;
        let grid = Grid::new(&domain, layout, diameter);
        let places = positions.iter().map(|&position| grid.place_of(position)).collect();
        Some(Self::filled(boundary, 0.5 * diameter, grid, places))
    }

    /// Disks where they were saved.
    #[cfg(feature = "serde")]
    pub(super) fn restored<B: Boundary + ?Sized>(
        boundary: &B,
        largest_radius: f64,
        grid: Grid,
        places: &[Place],
    ) -> Self {
        Self::filled(boundary, largest_radius, grid, places.to_vec())
    }

    #[cfg(feature = "serde")]
    pub(super) fn state(&self) -> GridState {
        GridState { layout: self.grid.layout(), places: self.places.clone() }
    }

    fn filled<B: Boundary + ?Sized>(
        boundary: &B,
        largest_radius: f64,
        grid: Grid,
        places: Vec<Place>,
    ) -> Self {
        let depth = grid.mesh().slots().div_ceil(SLOTS);
        let blocks = vec![Block::EMPTY; grid.len() * depth];
        let mut cells = Self { grid, blocks, depth, places };
        cells.mark_walls(boundary, largest_radius);
        for disk in 0..cells.places.len() {
            cells.enter(disk);
        }
        cells
    }

    fn mark_walls<B: Boundary + ?Sized>(&mut self, boundary: &B, largest_radius: f64) {
        for place in self.grid.places() {
            if boundary.may_touch(&self.grid.region(place), largest_radius) {
                let first = self.grid.index(place) * self.depth;
                self.blocks[first].mark_wall();
            }
        }
    }

    #[inline]
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    #[inline]
    pub(super) fn place(&self, disk: usize) -> Place {
        self.places[disk]
    }

    /// Whether disks in this cell can touch a wall.
    #[inline]
    pub(super) fn is_at_wall(&self, place: Place) -> bool {
        self.blocks[self.grid.index(place) * self.depth].is_at_wall()
    }

    #[inline]
    fn cell(&mut self, cell: usize) -> &mut [Block] {
        &mut self.blocks[cell * self.depth..(cell + 1) * self.depth]
    }

    /// Writes a disk into its cell and the ghost of that.
    #[inline]
    fn enter(&mut self, disk: usize) {
        let place = self.places[disk];
        self.push(self.grid.index(place), disk);
        if let Some(ghost) = self.grid.mirror(place) {
            self.push(self.grid.index(ghost), disk);
        }
    }

    /// Takes a disk out of its cell and the ghost of that.
    #[inline]
    fn leave(&mut self, disk: usize) {
        let place = self.places[disk];
        self.remove(self.grid.index(place), disk);
        if let Some(ghost) = self.grid.mirror(place) {
            self.remove(self.grid.index(ghost), disk);
        }
    }

    #[inline]
    fn push(&mut self, cell: usize, disk: usize) {
        match &mut self.blocks[cell * self.depth] {
            first if first.len() < SLOTS => first.push(disk),
            _ => self.push_behind_first(cell, disk),
        }
    }

    #[cold]
    fn push_behind_first(&mut self, cell: usize, disk: usize) {
        if let Some(block) = self.cell(cell).iter_mut().find(|block| block.len() < SLOTS) {
            return block.push(disk);
        }
        self.grow();
        self.push(cell, disk);
    }

    /// The last disk of the cell takes the place of the one that leaves.
    #[inline]
    fn remove(&mut self, cell: usize, disk: usize) {
        match &mut self.blocks[cell * self.depth] {
            first if first.len() < SLOTS => first.remove(disk),
            _ => self.remove_from_full(cell, disk),
        }
    }

    #[cold]
    fn remove_from_full(&mut self, cell: usize, disk: usize) {
        let blocks = self.cell(cell);
        let last = blocks.iter().rposition(|block| block.len() > 0).unwrap_or(0);
        let replacement = blocks[last].last();
        blocks[last].remove(replacement as usize);
        blocks.iter_mut().for_each(|block| block.replace(disk, replacement));
    }

    /// Twice as many blocks in every cell.
    #[cold]
    fn grow(&mut self) {
        let mut blocks = vec![Block::EMPTY; 2 * self.blocks.len()];
        for (old, new) in self.blocks.chunks_exact(self.depth).zip(blocks.chunks_exact_mut(2 * self.depth)) {
            new[..self.depth].copy_from_slice(old);
        }
        self.blocks = blocks;
        self.depth *= 2;
    }

    /// Takes a disk to the cell that it leaves for; returns what that adds to its `x`.
    #[inline]
    pub(super) fn cross(&mut self, disk: usize, exit: Exit) -> f64 {
        self.leave(disk);
        let (place, shift) = self.grid.neighbour(self.places[disk], exit.direction());
        self.places[disk] = place;
        self.enter(disk);
        shift
    }

    #[inline]
    pub(super) fn prefetch_place(&self, disk: usize) {
        prefetch(&self.places, disk);
    }

    /// Asks for the nine cells around a disk.
    #[inline]
    pub(super) fn prefetch_around(&self, disk: usize) {
        let (centre, stride) = (self.grid.index(self.places[disk]), self.grid.stride());
        for middle in [centre - stride, centre, centre + stride] {
            self.prefetch_cells(middle - 1, middle + 1);
        }
    }

    /// Asks for the cells that a disk leaves and enters by `exit`, and those that then come within reach.
    #[inline]
    pub(super) fn prefetch_ahead(&self, disk: usize, exit: Exit) {
        let (from, to) = (self.places[disk], self.next_place(disk, exit));
        self.grid.prefetch_region(to);
        for cell in [from, to].map(|place| self.grid.index(place)) {
            self.prefetch_cells(cell, cell);
        }
        let (first, step) = self.three_ahead(to, exit);
        if step == 1 {
            self.prefetch_cells(first, first + 2);
        } else {
            for cell in [first, first + step, first + 2 * step] {
                self.prefetch_cells(cell, cell);
            }
        }
    }

    /// Asks for these cells, which are not more than two cache lines.
    #[inline]
    fn prefetch_cells(&self, first: usize, last: usize) {
        prefetch(&self.blocks, first * self.depth);
        prefetch(&self.blocks, (last + 1) * self.depth - 1);
    }

    /// Room that [`Self::around`] and [`Self::ahead`] need.
    #[inline]
    pub(super) fn room(&self) -> usize {
        9 * self.depth * SLOTS
    }

    /// Writes the disks in the nine cells around `disk` (itself included) to `found`; returns how many.
    #[inline]
    pub(super) fn around(&self, disk: usize, found: &mut [u32]) -> usize {
        let centre = self.grid.index(self.places[disk]);
        let stride = self.grid.stride();
        let mut count = 0;
        for first in [centre - stride - 1, centre - 1, centre + stride - 1] {
            count = self.gather(first, 1, found, count);
        }
        count
    }

    /// The same for the three cells that come within reach of `place` when a disk has come there by `exit`.
    #[inline]
    pub(super) fn ahead(&self, place: Place, exit: Exit, found: &mut [u32]) -> usize {
        let (first, step) = self.three_ahead(place, exit);
        self.gather(first, step, found, 0)
    }

    /// The first of these three cells, and how far apart they are.
    #[inline]
    fn three_ahead(&self, place: Place, exit: Exit) -> (usize, usize) {
        let (right, up) = exit.direction();
        let stride = self.grid.stride();
        let middle =
            self.grid.index(place).wrapping_add_signed(right as isize * stride.cast_signed() + up as isize);
        let step = if up == 0 { 1 } else { stride };
        (middle - step, step)
    }

    /// The place that a disk is at when it has left its cell by `exit`.
    #[inline]
    pub(super) fn next_place(&self, disk: usize, exit: Exit) -> Place {
        self.grid.neighbour(self.places[disk], exit.direction()).0
    }

    /// Appends the disks of three cells.
    #[inline(always)]
    fn gather(&self, first: usize, step: usize, found: &mut [u32], count: usize) -> usize {
        // Loops of a length that the compiler knows are unrolled.
        match self.depth {
            1 => self.gather_blocks(1, first, step, found, count),
            2 => self.gather_blocks(2, first, step, found, count),
            depth => self.gather_blocks(depth, first, step, found, count),
        }
    }

    /// All slots of a block are copied; the next goes on behind the last that is taken, without a branch on how many those are.
    #[inline(always)]
    fn gather_blocks(
        &self,
        depth: usize,
        first: usize,
        step: usize,
        found: &mut [u32],
        mut count: usize,
    ) -> usize {
        let blocks = &self.blocks[first * depth..(first + 2 * step + 1) * depth];
        for cell in [0, step, 2 * step] {
            for block in &blocks[cell * depth..(cell + 1) * depth] {
                found[count..count + SLOTS].copy_from_slice(&block.slots());
                count += block.len();
                if block.len() < SLOTS {
                    break;
                }
            }
        }
        count
    }
}
