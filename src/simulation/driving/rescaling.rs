//! Rescaling of all velocities to a temperature.

use glam::DVec2;

use super::{Driving, drift_of, energy_of};
use crate::disk::LEAST_THERMAL;
use crate::observable::SampleTimes;
use crate::quantity::{accept, positive};
use crate::{Disk, ParameterError};

/// Rescaling: at each time of a clock, all velocities about their mean, and all spins, are multiplied by one
/// factor, so that the translational temperature is $`T = \tfrac12\langle m v'^2\rangle`$.
///
/// Under a rule without a speed scale, this changes nothing but the unit of time: a rescaled gas has the same
/// $`T_r/T`$ and cumulants as a gas that cools, but never becomes slow.
///
/// ```
/// use granular_edmd::observable::{SampleTimes, Temperatures};
/// use granular_edmd::prelude::*;
/// use granular_edmd::simulation::Rescaling;
///
/// let container = Container::periodic(20.0, 20.0)?;
/// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 100, 0.5)?, 1.0, 1)?;
/// let disks = initial::without_drift(disks)?;
/// let mut run = Simulation::builder(Smooth::from_restitution(0.8)?, container).disks(disks).build()?;
/// let mut rescaling = Rescaling::new(2.0, SampleTimes::every(0.5)?)?;
/// run.run_driven(&Limits::until(50.0), &mut rescaling, &mut ())?;
/// assert!((run.measure(&Temperatures).translational() - 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rescaling {
    temperature: f64,
    times: SampleTimes,
    energy: f64,
}

impl Rescaling {
    /// Creates a rescaling to this translational temperature.
    ///
    /// # Errors
    /// If the temperature is not finite and positive.
    pub fn new(temperature: f64, times: SampleTimes) -> Result<Self, ParameterError> {
        Ok(Self { temperature: positive("temperature", temperature)?, times, energy: 0.0 })
    }

    /// Returns the kinetic energy that all rescalings have added so far.
    pub const fn energy(&self) -> f64 {
        self.energy
    }
}

impl Driving for Rescaling {
    fn times(&mut self) -> &mut SampleTimes {
        &mut self.times
    }

    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        if disks.is_empty() {
            return Ok(());
        }
        let (before, drift) = (energy_of(disks), drift_of(disks));
        let about = |mean: DVec2| -> f64 {
            disks.iter().map(|disk| disk.mass() * (disk.velocity() - mean).length_squared()).sum()
        };
        let (squares, whole) = (about(drift), about(DVec2::ZERO));
        let present = 0.5 * squares / disks.len() as f64;
        let is_known = present > 0.0 && squares > LEAST_THERMAL * LEAST_THERMAL * whole;
        let requirement = "positive, and above the rounding of velocities";
        accept(is_known, "temperature before a rescaling", requirement, present)?;
        let factor = (self.temperature / present).sqrt();
        for disk in &mut *disks {
            let velocity = drift + factor * (disk.velocity() - drift);
            *disk = disk.with_velocity(velocity)?;
            *disk = disk.with_angular_velocity(factor * disk.angular_velocity())?;
        }
        self.energy += energy_of(disks) - before;
        Ok(())
    }
}

crate::gate::from_file! {
    Rescaling { temperature: f64, times: SampleTimes, energy: f64 } => {
        positive("temperature", temperature)?;
        crate::quantity::finite("energy of the rescalings", energy)?;
        Ok(Self { temperature, times, energy })
    }
}
