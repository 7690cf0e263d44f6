//! The cells of a class of larger disks.
//!
//! A large disk has two places. Its *home* is as large as the disk, and other disks look for it there. Its
//! *cell* is much smaller, and the disk keeps its partners until it leaves the cell. With a home alone, the
//! disk would have to know all small disks that it can touch from anywhere in its home. `layers.rs` has a
//! picture.
//!
//! Homes consist of whole cells, a power of two along each side, so that a home follows from a cell by a
//! shift of bits. A disk that enters another cell usually stays in its home, and then the contents of homes
//! do not change.

use std::f64::consts::SQRT_2;

use glam::DVec2;

use super::contents::Contents;
use super::grid::{Grid, Place};
use super::layout::{CellSize, FREE_PATHS, LEAST_PITCH, Layout, SizeClass};
use super::reach::{Homes, Reach};
use crate::boundary::{Boundary, Domain, Region};

/// Largest number of homes per disk. More would cost time, since searches also visit empty homes.
const HOMES_PER_DISK: f64 = 4.0;

/// Number of homes that is allowed however few disks there are.
const SPARE_HOMES: f64 = 16.0;

/// Largest number of doublings by which cells are finer than homes.
const FINEST: u32 = 10;

/// Number of columns or rows at which cells are not made finer any more.
const MOST_LINES: u32 = 1 << 20;

/// The layout of the cells of a class, and the number of cells that make up a home.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct LayerLayout {
    /// The cells.
    pub(in crate::simulation) cells: Layout,
    /// Number of cells along the side of a home, as an exponent of two.
    doublings: u32,
}

impl LayerLayout {
    /// Returns the layout for one of several classes of disks; `None` if the domain is too small.
    pub(super) fn new(
        domain: &Domain,
        classes: &[SizeClass],
        class: usize,
        cell_size: CellSize,
        highest: f64,
    ) -> Option<Self> {
        let SizeClass { largest, count, .. } = classes[class];
        let most = HOMES_PER_DISK * count as f64 + SPARE_HOMES;
        let homes = Layout::new(domain, largest, cell_size, most, highest)?;
        let height = domain.height().min(highest - domain.bottom + largest);
        let density = |class: &SizeClass| class.count as f64 / (domain.width() * height);
        // The mean free path, up to a factor of order 1.
        let free_path =
            1.0 / classes.iter().map(|other| density(other) * (largest + other.largest)).sum::<f64>();
        // In a small cell, a disk has few partners, but it leaves the cell often. A cell of this class is no
        // smaller than a cell of the smallest class, since the disks of this class search the cells of the
        // smallest class.
        let suitable =
            (FREE_PATHS * cell_size.pitch() * free_path).max(cell_size.pitch() * classes[0].largest);
        let mut layout = Self { cells: homes, doublings: 0 };
        // A cell is a home halved several times, so only some sizes are possible. The size whose ratio to the
        // suitable size is nearest to 1 is taken.
        while layout.cells.pitch.max_element() > SQRT_2 * suitable && layout.can_be_finer() {
            layout = layout.finer();
        }
        Some(layout)
    }

    /// Returns whether the numbers of columns and rows may be doubled. They are limited, since each column
    /// and row has entries in tables.
    fn can_be_finer(&self) -> bool {
        self.doublings < FINEST && self.cells.columns.max(self.cells.rows) < MOST_LINES
    }

    /// Returns the width and height of a home.
    pub(super) fn home_size(&self) -> DVec2 {
        self.cells.pitch * f64::from(1_u32 << self.doublings)
    }

    /// Returns the same homes with twice as many columns and rows of cells.
    fn finer(self) -> Self {
        let Layout { columns, rows, pitch, cell_size } = self.cells;
        let cells = Layout { columns: 2 * columns, rows: 2 * rows, pitch: 0.5 * pitch, cell_size };
        Self { cells, doublings: self.doublings + 1 }
    }

    /// Returns the layout of the homes, if a whole number of these cells makes up a home.
    #[cfg(feature = "serde")]
    pub(in crate::simulation) fn homes(&self) -> Option<Layout> {
        let Self { cells: Layout { columns, rows, pitch, cell_size }, doublings } = *self;
        let side = 1_u32.checked_shl(doublings).filter(|_| doublings <= FINEST)?;
        let whole = columns % side == 0 && rows % side == 0;
        let pitch = pitch * f64::from(side);
        whole.then_some(Layout { columns: columns / side, rows: rows / side, pitch, cell_size })
    }

