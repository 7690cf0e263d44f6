//! Memory and cells of a simulation, and the instructions with which it runs.

use std::fmt;

use super::Simulation;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::scheduler::{EventScheduler, LARGE_SYSTEM};

/// The memory and the cells of a simulation, its scheduler, and the instructions that it has chosen.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Footprint {
    /// Bytes of memory for each disk: its motion, its next event, its share of the cells. A scheduler takes
    /// about 8 to 24 more.
    pub bytes_per_disk: f64,
    /// Number of neighbor cells of the smallest disks.
    pub cells: usize,
    /// Number of the smallest disks' cells that hold disks.
    pub occupied_cells: usize,
    /// Number of the smallest disks, which are in these cells.
    pub disks_in_cells: usize,
    /// Name of the scheduler.
    pub scheduler: String,
    /// Vector instructions that the engine has chosen.
    pub instructions: String,
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Returns the memory, cells and instructions that the simulation uses at present.
    pub fn footprint(&self) -> Footprint {
        let [cells, occupied_cells, disks_in_cells] = self.cells.occupation();
        let name = std::any::type_name::<S>().rsplit("::").next().unwrap_or_default();
        let scheduler = match (name, self.len() < LARGE_SYSTEM) {
            ("BySize", true) => "TournamentTree, by size",
            ("BySize", false) => "BucketQueue, by size",
            _ => name,
        };
        Footprint {
            bytes_per_disk: (self.bodies.bytes() + self.cells.bytes()) as f64 / self.len() as f64,
            cells,
            occupied_cells,
            disks_in_cells,
            scheduler: scheduler.into(),
            instructions: self.instructions.level().name().into(),
        }
    }
}

impl fmt::Display for Footprint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bytes_per_disk, cells, occupied_cells, scheduler, instructions, .. } = self;
        let crowd = self.disks_in_cells as f64 / *occupied_cells as f64;
        write!(formatter, "{bytes_per_disk:.0} bytes a disk; {occupied_cells} of {cells} cells ")?;
        write!(formatter, "occupied, by {crowd:.2} disks each; ")?;
        write!(formatter, "scheduler {scheduler}, instructions {instructions}")
    }
}
