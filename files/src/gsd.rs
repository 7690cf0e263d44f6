//! GSD, the binary format of HOOMD-blue, for OVITO, freud and the Python package `gsd`.

mod archive;
mod indexed;
mod read;

pub(super) use indexed::open;
pub(super) use read::{frames, frames_of_file, is_gsd};

use std::io::{self, Write};

use granular_edmd::Disk;
use granular_edmd::observable::Snapshot;

use super::Frame;
use super::format::{half_turn, numbered, shown_depth, shown_top};

/// The number of rows of a chunk.
#[derive(Debug, Clone, Copy)]
enum Rows {
    Fixed(u64),
    /// One row for each kind up to the largest.
    Kinds,
    Disks,
    /// One row for each moving wall.
    Walls,
}

/// Codes of the types of numbers.
const U8: u8 = 1;
const U32: u8 = 3;
const U64: u8 = 4;
const I8: u8 = 5;
const I32: u8 = 7;
const F32: u8 = 9;
const F64: u8 = 10;

/// Length of a kind's name in bytes: its decimal number and a terminating NUL.
const NAME: usize = 6;

/// The chunks of each frame in their order: name, type, numbers in a row, rows.
///
/// `read_log` of the package `gsd` interprets a chunk with one row as a single number, so a vector is stored
/// as a column.
const CHUNKS: [(&str, u8, u32, Rows); 24] = [
    ("configuration/step", U64, 1, Rows::Fixed(1)),
    ("configuration/dimensions", U8, 1, Rows::Fixed(1)),
    ("configuration/box", F32, 1, Rows::Fixed(6)),
    ("particles/N", U32, 1, Rows::Fixed(1)),
    ("particles/types", I8, NAME as u32, Rows::Kinds),
    ("particles/typeid", U32, 1, Rows::Disks),
    ("particles/mass", F32, 1, Rows::Disks),
    ("particles/diameter", F32, 1, Rows::Disks),
    ("particles/moment_inertia", F32, 3, Rows::Disks),
    ("particles/position", F32, 3, Rows::Disks),
    ("particles/orientation", F32, 4, Rows::Disks),
    ("particles/velocity", F32, 3, Rows::Disks),
    ("particles/angmom", F32, 4, Rows::Disks),
    ("particles/image", I32, 3, Rows::Disks),
    ("log/particles/id", U64, 1, Rows::Disks),
    ("log/periodic", U8, 1, Rows::Fixed(2)),
    ("log/time", F64, 1, Rows::Fixed(1)),
    ("log/gravity", F64, 1, Rows::Fixed(2)),
    ("log/center", F64, 1, Rows::Fixed(2)),
    ("log/domain", F64, 1, Rows::Fixed(4)),
    ("log/walls/index", U32, 1, Rows::Walls),
    ("log/walls/x", F64, 1, Rows::Walls),
    ("log/walls/y", F64, 1, Rows::Walls),
    ("log/walls/phase", F64, 1, Rows::Walls),
];

/// The shape of a frame: its number in the file, and its numbers of disks, of kinds (the largest kind plus
/// one), and of moving walls.
#[derive(Debug, Clone, Copy)]
struct Shape {
    number: usize,
    disks: usize,
    kinds: usize,
    walls: usize,
}

impl Shape {
    fn of(frame: &Frame<'_>) -> Self {
        let (disks, walls) = (frame.snapshot().disks(), frame.snapshot().moving_walls().len());
        let kinds = disks.iter().map(|disk| usize::from(disk.kind().number()) + 1).max().unwrap_or(1);
        Self { number: frame.number(), disks: disks.len(), kinds, walls }
    }

    const fn rows(self, rows: Rows) -> u64 {
        match rows {
            Rows::Fixed(rows) => rows,
            Rows::Kinds => self.kinds as u64,
            Rows::Disks => self.disks as u64,
            Rows::Walls => self.walls as u64,
        }
    }
}

