//! The grid of neighbor cells: their sizes and their places.

use glam::DVec2;

use crate::boundary::{Domain, Region};
use crate::prefetch::prefetch;

use super::cell_size::CellSize;

/// Largest number of cells per disk. More cells would cost memory and save nothing.
pub(in crate::simulation) const CELLS_PER_DISK: f64 = 8.0;

/// Number of cells that is always allowed.
pub(in crate::simulation) const SPARE_CELLS: f64 = 4096.0;

/// Smallest size of a cell in diameters. It is above 1 by more than rounding.
pub(super) const LEAST_PITCH: f64 = 1.000_001;

/// The columns and rows of cells. A ring of ghosts surrounds them, so that every cell has eight neighbors.
///
/// Cells of one column are next to each other in memory. The usual large system is a wide, low box, in which
/// near places are then near in memory, too.
#[derive(Debug, Clone)]
pub(in crate::simulation) struct Grid {
    pub(in crate::simulation) layout: Layout,
    /// Number of cells in a column, ring included.
    stride: u32,
    /// Edges of the columns: `column_edges[c - 1]` and `column_edges[c]` bound column `c`. They are infinite
    /// at walls.
    column_edges: Vec<f64>,
    row_edges: Vec<f64>,
    /// Distance beyond its edges up to which a cell keeps its disks, so that fewer of them pass from one cell
    /// to another.
    margin: DVec2,
    /// Width of the domain if its sides are periodic, else 0.
    period: f64,
}

/// The column and row of a cell, ring included. The first real column and row are 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Place {
    pub(in crate::simulation) column: u32,
    pub(in crate::simulation) row: u32,
}

/// The dimensions of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Layout {
    pub(in crate::simulation) cell_size: CellSize,
    pub(in crate::simulation) columns: u32,
    pub(in crate::simulation) rows: u32,
    /// Size of a cell. In an open container, the rows grow from some height on.
    pub(in crate::simulation) pitch: DVec2,
}

impl Layout {
    /// Returns the layout of at most so many cells for disks of at most this diameter, or `None` if the domain is
    /// too small.
    pub(in crate::simulation) fn new(
        domain: &Domain,
        diameter: f64,
        cell_size: CellSize,
        most: f64,
        highest: f64,
    ) -> Option<Self> {
        let width = domain.width();
        let height = if domain.top.is_finite() {
            domain.height()
        } else {
            2.0 * open_height(domain, highest, diameter)
        };
        let pitch = (cell_size.pitch() * diameter).max((width * height / most).sqrt());
        let along = |length: f64, pitch: f64| (length / pitch).floor().max(1.0);
        let mut columns = along(width, pitch).min(most.floor());
        if domain.periodic && columns < 4.0 {
            // With fewer columns, a disk could meet a neighbor on both sides.
            columns = 4.0;
            if width < columns * LEAST_PITCH * diameter {
                return None;
            }
        }
        let rows = along(height, pitch).min((most / columns).max(1.0).floor());
        let valid = width > 0.0 && height > 0.0 && width.is_finite() && height.is_finite();
        let pitch = DVec2::new(width / columns, height / rows);
        valid.then_some(Self { cell_size, columns: columns as u32, rows: rows as u32, pitch })
    }
}

/// Returns the height of the even part of the grid of an open container.
fn open_height(domain: &Domain, highest: f64, diameter: f64) -> f64 {
    2.0 * (highest - domain.bottom).max(0.0) + 64.0 * diameter
}

impl Grid {
    /// Creates the grid of this layout.
    pub(in crate::simulation) fn new(domain: &Domain, layout: Layout, diameter: f64) -> Self {
        let margin = margin(domain, &layout, diameter);
        let mut column_edges = edges(domain.left, layout.pitch.x, layout.columns, !domain.periodic);
        if domain.periodic {
            // There is no margin beyond the periodic sides, since disks stay in the domain.
            column_edges[0] += margin.x;
            column_edges[layout.columns as usize] -= margin.x;
        }
        Self {
            stride: layout.rows + 2,
            column_edges,
            row_edges: row_edges(domain, &layout),
            margin,
            period: if domain.periodic { domain.width() } else { 0.0 },
            layout,
        }
    }

    /// Creates the grid of this layout with cells that keep no disks beyond their edges.
    pub(in crate::simulation) fn without_margin(domain: &Domain, layout: Layout) -> Self {
        Self::new(domain, layout, f64::INFINITY)
    }

    /// Returns the edges of the columns and of the rows.
    pub(super) fn edges(&self) -> [Vec<f64>; 2] {
        let mut columns = self.column_edges.clone();
        if self.period > 0.0 {
            columns[0] -= self.margin.x;
            columns[self.layout.columns as usize] += self.margin.x;
        }
        [columns, self.row_edges.clone()]
    }

