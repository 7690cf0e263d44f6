//! Mixtures of sizes, by a seeded generator.

use std::fmt;

use granular_edmd::ParameterError;
use granular_edmd::initial::Radii;

/// Radius of the smallest disks.
const SMALLEST: f64 = 0.5;

/// The sizes of the disks of a mixture.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sizes {
    /// A single large disk.
    Intruder,
    /// One large disk among a hundred.
    Few,
    /// Large disks with half of the area of all disks.
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
    /// The density is proportional to r⁻³, so the disks of each octave have the same area.
    PowerLaw,
}

impl Distribution {
    pub(crate) const ALL: [Self; 3] = [Self::Uniform, Self::LogNormal, Self::PowerLaw];

    fn radii(self, ratio: f64) -> Result<Radii, ParameterError> {
        let largest = ratio * SMALLEST;
        match self {
            Self::Uniform => Radii::uniform(SMALLEST, largest),
            Self::LogNormal => {
                Radii::log_normal(ratio.sqrt() * SMALLEST, ratio.ln() / 6.0, SMALLEST, largest)
            }
            Self::PowerLaw => Radii::power_law(3.0, SMALLEST, largest),
        }
    }
}

/// A mixture of `disks` disks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mixture {
    pub(crate) sizes: Sizes,
    /// The largest radius divided by the smallest.
    pub(crate) ratio: f64,
    pub(crate) disks: usize,
}

impl Mixture {
    /// Returns the radii of all disks.
    pub(crate) fn radii(&self) -> Result<Vec<f64>, ParameterError> {
        let Self { sizes, ratio, disks } = *self;
        let large = match sizes {
            Sizes::Intruder => 1,
            Sizes::Few => disks / 100,
            Sizes::HalfOfTheArea => (disks as f64 / (1.0 + ratio * ratio)).round().max(1.0) as usize,
            Sizes::Many(distribution) => {
                return Ok(distribution.radii(ratio)?.draw(disks, 3));
            }
        };
        let radius = |k| if k < large { SMALLEST * ratio } else { SMALLEST };
        Ok((0..disks).map(radius).collect())
    }

    /// Returns the radii of the small disks of a mixture of two sizes.
    pub(crate) fn small(&self) -> Result<Option<Vec<f64>>, ParameterError> {
        if matches!(self.sizes, Sizes::Many(_)) {
            return Ok(None);
        }
        Ok(Some(self.radii()?.into_iter().filter(|&radius| radius == SMALLEST).collect()))
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
