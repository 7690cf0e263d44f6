//! The velocities of a gas, for disks at given positions.

use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::quantity::non_negative;
use crate::random::normal;
use crate::{Disk, ParameterError};

/// Returns the same disks with Maxwellian velocities of this temperature.
///
/// The center of mass is at rest, except for a single disk, which gets the velocity that is drawn. All
/// angular velocities stay unchanged.
///
/// Each component of a velocity is a normal variable of variance $`T/m`$. The total momentum is then removed,
/// in proportion to the masses.
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
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(seed);
    let draw = |disk: &Disk| {
        let speed = (temperature / disk.mass()).sqrt();
        DVec2::new(speed * normal(&mut generator), speed * normal(&mut generator))
    };
    let velocities: Vec<DVec2> = disks.iter().map(draw).collect();
    let mass: f64 = disks.iter().map(Disk::mass).sum();
    let momentum: DVec2 = disks.iter().zip(&velocities).map(|(disk, &velocity)| disk.mass() * velocity).sum();
    let drift = if disks.len() > 1 { momentum / mass } else { DVec2::ZERO };
    disks.into_iter().zip(velocities).map(|(disk, velocity)| disk.with_velocity(velocity - drift)).collect()
}
