//! Dump files in the format of LAMMPS.

mod read;

pub(super) use read::frames;

use std::io::{self, BufRead, Write};

use super::extended_xyz::{shown_depth, shown_top};
use super::format::{Format, Frame, no_frame, skip_lines, whole_line};
use crate::Disk;
use crate::boundary::Domain;
use crate::disk::numbered;

/// The dump format of LAMMPS, as `dump custom` writes it with `units yes time yes`.
///
/// | column | |
/// |---|---|
/// | `id`, `type` | id of the disk in the run; number of its [`Kind`](crate::Kind) plus 1 |
/// | `x y z`, `xu yu` | position of the center, also unwrapped; `z` is 0 |
/// | `ix iy` | periods that the disk has passed to the right and up |
/// | `vx vy` | velocity of the center |
/// | `angle`, `omegaz` | angle and angular velocity in radians, counterclockwise |
/// | `radius`, `mass` | of the disk |
///
/// The time step is the number of the frame, and the units are called `lj`. Periodic directions are `pp`,
/// walls are `ff`. An open box is `fs`, and ends above the highest disk.
///
/// ```
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::Snapshot;
/// use granular_edmd::trajectory::{Format, Frame, LammpsDump};
///
/// let snapshot = Snapshot::new(2.5, &[], Domain::new(0.0, 4.0, 0.0, 6.0).with_periodic_sides(), 1.0);
/// let mut text = Vec::new();
/// LammpsDump.write_frame(&Frame::new(0, &snapshot), &mut text)?;
/// let text = String::from_utf8(text)?;
/// assert!(text.starts_with("ITEM: UNITS\nlj\nITEM: TIME\n2.5\nITEM: TIMESTEP\n0\n"));
/// assert!(text.contains("ITEM: BOX BOUNDS pp ff pp\n0.0 4.0\n0.0 6.0\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct LammpsDump;

/// The line above the disks.
const COLUMNS: &str = "ITEM: ATOMS id type x y z xu yu ix iy vx vy angle omegaz radius mass";

impl Format for LammpsDump {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        let snapshot = frame.snapshot();
        let (domain, disks) = (snapshot.domain(), snapshot.disks());
        let (top, half) = (shown_top(&domain, disks), 0.5 * shown_depth(disks));
        let sides = if domain.periodic_sides { "pp" } else { "ff" };
        let open = if domain.top.is_finite() { "ff" } else { "fs" };
        let ends = if domain.periodic_ends { "pp" } else { open };
        // Units appear once in a file: if they came again, OVITO would find only the first frame.
        if frame.number() == 0 {
            writeln!(out, "ITEM: UNITS\nlj")?;
        }
        writeln!(out, "ITEM: TIME\n{:?}", snapshot.time())?;
        writeln!(out, "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}", frame.number(), disks.len())?;
        writeln!(out, "ITEM: BOX BOUNDS {sides} {ends} pp\n{:?} {:?}", domain.left, domain.right)?;
        writeln!(out, "{:?} {top:?}\n{:?} {half:?}\n{COLUMNS}", domain.bottom, -half)?;
        numbered(disks).try_for_each(|(id, disk)| write_disk(out, id, disk, &domain))
    }

    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        let Some(name) = whole_line(input)? else { return Ok(None) };
        let time = if name == "ITEM: UNITS" {
            let Some(_) = whole_line(input)? else { return Ok(None) };
            item(input, "ITEM: TIME")?
        } else {
            after("ITEM: TIME", &name, input)?
        };
        let Some(time) = time else { return Ok(None) };
        let Some(_) = item(input, "ITEM: TIMESTEP")? else { return Ok(None) };
        let Some(count) = item(input, "ITEM: NUMBER OF ATOMS")? else { return Ok(None) };
        let time = time.parse().map_err(|_| no_frame("a time", &time))?;
        let count: usize = count.parse().map_err(|_| no_frame("a number of atoms", &count))?;
        let Some(_) = item(input, "ITEM: BOX BOUNDS")? else { return Ok(None) };
        // Two more lines of the box, and the names of the columns.
        Ok(skip_lines(input, count.saturating_add(3))?.then_some(time))
    }
}

/// Skips a line that must begin with this name, and returns the line after it.
fn item(input: &mut dyn BufRead, name: &str) -> io::Result<Option<String>> {
    let Some(line) = whole_line(input)? else { return Ok(None) };
    after(name, &line, input)
}

/// Checks that a line begins with this name, and returns the line after it.
fn after(name: &str, line: &str, input: &mut dyn BufRead) -> io::Result<Option<String>> {
    if line.starts_with(name) { whole_line(input) } else { Err(no_frame(&format!("`{name}`"), line)) }
}

fn write_disk(out: &mut dyn Write, id: u64, disk: &Disk, domain: &Domain) -> io::Result<()> {
    let (position, velocity, unwrapped) = (disk.position(), disk.velocity(), domain.unwrapped(disk));
    let [right, up] = disk.image();
    write!(out, "{id} {} {:?} {:?} 0.0 ", u32::from(disk.kind().number()) + 1, position.x, position.y)?;
    write!(out, "{:?} {:?} {right} {up} {:?} {:?} ", unwrapped.x, unwrapped.y, velocity.x, velocity.y)?;
    write!(out, "{:?} {:?} ", disk.angle(), disk.angular_velocity())?;
    writeln!(out, "{:?} {:?}", disk.radius(), disk.mass())
}
