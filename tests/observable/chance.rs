//! Random numbers, and points at random places.

use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;
use granular_edmd::{Disk, Kind, ParameterError};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A box of 20 by 10.
pub(crate) const BOX: Domain = Domain::new(0.0, 20.0, 0.0, 10.0);

/// Random numbers from a seed.
pub(crate) struct Chance(Xoshiro256PlusPlus);

impl Chance {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Draws a number from 0 to 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Draws a normal variable (Box and Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// Returns points at random places in the box, two of three of kind 0 and the others of kind 1.
pub(crate) fn points(count: usize, chance: &mut Chance) -> Result<Vec<Disk>, ParameterError> {
    let point = |index: usize| {
        let place = DVec2::new(20.0 * chance.uniform(), 10.0 * chance.uniform());
        Ok(Disk::new(place, 1e-3)?.with_kind(Kind::new((index % 3 / 2) as u16)))
    };
    (0..count).map(point).collect()
}