    /// Returns between which numbers the disks of each column, and of each row, are.
    pub(super) fn ranges(&self) -> [Vec<(f64, f64)>; 2] {
        let range = |edges: &[f64], margin: f64| {
            edges.windows(2).map(|pair| (pair[0] - margin, pair[1] + margin)).collect()
        };
        [range(&self.column_edges, self.margin.x), range(&self.row_edges, self.margin.y)]
    }

    /// Returns the distance beyond its edges up to which a cell keeps its disks.
    pub(super) fn margin(&self) -> DVec2 {
        self.margin
    }

    /// Iterates over all cells but those of the ring.
    pub(in crate::simulation) fn places(&self) -> impl Iterator<Item = Place> + use<> {
        let Layout { columns, rows, .. } = self.layout;
        (1..=columns).flat_map(move |column| (1..=rows).map(move |row| Place { column, row }))
    }

    /// Returns the number of cells, ring included.
    pub(in crate::simulation) fn len(&self) -> usize {
        self.stride() * (self.layout.columns as usize + 2)
    }

    pub(in crate::simulation) fn cell_size(&self) -> CellSize {
        self.layout.cell_size
    }

    /// Returns the number of cells in a column, ring included. Neighbors in a row are so far apart in memory.
    #[inline]
    pub(in crate::simulation) fn stride(&self) -> usize {
        self.stride as usize
    }

    pub(in crate::simulation) fn place_of(&self, position: DVec2) -> Place {
        let along = |edges: &[f64], x: f64| {
            let inner = &edges[1..edges.len() - 1];
            1 + inner.partition_point(|&edge| edge <= x) as u32
        };
        Place { column: along(&self.column_edges, position.x), row: along(&self.row_edges, position.y) }
    }

    #[inline]
    pub(in crate::simulation) fn index(&self, place: Place) -> usize {
        place.column as usize * self.stride as usize + place.row as usize
    }

    /// Returns the rectangle in which a cell keeps its disks. It extends to infinity beyond the walls.
    #[inline(always)]
    pub(in crate::simulation) fn region(&self, place: Place) -> Region {
        let (column, row) = (place.column as usize, place.row as usize);
        Region {
            min: DVec2::new(self.column_edges[column - 1], self.row_edges[row - 1]) - self.margin,
            max: DVec2::new(self.column_edges[column], self.row_edges[row]) + self.margin,
        }
    }

    /// Requests from memory what [`Self::region`] needs, since wide systems have many columns.
    #[inline]
    pub(in crate::simulation) fn prefetch_region(&self, place: Place) {
        prefetch(&self.column_edges, place.column as usize);
    }

    /// Returns the width of the domain if its sides are periodic, and 0 otherwise.
    #[inline]
    pub(in crate::simulation) fn period(&self) -> f64 {
        self.period
    }

    /// Returns the ghost that mirrors a cell at a periodic side, if the cell has one.
    #[inline]
    pub(in crate::simulation) fn mirror(&self, place: Place) -> Option<Place> {
        let columns = self.layout.columns;
        match place.column {
            _ if self.period == 0.0 => None,
            1 => Some(Place { column: columns + 1, ..place }),
            column if column == columns => Some(Place { column: 0, ..place }),
            _ => None,
        }
    }

    /// Returns the neighbor so many columns to the right and rows up, and the change of `x` on the way there.
    #[inline]
    pub(in crate::simulation) fn neighbor(&self, place: Place, (right, up): (i32, i32)) -> (Place, f64) {
        let mut to =
            Place { column: place.column.wrapping_add_signed(right), row: place.row.wrapping_add_signed(up) };
        let mut shift = 0.0;
        if self.period > 0.0 {
            if to.column == 0 {
                (to.column, shift) = (self.layout.columns, self.period);
            } else if to.column > self.layout.columns {
                (to.column, shift) = (1, -self.period);
            }
        }
        (to, shift)
    }
}

/// Returns the distance beyond its edges up to which a cell can keep its disks, if they shall collide only
/// with those in the cells around it.
///
/// A disk that turns back soon, or moves to and fro at an edge, then stays in its cell.
fn margin(domain: &Domain, layout: &Layout, diameter: f64) -> DVec2 {
    let mut margin = (0.5 * (layout.pitch - LEAST_PITCH * diameter)).max(DVec2::ZERO);
    if domain.periodic && layout.columns < 6 {
        // Neighbors could be more than half a period apart.
        margin.x = 0.0;
    }
    margin
}

fn edges(start: f64, pitch: f64, count: u32, walls: bool) -> Vec<f64> {
    let mut edges: Vec<f64> = (0..=count).map(|k| start + f64::from(k) * pitch).collect();
    if walls {
        edges[0] = f64::NEG_INFINITY;
        edges[count as usize] = f64::INFINITY;
    }
    edges
}

/// Returns the edges of the rows. In an open container, the upper half of the rows grows in proportion to the
/// height. A disk that flies high then does not share its cell with all others that are high.
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
