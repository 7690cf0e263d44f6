//! Radii drawn from distributions, and the velocities of a gas.

use glam::DVec2;

use crate::disk::LEAST_THERMAL;
use crate::quantity::{accept, non_negative, positive};
use crate::random::{Stream, generator, normal, uniform};
use crate::simulation::drift_of;
use crate::{Disk, ParameterError};

/// Largest distance from the median of log-normal radii, in standard deviations. The normal numbers that are
/// made from doubles never reach this distance.
const FARTHEST: f64 = 9.0;

/// A distribution of radii within bounds.
///
/// The same seed gives the same radii on all platforms.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::initial::{self, Radii};
///
/// let radii = Radii::log_normal(0.5, 0.3, 0.2, 1.2)?.draw(500, 42);
/// let disks = initial::disks_from_radii(radii, 1.0)?;
/// let disks = initial::scattered_mix(&Container::closed(60.0, 60.0)?, disks, 40.0, 42)?;
/// assert!(disks.iter().all(|disk| (0.2..=1.2).contains(&disk.radius())));
/// assert!(disks.iter().all(|disk| disk.mass() == 4.0 * disk.radius() * disk.radius()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Radii {
    law: Law,
    smallest: f64,
    largest: f64,
}

/// The density between the bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    Uniform,
    LogNormal { median: f64, deviation: f64 },
    Power { exponent: f64 },
    TwoSizes { share: f64 },
}

impl Radii {
    /// Creates a distribution of radii between these bounds, all equally likely.
    ///
    /// # Errors
    /// If a bound is not finite and positive, or the largest is below the smallest.
    pub fn uniform(smallest: f64, largest: f64) -> Result<Self, ParameterError> {
        Self::within(Law::Uniform, smallest, largest)
    }

    /// Creates a log-normal distribution of radii, cut at these bounds.
    ///
    /// The logarithm of the radius has the standard deviation `deviation`.
    ///
    /// The density is $`\propto R^{-1}\,e^{-\ln^2(R/R_0)/2\sigma^2}`$ for the median $`R_0`$ of the uncut
    /// distribution and the deviation $`\sigma`$.
    ///
    /// # Errors
    /// If a number is not finite and positive, or the median is not between the bounds.
    pub fn log_normal(
        median: f64,
        deviation: f64,
        smallest: f64,
        largest: f64,
    ) -> Result<Self, ParameterError> {
        let deviation = positive("deviation of log-normal radii", deviation)?;
        let is_inside = smallest <= median && median <= largest;
        let median = accept(is_inside, "median radius", "between the smallest and the largest", median)?;
        Self::within(Law::LogNormal { median, deviation }, smallest, largest)
    }

    /// Creates a distribution of radii R between these bounds, with a density in proportion to R to the power
    /// of minus `exponent`.
    ///
    /// # Errors
    /// If a bound is not finite and positive, the largest is below the smallest, or the exponent is not in
    /// [0, 10].
    pub fn power_law(exponent: f64, smallest: f64, largest: f64) -> Result<Self, ParameterError> {
        let is_known = (0.0..=10.0).contains(&exponent);
        let exponent = accept(is_known, "exponent of radii", "in [0, 10]", exponent)?;
        Self::within(Law::Power { exponent }, smallest, largest)
    }

    /// Creates a distribution of two radii, in which this fraction of all disks is large.
    ///
    /// Each draw has exactly this fraction of large disks, up to rounding to a whole number.
    ///
    /// # Errors
    /// If a radius is not finite and positive, the large one is below the small one, or the share is not in
    /// [0, 1].
    pub fn two_sizes(small: f64, large: f64, share: f64) -> Result<Self, ParameterError> {
        let share = accept((0.0..=1.0).contains(&share), "share of large disks", "in [0, 1]", share)?;
        Self::within(Law::TwoSizes { share }, small, large)
    }

    fn within(law: Law, smallest: f64, largest: f64) -> Result<Self, ParameterError> {
        let (smallest, largest) =
            (positive("smallest radius", smallest)?, positive("largest radius", largest)?);
        accept(smallest <= largest, "largest radius", "no less than the smallest", largest)?;
        Ok(Self { law, smallest, largest })
    }

    /// Draws `count` radii in random order.
    pub fn draw(&self, count: usize, seed: u64) -> Vec<f64> {
        let mut generator = generator(seed, Stream::Radii, 0);
        let mut uniform = || uniform(&mut generator);
        if let Law::TwoSizes { share } = self.law {
            return self.two(count, (share * count as f64).round() as usize, &mut uniform);
        }
        let draws = (0..count).map(|_| self.one(&mut uniform));
        draws.map(|radius| radius.clamp(self.smallest, self.largest)).collect()
    }

    /// Draws `count` radii, of which `large` are large, in random order.
    fn two(&self, count: usize, large: usize, uniform: &mut impl FnMut() -> f64) -> Vec<f64> {
        let mut left = large;
        let mut is_large = |open: usize| {
            let taken = uniform() * (open as f64) < left as f64;
            left -= usize::from(taken);
            taken
        };
        (1..=count).rev().map(|open| if is_large(open) { self.largest } else { self.smallest }).collect()
    }

    /// Draws one radius, which rounding may put beyond a bound.
    fn one(&self, uniform: &mut impl FnMut() -> f64) -> f64 {
        let span = libm::log(self.largest / self.smallest);
        match self.law {
            Law::LogNormal { median, deviation } => self.log_normal_radius(median, deviation, uniform),
            Law::Power { exponent: 1.0 } => self.smallest * libm::exp(span * uniform()),
            Law::Power { exponent } => {
                // The inverse of the distribution function, in logarithms, which do not overflow.
                let power = 1.0 - exponent;
                let share = libm::log1p(uniform() * libm::expm1(power * span));
                self.smallest * libm::exp(share / power)
            }
            Law::Uniform | Law::TwoSizes { .. } => self.smallest + (self.largest - self.smallest) * uniform(),
        }
    }

    /// Draws by rejection from a uniform logarithm. Since the median is within the bounds, at least one draw
    /// in eight is accepted, however near or far the bounds are.
    fn log_normal_radius(&self, median: f64, deviation: f64, uniform: &mut impl FnMut() -> f64) -> f64 {
        let least = (libm::log(self.smallest / median) / deviation).max(-FARTHEST);
        let most = (libm::log(self.largest / median) / deviation).min(FARTHEST);
        loop {
            let normal = least + (most - least) * uniform();
            if uniform() < libm::exp(-0.5 * normal * normal) {
                return median * libm::exp(deviation * normal);
            }
        }
    }
}

/// Returns homogeneous disks of these radii, all at rest at the origin, for the functions that place disks.
///
/// Masses are in proportion to the area, $`m = m_1 (2R)^2`$, where `mass` is the mass $`m_1`$ of a disk of
/// diameter 1. For equal masses, take [`Disk::new`] and [`Disk::with_mass`].
///
/// # Errors
/// If a radius or a mass is not in `[1e-30, 1e30]`.
///
/// ```
/// use granular_edmd::initial;
/// let disks = initial::disks_from_radii([0.5, 1.0], 1.0)?;
/// assert_eq!([disks[0].mass(), disks[1].mass()], [1.0, 4.0]);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn disks_from_radii(
    radii: impl IntoIterator<Item = f64>,
    mass: f64,
) -> Result<Vec<Disk>, ParameterError> {
    let disk =
        |radius: f64| Disk::new(DVec2::ZERO, radius)?.with_mass(mass * (2.0 * radius) * (2.0 * radius));
    radii.into_iter().map(disk).collect()
}

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
