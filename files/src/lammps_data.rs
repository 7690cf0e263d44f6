//! Data files of LAMMPS, so that one state can be run in both codes.

mod read;

pub(super) use read::{is_data, table};

use std::io::{self, Write};

use granular_edmd::Disk;

use super::State;
use super::disks::sphere_mass;
use super::format::{numbered, shown_depth, shown_top};

/// Words in the title that distinguish the files of this crate from other files.
const WRITER: &str = "written by granular-edmd";

impl State {
    /// Writes a data file of LAMMPS with `atom_style sphere`, for its `read_data`.
    ///
    /// The file has the box, the diameters, densities, positions, images, velocities and angular velocities.
    /// The type of an atom is the number of its [`Kind`](granular_edmd::Kind) plus 1. LAMMPS interprets the
    /// density as the density of a sphere, `ρ = 3m / 4πR³`. An open box ends above the highest disk, and a
    /// state without a box gets one around the disks. The title names the time and the periodic directions,
    /// which LAMMPS ignores. The format has no place for angles, inertia factors and walls.
    ///
    /// A [`Reader`](super::Reader) reads the file back to the same bits, except that a mass may differ by a
    /// rounding error.
    ///
    /// # Errors
    /// If the writer fails.
    pub fn write_lammps_data(&self, mut out: impl Write) -> io::Result<()> {
        let disks = &self.disks;
        let domain = self.snapshot().domain();
        let (top, half) = (shown_top(&domain, disks), 0.5 * shown_depth(disks));
        let types = disks.iter().map(|disk| u32::from(disk.kind().number()) + 1).max().unwrap_or(1);
        write!(out, "LAMMPS data file, atom_style sphere, {WRITER}")?;
        self.time.map_or(Ok(()), |time| write!(out, ", time = {time:?}"))?;
        let sides = [(domain.periodic_sides, "x"), (domain.periodic_ends, "y")];
        let sides: String = sides.into_iter().filter(|(is_so, _)| *is_so).map(|(_, name)| name).collect();
        write!(out, ", periodic = {}", if sides.is_empty() { "none" } else { &sides })?;
        writeln!(out, "\n\n{} atoms\n{types} atom types\n", disks.len())?;
        writeln!(out, "{:?} {:?} xlo xhi\n{:?} {top:?} ylo yhi", domain.left, domain.right, domain.bottom)?;
        writeln!(out, "{:?} {half:?} zlo zhi", -half)?;
        if !disks.is_empty() {
            writeln!(out, "\nAtoms # sphere\n")?;
            numbered(disks).try_for_each(|(id, disk)| write_atom(&mut out, id, disk))?;
            writeln!(out, "\nVelocities\n")?;
            numbered(disks).try_for_each(|(id, disk)| write_velocity(&mut out, id, disk))?;
        }
        out.flush()
    }
}

fn write_atom(out: &mut impl Write, id: u64, disk: &Disk) -> io::Result<()> {
    let (position, [right, up]) = (disk.position(), disk.image());
    let (kind, diameter) = (u32::from(disk.kind().number()) + 1, 2.0 * disk.radius());
    let density = density(disk.mass(), disk.radius());
    writeln!(out, "{id} {kind} {diameter:?} {density:?} {:?} {:?} 0.0 {right} {up} 0", position.x, position.y)
}

fn write_velocity(out: &mut impl Write, id: u64, disk: &Disk) -> io::Result<()> {
    let (velocity, turning) = (disk.velocity(), disk.angular_velocity());
    writeln!(out, "{id} {:?} {:?} 0.0 0.0 0.0 {turning:?}", velocity.x, velocity.y)
}

/// Returns the density of a sphere of this mass, or a neighboring number if only that gives back the same
/// mass.
fn density(mass: f64, radius: f64) -> f64 {
    let density = mass / sphere_mass(1.0, radius);
    let near = [density, density.next_up(), density.next_down()];
    near.into_iter().find(|&density| sphere_mass(density, radius) == mass).unwrap_or(density)
}
