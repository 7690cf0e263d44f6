//! The kinds of disks: their constant properties.

use glam::DVec2;

use crate::Disk;
use crate::collision::Material;

/// The constant properties of a disk: radius, mass and inertia.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind {
    /// A disk of this kind at rest at the origin.
    pub(super) disk: Disk,
    pub(super) material: Material,
}

impl Kind {
    fn of(disk: &Disk) -> Self {
        let disk = disk.with_motion(DVec2::ZERO, DVec2::ZERO, 0.0, 0.0);
        Self { disk, material: Material::of(&disk) }
    }
}

/// One kind for all disks if they are equal, so that it stays in the cache; otherwise one for each.
#[derive(Debug, Clone)]
pub(super) enum Kinds {
    Same(Kind),
    /// The kind of each disk; the radii apart, since every prediction needs them.
    Each {
        kinds: Vec<Kind>,
        radii: Vec<f64>,
    },
}

impl Kinds {
    pub(super) fn of(disks: &[Disk]) -> Self {
        match disks.split_first() {
            Some((first, rest)) if rest.iter().all(|disk| is_alike(disk, first)) => {
                Self::Same(Kind::of(first))
            }
            _ => Self::Each {
                kinds: disks.iter().map(Kind::of).collect(),
                radii: disks.iter().map(Disk::radius).collect(),
            },
        }
    }

    /// Returns the median diameter, which does not depend on the order of the disks; 0 without disks.
    pub(super) fn typical_diameter(&self) -> f64 {
        match self {
            Self::Same(kind) => 2.0 * kind.material.radius,
            Self::Each { radii, .. } if radii.is_empty() => 0.0,
            Self::Each { radii, .. } => {
                let mut radii = radii.clone();
                let middle = radii.len() / 2;
                2.0 * *radii.select_nth_unstable_by(middle, f64::total_cmp).1
            }
        }
    }

    /// Returns one disk for each, or one for all.
    #[cfg(feature = "serde")]
    pub(super) fn disks(&self) -> Vec<Disk> {
        match self {
            Self::Same(kind) => vec![kind.disk],
            Self::Each { kinds, .. } => kinds.iter().map(|kind| kind.disk).collect(),
        }
    }

    /// Returns the diameter, if all disks have the same one.
    #[inline]
    pub(super) fn common_diameter(&self) -> Option<f64> {
        match self {
            Self::Same(kind) => Some(2.0 * kind.material.radius),
            Self::Each { .. } => None,
        }
    }

    #[inline]
    pub(super) fn radius(&self, disk: usize) -> f64 {
        match self {
            Self::Same(kind) => kind.material.radius,
            Self::Each { radii, .. } => radii[disk],
        }
    }

    #[inline]
    pub(super) fn get(&self, disk: usize) -> &Kind {
        match self {
            Self::Same(kind) => kind,
            Self::Each { kinds, .. } => &kinds[disk],
        }
    }
}

fn is_alike(disk: &Disk, other: &Disk) -> bool {
    let properties = |disk: &Disk| [disk.radius(), disk.mass(), disk.inertia_factor()];
    properties(disk) == properties(other)
}
