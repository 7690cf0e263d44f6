//! Measurements of the box.

use granular_edmd::observable::{
    Accumulator, CenterOfMass, Collision, ConvectionOrder, DenseLayer, Energies, EnergyChange, HeightProfile,
    Observable, Observer, OrderParameters, Snapshot, Temperatures,
};
use granular_edmd::statistics::{BlockedMean, Estimate};

use super::VibratedBox;
use crate::Record;
use crate::analysis::thermal_noise;

/// Largest number of bins of a profile. A bin is one diameter high.
const MOST_BINS: usize = 65_536;

/// Height of the profile of an open box, in diameters.
const OPEN_PROFILE: f64 = 256.0;

/// One sample of a value.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Sample {
    /// $`\Psi_1`$.
    pub one_roll: f64,
    /// $`\Psi_2`$.
    pub two_rolls: f64,
    /// Height of the center of mass.
    pub height: f64,
    /// $`\langle\tfrac12 m v^2\rangle`$.
    pub translational_energy: f64,
    /// $`\langle\tfrac12 I\omega^2\rangle`$.
    pub rotational_energy: f64,
    /// $`T_y`$.
    pub vertical_temperature: f64,
    /// Number of disk–disk collisions since the previous sample.
    pub collisions: u64,
    /// Mean energy change in these collisions, or 0 without collisions.
    pub energy_change: f64,
}

impl Sample {
    /// Returns the mean energy change, NaN without collisions.
    pub(super) const fn known_change(&self) -> f64 {
        if self.collisions == 0 { f64::NAN } else { self.energy_change }
    }
}

/// The observer of the box: energy changes since the last sample, and the profile of all samples.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurement {
    change: EnergyChange,
    samples: u64,
    /// The packing fraction by height, summed over the samples.
    profile: Vec<f64>,
}

impl Observer for Measurement {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.change.on_collision(collision);
    }
}

impl Measurement {
    /// Takes a sample, with the collisions since the previous sample.
    pub(super) fn sample(&mut self, snapshot: &Snapshot<'_>) -> Sample {
        self.add_profile(snapshot);
        let change = std::mem::take(&mut self.change);
        let order = OrderParameters.measure(snapshot);
        let energies = Energies.measure(snapshot);
        Sample {
            one_roll: order.one_roll,
            two_rolls: order.two_rolls,
            height: CenterOfMass.measure(snapshot).y,
            translational_energy: energies.translational,
            rotational_energy: energies.rotational,
            vertical_temperature: Temperatures.measure(snapshot).vertical,
            collisions: change.disks().count(),
            energy_change: if change.disks().count() == 0 { 0.0 } else { change.disks().mean() },
        }
    }

    fn add_profile(&mut self, snapshot: &Snapshot<'_>) {
        let profile = profile(snapshot);
        self.samples += 1;
        self.profile.resize(profile.len(), 0.0);
        self.profile.iter_mut().zip(profile).for_each(|(sum, fraction)| *sum += fraction);
    }
}

/// Returns the packing fraction by height now.
fn profile(snapshot: &Snapshot<'_>) -> Vec<f64> {
    let top = snapshot.domain().top.min(MOST_BINS as f64);
    let bins = if snapshot.domain().top.is_finite() { top.ceil() } else { OPEN_PROFILE };
    let profile = HeightProfile::new(0.0, bins, bins as usize).and_then(|mut profile| {
        profile.add(snapshot)?;
        Ok(profile.iter().map(|(_, fraction)| fraction).collect())
    });
    // Creating the profile fails only for a height that is not positive, and a container's area is known.
    profile.unwrap_or_default()
}

/// Convection, layers and energy loss in a record of the box.
///
/// ```no_run
/// use granular_edmd_study::analysis::StateCriteria;
/// use granular_edmd_study::Study;
/// use granular_edmd_study::vibrated_box::VibratedBox;
///
/// for record in Study::<VibratedBox>::open("study")?.records() {
///     let record = record?;
///     let (noise, layer) = (record.thermal_noise(), record.densest_layer());
///     println!("{}", StateCriteria::default().classify(&record.order(), noise, layer)?.state());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl Record<VibratedBox> {
    /// Returns $`(\Psi_1, \Psi_2)`$ of each sample.
    pub fn order(&self) -> Vec<ConvectionOrder> {
        let order = |sample: &Sample| ConvectionOrder::new(sample.one_roll, sample.two_rolls);
        self.samples().iter().map(order).collect()
    }

    /// Returns the packing fraction by height, averaged over the samples: heights of the middles of bins of
    /// one diameter, and fractions.
    pub fn profile(&self) -> impl Iterator<Item = (f64, f64)> {
        let Measurement { samples, profile, .. } = self.observer();
        profile.iter().enumerate().map(|(bin, sum)| (bin as f64 + 0.5, sum / *samples as f64))
    }

    /// Returns the densest layer of the profile, or `None` without samples.
    pub fn densest_layer(&self) -> Option<DenseLayer> {
        DenseLayer::among(self.profile())
    }

    /// Returns the mean energy change in a collision of two disks, over all collisions.
    ///
    /// The mean is NaN without collisions, and the error is NaN if fewer than two samples have any.
    pub fn energy_change(&self) -> Estimate {
        let changes = self.samples().iter().map(Sample::known_change).filter(|change| !change.is_nan());
        if changes.clone().count() < 2 {
            return changes.collect::<BlockedMean>().estimate();
        }
        let collisions: f64 = self.samples().iter().map(|sample| sample.collisions as f64).sum();
        let total: f64 = self.samples().iter().map(|s| s.collisions as f64 * s.energy_change).sum();
        let mean = total / collisions;
        let per_sample = collisions / self.samples().len() as f64;
        // The error of a ratio is the error of the mean residual divided by the mean number of collisions.
        self.mean(|s| s.collisions as f64 * (s.energy_change - mean) / per_sample).about(mean)
    }

    /// Returns the standard deviation of $`\Psi_1`$ and $`\Psi_2`$ in a gas at rest with this temperature,
    /// $`\sqrt{T_y/2N}`$.
    pub fn thermal_noise(&self) -> f64 {
        let temperature = self.mean(|sample| sample.vertical_temperature).mean();
        thermal_noise(temperature, 1.0, self.experiment().disks).unwrap_or(f64::NAN)
    }
}
