//! The velocities of a gas, for disks at given positions.

use glam::DVec2;

use crate::disk::LEAST_THERMAL;
use crate::quantity::{accept, non_negative};
use crate::random::{Stream, generator, normal};
use crate::simulation::drift_of;
use crate::{Disk, ParameterError};

/// Returns the same disks with Maxwellian velocities of this temperature.
///
/// Each component of a velocity is an independent normal variable of variance $`T/m`$: the canonical
/// ensemble, which suits a box with walls. All angular velocities stay unchanged. The center of mass drifts
/// at a speed of about $`\sqrt{2T/M}`$, where $`M`$ is the total mass. In a periodic domain, where it would
/// drift forever, use [`without_drift`].
///
/// # Errors
/// If the temperature is negative or not finite.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial;
/// let disks = initial::lattice(&Container::closed(60.0, 150.0)?, 1000, 0.5)?;
/// let disks = initial::with_maxwellian_velocities(disks, 2.0, 1)?;
/// let energy: f64 = disks.iter().map(|disk| disk.translational_energy()).sum();
/// assert!((energy / 1000.0 - 2.0).abs() < 0.3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn with_maxwellian_velocities(
    disks: Vec<Disk>,
    temperature: f64,
    seed: u64,
) -> Result<Vec<Disk>, ParameterError> {
    non_negative("temperature", temperature)?;
    let mut generator = generator(seed, Stream::Velocities, 0);
    let moving = disks.into_iter().map(|disk| {
        let speed = (temperature / disk.mass()).sqrt();
        disk.with_velocity(DVec2::new(speed * normal(&mut generator), speed * normal(&mut generator)))
    });
    moving.collect()
}

/// Returns the same disks with their center of mass at rest and the same kinetic energy of translation.
///
/// The mean velocity, weighted by mass, is subtracted, and what is left is multiplied by one factor. The
/// [temperature](crate::observable::Temperatures) $`T = \tfrac12\langle m v^2\rangle`$ of $`N`$ disks is
/// therefore unchanged, for every $`N`$. After
/// [`with_maxwellian_velocities`], it is the drawn temperature on average over seeds. Since only $`2N - 2`$
/// components are independent, each of them has the mean energy $`\tfrac12 T N/(N-1)`$.
///
/// # Errors
/// If disks that move have no motion about their center of mass, like a single disk: nothing would be left.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::{Disk, initial};
/// let disks = initial::lattice(&Container::periodic(20.0, 20.0)?, 10, 0.5)?;
/// let drifting = initial::with_maxwellian_velocities(disks, 2.0, 1)?;
/// let energy = |disks: &[Disk]| disks.iter().map(Disk::translational_energy).sum::<f64>();
/// let gas = initial::without_drift(drifting.clone())?;
/// assert!((energy(&gas) / energy(&drifting) - 1.0).abs() < 1e-12);
/// assert!(gas.iter().map(Disk::velocity).sum::<DVec2>().length() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn without_drift(disks: Vec<Disk>) -> Result<Vec<Disk>, ParameterError> {
    let about = |mean: DVec2| -> f64 {
        disks.iter().map(|disk| disk.mass() * (disk.velocity() - mean).length_squared()).sum()
    };
    let drift = drift_of(&disks);
    let (whole, left) = (about(DVec2::ZERO), about(drift));
    if whole == 0.0 {
        return Ok(disks);
    }
    let is_known = left > LEAST_THERMAL * LEAST_THERMAL * whole;
    let requirement = "positive, and above the rounding of velocities (two disks with different velocities)";
    accept(is_known, "energy about the center of mass", requirement, 0.5 * left)?;
    let factor = (whole / left).sqrt();
    disks.iter().map(|disk| disk.with_velocity(factor * (disk.velocity() - drift))).collect()
}
