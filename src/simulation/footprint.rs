//! What a simulation takes: memory, cells, and the instructions that it runs with.

use super::Simulation;
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::instructions::Level;
use crate::scheduler::{EventScheduler, LARGE_SYSTEM};

/// What a simulation takes, as reports tell it.
#[derive(Debug, Clone)]
pub(crate) struct Footprint {
    /// Bytes of motions, forecasts and cells.
    pub(crate) bytes: usize,
    pub(crate) cells: usize,
    pub(crate) occupied_cells: usize,
    /// Number of disks in these cells.
    pub(crate) disks_in_cells: usize,
    pub(crate) scheduler: String,
    pub(crate) instructions: &'static str,
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Returns what the simulation takes at present.
    pub(crate) fn footprint(&self) -> Footprint {
        let [cells, occupied_cells, disks_in_cells] = self.cells.occupation();
        let bytes = self.bodies.bytes() + self.cells.bytes();
        let instructions = match self.instructions.level() {
            Level::Avx512 => "AVX-512",
            Level::Avx2 => "AVX2",
            Level::Built if cfg!(target_feature = "avx2") => "AVX2, as built",
            Level::Built => "as built",
        };
        Footprint {
            bytes,
            cells,
            occupied_cells,
            disks_in_cells,
            scheduler: self.scheduler_name(),
            instructions,
        }
    }

    /// Returns the name of the type of the scheduler, and what it has chosen.
    fn scheduler_name(&self) -> String {
        let whole = std::any::type_name::<S>();
        let name = whole.rsplit("::").next().unwrap_or(whole);
        match (name, self.len() < LARGE_SYSTEM) {
            ("BySize", true) => "TournamentTree, by size".into(),
            ("BySize", false) => "BucketQueue, by size".into(),
            _ => name.into(),
        }
    }
}
