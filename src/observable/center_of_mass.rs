//! The center of mass.

use glam::DVec2;

use super::{Heading, Observable, Snapshot, Tabular};

/// The position of the center of mass, or NaN without disks.
///
/// It is $`\sum m_i\vec r_i/\sum m_i`$. Its `y` is the $`Y_{cm}`$ of the paper's Fig. 2.
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
        let mass: f64 = snapshot.disks().iter().map(crate::Disk::mass).sum();
        let moment: DVec2 = snapshot.disks().iter().map(|disk| disk.mass() * disk.position()).sum();
        moment / mass
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
