//! The parts of the box: its base, its sides, and the collision rule of its disks.

use granular_edmd::boundary::{Container, Thermal, Wall};
use granular_edmd::wall::{BiParabolic, Sinusoidal, WallMotion};

use crate::ExperimentError;

/// The base of the box, which gives the disks their energy.
///
/// In a plan: `base.bi_parabolic = { amplitude = 0.1, angular_frequency = 10.0 }` or
/// `base.thermal = { temperature = 1.0 }`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Base {
    /// The paper's vibrating base, [`BiParabolic`].
    BiParabolic {
        /// $`A`$.
        amplitude: f64,
        /// $`\omega`$.
        angular_frequency: f64,
    },
    /// A true sine, [`Sinusoidal`].
    Sinusoidal {
        /// $`A`$.
        amplitude: f64,
        /// $`\omega`$.
        angular_frequency: f64,
    },
    /// A thermal base, [`Thermal`].
    Thermal {
        /// $`T_0`$.
        temperature: f64,
        /// True if collisions with the base change neither the tangential nor the angular velocity.
        #[serde(default)]
        slip: bool,
    },
}

/// The sides of the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Sides {
    /// Walls under the collision rule of the disks.
    #[default]
    Hard,
    /// Smooth elastic walls.
    Elastic,
    /// No side walls: a disk that leaves on one side enters on the other.
    Periodic,
}

impl Base {
    pub(super) fn period(&self) -> Option<f64> {
        let &(Self::BiParabolic { angular_frequency, .. } | Self::Sinusoidal { angular_frequency, .. }) =
            self
        else {
            return None;
        };
        BiParabolic::new(1.0, angular_frequency).ok().and_then(|motion| motion.period())
    }

    /// Returns the typical speed that the base gives to disks of mass 1.
    pub(super) fn speed(&self) -> f64 {
        match *self {
            Self::BiParabolic { amplitude, angular_frequency }
            | Self::Sinusoidal { amplitude, angular_frequency } => amplitude * angular_frequency,
            Self::Thermal { temperature, .. } => temperature.sqrt(),
        }
    }

    /// Returns the container whose floor is this base.
    pub(super) fn under(&self, container: Container) -> Result<Container, ExperimentError> {
        Ok(match *self {
            Self::BiParabolic { amplitude, angular_frequency } => {
                container.with_motion(Wall::Floor, BiParabolic::new(amplitude, angular_frequency)?)?
            }
            Self::Sinusoidal { amplitude, angular_frequency } => {
                container.with_motion(Wall::Floor, Sinusoidal::new(amplitude, angular_frequency)?)?
            }
            Self::Thermal { temperature, slip } => {
                let thermal = Thermal::new(temperature)?;
                container.with_temperature(Wall::Floor, if slip { thermal.with_slip() } else { thermal })?
            }
        })
    }
}
