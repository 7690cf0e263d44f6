//! Granular temperatures, also about the mean flow.

use super::{Grid, Heading, Observable, Snapshot, Tabular};
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
