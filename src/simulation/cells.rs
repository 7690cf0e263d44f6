//! Neighbour cells: a disk can only collide with disks in its own cell and the eight around it.

use glam::DVec2;

use super::event::Exit;
use crate::boundary::{Boundary, Domain, Region};

/// Cells per disk at most; more would cost memory and save nothing.
const CELLS_PER_DISK: f64 = 8.0;

/// Cells that are always allowed.
const SPARE_CELLS: f64 = 4096.0;

/// Least size of a cell in diameters: above 1 by more than rounding.
const LEAST_PITCH: f64 = 1.000_001;

/// Disks that a cell has room for at first: no more equal disks have their centres in one cell of the usual size.
const BLOCK: usize = 4;

/// A grid of cells and, around it, a ring of ghost cells, so that every cell has eight neighbours in memory order.
///
/// Ghosts are empty beyond walls; at periodic sides they mirror the cells of the opposite side. Every cell has the same
/// number of slots, filled from the first on: cells are collected by copying all of their slots and going on behind the
/// last that is taken, without a branch on how many those are.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    slots: Vec<[u32; BLOCK]>,
    /// Blocks of slots of a cell.
    blocks: usize,
    /// Slots taken in each cell.
    counts: Vec<u32>,
    /// Column and row of each disk.
    places: Vec<Place>,
    /// Cells in a row of the grid, ring included.
    stride: u32,
    /// `column_edges[c - 1]` and `column_edges[c]` bound column `c`; infinite at walls.
    column_edges: Vec<f64>,
    row_edges: Vec<f64>,
    /// Whether disks in a cell can touch a wall.
    at_wall: Vec<bool>,
    /// Width of the domain if its sides are periodic, else 0.
    period: f64,
    layout: Layout,
}

/// The grid and where the disks are in it: what a checkpoint keeps.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct GridState {
    layout: Layout,
    places: Vec<Place>,
}

#[cfg(feature = "serde")]
impl GridState {
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether the grid has a sensible size, and every disk is in it.
    pub(super) fn is_valid(&self) -> bool {
        let Layout { columns, rows, pitch } = self.layout;
        let most = 2.0 * (CELLS_PER_DISK * self.places.len() as f64 + SPARE_CELLS);
        let sized = columns > 0 && rows > 0 && f64::from(columns) * f64::from(rows) <= most;
        let inside = |place: &Place| (1..=columns).contains(&place.column) && (1..=rows).contains(&place.row);
        sized && pitch.is_finite() && self.places.iter().all(inside)
    }
}

/// A cell by its column and row, ring included: the first real ones are 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Place {
    pub(super) column: u32,
    pub(super) row: u32,
}

/// The size of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Layout {
    columns: u32,
    rows: u32,
    /// Size of a cell; in an open container the rows grow from some height on.
    pitch: DVec2,
}

impl Layout {
    /// The grid for `count` disks of at most this diameter; `None` if the domain is too small.
    fn new(domain: &Domain, diameter: f64, pitch: f64, count: usize, highest: f64) -> Option<Self> {
        let width = domain.width();
        let height = if domain.top.is_finite() {
            domain.height()
        } else {
            2.0 * open_height(domain, highest, diameter)
        };
        let most = CELLS_PER_DISK * count as f64 + SPARE_CELLS;
        let pitch = (pitch * diameter).max((width * height / most).sqrt());
        let along = |length: f64, pitch: f64| (length / pitch).floor().max(1.0);
        let mut columns = along(width, pitch).min(most.floor());
        if domain.periodic && columns < 4.0 {
            // With fewer columns a disk could meet a neighbour on both sides.
            columns = 4.0;
            if width < columns * LEAST_PITCH * diameter {
                return None;
            }
        }
        let rows = along(height, pitch).min((most / columns).max(1.0).floor());
        let valid = width > 0.0 && height > 0.0 && width.is_finite() && height.is_finite();
        let pitch = DVec2::new(width / columns, height / rows);
        valid.then_some(Self { columns: columns as u32, rows: rows as u32, pitch })
    }
}

/// How high the even part of the grid of an open container reaches.
fn open_height(domain: &Domain, highest: f64, diameter: f64) -> f64 {
    2.0 * (highest - domain.bottom).max(0.0) + 64.0 * diameter
}

impl Cells {
    /// Cells for disks at these positions; `None` if the domain is too small for them.
    ///
    /// `pitch` is the size of a cell in diameters of the largest disk.
    pub(super) fn new<B: Boundary + ?Sized>(
        boundary: &B,
        diameter: f64,
        pitch: f64,
        positions: &[DVec2],
    ) -> Option<Self> {
        let domain = boundary.domain();
        let highest = positions.iter().map(|p| p.y).fold(domain.bottom, f64::max);
        let layout = Layout::new(&domain, diameter, pitch.max(LEAST_PITCH), positions.len(), highest)?;
        let mut cells = Self::empty(boundary, 0.5 * diameter, layout);
        for &position in positions {
            let place = cells.place_of(position);
            cells.add(place);
        }
        Some(cells)
    }

