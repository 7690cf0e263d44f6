//! Energy change per collision: the paper's central quantity, measured.

use super::{Collision, Observer, Partner, RunningMean};

/// Mean change of kinetic energy per collision, `$\langle dE\rangle$`, with its standard error: for disk–disk
/// collisions and for each wall.
///
/// At a wall that moves, or is thermal, it is the energy that the disk gains or loses, the work of the wall included.
///
/// ```
/// use granular_edmd::observable::EnergyChange;
/// let energy_change = EnergyChange::default();
/// assert_eq!(energy_change.disks().count(), 0);
/// assert_eq!(energy_change.wall(0).count(), 0);
/// ```
#[derive(Debug, Clone, Default)]
pub struct EnergyChange {
    disks: RunningMean,
    walls: Vec<RunningMean>,
}

impl EnergyChange {
    /// Collisions of two disks.
    pub const fn disks(&self) -> &RunningMean {
        &self.disks
    }

    /// Collisions with the wall of this index; empty if there were none.
    pub fn wall(&self, wall: usize) -> RunningMean {
        self.walls.get(wall).copied().unwrap_or_default()
    }
}

impl Observer for EnergyChange {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        let mean = match collision.partner {
            Partner::Disk(_) => &mut self.disks,
            Partner::Wall(wall) => {
                if wall >= self.walls.len() {
                    self.walls.resize(wall + 1, RunningMean::default());
                }
                &mut self.walls[wall]
            }
        };
        mean.push(collision.energy_change);
    }
}
