//! A GSD file: a header, an index of chunks, their names, and the chunks.

use std::fs::File;
use std::io;
use std::ops::Range;
use std::path::Path;

use super::{CHUNKS, ENTRY, HEADER, Shape, id, number, read_at, width, write_chunks};

use crate::format::no_frame;
use crate::one_file::{check_later, is_gzip};
use crate::recording::{Growing, Layout, Recording, Start};
use crate::{Frame, RecordError};

/// Number of entries for which the first index has room. A full index is followed by an index of twice its
/// size.
const ROOM: usize = 1024;

/// Number of the chunk with the time of a frame.
const TIME: usize = 16;

/// The frames in a GSD file, and its index: the position of the index, the number of entries for which it has
/// room, the entries, and the chunks of each frame. The entries are written in place.
///
/// A frame counts once the first of its entries is in the index. The chunks are therefore written first, then
/// the other entries, and the first entry last: a process that is killed meanwhile leaves bytes that no
/// reader sees.
struct Indexed {
    location: u64,
    room: usize,
    entries: Vec<u8>,
    places: Vec<Range<u64>>,
    /// True if the file was cut: its index lists frames, or its header names an index, that the file does not
    /// contain.
    is_cut: bool,
}

/// Opens a file. A name with an ending for compression is an error, since an index needs plain bytes.
pub(crate) fn open(path: &Path, start: Start) -> Result<Recording, RecordError> {
    if is_gzip(path) {
        let reason = "a GSD file is not compressed, so its name must not end in .gz";
        return Err(RecordError::unusable(path, reason));
    }
    let ((mut file, is_new), mut index) = (Growing::open(path, start)?, Indexed::first());
    let mut times = Vec::new();
    if is_new {
        let head = [header(index.location, ROOM as u64), vec![0; ROOM * ENTRY], names()].concat();
        file.push(&head, &[])?;
    } else {
        times = index.read(&file.file).map_err(RecordError::io("continue", path))?;
        file.resume(index.end(), Vec::new());
    }
    Recording::new(file, is_new, times, index)
}

impl Indexed {
    /// Returns the index of a file without frames.
    const fn first() -> Self {
        Self { location: HEADER as u64, room: ROOM, entries: Vec::new(), places: Vec::new(), is_cut: false }
    }

    /// Returns the position after the index and after everything that it lists.
    fn end(&self) -> u64 {
        let least = (HEADER + ROOM * ENTRY + names().len()) as u64;
        let frames = self.places.last().map_or(0, |place| place.end);
        least.max(self.location + (self.room * ENTRY) as u64).max(frames)
    }

    /// Writes entries of the index, from this one on.
    fn write_entries(&self, file: &Growing, first: usize, entries: &[u8]) -> Result<(), RecordError> {
        let place = self.location + (self.entries.len() + first * ENTRY) as u64;
        file.write_at(place, entries).map_err(RecordError::io("write to", &file.path))
    }

    fn write_header(&self, file: &Growing) -> Result<(), RecordError> {
        let header = header(self.location, self.room as u64);
        file.write_at(0, &header).map_err(RecordError::io("write to", &file.path))
    }

    fn write(&mut self, file: &mut Growing, shape: Shape, bytes: &[u8]) -> Result<(), RecordError> {
        if self.is_cut {
            self.mend(file)?;
        }
        if self.entries.len() / ENTRY + CHUNKS.len() > self.room {
            self.enlarge(file)?;
        }
        let start = file.length;
        file.push(bytes, &[])?;
        let (entries, end) = entries(shape, start);
        // An unfinished frame may have left more entries than this frame has.
        let mut others = entries[ENTRY..].to_vec();
        others.resize((CHUNKS.len() - 1) * ENTRY, 0);
        self.write_entries(file, 1, &others)?;
        self.write_entries(file, 0, &entries[..ENTRY])?;
        self.entries.extend(entries);
        self.places.push(start..end);
        Ok(())
    }

    /// Removes from the index everything that was lost when the file was cut, before other bytes are written
    /// at the same positions.
    fn mend(&mut self, file: &Growing) -> Result<(), RecordError> {
        self.write_entries(file, 0, &vec![0; self.room * ENTRY - self.entries.len()])?;
        self.write_header(file)?;
        self.is_cut = false;
        Ok(())
    }

    /// Writes the index again after the chunks, with twice the room. The header then points to it.
    fn enlarge(&mut self, file: &mut Growing) -> Result<(), RecordError> {
        let larger = Self { location: file.length, room: 2 * self.room, ..Self::first() };
        let mut entries = self.entries.clone();
        entries.resize(larger.room * ENTRY, 0);
        file.push(&entries, &[])?;
        larger.write_header(file)?;
        (self.location, self.room) = (larger.location, larger.room);
        Ok(())
    }

    /// Reads the index of a file, and returns the times of its whole frames.
    ///
    /// Each index but the first lies after the frames of the previous index, which stays unchanged. A file
    /// that lost its last index therefore has the frames of the previous index.
    fn read(&mut self, file: &File) -> io::Result<Vec<f64>> {
        let (size, head) = (file.metadata()?.len(), read_at(file, 0, HEADER as u64)?);
        let last = (number(&head, 8), number(&head, 16));
        check_header(&head, last)?;
        if size < self.end() {
            return Err(no_frame("a GSD file with its index", "a shorter one"));
        }
        let mut times = Vec::new();
        loop {
            self.read_frames(file, size, &mut times)?;
            let next = Self { location: self.end(), room: 2 * self.room, ..Self::first() };
            let is_last = (self.location, self.room as u64) == last;
            if is_last || self.is_cut || size < next.end() {
                self.is_cut |= !is_last;
                return Ok(times);
            }
            (self.location, self.room) = (next.location, next.room);
            if read_at(file, self.location, self.entries.len() as u64)? != self.entries {
                return Err(no_frame("an index that lists all frames", "another"));
            }
        }
    }

