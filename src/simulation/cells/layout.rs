//! The dimensions of a grid of cells.

use glam::DVec2;

use super::cell_size::CellSize;
use crate::boundary::Domain;

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
