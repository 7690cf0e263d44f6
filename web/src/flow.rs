//! The mean flow on a grid, over the last oscillations.

use granular_edmd::Disk;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;

use crate::scene::Scene;

/// Cells side by side.
pub(crate) const COLUMNS: usize = 10;

/// Oscillations over which the flow is averaged: older ones count less and less.
const MEMORY: f64 = 100.0;

/// Sums over the disks seen in a cell, the older ones with less weight.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Cell {
    pub(crate) weight: f64,
    pub(crate) velocities: DVec2,
}

/// The flow: how far disks come in an oscillation, whatever they do within it. Unlike the library's `Fields`
/// it forgets, so that it shows a roll that turns.
#[derive(Debug)]
pub(crate) struct Flow {
    cells: Vec<Cell>,
    /// Cells on a unit of length.
    per_length: f64,
    /// Time and places an oscillation ago.
    before: (f64, Vec<DVec2>),
}

impl Flow {
    /// Lays square cells over the box.
    pub(crate) fn new(scene: Scene) -> Self {
        let (width, height) = scene.size();
        let per_length = COLUMNS as f64 / width;
        let rows = (height * per_length).ceil() as usize;
        Self { cells: vec![Cell::default(); COLUMNS * rows], per_length, before: (0.0, Vec::new()) }
    }

    pub(crate) fn add(&mut self, snapshot: &Snapshot<'_>) {
        let fade = 1.0 - 1.0 / MEMORY;
        for cell in &mut self.cells {
            cell.weight *= fade;
            cell.velocities *= fade;
        }
        let places: Vec<DVec2> = snapshot.disks().iter().map(Disk::position).collect();
        let elapsed = snapshot.time() - self.before.0;
        for (place, before) in places.iter().zip(&self.before.1) {
            let cell = 0.5 * (*place + *before) * self.per_length;
            let (column, row) = (cell.x.max(0.0) as usize, cell.y.max(0.0) as usize);
            if let Some(cell) = self.cells.get_mut(row * COLUMNS + column.min(COLUMNS - 1)) {
                cell.weight += 1.0;
                cell.velocities += (*place - *before) / elapsed;
            }
        }
        self.before = (snapshot.time(), places);
    }

    /// Returns mean velocity and mean number of disks of each cell, row by row from below.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (DVec2, f64)> {
        self.cells.iter().map(|cell| (cell.velocities / cell.weight.max(1e-9), cell.weight / MEMORY))
    }
}
