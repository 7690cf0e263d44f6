//! A file of GSD: a header, an index of chunks, their names, and the chunks.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use super::{CHUNKS, F64, I8, LOG, Shape, U8, U64};
use crate::file::{Growing, Locked, Medium as _};
use crate::observable::Snapshot;
use crate::trajectory::RecordError;
use crate::trajectory::format::no_frame;
use crate::trajectory::media::{self, is_gzip};
use crate::trajectory::store::Store;

/// Bytes of the header, and of an entry of the index.
const HEADER: usize = 256;
const ENTRY: usize = 32;

/// Entries for which the first index has room. An index that is full is followed by one of twice its size.
const ROOM: usize = 1024;

/// A store of frames in a file of GSD.
///
/// A frame counts once the first of its entries is in the index. So the chunks are written first, then the
/// other entries, and the first entry at last: a process that dies meanwhile leaves bytes that nobody sees.
pub(in crate::trajectory) struct Indexed {
    /// All but the entries of the present index, which are written in place.
    file: Growing<Locked>,
    index: Index,
}

/// The index: its place and the number of entries for which it has room, the entries, and the frames that
/// they list.
#[derive(Default)]
struct Index {
    location: u64,
    room: usize,
    entries: Vec<u8>,
    times: Vec<f64>,
    /// The chunks of each frame.
    places: Vec<Range<u64>>,
}

impl Indexed {
    /// Begins a new file. A name that asks for compression is an error, since an index needs plain bytes.
    pub(in crate::trajectory) fn create(path: &Path) -> Result<Self, RecordError> {
        if is_gzip(path) {
            let reason = "a file of GSD is not compressed, so its name must not end in .gz";
            let error = io::Error::new(io::ErrorKind::InvalidInput, reason);
            return Err(RecordError::io("use", path)(error));
        }
        let mut file = media::create(path)?;
        let index = Index { location: HEADER as u64, room: ROOM, ..Index::default() };
        let head = [header(index.location, ROOM as u64), vec![0; ROOM * ENTRY], names()].concat();
        file.push(&head, &[]).map_err(|error| {
            // The file is new, and has nothing that could be lost.
            let _ = fs::remove_file(path);
            RecordError::io("write to", path)(error)
        })?;
        Ok(Self { file, index })
    }

    /// Goes on after the last whole frame of a file.
    pub(in crate::trajectory) fn reopen(path: &Path) -> Result<Self, RecordError> {
        let medium = media::reopen(path)?;
        let found = Index::read(medium.file());
        let (index, length) = found.map_err(RecordError::io("go on in", path))?;
        if index.times.is_empty() {
            return Err(RecordError::NoFrame { path: path.to_owned() });
        }
        Ok(Self { file: Growing::new(path, medium, length, Vec::new()), index })
    }

    fn push(&mut self, shape: Shape, bytes: &[u8]) -> io::Result<()> {
        if self.index.entries.len() / ENTRY + CHUNKS.len() > self.index.room {
            self.enlarge_index()?;
        }
        let start = self.file.length;
        self.file.push(bytes, &[])?;
        let (entries, end) = entries(shape, start);
        let place = self.index.location + self.index.entries.len() as u64;
        // A frame that was not finished may have left more entries than this one has.
        let mut others = entries[ENTRY..].to_vec();
        others.resize((CHUNKS.len() - 1) * ENTRY, 0);
        self.file.medium.write_at(place + ENTRY as u64, &others)?;
        self.file.medium.write_at(place, &entries[..ENTRY])?;
        self.index.entries.extend(entries);
        self.index.places.push(start..end);
        Ok(())
    }

    /// Writes the index again after the chunks, with twice the room. The header then points to it.
    fn enlarge_index(&mut self) -> io::Result<()> {
        let (location, room) = (self.file.length, 2 * self.index.room);
        let mut larger = self.index.entries.clone();
        larger.resize(room * ENTRY, 0);
        self.file.push(&larger, &[])?;
        self.file.medium.write_at(0, &header(location, room as u64))?;
        (self.index.location, self.index.room) = (location, room);
        Ok(())
    }
}

impl Store for Indexed {
    fn times(&self) -> &[f64] {
        &self.index.times
    }

    fn append(&mut self, snapshot: &Snapshot<'_>, bytes: &[u8]) -> Result<(), RecordError> {
        let shape = Shape::of(self.index.times.len(), snapshot.disks());
        self.push(shape, bytes).map_err(RecordError::io("write to", &self.file.path))?;
        self.index.times.push(snapshot.time());
        Ok(())
    }

    fn has(&mut self, number: usize, bytes: &[u8]) -> Result<bool, RecordError> {
        let place = self.index.places[number].clone();
        let there = read_at(self.file.medium.file(), place.start, place.end - place.start);
        Ok(there.map_err(RecordError::io("read", &self.file.path))? == bytes)
    }

