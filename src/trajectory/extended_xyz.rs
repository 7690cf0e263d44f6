//! The extended XYZ format, which OVITO reads and from which a run can start.

mod keys;
mod read;

pub(super) use read::frames;

use std::io::{self, BufRead, Write};

use glam::DVec2;

use super::format::{Format, Frame, no_frame, skip_lines, whole_line};
use crate::boundary::Domain;
use crate::disk::numbered;
use crate::{Disk, Gravity};

/// The extended XYZ format: a number of disks, a line of keys, and a line for each disk.
///
/// | column | |
/// |---|---|
/// | `id` | id of the disk in the run |
/// | `species` | number of its [`Kind`](crate::Kind) |
/// | `pos`, `velo` | position and velocity of the center; `z` is 0 |
/// | `angle`, `angular_velocity` | in radians, counterclockwise |
/// | `radius`, `mass`, `inertia_factor` | as in [`Disk`] |
/// | `image` | periods that the disk has passed to the right and up, from [`Disk::image`] |
/// | `unwrapped` | position from [`Domain::unwrapped`] |
///
/// The keys are `Lattice`, `Origin` and `pbc`, which OVITO knows, and `Time`, `Gravity` and `Domain`
/// (left, right, bottom and top, where an open top is `inf`). Gravity is a number that points down, or the
/// two components of the acceleration. The lattice of an open box ends above the highest disk.
///
/// A [`Reader`](super::Reader) reads the disks back to the same bits.
///
/// ```
/// use granular_edmd::Disk;
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::Snapshot;
/// use granular_edmd::trajectory::{ExtendedXyz, Format, Frame, Reader};
///
/// let disks = [Disk::new(DVec2::new(0.1, 0.7), 0.5)?.with_velocity(DVec2::new(1.0 / 3.0, -2.0))?];
/// let snapshot = Snapshot::new(12.5, &disks, Domain::new(-1.0, 4.0, 0.0, f64::INFINITY), 1.0);
/// let mut text = Vec::new();
/// ExtendedXyz.write_frame(&Frame::new(0, &snapshot), &mut text)?;
/// let state = Reader::new().read_from(text.as_slice())?;
/// assert_eq!((state.disks(), state.time()), ([disks[0].with_id(1)?].as_slice(), Some(12.5)));
/// assert_eq!(state.domain(), Some(snapshot.domain()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct ExtendedXyz;

/// Columns of each disk.
const PROPERTIES: &str = "id:I:1:species:S:1:pos:R:3:velo:R:3:angle:R:1:angular_velocity:R:1:radius:R:1:mass:R:1:\
     inertia_factor:R:1:image:I:2:unwrapped:R:2";

impl Format for ExtendedXyz {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        let snapshot = frame.snapshot();
        let (domain, disks) = (snapshot.domain(), snapshot.disks());
        let Domain { left, right, bottom, top, .. } = domain;
        let height = shown_top(&domain, disks) - bottom;
        let depth = shown_depth(disks);
        writeln!(out, "{}", disks.len())?;
        write!(out, "Lattice=\"{:?} 0.0 0.0 0.0 {height:?} 0.0 0.0 0.0 {depth:?}\" ", domain.width())?;
        write!(out, "Origin=\"{left:?} {bottom:?} {:?}\" ", -0.5 * depth)?;
        write!(out, "pbc=\"{} {} F\" ", letter(domain.periodic_sides), letter(domain.periodic_ends))?;
        write!(out, "Properties={PROPERTIES} Time={:?} Gravity=", snapshot.time())?;
        write_gravity(out, snapshot.gravity())?;
        writeln!(out, " Domain=\"{left:?} {right:?} {bottom:?} {top:?}\"")?;
        numbered(disks).try_for_each(|(id, disk)| write_disk(out, id, disk, &domain))
    }

    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        let Some(count) = whole_line(input)? else { return Ok(None) };
        let count: usize = count.trim().parse().map_err(|_| no_frame("a number of disks", &count))?;
        let Some(keys) = whole_line(input)? else { return Ok(None) };
        let time = keys::Keys::parse(&keys, 0)
            .and_then(|keys| keys.time())
            .ok()
            .flatten()
            .ok_or_else(|| no_frame("the key `Time` and a number", &keys))?;
        Ok(skip_lines(input, count)?.then_some(time))
    }
}

/// Writes the number of gravity that points down, or else the acceleration.
fn write_gravity(out: &mut dyn Write, gravity: Gravity) -> io::Result<()> {
    if gravity.rightward() == 0.0 {
        return write!(out, "{:?}", gravity.downward());
    }
    let DVec2 { x, y } = gravity.acceleration();
    write!(out, "\"{x:?} {y:?}\"")
}

fn write_disk(out: &mut dyn Write, id: u64, disk: &Disk, domain: &Domain) -> io::Result<()> {
    let (position, velocity, unwrapped) = (disk.position(), disk.velocity(), domain.unwrapped(disk));
    let [right, up] = disk.image();
    write!(out, "{id} {} {:?} {:?} 0.0 ", disk.kind().number(), position.x, position.y)?;
    write!(out, "{:?} {:?} 0.0 {:?} {:?} ", velocity.x, velocity.y, disk.angle(), disk.angular_velocity())?;
    write!(out, "{:?} {:?} {:?} ", disk.radius(), disk.mass(), disk.inertia_factor())?;
    writeln!(out, "{right} {up} {:?} {:?}", unwrapped.x, unwrapped.y)
}

const fn letter(is_periodic: bool) -> char {
    if is_periodic { 'T' } else { 'F' }
}

/// Returns the top of the box, above the highest disk if the box is open, for programs that have no open
/// boxes.
pub(super) fn shown_top(domain: &Domain, disks: &[Disk]) -> f64 {
    if domain.top.is_finite() {
        return domain.top;
    }
    let highest = disks.iter().map(|disk| disk.position().y + 2.0 * disk.radius());
    highest.fold(domain.bottom + domain.width(), f64::max)
}

/// Returns the depth of the box: the diameter of the largest disk, or 1 without disks.
pub(super) fn shown_depth(disks: &[Disk]) -> f64 {
    let radius = disks.iter().map(Disk::radius).fold(0.0, f64::max);
    if radius > 0.0 { 2.0 * radius } else { 1.0 }
}
