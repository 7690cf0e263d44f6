//! GSD, the binary format of HOOMD-blue, for OVITO, freud and the Python package `gsd`.

mod indexed;
mod read;

pub(super) use indexed::Indexed;
pub(super) use read::{frames, is_gsd};

use std::io::{self, Write};

use super::extended_xyz::{shown_depth, shown_top};
use super::{Format, Frame};
use crate::Disk;
use crate::disk::numbered;
use crate::observable::Snapshot;

/// The format of a frame, as the bytes of its chunks, one after another. It stays inside this module, since
/// the file also needs an index, which [`Indexed`] keeps.
#[derive(Debug, Clone, Copy)]
pub(super) struct HoomdSchema;

/// The number of rows of a chunk.
#[derive(Debug, Clone, Copy)]
enum Rows {
    One,
    Six,
    /// One for each kind up to the largest.
    Kinds,
    Disks,
}

/// Codes of the types of numbers.
const U8: u8 = 1;
const U32: u8 = 3;
const U64: u8 = 4;
const I8: u8 = 5;
const I32: u8 = 7;
const F32: u8 = 9;
const F64: u8 = 10;

/// Bytes of the name of a kind: its number and a zero.
const NAME: usize = 6;

/// Numbers in double precision at the end of a frame; the first is its time.
const LOG: usize = 5;

/// The chunks of each frame in their order: name, type, numbers in a row, rows.
const CHUNKS: [(&str, u8, u32, Rows); 18] = [
    ("configuration/step", U64, 1, Rows::One),
    ("configuration/dimensions", U8, 1, Rows::One),
    ("configuration/box", F32, 1, Rows::Six),
    ("particles/N", U32, 1, Rows::One),
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
    ("log/time", F64, 1, Rows::One),
    ("log/gravity", F64, 2, Rows::One),
    ("log/center", F64, 2, Rows::One),
];

/// The shape of a frame: its number, its disks, and the number of kinds up to the largest.
#[derive(Debug, Clone, Copy)]
struct Shape {
    number: usize,
    disks: usize,
    kinds: usize,
}

impl Shape {
    fn of(number: usize, disks: &[Disk]) -> Self {
        let kinds = disks.iter().map(|disk| usize::from(disk.kind().number()) + 1).max().unwrap_or(1);
        Self { number, disks: disks.len(), kinds }
    }

    const fn rows(self, rows: Rows) -> u64 {
        match rows {
            Rows::One => 1,
            Rows::Six => 6,
            Rows::Kinds => self.kinds as u64,
            Rows::Disks => self.disks as u64,
        }
    }
}

impl Format for HoomdSchema {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        let (snapshot, disks) = (frame.snapshot(), frame.snapshot().disks());
        let Shape { kinds, .. } = Shape::of(frame.number(), disks);
        let Ok(count) = u32::try_from(disks.len()) else {
            return Err(io::Error::other("a file of GSD has room for 2^32 disks"));
        };
        let (center, [width, height]) = seen_box(snapshot);
        out.write_all(&(frame.number() as u64).to_le_bytes())?;
        out.write_all(&[2])?;
        // Of a box in the plane, readers ignore the depth. The last three numbers are its tilts.
        singles(out, [width, height, shown_depth(disks), 0.0, 0.0, 0.0])?;
        out.write_all(&count.to_le_bytes())?;
        for kind in 0..kinds {
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
        column(&half_turn, 4)?;
        column(&|disk| [disk.velocity().x, disk.velocity().y, 0.0, 0.0], 3)?;
        column(&angular_momentum, 4)?;
        for [right, up] in disks.iter().map(Disk::image) {
            [right, up, 0].iter().try_for_each(|image| out.write_all(&image.to_le_bytes()))?;
        }
        numbered(disks).try_for_each(|(id, _)| out.write_all(&id.to_le_bytes()))?;
        let gravity = snapshot.gravity().acceleration();
        let log: [f64; LOG] = [snapshot.time(), gravity.x, gravity.y, center[0], center[1]];
        log.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
    }
}

/// Returns the center and the size of the box that a file shows. In the file, positions count from the
/// center.
///
/// The center of an open box is on its bottom, since the center of a box that ends above the highest disk
/// would move, and with it the positions of all disks.
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

/// Returns the orientation as a quaternion, that is by half of the angle.
fn half_turn(disk: &Disk) -> [f64; 4] {
    let half = 0.5 * disk.angle();
    [libm::cos(half), 0.0, 0.0, libm::sin(half)]
}

/// Returns the angular momentum as HOOMD-blue has it: twice the orientation times the momentum in the frame
/// of the body, as quaternions.
fn angular_momentum(disk: &Disk) -> [f64; 4] {
    let ([real, _, _, up], momentum) = (half_turn(disk), moment_of_inertia(disk) * disk.angular_velocity());
    [-2.0 * up * momentum, 0.0, 0.0, 2.0 * real * momentum]
}

/// Writes numbers in single precision, which all readers of the schema expect.
fn singles(out: &mut dyn Write, numbers: impl IntoIterator<Item = f64>) -> io::Result<()> {
    numbers.into_iter().try_for_each(|number| out.write_all(&(number as f32).to_le_bytes()))
}
