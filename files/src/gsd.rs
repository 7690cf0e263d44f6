//! GSD, the binary format of HOOMD-blue, for OVITO, freud and the Python package `gsd`.

mod indexed;
mod read;

pub(super) use indexed::open;
pub(super) use read::{frames, is_gsd};

use std::collections::BTreeSet;
use std::io::{self, Read, Seek, SeekFrom, Write};

use granular_edmd::Disk;
use granular_edmd::observable::Snapshot;

use super::Frame;
use super::format::{half_turn, numbered, shown_depth, shown_top};
use crate::ReadError;

/// Returns the number of rows of a chunk.
type Rows = fn(&Shape) -> u64;

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
    ("configuration/step", U64, 1, |_| 1),
    ("configuration/dimensions", U8, 1, |_| 1),
    ("configuration/box", F32, 1, |_| 6),
    ("particles/N", U32, 1, |_| 1),
    ("particles/types", I8, NAME as u32, |shape| shape.kinds),
    ("particles/typeid", U32, 1, |shape| shape.disks),
    ("particles/mass", F32, 1, |shape| shape.disks),
    ("particles/diameter", F32, 1, |shape| shape.disks),
    ("particles/moment_inertia", F32, 3, |shape| shape.disks),
    ("particles/position", F32, 3, |shape| shape.disks),
    ("particles/orientation", F32, 4, |shape| shape.disks),
    ("particles/velocity", F32, 3, |shape| shape.disks),
    ("particles/angmom", F32, 4, |shape| shape.disks),
    ("particles/image", I32, 3, |shape| shape.disks),
    ("log/particles/id", U64, 1, |shape| shape.disks),
    ("log/periodic", U8, 1, |_| 2),
    ("log/time", F64, 1, |_| 1),
    ("log/gravity", F64, 1, |_| 2),
    ("log/center", F64, 1, |_| 2),
    ("log/domain", F64, 1, |_| 4),
    ("log/walls/index", U32, 1, |shape| shape.walls),
    ("log/walls/x", F64, 1, |shape| shape.walls),
    ("log/walls/y", F64, 1, |shape| shape.walls),
    ("log/walls/phase", F64, 1, |shape| shape.walls),
];

/// The shape of a frame: its number in the file, and its numbers of disks, of kinds (the largest kind plus
/// one), and of moving walls.
#[derive(Debug, Clone, Copy)]
struct Shape {
    number: u64,
    disks: u64,
    kinds: u64,
    walls: u64,
}

impl Shape {
    fn of(frame: &Frame<'_>) -> Self {
        let (disks, walls) = (frame.snapshot().disks(), frame.snapshot().moving_walls().len());
        let kinds = disks.iter().map(|disk| u64::from(disk.kind().number()) + 1).max().unwrap_or(1);
        Self { number: frame.number() as u64, disks: disks.len() as u64, kinds, walls: walls as u64 }
    }
}

