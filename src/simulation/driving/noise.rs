//! White noise: random kicks that conserve the total momentum.

use glam::DVec2;

use super::{Driving, drift_of, energy_of};
use crate::observable::SampleTimes;
use crate::quantity::non_negative;
use crate::random::{Stream, derived_seed, generator_at, normal};
use crate::{Disk, ParameterError};

/// White noise: at each time of a clock, every disk gets a random kick, and the total momentum is conserved.
///
/// Each component of each velocity gains a normal variable of variance $`\xi_0^2 t`$ in a time $`t`$. The
/// mean of all kicks, weighted by mass, is then subtracted. Thus the temperature of $`N`$ equal disks of mass
/// $`m`$ grows at the rate
///
/// ```math
/// \dot T = m\,\xi_0^2\left(1-\tfrac1N\right),
/// ```
///
/// and, with [rotational noise](Self::with_rotational_noise), $`\dot T_r = I\,\xi_r^2`$. The noise is white
/// if the kicks are more frequent than collisions. At each kick, all events are predicted anew, so a kick
/// takes about as long as one collision per disk.
///
/// The random numbers of a kick follow from the seed and the time of the kick. A noise that is made anew with
/// the same seed therefore goes on, instead of repeating its kicks. A second noise of one run needs another
/// seed or [stream](Self::with_stream).
///
/// ```
/// use granular_edmd::observable::{EnergyChange, SampleTimes};
/// use granular_edmd::prelude::*;
/// use granular_edmd::simulation::WhiteNoise;
///
/// let container = Container::periodic(20.0, 20.0)?;
/// let disks = initial::lattice(&container, 100, 0.5)?;
/// let mut run = Simulation::builder(Smooth::from_restitution(0.9)?, container).disks(disks).build()?;
/// let mut noise = WhiteNoise::new(0.1, SampleTimes::every(0.1)?, 7)?;
/// let mut lost = EnergyChange::default();
/// run.run_driven(&Limits::until(20.0), &mut noise, &mut lost)?;
/// // The present energy is what the kicks added, less what collisions dissipated.
/// let lost = lost.disks().sum();
/// let energy: f64 = run.disks().iter().map(Disk::translational_energy).sum();
/// assert!((noise.energy() + lost - energy).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Source: D. R. M. Williams and F. C. MacKintosh, Phys. Rev. E 54, R9 (1996); T. P. C. van Noije and M. H.
/// Ernst, Granular Matter 1, 57 (1998).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct WhiteNoise {
    noise: f64,
    rotational_noise: f64,
    times: SampleTimes,
    seed: u64,
    /// Time of the latest kick, and the number of kicks at this time.
    latest: (f64, u64),
    energy: f64,
}

impl WhiteNoise {
    /// Creates noise of this strength $`\xi_0^2`$, the variance that a component of a velocity gains per unit
    /// of time.
    ///
    /// # Errors
    /// If the strength is negative or not finite.
    pub fn new(noise: f64, times: SampleTimes, seed: u64) -> Result<Self, ParameterError> {
        let (noise, times) = (non_negative("noise", noise)?, times.equally_spaced()?);
        Ok(Self { noise, rotational_noise: 0.0, times, seed, latest: (0.0, 0), energy: 0.0 })
    }

    /// Returns the same noise, which also kicks the spins: $`\xi_r^2`$ is the variance that an angular
    /// velocity gains per unit of time.
    ///
    /// # Errors
    /// If the strength is negative or not finite.
    pub fn with_rotational_noise(self, noise: f64) -> Result<Self, ParameterError> {
        Ok(Self { rotational_noise: non_negative("rotational noise", noise)?, ..self })
    }

    /// Returns the same noise with the random numbers of the stream with this number, for a second noise of
    /// the same seed.
    #[must_use]
    pub const fn with_stream(self, number: u64) -> Self {
        Self { seed: derived_seed(self.seed, Stream::Noise, number), ..self }
    }

    /// Returns the kinetic energy that all kicks have added so far.
    pub const fn energy(&self) -> f64 {
        self.energy
    }
}

impl Driving for WhiteNoise {
    fn times(&mut self) -> &mut SampleTimes {
        &mut self.times
    }

    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        let before = energy_of(disks);
        let [speed, spin] =
            [self.noise, self.rotational_noise].map(|noise| (noise * self.times.interval()).sqrt());
        let (drift, time) = (drift_of(disks), self.times.upcoming());
        // A caller without a run may kick several times while the clock stands still.
        let earlier = if time == self.latest.0 { self.latest.1 } else { 0 };
        self.latest = (time, earlier + 1);
        let mut random = generator_at(self.seed, Stream::Noise, earlier, time);
        for disk in &mut *disks {
            let kick = DVec2::new(normal(&mut random), normal(&mut random));
            let turn = if spin > 0.0 { spin * normal(&mut random) } else { 0.0 };
            *disk = disk.with_velocity(disk.velocity() + speed * kick)?;
            *disk = disk.with_angular_velocity(disk.angular_velocity() + turn)?;
        }
        let gained = drift_of(disks) - drift;
        for disk in &mut *disks {
            *disk = disk.with_velocity(disk.velocity() - gained)?;
        }
        self.energy += energy_of(disks) - before;
        Ok(())
    }
}

crate::gate::from_file! {
    WhiteNoise {
        noise: f64, rotational_noise: f64, times: SampleTimes, seed: u64, latest: (f64, u64), energy: f64
    } => {
        non_negative("noise", noise)?;
        non_negative("rotational noise", rotational_noise)?;
        crate::quantity::finite("energy of the kicks", energy)?;
        Ok(Self { noise, rotational_noise, times, seed, latest, energy })
    }
}
