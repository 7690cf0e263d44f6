//! The mean flow on a grid.

use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;

/// Largest number of rows. Nothing is kept beyond it, since a disk may fly high without a lid.
const MOST_ROWS: usize = 2000;

/// The mean velocity of the disks on a grid of square cells. Each disk counts once per snapshot.
#[derive(Debug, Clone)]
pub(crate) struct Flow {
    domain: Domain,
    columns: usize,
    cells: Vec<Cell>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    count: u64,
    velocities: DVec2,
}

/// The mean velocity at the center of a cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arrow {
    pub(crate) position: DVec2,
    pub(crate) velocity: DVec2,
}

impl Flow {
    /// Creates an empty flow on a grid of this many columns.
    pub(crate) fn new(domain: Domain, columns: usize) -> Self {
        Self { domain, columns: columns.max(1), cells: Vec::new() }
    }

    /// Returns the length of the side of a cell.
    pub(crate) fn pitch(&self) -> f64 {
        self.domain.width() / self.columns as f64
    }

    /// Counts the disks of a snapshot.
    pub(crate) fn add(&mut self, snapshot: &Snapshot<'_>) {
        for disk in snapshot.disks() {
            if let Some(index) = self.index(disk.position()) {
                if index >= self.cells.len() {
                    self.cells.resize(index + 1, Cell::default());
                }
                self.cells[index].count += 1;
                self.cells[index].velocities += disk.velocity();
            }
        }
    }

    fn index(&self, position: DVec2) -> Option<usize> {
        let offset = (position - DVec2::new(self.domain.left, self.domain.bottom)) / self.pitch();
        let (column, row) = (offset.x.max(0.0) as usize, offset.y.max(0.0) as usize);
        (row < MOST_ROWS).then(|| row * self.columns + column.min(self.columns - 1))
    }

    /// Returns the arrows of the cells that hold at least this share of what the fullest cell holds.
    pub(crate) fn arrows(&self, share: f64) -> Vec<Arrow> {
        let most = self.cells.iter().map(|cell| cell.count).max().unwrap_or(0);
        let enough = (share * most as f64).max(1.0);
        let seen = self.cells.iter().enumerate().filter(|(_, cell)| cell.count as f64 >= enough);
        seen.map(|(index, cell)| Arrow {
            position: self.center(index),
            velocity: cell.velocities / cell.count as f64,
        })
        .collect()
    }

    fn center(&self, index: usize) -> DVec2 {
        let (row, column) = (index / self.columns, index % self.columns);
        let corner = DVec2::new(self.domain.left, self.domain.bottom);
        corner + self.pitch() * DVec2::new(column as f64 + 0.5, row as f64 + 0.5)
    }
}
