//! The center of mass.

use std::f64::consts::TAU;

use glam::DVec2;

use super::{Heading, Observable, Snapshot, Tabular};
use crate::Disk;
use crate::boundary::direction;

/// The position of the center of mass, or NaN without disks.
///
/// It is $`\sum m_i\vec r_i/\sum m_i`$. Its `y` is the $`Y_{cm}`$ of the paper's Fig. 2.
///
/// In a periodic direction, the mean of positions depends on where the seam is. There, the value is the
/// circular mean (Bai and Breen 2008): the direction of $`\sum m_i e^{2\pi i x_i/L}`$, as a position in the
/// domain. It moves along with the disks, even across the seam. If the disks are symmetric about it, it is
/// their center of mass. It is NaN if the sum vanishes, as for disks that are spread evenly, and mostly noise
/// if the sum nearly vanishes. To follow the center over time, use displacements of
/// [unwrapped](crate::boundary::Domain::unwrapped) positions.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::{CenterOfMass, Observable, Snapshot};
///
/// let disks = [
///     Disk::new(DVec2::new(1.0, 1.0), 0.5)?,
///     Disk::new(DVec2::new(3.0, 5.0), 0.5)?.with_mass(3.0)?,
/// ];
/// let domain = Domain::new(0.0, 4.0, 0.0, 6.0);
/// let center = CenterOfMass.measure(&Snapshot::new(0.0, &disks, domain, 0.0));
/// assert_eq!(center, DVec2::new(2.5, 4.0));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CenterOfMass;

impl Observable for CenterOfMass {
    type Value = DVec2;

    fn measure(&self, snapshot: &Snapshot<'_>) -> DVec2 {
        let mass: f64 = snapshot.disks().iter().map(Disk::mass).sum();
        let moment: DVec2 = snapshot.disks().iter().map(|disk| disk.mass() * disk.position()).sum();
        let (domain, mut center) = (snapshot.domain(), moment / mass);
        if domain.periodic_sides {
            center.x = circular_mean(snapshot, mass, domain.left, domain.width(), |place| place.x);
        }
        if domain.periodic_ends {
            center.y = circular_mean(snapshot, mass, domain.bottom, domain.height(), |place| place.y);
        }
        center
    }
}

/// Returns the circular mean of a coordinate, between `low` and `low + period`; NaN if the disks have no mean
/// direction.
fn circular_mean(
    snapshot: &Snapshot<'_>,
    mass: f64,
    low: f64,
    period: f64,
    coordinate: impl Fn(DVec2) -> f64,
) -> f64 {
    /// Length of the mean direction below which the direction is due to rounding.
    const ROUNDING: f64 = 1e-12;
    let turns = |disk: &Disk| (coordinate(disk.position()) - low) / period;
    let sum: DVec2 = snapshot.disks().iter().map(|disk| disk.mass() * direction(TAU * turns(disk))).sum();
    if sum.length() > ROUNDING * mass {
        low + (libm::atan2(sum.y, sum.x) / TAU).rem_euclid(1.0) * period
    } else {
        f64::NAN
    }
}

impl Tabular for CenterOfMass {
    fn headings(&self) -> Vec<Heading> {
        vec![Heading::new("center_x", "length"), Heading::new("center_y", "length")]
    }

    fn add_numbers(&self, value: &DVec2, row: &mut Vec<f64>) {
        row.extend([value.x, value.y]);
    }
}