    /// The same grid as one that was saved, with the disks where they were.
    #[cfg(feature = "serde")]
    pub(super) fn restored<B: Boundary + ?Sized>(
        boundary: &B,
        largest_radius: f64,
        saved: &GridState,
    ) -> Self {
        let mut cells = Self::empty(boundary, largest_radius, saved.layout);
        for &place in &saved.places {
            cells.add(place);
        }
        cells
    }

    #[cfg(feature = "serde")]
    pub(super) fn state(&self) -> GridState {
        GridState { layout: self.layout, places: self.places.clone() }
    }

    fn empty<B: Boundary + ?Sized>(boundary: &B, largest_radius: f64, layout: Layout) -> Self {
        let domain = boundary.domain();
        let stride = layout.columns + 2;
        let count = stride as usize * (layout.rows as usize + 2);
        let mut cells = Self {
            slots: vec![[0; BLOCK]; count],
            blocks: 1,
            counts: vec![0; count],
            places: Vec::new(),
            stride,
            column_edges: edges(domain.left, layout.pitch.x, layout.columns, !domain.periodic),
            row_edges: row_edges(&domain, &layout),
            at_wall: vec![false; count],
            period: if domain.periodic { domain.width() } else { 0.0 },
            layout,
        };
        cells.mark_walls(boundary, largest_radius);
        cells
    }

    fn mark_walls<B: Boundary + ?Sized>(&mut self, boundary: &B, largest_radius: f64) {
        for row in 1..=self.layout.rows {
            for column in 1..=self.layout.columns {
                let place = Place { column, row };
                let cell = self.index(place);
                self.at_wall[cell] = boundary.may_touch(&self.region(place), largest_radius);
            }
        }
    }

    fn place_of(&self, position: DVec2) -> Place {
        let along = |edges: &[f64], x: f64| {
            let inner = &edges[1..edges.len() - 1];
            1 + inner.partition_point(|&edge| edge <= x) as u32
        };
        Place { column: along(&self.column_edges, position.x), row: along(&self.row_edges, position.y) }
    }

    #[inline]
    fn index(&self, place: Place) -> usize {
        place.row as usize * self.stride as usize + place.column as usize
    }

    #[inline]
    pub(super) fn place(&self, disk: usize) -> Place {
        self.places[disk]
    }

    /// Whether this disk can touch a wall where it is.
    #[inline]
    pub(super) fn is_at_wall(&self, disk: usize) -> bool {
        self.at_wall[self.index(self.places[disk])]
    }

    /// The rectangle of a cell; infinite beyond the walls.
    #[inline]
    pub(super) fn region(&self, place: Place) -> Region {
        let (column, row) = (place.column as usize, place.row as usize);
        Region {
            min: DVec2::new(self.column_edges[column - 1], self.row_edges[row - 1]),
            max: DVec2::new(self.column_edges[column], self.row_edges[row]),
        }
    }

    /// The width of the domain if its sides are periodic, else 0.
    #[inline]
    pub(super) fn period(&self) -> f64 {
        self.period
    }

    /// The next disk is in this cell.
    fn add(&mut self, place: Place) {
        self.places.push(place);
        self.enter(self.places.len() - 1);
    }

    /// The ghost that mirrors a cell at a periodic side, or the cell itself where there is none.
    #[inline]
    fn mirror(&self, place: Place) -> Place {
        let Layout { columns, .. } = self.layout;
        match place.column {
            1 if self.period > 0.0 => Place { column: columns + 1, ..place },
            column if column == columns && self.period > 0.0 => Place { column: 0, ..place },
            _ => place,
        }
    }

    /// Writes a disk into its cell and the ghost of that.
    #[inline]
    fn enter(&mut self, disk: usize) {
        let place = self.places[disk];
        let cell = self.index(place);
        if self.counts[cell] as usize == self.blocks * BLOCK {
            self.grow();
        }
        self.push(cell, disk);
        let mirror = self.index(self.mirror(place));
        if mirror != cell {
            self.push(mirror, disk);
        }
    }

    /// The slots of a cell.
    #[inline]
    fn cell(&mut self, cell: usize) -> &mut [u32] {
        let start = cell * self.blocks;
        self.slots[start..start + self.blocks].as_flattened_mut()
    }

    #[inline]
    fn push(&mut self, cell: usize, disk: usize) {
        let count = self.counts[cell];
        self.cell(cell)[count as usize] = disk as u32;
        self.counts[cell] = count + 1;
    }

