//! The mean flow on a grid, over the last oscillations.

use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;

pub(crate) const COLUMNS: usize = 10;
pub(crate) const ROWS: usize = 25;

/// Oscillations over which the flow is averaged: older ones count less and less.
const MEMORY: f64 = 100.0;

/// Sums over the disks seen in a cell, the older ones with less weight.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Cell {
    pub(crate) weight: f64,
    pub(crate) velocities: DVec2,
}

/// The flow. Unlike the library's `Fields` it forgets, so that it shows a roll that turns.
#[derive(Debug)]
pub(crate) struct Flow(Vec<Cell>);

impl Flow {
    pub(crate) fn new() -> Self {
        Self(vec![Cell::default(); COLUMNS * ROWS])
    }

    pub(crate) fn add(&mut self, snapshot: &Snapshot<'_>) {
        let fade = 1.0 - 1.0 / MEMORY;
        for cell in &mut self.0 {
            cell.weight *= fade;
            cell.velocities *= fade;
        }
        let domain = snapshot.domain();
        let corner = DVec2::new(domain.left, domain.bottom);
        let per_length =
            DVec2::new(COLUMNS as f64, ROWS as f64) / DVec2::new(domain.width(), domain.top - domain.bottom);
        for disk in snapshot.disks() {
            let place = (disk.position() - corner) * per_length;
            let (column, row) = (place.x.max(0.0) as usize, place.y.max(0.0) as usize);
            if let Some(cell) = self.0.get_mut(row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)) {
                cell.weight += 1.0;
                cell.velocities += disk.velocity();
            }
        }
    }

    /// Returns mean velocity and mean number of disks of each cell, row by row from below.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (DVec2, f64)> {
        self.0.iter().map(|cell| (cell.velocities / cell.weight.max(1e-9), cell.weight / MEMORY))
    }
}
