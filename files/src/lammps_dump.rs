//! Dump files in the format of LAMMPS.

mod read;

pub(super) use read::frames;

use std::io::{self, BufRead, Write};

use super::format::{no_frame, skip_lines, whole_line};
use super::shown::{numbered, shown_depth, shown_top};
use super::{Frame, FrameFormat};
use granular_edmd::Disk;
use granular_edmd::boundary::Domain;

/// The dump format of LAMMPS, as `dump custom` writes it.
///
/// | column | |
/// |---|---|
/// | `id`, `type` | id of the disk in the run; number of its [`Kind`](granular_edmd::Kind) plus 1 |
/// | `x y z`, `xu yu` | position of the center, also unwrapped; `z` is 0 |
/// | `ix iy` | periods that the disk has passed to the right and up |
/// | `vx vy` | velocity of the center |
/// | `angle`, `omegaz` | angle and angular velocity in radians, counterclockwise |
/// | `radius`, `mass` | of the disk |
/// | `v_time` | time of the frame |
///
/// The time step is the number of the frame. Periodic directions are `pp`, walls are `ff`. An open box is
/// `fs`, and ends above the highest disk. The format has no place for inertia factors, gravity and walls that
/// move.
///
/// The time is a column, since some programs, such as MDAnalysis, do not know `ITEM: TIME`. Only a frame
/// without disks has that item.
///
/// ```
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::Snapshot;
/// use granular_edmd_files::{Frame, FrameFormat, LammpsDump};
/// # use granular_edmd::{Disk, glam::DVec2};
///
/// let disks = [Disk::new(DVec2::new(1.0, 2.0), 0.5)?];
/// let snapshot = Snapshot::new(2.5, &disks, Domain::new(0.0, 4.0, 0.0, 6.0).with_periodic_sides(), 1.0);
/// let mut text = Vec::new();
/// LammpsDump.write_frame(&Frame::new(0, &snapshot), &mut text)?;
/// let text = String::from_utf8(text)?;
/// assert!(text.starts_with("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\n"));
/// assert!(text.contains("ITEM: BOX BOUNDS pp ff pp\n0.0 4.0\n0.0 6.0\n"));
/// assert!(text.ends_with(" 0.5 1.0 2.5\n"), "radius, mass and time");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct LammpsDump;

/// The line above the disks.
const COLUMNS: &str = "ITEM: ATOMS id type x y z xu yu ix iy vx vy angle omegaz radius mass v_time";

impl FrameFormat for LammpsDump {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        let snapshot = frame.snapshot();
        let (time, domain, disks) = (snapshot.time(), snapshot.domain(), snapshot.disks());
        let (top, half) = (shown_top(&domain, disks), 0.5 * shown_depth(disks));
        let sides = if domain.periodic_sides { "pp" } else { "ff" };
        let open = if domain.top.is_finite() { "ff" } else { "fs" };
        let ends = if domain.periodic_ends { "pp" } else { open };
        if disks.is_empty() {
            writeln!(out, "ITEM: TIME\n{time:?}")?;
        }
        writeln!(out, "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}", frame.number(), disks.len())?;
        writeln!(out, "ITEM: BOX BOUNDS {sides} {ends} pp\n{:?} {:?}", domain.left, domain.right)?;
        writeln!(out, "{:?} {top:?}\n{:?} {half:?}\n{COLUMNS}", domain.bottom, -half)?;
        numbered(disks).try_for_each(|(id, disk)| {
            write_disk(out, id, disk, &domain)?;
            writeln!(out, " {time:?}")
        })
    }

    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        match whole_frame(input) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
            time => time.map(Some),
        }
    }
}

/// Skips a frame, and returns its time, or an error if the frame is cut short.
fn whole_frame(input: &mut dyn BufRead) -> io::Result<f64> {
    let (mut name, mut time) = (line(input)?, None);
    if name == "ITEM: TIME" {
        time = Some(line(input)?);
        name = line(input)?;
    }
    check("ITEM: TIMESTEP", &name)?;
    line(input)?;
    check("ITEM: NUMBER OF ATOMS", &line(input)?)?;
    let count = line(input)?;
    let count: usize = count.parse().map_err(|_| no_frame("a number of atoms", &count))?;
    check("ITEM: BOX BOUNDS", &line(input)?)?;
    (0..3).try_for_each(|_| line(input).map(drop))?;
    let columns = line(input)?;
    if columns != COLUMNS {
        return Err(no_frame("the columns of this version", &columns));
    }
    let is_in_row = time.is_none() && count > 0;
    let time = if is_in_row { line(input)? } else { time.unwrap_or_default() };
    let time = time.rsplit(' ').next().unwrap_or_default();
    let time = time.parse().map_err(|_| no_frame("a time", time))?;
    let is_whole = skip_lines(input, count - usize::from(is_in_row))?;
    if is_whole { Ok(time) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
}

/// Returns the next line, which must be complete.
fn line(input: &mut dyn BufRead) -> io::Result<String> {
    whole_line(input)?.ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
}

/// Checks that a line begins with this name.
fn check(name: &str, line: &str) -> io::Result<()> {
    if line.starts_with(name) { Ok(()) } else { Err(no_frame(&format!("`{name}`"), line)) }
}

fn write_disk(out: &mut dyn Write, id: u64, disk: &Disk, domain: &Domain) -> io::Result<()> {
    let (position, velocity, unwrapped) = (disk.position(), disk.velocity(), domain.unwrapped(disk));
    let [right, up] = disk.image();
    write!(out, "{id} {} {:?} {:?} 0.0 ", u32::from(disk.kind().number()) + 1, position.x, position.y)?;
    write!(out, "{:?} {:?} {right} {up} {:?} {:?} ", unwrapped.x, unwrapped.y, velocity.x, velocity.y)?;
    write!(out, "{:?} {:?} ", disk.angle(), disk.angular_velocity())?;
    write!(out, "{:?} {:?}", disk.radius(), disk.mass())
}
