//! Granular temperatures.

use super::{Heading, Observable, Snapshot, Tabular};
use crate::Disk;

/// Granular temperatures per degree of freedom, in units of energy.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Temperature {
    /// Horizontal temperature, T_x = ⟨m v_x²⟩.
    pub horizontal: f64,
    /// Vertical temperature, T_y = ⟨m v_y²⟩.
    pub vertical: f64,
    /// Rotational temperature, T_rot = ⟨I ω²⟩.
    pub rotational: f64,
}

impl Temperature {
    /// Creates temperatures from the horizontal, vertical and rotational temperature.
    pub const fn new(horizontal: f64, vertical: f64, rotational: f64) -> Self {
        Self { horizontal, vertical, rotational }
    }

    /// Returns the translational temperature, T = (T_x + T_y)/2.
    pub fn translational(&self) -> f64 {
        0.5 * (self.horizontal + self.vertical)
    }
}

/// The horizontal, vertical and rotational temperature of all disks, in the frame of the container; NaN
/// without disks.
///
/// The flow of convection rolls counts as temperature here, but contributes only a small part
/// ($`\Psi^2\ll T`$).
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::{Observable, Snapshot, Temperatures};
///
/// let disk = Disk::new(DVec2::ONE, 0.5)?.with_velocity(DVec2::new(1.0, 2.0))?.with_angular_velocity(4.0)?;
/// let domain = Domain::new(0.0, 4.0, 0.0, 6.0);
/// let temperature = Temperatures.measure(&Snapshot::new(0.0, &[disk], domain, 2.0));
/// assert_eq!((temperature.horizontal, temperature.vertical, temperature.rotational), (1.0, 4.0, 2.0));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Temperatures;

impl Observable for Temperatures {
    type Value = Temperature;

    fn measure(&self, snapshot: &Snapshot<'_>) -> Temperature {
        Temperature {
            horizontal: snapshot.mean(|disk| disk.mass() * (disk.velocity().x * disk.velocity().x)),
            vertical: snapshot.mean(|disk| disk.mass() * (disk.velocity().y * disk.velocity().y)),
            rotational: 2.0 * snapshot.mean(Disk::rotational_energy),
        }
    }
}

impl Tabular for Temperatures {
    fn headings(&self) -> Vec<Heading> {
        vec![
            Heading::new("horizontal_temperature", "energy"),
            Heading::new("vertical_temperature", "energy"),
            Heading::new("rotational_temperature", "energy"),
        ]
    }

    fn add_numbers(&self, value: &Temperature, row: &mut Vec<f64>) {
        row.extend([value.horizontal, value.vertical, value.rotational]);
    }
}