/// Writes the chunks of a frame, one after another. The file also needs an index, which [`Indexed`] keeps.
fn write_chunks(frame: &Frame<'_>, out: &mut Vec<u8>) -> io::Result<()> {
    let (snapshot, disks, shape) = (frame.snapshot(), frame.snapshot().disks(), Shape::of(frame));
    let Ok(count) = u32::try_from(disks.len()) else {
        return Err(io::Error::other("a GSD file has room for 2^32 disks"));
    };
    let (center, [width, height]) = seen_box(snapshot);
    out.write_all(&(frame.number() as u64).to_le_bytes())?;
    out.write_all(&[2])?;
    // Readers ignore the depth of a two-dimensional box. The last three numbers are its tilts.
    singles(out, [width, height, shown_depth(disks), 0.0, 0.0, 0.0])?;
    out.write_all(&count.to_le_bytes())?;
    for kind in 0..shape.kinds {
        let mut name = [0; NAME];
        write!(name.as_mut_slice(), "{kind}")?;
        out.write_all(&name)?;
    }
    disks.iter().try_for_each(|disk| out.write_all(&u32::from(disk.kind().number()).to_le_bytes()))?;
    let mut column = |numbers: &dyn Fn(&Disk) -> [f64; 4], columns: usize| {
        disks.iter().try_for_each(|disk| singles(out, numbers(disk).into_iter().take(columns)))
    };
    column(&|disk| [disk.mass(); 4], 1)?;
    column(&|disk| [2.0 * disk.radius(); 4], 1)?;
    column(&|disk| [0.0, 0.0, moment_of_inertia(disk), 0.0], 3)?;
    column(&|disk| [disk.position().x - center[0], disk.position().y - center[1], 0.0, 0.0], 3)?;
    column(&|disk| [half_turn(disk)[0], 0.0, 0.0, half_turn(disk)[1]], 4)?;
    column(&|disk| [disk.velocity().x, disk.velocity().y, 0.0, 0.0], 3)?;
    column(&angular_momentum, 4)?;
    for [right, up] in disks.iter().map(Disk::image) {
        [right, up, 0].iter().try_for_each(|image| out.write_all(&image.to_le_bytes()))?;
    }
    numbered(disks).try_for_each(|(id, _)| out.write_all(&id.to_le_bytes()))?;
    write_log(snapshot, center, out);
    Ok(())
}

/// Writes the numbers of the whole frame, in double precision.
fn write_log(snapshot: &Snapshot<'_>, [x, y]: [f64; 2], out: &mut Vec<u8>) {
    let (domain, gravity) = (snapshot.domain(), snapshot.gravity().acceleration());
    out.extend([domain.periodic_sides, domain.periodic_ends].map(u8::from));
    let numbers = [snapshot.time(), gravity.x, gravity.y, x, y];
    let walls = snapshot.moving_walls();
    let edges = [domain.left, domain.right, domain.bottom, domain.top];
    out.extend(numbers.iter().chain(&edges).flat_map(|number| number.to_le_bytes()));
    out.extend(walls.iter().flat_map(|wall| (wall.0 as u32).to_le_bytes()));
    out.extend(walls.iter().flat_map(|wall| wall.1.x.to_le_bytes()));
    out.extend(walls.iter().flat_map(|wall| wall.1.y.to_le_bytes()));
    out.extend(walls.iter().flat_map(|wall| wall.2.to_le_bytes()));
}

/// Returns the center and the size of the box in a file. In the file, positions are measured from the center.
///
/// The center of an open box is on its bottom. The middle of such a box moves with the highest disk, and all
/// positions relative to the middle would move, too.
fn seen_box(snapshot: &Snapshot<'_>) -> ([f64; 2], [f64; 2]) {
    let domain = snapshot.domain();
    let (x, width) = (0.5 * (domain.left + domain.right), domain.width());
    let height = shown_top(&domain, snapshot.disks()) - domain.bottom;
    if domain.top.is_finite() {
        ([x, domain.bottom + 0.5 * height], [width, height])
    } else {
        ([x, domain.bottom], [width, 2.0 * height])
    }
}

fn moment_of_inertia(disk: &Disk) -> f64 {
    disk.inertia_factor() * disk.mass() * disk.radius() * disk.radius()
}

/// Returns the angular momentum in HOOMD-blue's form: twice the orientation times the momentum in the frame
/// of the body, as quaternions.
fn angular_momentum(disk: &Disk) -> [f64; 4] {
    let ([real, up], momentum) = (half_turn(disk), moment_of_inertia(disk) * disk.angular_velocity());
    [-2.0 * up * momentum, 0.0, 0.0, 2.0 * real * momentum]
}

/// Writes numbers in single precision, which all readers of the schema expect.
fn singles(out: &mut dyn Write, numbers: impl IntoIterator<Item = f64>) -> io::Result<()> {
    numbers.into_iter().try_for_each(|number| out.write_all(&(number as f32).to_le_bytes()))
}
