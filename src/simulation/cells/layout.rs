//! The dimensions of a grid: sizes of cells, edges of columns and rows, and classes of disks of similar size.

use glam::DVec2;

use crate::boundary::Domain;

/// Number of cells of the smallest class that is allowed however few disks there are.
pub(super) const SPARE_SMALL_CELLS: f64 = 64.0;

/// Width of a cell in free paths, per unit of [`CellSize::pitch`].
pub(super) const FREE_PATHS: f64 = 3.0;

/// The size of the cells. Small cells hold fewer neighbors, and large cells are left less often.
///
/// The smallest cells are best where disks crowd, and the largest cells in a dilute gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) enum CellSize {
    Small,
    #[default]
    Medium,
    Large,
}

impl CellSize {
    /// Returns the size of a cell in diameters of the largest disk.
    pub(in crate::simulation) const fn pitch(self) -> f64 {
        match self {
            Self::Small => 1.08,
            Self::Medium => 1.4,
            Self::Large => 2.0,
        }
    }

    /// Returns the size that suits disks with these numbers of cell crossings and collisions in the same
    /// time.
    ///
    /// At each bound, runs with either size take equally long. The bounds are far enough apart that no run
    /// alternates between two sizes.
    pub(in crate::simulation) fn suitable(self, cell_crossings: u64, collisions: u64) -> Self {
        // Without collisions, this is NaN or infinite. NaN leaves the size unchanged, since all comparisons
        // fail, and infinity means the largest cells, as it should.
        let passed = cell_crossings as f64 / collisions as f64;
        match self {
            Self::Small if passed > 1.2 => Self::Medium,
            Self::Medium if passed > 1.45 => Self::Large,
            Self::Medium if passed < 0.45 => Self::Small,
            Self::Large if passed < 0.55 => Self::Medium,
            _ => self,
        }
    }
}

/// Disks of similar size.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct SizeClass {
    /// The largest diameter.
    pub(in crate::simulation) largest: f64,
    /// The smallest diameter.
    pub(in crate::simulation) smallest: f64,
    /// Number of disks.
    pub(in crate::simulation) count: usize,
}

impl SizeClass {
    /// Returns the class for which cells are made if there are no disks. Any cells for which the domain has
    /// room will do, even where it is periodic.
    pub(super) fn of_nobody(domain: &Domain) -> Self {
        let any = 0.125 * domain.width().min(domain.height());
        Self { largest: any, smallest: any, count: 0 }
    }

    /// Returns the union of this class and a class of larger disks.
    pub(super) fn with(&self, larger: &Self) -> Self {
        Self { largest: larger.largest, smallest: self.smallest, count: self.count + larger.count }
    }
}

/// Returns one class of all disks, or `None` if there are no disks.
pub(super) fn together(classes: &[SizeClass]) -> Option<SizeClass> {
    classes.iter().copied().reduce(|together, class| together.with(&class))
}

/// Returns the number of disks in all classes.
pub(super) fn count(classes: &[SizeClass]) -> usize {
    classes.iter().map(|class| class.count).sum()
}

/// Returns the class of disks of this diameter.
pub(super) fn class_of(classes: &[SizeClass], diameter: f64) -> u8 {
    classes.partition_point(|class| class.largest < diameter) as u8
}

/// Largest number of cells per disk. More cells would cost memory and save nothing.
pub(in crate::simulation) const CELLS_PER_DISK: f64 = 8.0;

/// Number of cells that is allowed however few disks there are.
pub(in crate::simulation) const SPARE_CELLS: f64 = 4096.0;

/// Smallest size of a cell in diameters. It is above 1 by more than rounding.
pub(super) const LEAST_PITCH: f64 = 1.000_001;

/// Fewest columns at periodic sides, and rows at periodic ends. With fewer, a disk could meet the same
/// neighbor on both sides.
pub(crate) const FEWEST: f64 = 4.0;

