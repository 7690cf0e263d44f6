//! Measurements of the box.

use granular_edmd::observable::{
    Accumulator, CenterOfMass, Collision, Energies, EnergyChange, HeightProfile, Observable, Observer,
    OrderParameters, Snapshot, Temperatures,
};

use crate::experiment::record;

/// Largest number of bins of a profile: of one diameter each.
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

/// The observer of the box: energy changes since the last sample, and the profile of all samples.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurement {
    change: EnergyChange,
    samples: u64,
    /// Sums over the samples of the packing fraction.
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

    /// Returns the packing fraction by height, averaged over the samples: heights of the middles of bins of
    /// one diameter, and fractions.
    pub(super) fn profile(&self) -> impl Iterator<Item = (f64, f64)> {
        let samples = self.samples as f64;
        self.profile.iter().enumerate().map(move |(bin, sum)| (bin as f64 + 0.5, sum / samples))
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
    let profile = HeightProfile::new(0.0, bins, bins as usize).map(|mut profile| {
        profile.add(snapshot);
        profile.iter().map(|(_, fraction)| fraction).collect()
    });
    // Creating the profile fails only for a height that is not positive.
    profile.unwrap_or_default()
}

/// Checks that the contents of a file are possible measurements.
pub(super) fn check(samples: &[Sample], measurement: &Measurement) -> Result<(), &'static str> {
    let Measurement { samples: count, profile, .. } = measurement;
    let is_sum = |sum: &f64| sum.is_finite() && *sum >= 0.0;
    record::check(samples.iter().all(is_finite), "a sample is not finite")?;
    record::check(profile.iter().all(is_sum), "a packing fraction is negative or not finite")?;
    record::check(profile.len() <= MOST_BINS, "its profile is higher than any")?;
    record::check(*count == samples.len() as u64, "its profile is not of its samples")
}

fn is_finite(sample: &Sample) -> bool {
    let flow = [sample.one_roll, sample.two_rolls, sample.height, sample.vertical_temperature];
    let energies = [sample.translational_energy, sample.rotational_energy, sample.energy_change];
    flow.iter().chain(&energies).all(|number| number.is_finite())
}
