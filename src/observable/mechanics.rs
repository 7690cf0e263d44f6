//! Mechanics of the whole system: its center of mass, energies and granular temperatures per disk, and walls
//! with a mass.

use std::f64::consts::TAU;

use glam::DVec2;

use super::table::{ENERGY, tabular};
use super::{Grid, Heading, Observable, Snapshot, Tabular};
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

tabular! { CenterOfMass, center => {
    "center_x" ["length"]: center.x,
    "center_y" ["length"]: center.y,
}}

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
    /// Returns the sum of all three energies.
    pub fn total(&self) -> f64 {
        self.translational + self.rotational + self.potential
    }
}

/// The translational, rotational and potential energy, averaged over the disks; NaN without disks.
///
/// Walls with a mass have energies of their own: [`FreeWall`].
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

tabular! { Energies, energies => {
    "translational_energy" [ENERGY]: energies.translational,
    "rotational_energy" [ENERGY]: energies.rotational,
    "potential_energy" [ENERGY]: energies.potential,
}}

/// The motion of a wall or part with a mass, as a [`Piston`](crate::wall::Piston) has it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct FreeWallMotion {
    /// Displacement from the position at rest.
    pub displacement: DVec2,
    /// Velocity.
    pub velocity: DVec2,
    /// Energy, kinetic and potential.
    pub energy: f64,
}

/// The displacement, the velocity and the energy of a wall or part with a mass, which the disks push; NaN for
/// a wall without a mass, and for an unknown name.
///
/// The [`Energies`] of the disks, times their number, and the energies of these walls are constant in a
/// container of elastic disks at rest, as long as no wall reaches a stop.
///
/// ```
/// use granular_edmd::observable::FreeWall;
/// use granular_edmd::prelude::*;
/// use granular_edmd::wall::Piston;
///
/// let lid = Piston::new(4.0, [-3.0, 3.0])?.with_force(0.5)?.with_start(1.0, 0.0)?;
/// let container = Container::closed(6.0, 8.0)?.with_piston(Wall::Lid, lid)?;
/// let disk = Disk::new(DVec2::new(3.0, 2.0), 0.5)?;
/// let mut run = Simulation::builder(Elastic, container).disks([disk]).build()?;
/// run.run_until(2.0, &mut ())?;
/// // The force 1/2 accelerates the mass 4 inward, which is down.
/// let lid = run.measure(&FreeWall::named("lid"));
/// assert_eq!((lid.displacement.y, lid.velocity.y), (-1.25, -0.25));
/// assert_eq!(lid.energy, -0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FreeWall {
    name: String,
}

impl FreeWall {
    /// Creates the observable of the wall or part of this name.
    pub fn named(name: impl Into<String>) -> Self {
        Self { name: name.into() }
    }
}

impl Observable for FreeWall {
    type Value = FreeWallMotion;

    fn measure(&self, snapshot: &Snapshot<'_>) -> FreeWallMotion {
        let found = snapshot.walls().zip(0..).find(|(wall, _)| wall.name == self.name);
        let motion = found.and_then(|(wall, index)| {
            let ((displacement, _), velocity) = (wall.motion?, snapshot.wall_velocity(index)?);
            Some(FreeWallMotion { displacement, velocity, energy: wall.energy? })
        });
        let unknown = FreeWallMotion { displacement: DVec2::NAN, velocity: DVec2::NAN, energy: f64::NAN };
        motion.unwrap_or(unknown)
    }
}

tabular! { FreeWall, motion => {
    "displacement_x" ["length"]: motion.displacement.x,
    "displacement_y" ["length"]: motion.displacement.y,
    "wall_velocity_x" ["length/time"]: motion.velocity.x,
    "wall_velocity_y" ["length/time"]: motion.velocity.y,
    "wall_energy" [ENERGY]: motion.energy,
}}

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

tabular! { Temperatures, temperature => {
    "horizontal_temperature" [ENERGY]: temperature.horizontal,
    "vertical_temperature" [ENERGY]: temperature.vertical,
    "rotational_temperature" [ENERGY]: temperature.rotational,
}}

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
        let [horizontal, vertical, rotational] = [horizontal, vertical, rotational].map(|sum| sum / freedom);
        Temperature { horizontal, vertical, rotational }
    }
}

tabular! { TemperaturesAboutFlow, temperature => {
    "horizontal_temperature_about_flow" [ENERGY]: temperature.horizontal,
    "vertical_temperature_about_flow" [ENERGY]: temperature.vertical,
    "rotational_temperature_about_flow" [ENERGY]: temperature.rotational,
}}
