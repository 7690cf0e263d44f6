//! Sizes of neighbor cells.

/// Number of cells of the smallest class that is allowed however few disks there are.
pub(super) const SPARE_SMALL_CELLS: f64 = 64.0;

/// Width of a cell in free paths, per unit of [`CellSize::pitch`].
pub(super) const FREE_PATHS: f64 = 3.0;

/// The size of the cells. Small cells hold fewer neighbors, and large cells are left less often.
///
/// The smallest cells are best where disks crowd, and the largest cells in a dilute gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) enum CellSize {
    Small,
    #[default]
    Medium,
    Large,
}

impl CellSize {
    /// Returns the size of a cell in diameters of the largest disk.
    pub(in crate::simulation) const fn pitch(self) -> f64 {
        match self {
            Self::Small => 1.08,
            Self::Medium => 1.4,
            Self::Large => 2.0,
        }
    }

    /// Returns the size that suits disks with these numbers of cell crossings and collisions in the same
    /// time.
    ///
    /// At each bound, runs with either size take equally long. The bounds are far enough apart that no run
    /// alternates between two sizes.
    pub(in crate::simulation) fn suitable(self, cell_crossings: u64, collisions: u64) -> Self {
        // Without collisions, this is NaN or infinite. NaN leaves the size unchanged, since all comparisons
        // fail, and infinity means the largest cells, as it should.
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
