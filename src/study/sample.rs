//! What is measured at one time.

use crate::observable::{
    CenterOfMass, Energies, EnergyChange, Observable, OrderParameters, Snapshot, Temperatures,
};

/// One sample of a value.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Sample {
    /// Time since the start of the ramp.
    pub time: f64,
    /// `$\Psi_1$`.
    pub one_roll: f64,
    /// `$\Psi_2$`.
    pub two_rolls: f64,
    /// Height of the centre of mass.
    pub height: f64,
    /// `$\langle\tfrac12 m v^2\rangle$`.
    pub translational_energy: f64,
    /// `$\langle\tfrac12 I\omega^2\rangle$`.
    pub rotational_energy: f64,
    /// `$T_y$`.
    pub vertical_temperature: f64,
    /// Collisions of two disks in the interval that belongs to the sample.
    pub collisions: u64,
    /// Mean energy change of those collisions; 0 if there were none.
    pub energy_change: f64,
}

impl Sample {
    /// A sample without its collisions, which [`Self::with_collisions`] adds.
    pub(super) fn of(snapshot: &Snapshot<'_>) -> Self {
        let order = OrderParameters.measure(snapshot);
        let energies = Energies.measure(snapshot);
        Self {
            time: snapshot.time(),
            one_roll: order.one_roll,
            two_rolls: order.two_rolls,
            height: CenterOfMass.measure(snapshot).y,
            translational_energy: energies.translational,
            rotational_energy: energies.rotational,
            vertical_temperature: Temperatures.measure(snapshot).vertical,
            collisions: 0,
            energy_change: 0.0,
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        let Self { time, one_roll, two_rolls, height, translational_energy, rotational_energy, .. } = *self;
        let flow = [time, one_roll, two_rolls, height];
        let energies =
            [translational_energy, rotational_energy, self.vertical_temperature, self.energy_change];
        flow.iter().chain(&energies).all(|number| number.is_finite())
    }

    pub(super) fn with_collisions(self, change: &EnergyChange) -> Self {
        Self { collisions: change.disks().count(), energy_change: change.disks().mean(), ..self }
    }
}