    /// Returns the same homes with cells at most this wide and high, if cells can be so fine.
    pub(super) fn narrower(self, widest: DVec2) -> Option<Self> {
        let mut layout = self;
        while layout.cells.pitch.cmpgt(widest).any() {
            if !layout.can_be_finer() {
                return None;
            }
            layout = layout.finer();
        }
        Some(layout)
    }
}

/// Returns the largest allowed width and height of a cell of a class; infinite in a direction that is not
/// periodic.
///
/// Two disks must meet at the image that is nearest now, wherever they move in their cells. Their distance is
/// at most the sum of their distance at a touch and the widths of both cells. While this sum is less than
/// half a period, no other image comes nearer.
pub(super) fn widest(domain: &Domain, grid: &Grid, smallest: f64, diameter: f64) -> DVec2 {
    // Both of two equal disks may be anywhere in their cells. Each cell may therefore be as wide as (p/2 −
    // d)/2, where p is the period and d the distance at a touch. For a small disk, the margin of its cell
    // counts, too, since the disk may be outside the cell by the margin.
    let half = 0.5 * domain.periods();
    let small_cell = grid.layout.pitch + 2.0 * grid.margin;
    let beside_equal = 0.5 * (half - LEAST_PITCH * diameter);
    let beside_small = half - 0.5 * LEAST_PITCH * (diameter + smallest) - small_cell;
    DVec2::select(half.cmpgt(DVec2::ZERO), beside_equal.min(beside_small), DVec2::INFINITY)
}

/// The disks of a class in their homes, and the homes in which these disks search for partners.
#[derive(Debug, Clone)]
pub(super) struct Layer {
    pub(super) layout: LayerLayout,
    pub(super) grid: Grid,
    pub(super) contents: Contents,
    /// The homes within reach of a disk of this class, one entry for each class, from the smallest to this
    /// one.
    pub(super) reaches: Vec<Reach>,
}

impl Layer {
    /// Creates a layer without disks. It knows no other homes until it is given its reaches.
    pub(super) fn empty(domain: &Domain, layout: LayerLayout) -> Self {
        let grid = Grid::without_margin(domain, layout.cells);
        let homes = (layout.cells.columns as usize * layout.cells.rows as usize) >> (2 * layout.doublings);
        Self { layout, grid, contents: Contents::empty(homes), reaches: Vec::new() }
    }

    /// Returns the number of homes.
    pub(super) fn len(&self) -> usize {
        (self.layout.cells.columns as usize * self.layout.cells.rows as usize) >> (2 * self.layout.doublings)
    }

    /// Returns the number of homes in a column.
    fn stride(&self) -> usize {
        self.layout.cells.rows as usize >> self.layout.doublings
    }

    pub(super) fn homes(&self) -> Homes<'_> {
        Homes { grid: &self.grid, cells: 1 << self.layout.doublings, stride: self.stride(), first: 0 }
    }

    pub(super) fn home(&self, place: Place) -> usize {
        let home = |cell: u32| ((cell - 1) >> self.layout.doublings) as usize;
        home(place.column) * self.stride() + home(place.row)
    }

    pub(super) fn mark_walls(&mut self, boundary: &dyn Boundary, largest_radius: f64) {
        let Layout { columns, rows, .. } = self.layout.cells;
        let side = 1 << self.layout.doublings;
        for column in (1..=columns).step_by(side) {
            for row in (1..=rows).step_by(side) {
                let last = Place { column: column + side as u32 - 1, row: row + side as u32 - 1 };
                let first = Place { column, row };
                let region = Region::new(self.grid.region(first).min, self.grid.region(last).max);
                if boundary.may_touch(&region, largest_radius) {
                    self.contents.mark_wall(self.home(first));
                }
            }
        }
    }

    pub(super) fn is_at_wall(&self, place: Place) -> bool {
        self.contents.is_at_wall(self.home(place))
    }

    /// Moves a disk from one cell to another.
    pub(super) fn cross(&mut self, disk: usize, from: Place, to: Place) {
        let (old, new) = (self.home(from), self.home(to));
        if old != new {
            self.contents.remove(old, disk);
            self.contents.push(new, disk);
        }
    }

    /// Returns the reaches to all smaller classes, and the reach to its own class.
    pub(super) fn reaches(&self) -> (&[Reach], Option<&Reach>) {
        match self.reaches.split_last() {
            Some((own, smaller)) => (smaller, Some(own)),
            None => (&[], None),
        }
    }
}
