//! The energy change per collision, the paper's central quantity, as measured in a run.

use super::by_wall::ByWall;
use super::system::System;
use super::table::{ENERGY, Table, headings, row};
use super::{Collision, Heading, Observer, ObserverError, Partner, Snapshot};
use crate::statistics::BlockedMean;

/// An observer of the mean change of kinetic energy per collision, ⟨dE⟩, for disk–disk collisions and for
/// each wall.
///
/// Collisions of one run are correlated, since the gas heats and cools. [`BlockedMean::estimate`] gives a
/// mean whose error accounts for these correlations. At a moving or thermal wall, the energy change is the
/// change of the disk's energy, including the work of the wall.
///
/// A run ends with an error if it belongs to another system than the previous run, or if it goes back in
/// time. Clear the observer before such a run, or use another one.
/// [`Estimate::over_repeats`](crate::statistics::Estimate::over_repeats) gives the mean over several systems.
///
/// ```
/// use granular_edmd::observable::EnergyChange;
/// let energy_change = EnergyChange::default();
/// assert_eq!(energy_change.disks().count(), 0);
/// assert_eq!(energy_change.wall("floor").count(), 0);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct EnergyChange {
    disks: BlockedMean,
    walls: ByWall<BlockedMean>,
    /// The system that is measured, and the end of its latest run.
    #[cfg_attr(feature = "serde", serde(default))]
    system: System,
}

impl Default for EnergyChange {
    fn default() -> Self {
        let (disks, system) = (BlockedMean::with_room(), System::default());
        Self { disks, walls: ByWall::NONE, system }
    }
}

/// An empty mean, for a wall that was never touched.
static NEVER_TOUCHED: BlockedMean = BlockedMean::new();

impl EnergyChange {
    /// Returns the mean over collisions of two disks.
    pub const fn disks(&self) -> &BlockedMean {
        &self.disks
    }

    /// Returns the mean over collisions with the wall or part of this name; empty if it was never touched.
    pub fn wall(&self, name: &str) -> &BlockedMean {
        self.walls.get(name).unwrap_or(&NEVER_TOUCHED)
    }

    /// Forgets all collisions so far.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

impl Observer for EnergyChange {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.system.begin(start)?;
        self.walls.find_all(start);
        Ok(())
    }

    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        let mean = match collision.partner {
            Partner::Disk(_) => Some(&mut self.disks),
            Partner::Wall(wall) => self.walls.at(wall),
        };
        if let Some(mean) = mean {
            mean.push(collision.energy_change);
        }
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.system.pause(end);
    }
}

/// The walls are numbered in the order of the first run's boundary.
impl Table for EnergyChange {
    fn headings(&self) -> Vec<Heading> {
        headings(&[("wall", "1"), ("collisions", "1")], &[("energy_change", ENERGY)])
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        let walls = (0..).map(f64::from).zip(self.walls.values()).filter(|(_, mean)| mean.count() > 0);
        let partners = std::iter::once((f64::NAN, &self.disks)).chain(walls);
        Box::new(partners.map(|(wall, mean)| row(&[wall, mean.count() as f64], &[mean.estimate()])))
    }
}