    /// Reads the frames that the present index lists beyond the known frames.
    fn read_frames(&mut self, file: &File, size: u64, times: &mut Vec<f64>) -> io::Result<()> {
        let known = self.entries.len();
        let entries = read_at(file, self.location + known as u64, (self.room * ENTRY - known) as u64)?;
        let mut rest = entries.as_slice();
        // The first entry of a frame is written last, so a frame with this entry was complete once.
        while rest.len() >= ENTRY && number(rest, 16) != 0 {
            let start = number(rest, 16);
            let (known, end) = self::entries(shape_at(rest, times.len()), start);
            let Some(after) = rest.strip_prefix(known.as_slice()).filter(|_| start == self.end()) else {
                return Err(no_frame("a whole frame", "a damaged one"));
            };
            if end > size {
                self.is_cut = true;
                return Ok(());
            }
            let time = known
                .chunks_exact(ENTRY)
                .find(|entry| id(entry) == TIME)
                .map_or(0, |entry| number(entry, 16));
            let time = f64::from_bits(number(&read_at(file, time, 8)?, 0));
            check_later(times, time)?;
            times.push(time);
            self.entries.extend(known);
            self.places.push(start..end);
            rest = after;
        }
        Ok(())
    }
}

impl Layout for Indexed {
    fn make(&self, frame: &Frame<'_>, bytes: &mut Vec<u8>) -> io::Result<()> {
        write_chunks(frame, bytes)
    }

    fn push(&mut self, file: &mut Growing, frame: &Frame<'_>, bytes: &[u8]) -> Result<(), RecordError> {
        let before = file.length;
        self.write(file, Shape::of(frame), bytes).inspect_err(|_| file.length = before)
    }

    fn has(&self, file: &Growing, number: usize, bytes: &[u8]) -> Result<bool, RecordError> {
        let place = self.places[number].clone();
        let there = read_at(&file.file, place.start, place.end - place.start);
        Ok(there.map_err(RecordError::io("read", &file.path))? == bytes)
    }
}

/// Checks that a file has the version that this crate writes, and an index of a size that this crate makes.
fn check_header(head: &[u8], (location, room): (u64, u64)) -> io::Result<()> {
    if head == header(location, room) && (room / ROOM as u64).is_power_of_two() {
        return Ok(());
    }
    let is_ours = head[48..].starts_with(b"granular-edmd");
    let found = if is_ours { "one of another version" } else { "another" };
    Err(no_frame("a GSD file by this version of granular-edmd", found))
}

/// Returns the header of a file with its index at this position, and room for this number of entries.
fn header(location: u64, room: u64) -> Vec<u8> {
    let numbers = [
        0x65DF_65DF_65DF_65DF,
        location,
        room,
        (HEADER + ROOM * ENTRY) as u64,
        (names().len() / 64) as u64,
        // The versions are 1.4 of the schema and 2.0 of the file format.
        1 << 16 | 4 | 2 << 48,
    ];
    let mut header: Vec<u8> = numbers.iter().flat_map(|number: &u64| number.to_le_bytes()).collect();
    for (text, end) in [("granular-edmd", 112), ("hoomd", HEADER)] {
        header.extend(text.as_bytes());
        header.resize(end, 0);
    }
    header
}

/// Returns the shape of the frame with the next entries.
fn shape_at(entries: &[u8], frame: usize) -> Shape {
    let is_of_frame = |entry: &&[u8]| number(entry, 0) == frame as u64;
    let own = || entries.chunks_exact(ENTRY).take(CHUNKS.len()).take_while(is_of_frame);
    let rows = |chunk| {
        let rows = own().find(|entry| id(entry) == chunk).map(|entry| number(entry, 8));
        rows.and_then(|rows| u32::try_from(rows).ok()).map_or(0, u64::from)
    };
    Shape { number: frame as u64, disks: rows(5), kinds: rows(4), walls: rows(20) }
}

/// Returns the entries of a frame whose chunks begin at byte `start`, and the position after the last chunk.
/// Chunks without rows have no entry.
fn entries(shape: Shape, start: u64) -> (Vec<u8>, u64) {
    let (mut entries, mut location) = (Vec::new(), start);
    for (id, &(_, kind, columns, rows_of)) in (0_u16..).zip(&CHUNKS) {
        let rows = rows_of(&shape);
        if rows > 0 {
            let numbers = [shape.number, rows, location];
            entries.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
            entries.extend(columns.to_le_bytes());
            entries.extend(id.to_le_bytes());
            entries.extend([kind, 0]);
        }
        location = location.saturating_add(rows * u64::from(columns) * width(kind));
    }
    (entries, location)
}

/// Returns the list of names, each followed by a zero, in whole pieces of 64 bytes.
fn names() -> Vec<u8> {
    let mut names: Vec<u8> = CHUNKS.iter().flat_map(|chunk| chunk.0.bytes().chain([0])).collect();
    names.resize((names.len() + 1).next_multiple_of(64), 0);
    names
}
