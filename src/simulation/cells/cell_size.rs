//! Sizes of neighbor cells.

/// Size of the cells: small ones hold fewer neighbors, large ones are passed less often.
///
/// Where disks crowd, the smallest are the fastest; in a dilute gas, the largest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) enum CellSize {
    Small,
    Medium,
    Large,
}

impl CellSize {
    /// Size of a cell in diameters of the largest disk.
    pub(in crate::simulation) const fn pitch(self) -> f64 {
        match self {
            Self::Small => 1.08,
            Self::Medium => 1.4,
            Self::Large => 2.0,
        }
    }

    /// The mesh that suits disks which passed so many cells while they collided so often.
    ///
    /// The bounds are where runs of either mesh take as long, and far enough apart that none is changed to and fro.
    pub(in crate::simulation) fn suitable(self, cell_crossings: u64, collisions: u64) -> Self {
        let passed = cell_crossings as f64 / collisions as f64;
        match self {
            Self::Small if passed > 1.2 => Self::Medium,
            Self::Medium if passed > 1.45 => Self::Large,
            Self::Medium if passed < 0.45 => Self::Small,
            Self::Large if passed < 0.55 => Self::Medium,
            _ => self,
        }
    }
}