    fn file(&self) -> &Growing<Locked> {
        &self.file
    }
}

impl Index {
    /// Reads the index of a file, and the number of bytes that the next frame must not overwrite.
    fn read(file: &File) -> io::Result<(Self, u64)> {
        let size = file.metadata()?.len();
        let head = read_at(file, 0, HEADER as u64)?;
        let (location, room) = (number(&head, 8), number(&head, 16));
        let mut index = Self { location, room: usize::try_from(room).unwrap_or(0), ..Self::default() };
        let end = room.checked_mul(ENTRY as u64).and_then(|bytes| bytes.checked_add(location));
        let Some(end) = end.filter(|&end| end <= size && head == header(location, room)) else {
            return Err(no_frame("a file of GSD by granular-edmd", "another"));
        };
        let entries = read_at(file, location, end - location)?;
        let least = (HEADER + ROOM * ENTRY + names().len()) as u64;
        let mut length = end.max(least);
        loop {
            let rest = &entries[index.entries.len()..];
            // The first entry of a frame is written last, so a frame that has it was whole once.
            if rest.len() < ENTRY || number(rest, 16) == 0 {
                return Ok((index, length));
            }
            let start = number(rest, 16);
            let shape = shape_at(rest, index.times.len());
            let known = shape.map(|shape| self::entries(shape, start));
            let Some((known, end)) = known.filter(|(known, end)| rest.starts_with(known) && *end <= size)
            else {
                return Err(no_frame("a whole frame", "a damaged one"));
            };
            let time = f64::from_bits(number(&read_at(file, end - (8 * LOG) as u64, 8)?, 0));
            if !time.is_finite() || index.times.last().is_some_and(|&last| last >= time) {
                return Err(no_frame("a frame after the one before", &format!("time {time:?}")));
            }
            index.entries.extend(known);
            index.times.push(time);
            index.places.push(start..end);
            length = length.max(end);
        }
    }
}

/// Returns the header of a file whose index is here, and has room for so many entries.
fn header(location: u64, room: u64) -> Vec<u8> {
    let numbers = [
        0x65DF_65DF_65DF_65DF,
        location,
        room,
        (HEADER + ROOM * ENTRY) as u64,
        (names().len() / 64) as u64,
        // Version 1.4 of the schema, and 2.0 of the file.
        1 << 16 | 4 | 2 << 48,
    ];
    let mut header: Vec<u8> = numbers.iter().flat_map(|number: &u64| number.to_le_bytes()).collect();
    for (text, end) in [("granular-edmd", 112), ("hoomd", HEADER)] {
        header.extend(text.as_bytes());
        header.resize(end, 0);
    }
    header
}

/// Returns the shape of the frame whose entries come next, if they can be those of a frame.
fn shape_at(entries: &[u8], number: usize) -> Option<Shape> {
    let rows = |index: usize| {
        let entry = entries.get(index * ENTRY..(index + 1) * ENTRY)?;
        let rows = u32::try_from(self::number(entry, 8)).ok()?;
        (usize::from(u16::from_le_bytes([entry[28], entry[29]])) == index).then_some(rows as usize)
    };
    Some(Shape { number, disks: rows(5).unwrap_or(0), kinds: rows(4)? })
}

/// Returns the entries of a frame whose chunks begin at this place, and the place after the chunks. Chunks
/// without rows have no entry.
fn entries(shape: Shape, start: u64) -> (Vec<u8>, u64) {
    let (mut entries, mut location) = (Vec::new(), start);
    for (id, &(_, kind, columns, rows)) in (0_u16..).zip(&CHUNKS) {
        let rows = shape.rows(rows);
        if rows > 0 {
            let numbers = [shape.number as u64, rows, location];
            entries.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
            entries.extend(columns.to_le_bytes());
            entries.extend(id.to_le_bytes());
            entries.extend([kind, 0]);
        }
        location = location.saturating_add(rows * u64::from(columns) * width(kind));
    }
    (entries, location)
}

/// Returns the bytes of a number of this type.
const fn width(kind: u8) -> u64 {
    match kind {
        U8 | I8 => 1,
        U64 | F64 => 8,
        _ => 4,
    }
}

/// Returns the list of names, each followed by a zero, in whole pieces of 64 bytes.
fn names() -> Vec<u8> {
    let mut names: Vec<u8> = CHUNKS.iter().flat_map(|chunk| chunk.0.bytes().chain([0])).collect();
    names.resize((names.len() + 1).next_multiple_of(64), 0);
    names
}

fn number(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..].as_chunks().0[0])
}

fn read_at(mut file: &File, start: u64, length: u64) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes)?;
    if bytes.len() as u64 == length { Ok(bytes) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
}
