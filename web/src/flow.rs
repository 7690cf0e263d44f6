//! The mean flow on a grid, with a memory that fades.

use granular_edmd::Disk;
use granular_edmd::glam::DVec2;

use crate::settings::{HEIGHT, WIDTH};

/// Number of columns and rows of square cells.
pub const COLUMNS: usize = 12;
pub const ROWS: usize = (COLUMNS as f64 * HEIGHT / WIDTH) as usize;

/// Share of the past that is kept from one oscillation to the next: the flow of the last two hundred.
const MEMORY: f32 = 0.995;

/// Number and momentum of the disks in each cell, over the recent past.
#[derive(Debug, Clone)]
pub struct Flow {
    cells: Vec<[f32; 3]>,
}

impl Default for Flow {
    fn default() -> Self {
        Self { cells: vec![[0.0; 3]; COLUMNS * ROWS] }
    }
}

impl Flow {
    /// Adds the disks at one time.
    pub fn add(&mut self, disks: &[Disk]) {
        for number in self.cells.as_flattened_mut() {
            *number *= MEMORY;
        }
        let side = WIDTH / COLUMNS as f64;
        for disk in disks {
            let place = (disk.position() / side).floor().max(DVec2::ZERO);
            let (column, row) = ((place.x as usize).min(COLUMNS - 1), (place.y as usize).min(ROWS - 1));
            let cell = &mut self.cells[row * COLUMNS + column];
            let velocity = disk.velocity();
            *cell = [cell[0] + 1.0, cell[1] + velocity.x as f32, cell[2] + velocity.y as f32];
        }
    }

    /// Returns count and momentum of each cell, row by row from below.
    #[must_use]
    pub fn cells(&self) -> &[f32] {
        self.cells.as_flattened()
    }
}
