//! The grid of neighbor cells: their sizes and their places.

use glam::DVec2;

use super::layout::{Layout, edges, margin, row_edges, widen};
use crate::boundary::{Domain, Region};
use crate::instructions::prefetch;

/// The columns and rows of cells. A ring of ghosts surrounds them, so that every cell has eight neighbors.
///
/// Cells of one column are next to each other in memory. The usual large system is a wide, low box, and in
/// this order places that are near in the box are also near in memory.
#[derive(Debug, Clone, Default)]
pub(in crate::simulation) struct Grid {
    pub(in crate::simulation) layout: Layout,
    /// Number of cells in a column, ring included.
    pub(super) stride: usize,
    /// Edges of the columns: `column_edges[c - 1]` and `column_edges[c]` bound column `c`. They are infinite
    /// at walls.
    column_edges: Vec<f64>,
    row_edges: Vec<f64>,
    /// Distance beyond the edges of a cell up to which the cell keeps its disks, so that fewer disks pass
    /// from one cell to another.
    pub(super) margin: DVec2,
    /// Horizontal and vertical period of the domain; 0 where it is not periodic.
    pub(in crate::simulation) periods: DVec2,
    /// True if one of the periods is not 0: a flag that is cheap to test.
    pub(super) is_periodic: bool,
}

/// The column and row of a cell, ring included. The first real column and row are 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Place {
    pub(in crate::simulation) column: u32,
    pub(in crate::simulation) row: u32,
}

impl Grid {
    /// Creates the grid of this layout.
    pub(in crate::simulation) fn new(domain: &Domain, layout: Layout, diameter: f64) -> Self {
        let margin = margin(domain, &layout, diameter);
        let mut column_edges = edges(domain.left, layout.pitch.x, layout.columns, !domain.periodic_sides);
        let mut row_edges = row_edges(domain, &layout);
        // There is no margin beyond periodic sides and ends, since disks stay in the domain.
        if domain.periodic_sides {
            widen(&mut column_edges, -margin.x);
        }
        if domain.periodic_ends {
            widen(&mut row_edges, -margin.y);
        }
        let (stride, periods) = (layout.rows as usize + 2, domain.periods());
        let is_periodic = periods != DVec2::ZERO;
        Self { layout, stride, column_edges, row_edges, margin, periods, is_periodic }
    }

    /// Creates the grid of this layout with cells that keep no disks beyond their edges.
    ///
    /// The layers of larger disks use such grids. Reaches are computed from the edges, so a margin would
    /// enlarge every reach.
    pub(in crate::simulation) fn without_margin(domain: &Domain, layout: Layout) -> Self {
        Self::new(domain, layout, f64::INFINITY)
    }

    /// Returns the edges of the columns and of the rows.
    pub(super) fn edges(&self) -> [Vec<f64>; 2] {
        let (mut columns, mut rows) = (self.column_edges.clone(), self.row_edges.clone());
        if self.periods.x > 0.0 {
            widen(&mut columns, self.margin.x);
        }
        if self.periods.y > 0.0 {
            widen(&mut rows, self.margin.y);
        }
        [columns, rows]
    }

    /// Returns the range of coordinates of the disks in each column, and in each row.
    pub(super) fn ranges(&self) -> [Vec<(f64, f64)>; 2] {
        let range = |edges: &[f64], margin: f64| {
            edges.windows(2).map(|pair| (pair[0] - margin, pair[1] + margin)).collect()
        };
        [range(&self.column_edges, self.margin.x), range(&self.row_edges, self.margin.y)]
    }

    /// Iterates over all real cells, without the ring of ghosts.
    pub(in crate::simulation) fn places(&self) -> impl Iterator<Item = Place> + use<> {
        let Layout { columns, rows, .. } = self.layout;
        (1..=columns).flat_map(move |column| (1..=rows).map(move |row| Place { column, row }))
    }

    /// Returns the number of cells, ring included.
    pub(in crate::simulation) fn len(&self) -> usize {
        self.stride * (self.layout.columns as usize + 2)
    }

    pub(in crate::simulation) fn place_of(&self, position: DVec2) -> Place {
        let DVec2 { x, y } = self.layout.pitch;
        Place { column: among(&self.column_edges, x, position.x), row: among(&self.row_edges, y, position.y) }
    }

    #[inline]
    pub(in crate::simulation) fn index(&self, place: Place) -> usize {
        place.column as usize * self.stride + place.row as usize
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

    /// Prefetches the column edges that [`Self::region`] needs, since wide systems have many columns.
    #[inline]
    pub(in crate::simulation) fn prefetch_region(&self, place: Place) {
        prefetch(&self.column_edges, place.column as usize);
    }

    /// Returns the ghosts that mirror a cell at periodic sides and ends: at the opposite side, at the
    /// opposite end, and at the opposite corner.
    #[inline]
    pub(in crate::simulation) fn mirrors(&self, place: Place) -> impl Iterator<Item = Place> + use<> {
        let Layout { columns, rows, .. } = self.layout;
        let column = opposite(place.column, columns).filter(|_| self.periods.x > 0.0);
        let row = opposite(place.row, rows).filter(|_| self.periods.y > 0.0);
        let beside = column.map(|column| Place { column, ..place });
        let above = row.map(|row| Place { row, ..place });
        let across = column.zip(row).map(|(column, row)| Place { column, row });
        [beside, above, across].into_iter().flatten()
    }

    /// Returns the neighbor at these numbers of columns to the right and rows up, and the numbers of periods
    /// crossed between the two cells.
    #[inline(always)]
    pub(in crate::simulation) fn neighbor(&self, place: Place, (right, up): (i32, i32)) -> (Place, [i32; 2]) {
        let mut to =
            Place { column: place.column.wrapping_add_signed(right), row: place.row.wrapping_add_signed(up) };
        let mut passed = [0; 2];
        if self.is_periodic {
            if self.periods.x > 0.0 {
                (to.column, passed[0]) = brought_back(to.column, self.layout.columns);
            }
            if self.periods.y > 0.0 {
                (to.row, passed[1]) = brought_back(to.row, self.layout.rows);
            }
        }
        (to, passed)
    }
}

/// Returns the column or row of the ring that mirrors `line`, if that is the first or the last of `count`.
#[inline]
fn opposite(line: u32, count: u32) -> Option<u32> {
    match line {
        1 => Some(count + 1),
        line if line == count => Some(0),
        _ => None,
    }
}

/// Replaces a column or row of the ring by the column or row that it mirrors. Returns the result, and the
/// number of periods passed.
#[inline]
fn brought_back(line: u32, count: u32) -> (u32, i32) {
    match line {
        0 => (count, -1),
        line if line > count => (1, 1),
        line => (line, 0),
    }
}

/// Returns the number of the cell along one side of the grid, from the edges of the cells and their pitch.
fn among(edges: &[f64], pitch: f64, position: f64) -> u32 {
    // Nearly all edges are a pitch apart. Rows high above an open container are not, and rounding may put a
    // position at an edge on its other side: there, the edges are searched.
    let inner = &edges[1..edges.len() - 1];
    let first = inner.first().copied().unwrap_or(f64::INFINITY);
    let guess = (((position - first) / pitch + 1.0) as usize).min(inner.len());
    let is_there = edges[guess] <= position && position < edges[guess + 1];
    1 + if is_there { guess } else { inner.partition_point(|&edge| edge <= position) } as u32
}