/// The dimensions of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Layout {
    pub(in crate::simulation) cell_size: CellSize,
    pub(in crate::simulation) columns: u32,
    pub(in crate::simulation) rows: u32,
    /// Size of a cell. In an open container, the rows become higher above some height.
    pub(in crate::simulation) pitch: DVec2,
}

impl Layout {
    /// Returns the layout of at most `most` cells for disks up to this diameter, or `None` if the domain is
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
        if domain.periodic_sides {
            columns = columns.max(FEWEST);
        }
        let mut rows = along(height, pitch).min((most / columns).max(1.0).floor());
        if domain.periodic_ends {
            rows = rows.max(FEWEST);
        }
        let is_wide =
            |is_periodic: bool, length: f64| !is_periodic || length >= FEWEST * LEAST_PITCH * diameter;
        if !(is_wide(domain.periodic_sides, width) && is_wide(domain.periodic_ends, height)) {
            return None;
        }
        let valid = width > 0.0 && height > 0.0 && width.is_finite() && height.is_finite();
        let pitch = DVec2::new(width / columns, height / rows);
        valid.then_some(Self { cell_size, columns: columns as u32, rows: rows as u32, pitch })
    }
}

/// Returns the height of that part of an open container's grid in which all rows are equally high.
fn open_height(domain: &Domain, highest: f64, diameter: f64) -> f64 {
    2.0 * (highest - domain.bottom).max(0.0) + 64.0 * diameter
}

/// Returns the largest distance beyond the edges of a cell up to which the cell can keep its disks, so that
/// these disks still collide only with disks in the cells around it.
///
/// A disk that turns back soon, or moves back and forth at an edge, then stays in its cell.
pub(super) fn margin(domain: &Domain, layout: &Layout, diameter: f64) -> DVec2 {
    let mut margin = (0.5 * (layout.pitch - LEAST_PITCH * diameter)).max(DVec2::ZERO);
    // With so few columns or rows, a margin would let neighbors be more than half a period apart.
    if domain.periodic_sides && layout.columns < 6 {
        margin.x = 0.0;
    }
    if domain.periodic_ends && layout.rows < 6 {
        margin.y = 0.0;
    }
    margin
}

/// Moves the outermost edges outward by a margin, or inward if it is negative.
pub(super) fn widen(edges: &mut [f64], margin: f64) {
    // Cells keep their disks up to a margin beyond their edges (`Grid::region`). At periodic sides, the
    // margin would take disks out of the domain. `Grid::new` therefore moves the outermost edges inward by
    // the margin, so that the outermost cells, margin included, end at the side of the domain, and
    // `Grid::edges` moves them back.
    if let [first, .., last] = edges {
        *first -= margin;
        *last += margin;
    }
}

/// Returns the edges of `count` intervals of equal width. At walls, the first and the last edge are infinite.
pub(super) fn edges(start: f64, pitch: f64, count: u32, walls: bool) -> Vec<f64> {
    let mut edges: Vec<f64> = (0..=count).map(|k| start + f64::from(k) * pitch).collect();
    if walls {
        edges[0] = f64::NEG_INFINITY;
        edges[count as usize] = f64::INFINITY;
    }
    edges
}

/// Returns the edges of the rows. In an open container, the rows in the upper half become higher in
/// proportion to their height above the floor, so a disk that flies high does not share its cell with all
/// other disks at great heights.
pub(super) fn row_edges(domain: &Domain, layout: &Layout) -> Vec<f64> {
    /// Ratio of heights from row to row. A few more rows then reach exponentially higher.
    const GROWTH: f64 = 1.1;
    let mut edges = edges(domain.bottom, layout.pitch.y, layout.rows, !domain.periodic_ends);
    if domain.top.is_infinite() {
        let even = (layout.rows as usize / 2).max(1);
        for row in even + 1..edges.len() - 1 {
            let height = edges[row - 1] - domain.bottom.min(edges[row - 1]);
            edges[row] = edges[row - 1] + (height * (GROWTH - 1.0)).max(layout.pitch.y);
        }
    }
    edges
}
