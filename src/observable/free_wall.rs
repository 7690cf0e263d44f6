//! Walls with a mass.

use glam::DVec2;

use super::{Heading, Observable, Snapshot, Tabular};

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
/// The [`Energies`](super::Energies) of the disks, times their number, and the energies of these walls are
/// constant in a container of elastic disks at rest.
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

impl Tabular for FreeWall {
    fn headings(&self) -> Vec<Heading> {
        let names = [
            ("displacement_x", "length"),
            ("displacement_y", "length"),
            ("wall_velocity_x", "length/time"),
            ("wall_velocity_y", "length/time"),
            ("wall_energy", "energy"),
        ];
        names.map(Heading::from).into()
    }

    fn add_numbers(&self, value: &FreeWallMotion, row: &mut Vec<f64>) {
        let FreeWallMotion { displacement, velocity, energy } = value;
        row.extend([displacement.x, displacement.y, velocity.x, velocity.y, *energy]);
    }
}
