//! The energy change per collision, the paper's central quantity, in a run and by height.

use super::by_wall::ByWall;
use super::grid::check_heights;
use super::sample_times::System;
use super::table::{ENERGY, table};
use super::{Accumulator, Collision, Observer, ObserverError, Partner, Snapshot};
use crate::ParameterError;
use crate::statistics::{Bins, BlockedMean};

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

    /// Returns the change in collisions of disks, and in those with each wall that was touched.
    fn partners(&self) -> impl Iterator<Item = (f64, &BlockedMean)> {
        let walls = (0..).map(f64::from).zip(self.walls.values()).filter(|(_, mean)| mean.count() > 0);
        std::iter::once((f64::NAN, &self.disks)).chain(walls)
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

table! {
    /// The walls are numbered in the order of the first run's boundary.
    EnergyChange, this: for (wall, mean) in this.partners();
    "wall" ["1"]: wall,
    "collisions" ["1"]: mean.count() as f64;
    "energy_change" [ENERGY]: mean.estimate()
}

/// A layer of an [`EnergyChangeProfile`].
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct EnergyChangeLayer {
    /// Height of the layer's middle.
    pub height: f64,
    /// Energy changes of the disk–disk collisions in the layer.
    pub energy_change: BlockedMean,
    /// Values of ½ m v² of the disks seen in the layer, in the frame of the container.
    ///
    /// Their mean is the translational temperature.
    pub translational_temperature: BlockedMean,
    /// Values of I ω² of the disks seen in the layer.
    ///
    /// Their mean is the rotational temperature.
    pub rotational_temperature: BlockedMean,
}

impl EnergyChangeLayer {
    /// Returns the mean energy change divided by the temperature in this layer, ⟨dE⟩/T, or `None` before
    /// there are collisions and a temperature.
    pub fn relative_energy_change(&self) -> Option<f64> {
        let temperature = self.translational_temperature.mean();
        (self.energy_change.count() > 0 && temperature > 0.0).then(|| self.energy_change.mean() / temperature)
    }
}

/// The energy change per disk–disk collision by height, with the temperatures there.
///
/// A collision counts in the layer of its first disk's center. The contact is up to a radius above or below
/// this center.
///
/// The profile allows a comparison with the kinetic theory of a gas of one temperature, layer by layer and on
/// average. Errors are computed from blocks of consecutive collisions, and of consecutive disks in a layer,
/// so neither needs to be independent.
///
/// ```
/// use granular_edmd::observable::EnergyChangeProfile;
/// let profile = EnergyChangeProfile::new(0.0, 150.0, 30)?;
/// assert_eq!(profile.layers().len(), 30);
/// assert_eq!(profile.relative_energy_change(), None);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct EnergyChangeProfile {
    bins: Bins,
    layers: Vec<EnergyChangeLayer>,
}

impl EnergyChangeProfile {
    /// Creates a profile of `layers` layers from the height `bottom` to `top`.
    ///
    /// Collisions and disks outside the profile are left out. A run ends with an error if the whole profile
    /// is outside the domain.
    ///
    /// # Errors
    /// If a height is not finite, `top` is not above `bottom`, or the number of layers is not in `1..=2^20`.
    pub fn new(bottom: f64, top: f64, layers: usize) -> Result<Self, ParameterError> {
        let bins = Bins::new(bottom, top, layers)?;
        let layer = |bin| EnergyChangeLayer { height: bins.middle(bin), ..EnergyChangeLayer::default() };
        Ok(Self { bins, layers: (0..layers).map(layer).collect() })
    }

    /// Returns the layers, from the bottom up.
    pub fn layers(&self) -> &[EnergyChangeLayer] {
        &self.layers
    }

    /// Returns the energy change divided by the local temperature, averaged over collisions: ⟨dE/T(y)⟩.
    ///
    /// The result is `None` before a layer has collisions and a temperature.
    pub fn relative_energy_change(&self) -> Option<f64> {
        self.over_collisions(EnergyChangeLayer::relative_energy_change)
    }

    /// Returns the ratio of the local temperatures, averaged over collisions: ⟨T_rot(y)/T(y)⟩.
    ///
    /// The result is `None` before a layer has collisions and a temperature.
    pub fn rotational_ratio(&self) -> Option<f64> {
        self.over_collisions(|layer| {
            let temperature = layer.translational_temperature.mean();
            (temperature > 0.0).then(|| layer.rotational_temperature.mean() / temperature)
        })
    }

    fn over_collisions(&self, quantity: impl Fn(&EnergyChangeLayer) -> Option<f64>) -> Option<f64> {
        let known =
            || self.layers.iter().filter_map(|layer| Some((layer.energy_change.count(), quantity(layer)?)));
        let collisions: u64 = known().map(|(count, _)| count).sum();
        let sum: f64 = known().map(|(count, value)| count as f64 * value).sum();
        (collisions > 0).then(|| sum / collisions as f64)
    }
}

impl Accumulator for EnergyChangeProfile {
    fn on_collision(&mut self, collision: &Collision) {
        if let (Partner::Disk(_), Some(bin)) = (collision.partner, self.bins.find(collision.position.y)) {
            self.layers[bin].energy_change.push(collision.energy_change);
        }
    }

    fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ParameterError> {
        for disk in snapshot.disks() {
            if let Some(bin) = self.bins.find(snapshot.domain().folded(disk.position()).y) {
                self.layers[bin].translational_temperature.push(disk.translational_energy());
                self.layers[bin].rotational_temperature.push(2.0 * disk.rotational_energy());
            }
        }
        Ok(())
    }

    fn check(&self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        check_heights(&self.bins, &start.domain())
    }
}

table! { EnergyChangeProfile, this: for layer in this.layers.iter();
    "height" ["length"]: layer.height,
    "collisions" ["1"]: layer.energy_change.count() as f64;
    "energy_change" [ENERGY]: layer.energy_change.estimate(),
    "translational_temperature" [ENERGY]: layer.translational_temperature.estimate(),
    "rotational_temperature" [ENERGY]: layer.rotational_temperature.estimate()
}

crate::gate::from_file! {
    EnergyChangeProfile { bins: Bins, layers: Vec<EnergyChangeLayer> } => {
        bins.check_count(layers.len())?;
        Ok(Self { bins, layers })
    }
}
