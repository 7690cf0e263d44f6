//! Granular temperatures about the mean flow.

use super::{Grid, Heading, Observable, Snapshot, Tabular, Temperature};

/// The temperatures about the mean flow, from the velocities minus the mean velocity in each cell of a grid.
///
/// With $`C`$ cells that hold disks and $`N`$ disks in the grid,
///
/// ```math
/// T_x = \frac1{N - C}\sum_i m_i (v_{i,x} - u_x)^2
/// ```
///
/// with $`u = \sum m v/\sum m`$ in the cell of the disk, and likewise for $`y`$ and the rotation about the
/// mean spin. A gas at rest has the same temperature on any grid, since each mean costs one degree of
/// freedom. Flow that varies within a cell still counts: a shear rate $`\gamma`$ across a cell of height
/// $`h`$ adds $`m\gamma^2h^2/12`$ to $`T_x`$. The values are NaN if no cell holds two disks.
///
/// ```
/// use granular_edmd::boundary::{Domain, Region};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{Grid, Observable, Snapshot, Temperatures, TemperaturesAboutFlow};
/// use granular_edmd::Disk;
///
/// // Two streams, one to the right and one to the left above it.
/// let disk = |x, y, vx| Disk::new(DVec2::new(x, y), 0.4)?.with_velocity(DVec2::new(vx, 0.0));
/// let disks = [disk(1.0, 0.5, 3.0)?, disk(3.0, 0.5, 3.0)?, disk(1.0, 1.5, -3.0)?, disk(3.0, 1.5, -3.0)?];
/// let snapshot = Snapshot::new(0.0, &disks, Domain::new(0.0, 4.0, 0.0, 2.0), 0.0);
/// let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::new(4.0, 2.0)), 1, 2)?;
/// assert_eq!(TemperaturesAboutFlow::new(grid).measure(&snapshot).horizontal, 0.0);
/// assert_eq!(Temperatures.measure(&snapshot).horizontal, 9.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct TemperaturesAboutFlow {
    grid: Grid,
}

impl TemperaturesAboutFlow {
    /// Creates temperatures about the mean velocity in each cell of this grid.
    ///
    /// Disks outside the grid are left out.
    pub const fn new(grid: Grid) -> Self {
        Self { grid }
    }
}

impl Observable for TemperaturesAboutFlow {
    type Value = Temperature;

    fn measure(&self, snapshot: &Snapshot<'_>) -> Temperature {
        let [mut horizontal, mut vertical, mut rotational, mut freedom] = [0.0; 4];
        for cell in self.grid.sums(snapshot).iter().filter(|cell| cell.count > 1) {
            horizontal += cell.velocity[0].squares;
            vertical += cell.velocity[1].squares;
            rotational += cell.angular_velocity.squares;
            freedom += (cell.count - 1) as f64;
        }
        Temperature::new(horizontal / freedom, vertical / freedom, rotational / freedom)
    }
}

impl Tabular for TemperaturesAboutFlow {
    fn headings(&self) -> Vec<Heading> {
        ["horizontal", "vertical", "rotational"]
            .map(|name| Heading::new(format!("{name}_temperature_about_flow"), "energy"))
            .into()
    }

    fn add_numbers(&self, value: &Temperature, row: &mut Vec<f64>) {
        row.extend([value.horizontal, value.vertical, value.rotational]);
    }
}