/// Writes the chunks of a frame, one after another. The file also needs an index, which [`Indexed`] keeps.
fn write_chunks(frame: &Frame<'_>, out: &mut Vec<u8>) -> io::Result<()> {
    let (snapshot, disks, shape) = (frame.snapshot(), frame.snapshot().disks(), Shape::of(frame));
    let Ok(count) = u32::try_from(disks.len()) else {
        return Err(io::Error::other("a GSD file has room for 2^32 disks"));
    };
    let (center, [width, height]) = seen_box(snapshot);
    out.write_all(&shape.number.to_le_bytes())?;
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
    column(&|disk| [0.0, 0.0, disk.moment_of_inertia(), 0.0], 3)?;
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

/// Returns the angular momentum in HOOMD-blue's form: twice the orientation times the momentum in the frame
/// of the body, as quaternions.
fn angular_momentum(disk: &Disk) -> [f64; 4] {
    let ([real, up], momentum) = (half_turn(disk), disk.moment_of_inertia() * disk.angular_velocity());
    [-2.0 * up * momentum, 0.0, 0.0, 2.0 * real * momentum]
}

/// Writes numbers in single precision, which all readers of the schema expect.
fn singles(out: &mut dyn Write, numbers: impl IntoIterator<Item = f64>) -> io::Result<()> {
    numbers.into_iter().try_for_each(|number| out.write_all(&(number as f32).to_le_bytes()))
}

/// Numbers of bytes of the header, of an entry of the index, and of a name in the first version of the
/// format.
const HEADER: usize = 256;
const ENTRY: usize = 32;
const NAME_BYTES: usize = 64;

/// An open file. Only its names and its index are in memory.
struct Archive<R> {
    input: R,
    names: Vec<String>,
    /// The entries of the index, as raw bytes.
    entries: Vec<[u8; ENTRY]>,
    /// True if this crate wrote the file.
    is_own: bool,
    /// Numbers of the names that were requested.
    asked: BTreeSet<usize>,
}

/// The numbers of a chunk.
#[derive(Default)]
struct Chunk {
    rows: usize,
    columns: usize,
    kind: u8,
    bytes: Vec<u8>,
}

impl<R: Read + Seek> Archive<R> {
    fn open(mut input: R) -> Result<Self, ReadError> {
        let unread = |error: io::Error| ReadError::gsd(error.to_string());
        let head = read_at(&mut input, 0, HEADER as u64).map_err(unread)?;
        let version = u16::from_le_bytes([head[46], head[47]]);
        if !(1..=2).contains(&version) || !head[112..].starts_with(b"hoomd\0") {
            let schema = String::from_utf8_lossy(&head[112..124]);
            let found = format!("{version} with the schema {:?}", schema.trim_end_matches('\0'));
            let needed = "GSD must be version 1 or 2 with the schema \"hoomd\"";
            return Err(ReadError::gsd(format!("{needed}, not {found}")));
        }
        let mut list = |at: usize, size: usize| {
            let (start, count) = (number(&head, at), number(&head, at + 8));
            read_at(&mut input, start, count.saturating_mul(size as u64)).map_err(unread)
        };
        let (names, entries) = (list(24, NAME_BYTES)?, list(8, ENTRY)?);
        let entries = entries.as_chunks().0.iter().copied();
        let archive = Self {
            input,
            names: read_names(&names, version),
            entries: entries.take_while(|entry| number(entry, 16) != 0).collect(),
            asked: BTreeSet::new(),
            is_own: head[48..].starts_with(b"granular-edmd\0"),
        };
        // Each frame but the first has an entry, so a damaged number cannot claim an arbitrary number of
        // frames.
        let is_bounded = archive.frames() <= archive.entries.len() as u64 + 1;
        if is_bounded && archive.entries.is_sorted_by_key(|entry| number(entry, 0)) {
            return Ok(archive);
        }
        Err(ReadError::gsd("the index of the file is damaged"))
    }

    /// Returns the number of frames.
    fn frames(&self) -> u64 {
        self.entries.last().map_or(0, |last| number(last, 0).saturating_add(1))
    }

    /// Returns the names of the chunks that were never requested, although they have rows in this frame or in
    /// the first one.
    fn unread(&self, frame: u64) -> impl Iterator<Item = &str> {
        let is_filled =
            move |entry: &&[u8; ENTRY]| [0, frame].contains(&number(*entry, 0)) && number(*entry, 8) > 0;
        let filled = self.entries.iter().filter(is_filled);
        let filled: BTreeSet<usize> = filled.map(|entry| id(entry.as_slice())).collect();
        let unread = filled.into_iter().filter(|id| !self.asked.contains(id));
        unread.filter_map(|id| self.names.get(id)).map(String::as_str)
    }

    /// Reads a chunk of a frame. Returns `None` if the frame does not have the chunk.
    fn chunk(&mut self, frame: u64, name: &str) -> Result<Option<Chunk>, ReadError> {
        let Some(wanted) = self.names.iter().position(|known| known == name) else { return Ok(None) };
        self.asked.insert(wanted);
        let start = self.entries.partition_point(|entry| number(entry, 0) < frame);
        let mut entries = self.entries[start..].iter().take_while(|entry| number(*entry, 0) == frame);
        let Some(&entry) = entries.find(|entry| id(*entry) == wanted) else { return Ok(None) };
        let (rows, columns, kind) = (number(&entry, 8), number(&entry, 24) & 0xffff_ffff, entry[30]);
        let length = rows.saturating_mul(columns).saturating_mul(width(kind));
        let named = |error: io::Error| ReadError::gsd(format!("frame {frame}, chunk `{name}`: {error}"));
        let bytes = read_at(&mut self.input, number(&entry, 16), length).map_err(named)?;
        Ok(Some(Chunk { rows: rows as usize, columns: columns as usize, kind, bytes }))
    }
}

impl Chunk {
    /// Returns a number of the chunk, or NaN if the chunk does not have the number or its type is not known.
    ///
    /// If the chunk has one column, in single precision, the number is read from its shortest decimal form,
    /// so that 0.35 stays 0.35.
    fn number(&self, row: usize, column: usize) -> f64 {
        let (width, mut eight) = (width(self.kind) as usize, [0; 8]);
        let place = (row * self.columns + column) * width;
        let Some(bytes) = self.bytes.get(place..place + width) else { return f64::NAN };
        eight[..width].copy_from_slice(bytes);
        let first = u64::from_le_bytes(eight);
        match self.kind {
            1..=4 => first as f64,
            5 => f64::from(first as i8),
            6 => f64::from(first as i16),
            7 => f64::from(first as i32),
            8 => first.cast_signed() as f64,
            F32 if self.columns == 1 => f32::from_bits(first as u32).to_string().parse().unwrap_or(f64::NAN),
            F32 => f64::from(f32::from_bits(first as u32)),
            F64 => f64::from_bits(first),
            _ => f64::NAN,
        }
    }

    /// Returns these columns of all rows, row after row.
    fn numbers(&self, columns: &[usize]) -> Vec<f64> {
        let row = |row| columns.iter().map(move |&column| self.number(row, column));
        (0..self.rows).flat_map(row).collect()
    }
}

/// Returns how many bytes a number of this type has, or 0 if the type is not known.
const fn width(kind: u8) -> u64 {
    match kind {
        1 | 5 => 1,
        2 | 6 => 2,
        3 | 7 | F32 => 4,
        4 | 8 | F64 => 8,
        _ => 0,
    }
}

/// Returns the names of chunks. In version 1 each name fills 64 bytes; in later versions a zero byte ends it.
fn read_names(bytes: &[u8], version: u16) -> Vec<String> {
    let name = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim_end_matches('\0').to_owned();
    let names: Vec<String> = if version == 1 {
        bytes.chunks(NAME_BYTES).map(name).collect()
    } else {
        bytes.split(|&byte| byte == 0).map(name).collect()
    };
    names.into_iter().take_while(|name| !name.is_empty()).collect()
}

/// Returns the whole number at a position.
fn number(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..].as_chunks().0[0])
}

/// Returns the number of the chunk that an entry lists.
fn id(entry: &[u8]) -> usize {
    usize::from(u16::from_le_bytes([entry[28], entry[29]]))
}

/// Reads bytes, or returns an error if some are missing.
fn read_at(mut input: impl Read + Seek, start: u64, length: u64) -> io::Result<Vec<u8>> {
    input.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    input.take(length).read_to_end(&mut bytes)?;
    let cut = || io::Error::new(io::ErrorKind::UnexpectedEof, "the file is cut short");
    if bytes.len() as u64 == length { Ok(bytes) } else { Err(cut()) }
}
