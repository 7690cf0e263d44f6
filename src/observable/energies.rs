//! Energies per disk.

use super::{Heading, Observable, Snapshot, Tabular};
use crate::Disk;

/// Mean energies per disk.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct EnergyPerDisk {
    /// Translational energy, ⟨½ m v²⟩.
    pub translational: f64,
    /// Rotational energy, ⟨½ I ω²⟩.
    pub rotational: f64,
    /// Potential energy, ⟨−m **g**·**r**⟩, from unwrapped positions. It is zero at the origin.
    pub potential: f64,
}

impl EnergyPerDisk {
    /// Creates energies from the translational, rotational and potential energy.
    pub const fn new(translational: f64, rotational: f64, potential: f64) -> Self {
        Self { translational, rotational, potential }
    }

    /// Returns the sum of all three energies.
    pub fn total(&self) -> f64 {
        self.translational + self.rotational + self.potential
    }
}

/// The translational, rotational and potential energy, averaged over the disks; NaN without disks.
///
/// Walls with a mass have energies of their own: [`FreeWall`](super::FreeWall).
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::{Energies, Observable, Snapshot};
///
/// let disks = [Disk::new(DVec2::new(1.0, 3.0), 0.5)?.with_velocity(DVec2::X)?];
/// let domain = Domain::new(0.0, 4.0, 0.0, 6.0);
/// let energies = Energies.measure(&Snapshot::new(0.0, &disks, domain, 2.0));
/// assert_eq!((energies.translational, energies.potential), (0.5, 6.0));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Energies;

impl Observable for Energies {
    type Value = EnergyPerDisk;

    fn measure(&self, snapshot: &Snapshot<'_>) -> EnergyPerDisk {
        EnergyPerDisk {
            translational: snapshot.mean(Disk::translational_energy),
            rotational: snapshot.mean(Disk::rotational_energy),
            potential: snapshot.mean(|disk| potential(snapshot, disk)),
        }
    }
}

fn potential(snapshot: &Snapshot<'_>, disk: &Disk) -> f64 {
    let (gravity, place) = (snapshot.gravity(), snapshot.domain().unwrapped(disk));
    disk.mass() * gravity.downward() * place.y - disk.mass() * gravity.rightward() * place.x
}

impl Tabular for Energies {
    fn headings(&self) -> Vec<Heading> {
        vec![
            Heading::new("translational_energy", "energy"),
            Heading::new("rotational_energy", "energy"),
            Heading::new("potential_energy", "energy"),
        ]
    }

    fn add_numbers(&self, value: &EnergyPerDisk, row: &mut Vec<f64>) {
        row.extend([value.translational, value.rotational, value.potential]);
    }
}
