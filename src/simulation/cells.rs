//! Neighbor cells: a disk can only collide with disks in its own cell and the eight cells around it.

mod block;
mod cell_size;
mod contents;
mod grid;

use glam::DVec2;

use super::state::Exit;
use crate::boundary::Boundary;
use crate::prefetch::prefetch;
pub(super) use cell_size::CellSize;
use contents::Contents;
#[cfg(feature = "serde")]
pub(super) use grid::{CELLS_PER_DISK, SPARE_CELLS};
pub(super) use grid::{Grid, Layout, Place};

/// The disks in the cells of a grid.
///
/// Ghost cells are empty beyond walls. At periodic sides, they mirror the cells of the opposite side.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    grid: Grid,
    contents: Contents,
    /// Column and row of each disk.
    pub(super) places: Vec<Place>,
}

impl Cells {
    /// Creates cells for disks of at most this diameter at these positions, or `None` if the domain is too
    /// small for them.
    pub(super) fn new<B: Boundary + ?Sized>(
        boundary: &B,
        diameter: f64,
        cell_size: CellSize,
        positions: impl ExactSizeIterator<Item = DVec2> + Clone,
    ) -> Option<Self> {
        let domain = boundary.domain();
        let highest = positions.clone().map(|position| position.y).fold(domain.bottom, f64::max);
        let layout = Layout::new(&domain, diameter, cell_size, positions.len(), highest)?;
        let grid = Grid::new(&domain, layout, diameter);
        let places = positions.map(|position| grid.place_of(position)).collect();
        Some(Self::filled(boundary, 0.5 * diameter, grid, places))
    }

    /// Creates cells of this grid with the disks in these places.
    pub(super) fn filled<B: Boundary + ?Sized>(
        boundary: &B,
        largest_radius: f64,
        grid: Grid,
        places: Vec<Place>,
    ) -> Self {
        let contents = Contents::empty(grid.len(), 1);
        let mut cells = Self { grid, contents, places };
        cells.mark_walls(boundary, largest_radius);
        for disk in 0..cells.places.len() {
            cells.enter(disk);
        }
        cells
    }

    fn mark_walls<B: Boundary + ?Sized>(&mut self, boundary: &B, largest_radius: f64) {
        for place in self.grid.places() {
            if boundary.may_touch(&self.grid.region(place), largest_radius) {
                self.contents.mark_wall(self.grid.index(place));
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

    /// Tells whether disks in this cell can touch a wall.
    #[inline]
    pub(super) fn is_at_wall(&self, place: Place) -> bool {
        self.contents.is_at_wall(self.grid.index(place))
    }

    /// Writes a disk into its cell, and into the ghost of that cell.
    #[inline]
    fn enter(&mut self, disk: usize) {
        let place = self.places[disk];
        self.contents.push(self.grid.index(place), disk);
        if let Some(ghost) = self.grid.mirror(place) {
            self.contents.push(self.grid.index(ghost), disk);
        }
    }

    /// Takes a disk out of its cell, and out of the ghost of that cell.
    #[inline]
    fn leave(&mut self, disk: usize) {
        let place = self.places[disk];
        self.contents.remove(self.grid.index(place), disk);
        if let Some(ghost) = self.grid.mirror(place) {
            self.contents.remove(self.grid.index(ghost), disk);
        }
    }

    /// Moves a disk to the cell that it enters by this exit. Returns the change of its `x` that goes with it.
    #[inline]
    pub(super) fn cross(&mut self, disk: usize, exit: Exit) -> f64 {
        self.leave(disk);
        let (place, shift) = self.grid.neighbor(self.places[disk], exit.direction());
        self.places[disk] = place;
        self.enter(disk);
        shift
    }

    #[inline]
    pub(super) fn prefetch_place(&self, disk: usize) {
        prefetch(&self.places, disk);
    }

    /// Requests the nine cells around a disk from memory.
    #[inline]
    pub(super) fn prefetch_around(&self, disk: usize) {
        let (center, stride) = (self.grid.index(self.places[disk]), self.grid.stride());
        for middle in [center - stride, center, center + stride] {
            self.contents.prefetch(middle - 1);
            self.contents.prefetch(middle + 1);
        }
    }

    /// Requests from memory the cells that a disk leaves and enters by `exit`, and those that then come
    /// within reach.
    #[inline]
    pub(super) fn prefetch_ahead(&self, disk: usize, exit: Exit) {
        let (from, to) = (self.places[disk], self.next_place(disk, exit));
        self.grid.prefetch_region(to);
        let (first, step) = self.three_ahead(to, exit);
        for cell in [self.grid.index(from), self.grid.index(to), first, first + step, first + 2 * step] {
            self.contents.prefetch(cell);
        }
    }

    /// Returns the room that [`Self::around`] and [`Self::ahead`] need.
    #[inline]
    pub(super) fn room(&self) -> usize {
        self.contents.room(9)
    }

    /// Writes the disks in the nine cells around `disk` (itself included) to `found`. Returns their number.
    #[inline]
    pub(super) fn around(&self, disk: usize, found: &mut [u32]) -> usize {
        let center = self.grid.index(self.places[disk]);
        let stride = self.grid.stride();
        let mut count = 0;
        for first in [center - stride - 1, center - 1, center + stride - 1] {
            count = self.contents.gather(first, 1, found, count);
        }
        count
    }

    /// Writes the disks in the three cells that come within reach of `place`, after a disk came there by
    /// `exit`, to `found`. Returns their number.
    #[inline]
    pub(super) fn ahead(&self, place: Place, exit: Exit, found: &mut [u32]) -> usize {
        let (first, step) = self.three_ahead(place, exit);
        self.contents.gather(first, step, found, 0)
    }

    /// Returns the first of these three cells, and their distance in memory.
    #[inline]
    fn three_ahead(&self, place: Place, exit: Exit) -> (usize, usize) {
        let (right, up) = exit.direction();
        let stride = self.grid.stride();
        let middle =
            self.grid.index(place).wrapping_add_signed(right as isize * stride.cast_signed() + up as isize);
        let step = if up == 0 { 1 } else { stride };
        (middle - step, step)
    }

    /// Returns the place of a disk after it has left its cell by `exit`.
    #[inline]
    pub(super) fn next_place(&self, disk: usize, exit: Exit) -> Place {
        self.grid.neighbor(self.places[disk], exit.direction()).0
    }
}
