//! A file of GSD by any program: its names, its index, and its chunks.

use std::io::{Read, Seek, SeekFrom};

use super::{F32, F64};
use crate::trajectory::ReadError;

/// Bytes of the header, of an entry of the index, and of a name in the first version of the format.
const HEADER: u64 = 256;
const ENTRY: u64 = 32;
const NAME: usize = 64;

/// An open file. Only its names and its index are in memory.
pub(super) struct Archive<R> {
    input: R,
    size: u64,
    names: Vec<String>,
    entries: Vec<Entry>,
    /// True if this crate wrote the file.
    pub(super) is_own: bool,
}

/// An entry of the index.
#[derive(Clone, Copy)]
struct Entry {
    frame: u64,
    rows: u64,
    location: u64,
    columns: u32,
    id: u16,
    kind: u8,
}

/// The numbers of a chunk.
#[derive(Default)]
pub(super) struct Chunk {
    pub(super) rows: usize,
    pub(super) columns: usize,
    kind: u8,
    pub(super) bytes: Vec<u8>,
}

impl<R: Read + Seek> Archive<R> {
    pub(super) fn open(mut input: R) -> Result<Self, ReadError> {
        let size = input.seek(SeekFrom::End(0)).map_err(|error| ReadError::gsd(error.to_string()))?;
        let mut archive = Self { input, size, names: Vec::new(), entries: Vec::new(), is_own: false };
        let head = archive.bytes(0, HEADER)?;
        let number = |at: usize| u64::from_le_bytes(head[at..].as_chunks().0[0]);
        let (index, room, names, length) = (number(8), number(16), number(24), number(32));
        let version = u16::from_le_bytes([head[46], head[47]]);
        if !(1..=2).contains(&version) || !head[112..].starts_with(b"hoomd\0") {
            let schema = String::from_utf8_lossy(&head[112..124]);
            let found = format!("{version} with the schema {:?}", schema.trim_end_matches('\0'));
            return Err(ReadError::gsd(format!(
                "GSD must be version 1 or 2 with the schema \"hoomd\", not {found}"
            )));
        }
        archive.is_own = head[48..].starts_with(b"granular-edmd\0");
        let names = archive.bytes(names, length.saturating_mul(NAME as u64))?;
        archive.names = read_names(&names, version);
        let entries = archive.bytes(index, room.saturating_mul(ENTRY))?;
        let entries = entries.chunks_exact(ENTRY as usize).map(Entry::read);
        archive.entries = entries.take_while(|entry| entry.location != 0).collect();
        let is_known = |entry: &Entry| usize::from(entry.id) < archive.names.len();
        // Each frame but the first has an entry, so a damaged number cannot ask for any number of frames.
        let is_bounded = archive.frames() <= archive.entries.len() as u64 + 1;
        let is_sorted = archive.entries.is_sorted_by_key(|entry| entry.frame);
        if is_bounded && is_sorted && archive.entries.iter().all(is_known) {
            return Ok(archive);
        }
        Err(ReadError::gsd("the index of the file is damaged"))
    }

    /// Returns the number of frames.
    pub(super) fn frames(&self) -> u64 {
        self.entries.last().map_or(0, |last| last.frame.saturating_add(1))
    }

    /// Returns the names of all chunks.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// Reads a chunk of a frame, if it is there.
    pub(super) fn chunk(&mut self, frame: u64, name: &str) -> Result<Option<Chunk>, ReadError> {
        let Some(id) = self.names.iter().position(|known| known == name) else { return Ok(None) };
        let start = self.entries.partition_point(|entry| entry.frame < frame);
        let mut entries = self.entries[start..].iter().take_while(|entry| entry.frame == frame);
        let Some(&entry) = entries.find(|entry| usize::from(entry.id) == id) else { return Ok(None) };
        let named = |error: ReadError| ReadError::gsd(format!("frame {frame}, chunk `{name}`: {error}"));
        let width =
            width(entry.kind).ok_or_else(|| named(ReadError::gsd("its numbers are of no known type")))?;
        let length = entry.rows.saturating_mul(u64::from(entry.columns)).saturating_mul(width);
        let bytes = self.bytes(entry.location, length).map_err(named)?;
        let (rows, columns) = (entry.rows as usize, entry.columns as usize);
        Ok(Some(Chunk { rows, columns, kind: entry.kind, bytes }))
    }

    /// Reads bytes, none of which may lie beyond the end of the file.
    fn bytes(&mut self, start: u64, length: u64) -> Result<Vec<u8>, ReadError> {
        if start.checked_add(length).is_none_or(|end| end > self.size) {
            return Err(ReadError::gsd("the file ends before it; it is cut short"));
        }
        let mut bytes = vec![0; length as usize];
        let read = self.input.seek(SeekFrom::Start(start)).and_then(|_| self.input.read_exact(&mut bytes));
        read.map(|()| bytes).map_err(|error| ReadError::gsd(error.to_string()))
    }
}

impl Entry {
    fn read(bytes: &[u8]) -> Self {
        let number = |at: usize| u64::from_le_bytes(bytes[at..].as_chunks().0[0]);
        Self {
            frame: number(0),
            rows: number(8),
            location: number(16),
            columns: number(24) as u32,
            id: u16::from_le_bytes([bytes[28], bytes[29]]),
            kind: bytes[30],
        }
    }
}

impl Chunk {
    /// Returns a number of the chunk.
    pub(super) fn number(&self, row: usize, column: usize) -> f64 {
        let number = row * self.columns + column;
        let bytes = |width: usize| self.bytes.get(number * width..).unwrap_or_default();
        let first = |width: usize| {
            let mut eight = [0; 8];
            let there = &bytes(width)[..width.min(bytes(width).len())];
            eight[..there.len()].copy_from_slice(there);
            u64::from_le_bytes(eight)
        };
        match self.kind {
            1 => first(1) as f64,
            2 => first(2) as f64,
            3 => first(4) as f64,
            4 => first(8) as f64,
            5 => f64::from(first(1) as i8),
            6 => f64::from(first(2) as i16),
            7 => f64::from(first(4) as i32),
            8 => first(8).cast_signed() as f64,
            F32 => f64::from(f32::from_bits(first(4) as u32)),
            F64 => f64::from_bits(first(8)),
            _ => f64::NAN,
        }
    }

    /// Returns whether the numbers are in single precision.
    pub(super) const fn is_single(&self) -> bool {
        self.kind == F32
    }

    /// Returns a number in the digits that single precision shows, so that 0.35 is 0.35.
    pub(super) fn decimal(&self, row: usize) -> f64 {
        let number = self.number(row, 0);
        let shown = self.is_single().then(|| (number as f32).to_string().parse().ok());
        shown.flatten().unwrap_or(number)
    }
}

/// Returns the bytes of a number of this type.
const fn width(kind: u8) -> Option<u64> {
    match kind {
        1 | 5 => Some(1),
        2 | 6 => Some(2),
        3 | 7 | F32 => Some(4),
        4 | 8 | F64 => Some(8),
        _ => None,
    }
}

/// Returns the names of chunks, each of 64 bytes in the first version, and else one after another.
fn read_names(bytes: &[u8], version: u16) -> Vec<String> {
    let name = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim_end_matches('\0').to_owned();
    let names = if version == 1 {
        bytes.chunks(NAME).map(name).collect()
    } else {
        bytes.split(|&byte| byte == 0).map(name).collect()
    };
    let names: Vec<String> = names;
    names.into_iter().take_while(|name| !name.is_empty()).collect()
}
