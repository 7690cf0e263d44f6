//! Mixtures of sizes, by a seeded generator.

use std::f64::consts::TAU;
use std::fmt;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Radius of the smallest disks.
const SMALLEST: f64 = 0.5;

/// Which disks a mixture consists of.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sizes {
    /// A single large disk.
    Intruder,
    /// One large disk among a hundred.
    Few,
    /// Large disks take half of the area of all.
    HalfOfTheArea,
    /// Many sizes.
    Many(Distribution),
}

impl Sizes {
    /// The mixtures of two sizes.
    pub(crate) const TWO: [Self; 3] = [Self::Intruder, Self::Few, Self::HalfOfTheArea];
}

/// A distribution of radii from the smallest to the largest.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Distribution {
    Uniform,
    /// The smallest and largest are three standard deviations from the median.
    LogNormal,
    /// As r⁻³: each octave takes the same area.
    PowerLaw,
}

impl Distribution {
    pub(crate) const ALL: [Self; 3] = [Self::Uniform, Self::LogNormal, Self::PowerLaw];

    /// Returns a radius in terms of the smallest.
    fn sample(self, ratio: f64, generator: &mut Xoshiro256PlusPlus) -> f64 {
        match self {
            Self::Uniform => 1.0 + (ratio - 1.0) * generator.random::<f64>(),
            Self::LogNormal => loop {
                let radius = (ratio.ln() * (0.5 + normal(generator) / 6.0)).exp();
                if (1.0..=ratio).contains(&radius) {
                    return radius;
                }
            },
            Self::PowerLaw => (1.0 - generator.random::<f64>() * (1.0 - ratio.powi(-2))).powf(-0.5),
        }
    }
}

fn normal(generator: &mut Xoshiro256PlusPlus) -> f64 {
    let (u, v): (f64, f64) = (1.0 - generator.random::<f64>(), generator.random());
    (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
}

/// A mixture of so many disks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mixture {
    pub(crate) sizes: Sizes,
    /// The largest radius over the smallest.
    pub(crate) ratio: f64,
    pub(crate) disks: usize,
}

impl Mixture {
    /// Returns the radii of all disks.
    pub(crate) fn radii(&self) -> Vec<f64> {
        let Self { sizes, ratio, disks } = *self;
        let large = match sizes {
            Sizes::Intruder => 1,
            Sizes::Few => disks / 100,
            Sizes::HalfOfTheArea => (disks as f64 / (1.0 + ratio * ratio)).round().max(1.0) as usize,
            Sizes::Many(distribution) => {
                let mut generator = Xoshiro256PlusPlus::seed_from_u64(3);
                return (0..disks).map(|_| SMALLEST * distribution.sample(ratio, &mut generator)).collect();
            }
        };
        let radius = |k| if k < large { SMALLEST * ratio } else { SMALLEST };
        (0..disks).map(radius).collect()
    }
}

impl Mixture {
    /// Returns the radii of the small disks of a mixture of two sizes.
    pub(crate) fn small(&self) -> Option<Vec<f64>> {
        let is_small = |radius: &f64| *radius == SMALLEST;
        let of_two = !matches!(self.sizes, Sizes::Many(_));
        of_two.then(|| self.radii().into_iter().filter(is_small).collect())
    }
}

impl fmt::Display for Sizes {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Intruder => "one intruder",
            Self::Few => "1 % large",
            Self::HalfOfTheArea => "half of the area large",
            Self::Many(Distribution::Uniform) => "uniform",
            Self::Many(Distribution::LogNormal) => "log-normal",
            Self::Many(Distribution::PowerLaw) => "power law",
        })
    }
}