    /// Takes a disk out of its cell and the ghost of that.
    #[inline]
    fn leave(&mut self, disk: usize) {
        let place = self.places[disk];
        let cell = self.index(place);
        self.remove(cell, disk);
        let mirror = self.index(self.mirror(place));
        if mirror != cell {
            self.remove(mirror, disk);
        }
    }

    /// The last disk of the cell takes the place of the one that leaves.
    #[inline]
    fn remove(&mut self, cell: usize, disk: usize) {
        self.counts[cell] -= 1;
        let count = self.counts[cell] as usize;
        let slots = self.cell(cell);
        let last = slots[count];
        for slot in slots {
            *slot = if *slot == disk as u32 { last } else { *slot };
        }
    }

    /// Twice as many slots in every cell.
    #[cold]
    fn grow(&mut self) {
        let mut slots = vec![[0; BLOCK]; 2 * self.slots.len()];
        for (old, new) in self.slots.chunks_exact(self.blocks).zip(slots.chunks_exact_mut(2 * self.blocks)) {
            new[..self.blocks].copy_from_slice(old);
        }
        self.slots = slots;
        self.blocks *= 2;
    }

    /// Takes a disk to the cell that it leaves for; returns what that adds to its `x`.
    #[inline]
    pub(super) fn cross(&mut self, disk: usize, exit: Exit) -> f64 {
        self.leave(disk);
        let columns = self.layout.columns;
        let (right, up) = exit.direction();
        let place = &mut self.places[disk];
        place.column = place.column.wrapping_add_signed(right);
        place.row = place.row.wrapping_add_signed(up);
        let mut shift = 0.0;
        if place.column == 0 {
            (place.column, shift) = (columns, self.period);
        } else if place.column > columns {
            (place.column, shift) = (1, -self.period);
        }
        self.enter(disk);
        shift
    }

    /// Room that [`Self::around`] and [`Self::ahead`] need.
    #[inline]
    pub(super) fn room(&self) -> usize {
        self.places.len() + self.blocks * BLOCK
    }

    /// Writes the disks in the nine cells around `disk` (itself included) to `found`; returns how many.
    #[inline]
    pub(super) fn around(&self, disk: usize, found: &mut [u32]) -> usize {
        let centre = self.index(self.places[disk]);
        let stride = self.stride as usize;
        let mut count = 0;
        for first in [centre - stride - 1, centre - 1, centre + stride - 1] {
            count = self.gather(first, 1, found, count);
        }
        count
    }

    /// The same for the three cells that come within reach after `disk` has left its cell by `exit`.
    #[inline]
    pub(super) fn ahead(&self, disk: usize, exit: Exit, found: &mut [u32]) -> usize {
        let (right, up) = exit.direction();
        let stride = self.stride as usize;
        let middle = self
            .index(self.places[disk])
            .wrapping_add_signed(right as isize + up as isize * stride.cast_signed());
        let step = if up == 0 { stride } else { 1 };
        self.gather(middle - step, step, found, 0)
    }

    /// Appends the disks of three cells.
    #[inline(always)]
    fn gather(&self, first: usize, step: usize, found: &mut [u32], mut count: usize) -> usize {
        for cell in [first, first + step, first + 2 * step] {
            if self.blocks == 1 {
                // A copy of known length is one load and one store.
                found[count..count + BLOCK].copy_from_slice(&self.slots[cell]);
            } else {
                let slots = self.slots[cell * self.blocks..(cell + 1) * self.blocks].as_flattened();
                found[count..count + slots.len()].copy_from_slice(slots);
            }
            count += self.counts[cell] as usize;
        }
        count
    }
}

fn edges(start: f64, pitch: f64, count: u32, walls: bool) -> Vec<f64> {
    let mut edges: Vec<f64> = (0..=count).map(|k| start + f64::from(k) * pitch).collect();
    if walls {
        edges[0] = f64::NEG_INFINITY;
        edges[count as usize] = f64::INFINITY;
    }
    edges
}

/// Edges of the rows. In an open container the upper half of them grows in proportion to the height: however high a disk
/// flies, it does not share its cell with all others that are high.
fn row_edges(domain: &Domain, layout: &Layout) -> Vec<f64> {
    const GROWTH: f64 = 1.1;
    let mut edges = edges(domain.bottom, layout.pitch.y, layout.rows, true);
    if domain.top.is_infinite() {
        let even = (layout.rows as usize / 2).max(1);
        for row in even + 1..edges.len() - 1 {
            let height = edges[row - 1] - domain.bottom.min(edges[row - 1]);
            edges[row] = edges[row - 1] + (height * (GROWTH - 1.0)).max(layout.pitch.y);
        }
    }
    edges
}
