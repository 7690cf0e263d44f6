//! A GSD file of any program: its names, its index, and its chunks.

use std::collections::BTreeSet;
use std::io::{self, Read, Seek, SeekFrom};

use super::{F32, F64};
use crate::ReadError;

/// Numbers of bytes of the header, of an entry of the index, and of a name in the first version of the
/// format.
pub(super) const HEADER: usize = 256;
pub(super) const ENTRY: usize = 32;
const NAME: usize = 64;

/// An open file. Only its names and its index are in memory.
pub(super) struct Archive<R> {
    input: R,
    pub(super) names: Vec<String>,
    /// The entries of the index, as raw bytes.
    entries: Vec<[u8; ENTRY]>,
    /// True if this crate wrote the file.
    pub(super) is_own: bool,
    /// Numbers of the names that were requested.
    asked: BTreeSet<usize>,
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
        let (names, entries) = (list(24, NAME)?, list(8, ENTRY)?);
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
    pub(super) fn frames(&self) -> u64 {
        self.entries.last().map_or(0, |last| number(last, 0).saturating_add(1))
    }

    /// Returns the names of the chunks that were never requested, although they have rows in this frame or in
    /// the first one.
    pub(super) fn unread(&self, frame: u64) -> impl Iterator<Item = &str> {
        let is_filled =
            move |entry: &&[u8; ENTRY]| [0, frame].contains(&number(*entry, 0)) && number(*entry, 8) > 0;
        let filled = self.entries.iter().filter(is_filled);
        let filled: BTreeSet<usize> = filled.map(|entry| id(entry.as_slice())).collect();
        let unread = filled.into_iter().filter(|id| !self.asked.contains(id));
        unread.filter_map(|id| self.names.get(id)).map(String::as_str)
    }

    /// Reads a chunk of a frame. Returns `None` if the frame does not have the chunk.
    pub(super) fn chunk(&mut self, frame: u64, name: &str) -> Result<Option<Chunk>, ReadError> {
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
    pub(super) fn number(&self, row: usize, column: usize) -> f64 {
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

    /// Returns whether the numbers are in single precision.
    pub(super) const fn is_single(&self) -> bool {
        self.kind == F32
    }
}

/// Returns how many bytes a number of this type has, or 0 if the type is not known.
pub(super) const fn width(kind: u8) -> u64 {
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
        bytes.chunks(NAME).map(name).collect()
    } else {
        bytes.split(|&byte| byte == 0).map(name).collect()
    };
    names.into_iter().take_while(|name| !name.is_empty()).collect()
}

/// Returns the whole number at a position.
pub(super) fn number(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..].as_chunks().0[0])
}

/// Returns the number of the chunk that an entry lists.
pub(super) fn id(entry: &[u8]) -> usize {
    usize::from(u16::from_le_bytes([entry[28], entry[29]]))
}

/// Reads bytes, or returns an error if some are missing.
pub(super) fn read_at(mut input: impl Read + Seek, start: u64, length: u64) -> io::Result<Vec<u8>> {
    input.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    input.take(length).read_to_end(&mut bytes)?;
    let cut = || io::Error::new(io::ErrorKind::UnexpectedEof, "the file is cut short");
    if bytes.len() as u64 == length { Ok(bytes) } else { Err(cut()) }
}
