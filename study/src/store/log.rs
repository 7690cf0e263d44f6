//! Logs: files that grow by complete pieces, each with a header, a checksum and contents.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

use granular_edmd::file::{Damage, Seal};

/// First bytes of every piece, by which the next piece is found after damage.
const MARK: [u8; 4] = *b"\xabPC\n";

/// Number of bytes in the header of a piece.
pub(crate) const HEAD: usize = 16;

/// Number of bytes before the contents of a piece: mark, header, length, a checksum of these three, and a
/// checksum of the contents.
const BEFORE: usize = 4 + HEAD + 4 + 8 + 16;

/// Number of bytes before the first piece: the first bytes and the version of the format.
pub(crate) const START: u64 = 12;

/// A log: a file to which one process appends, while any number of others may read.
///
/// A piece counts once it is whole. A writer that is killed, or a drive that is full, leaves no piece, or an
/// incomplete piece at the end, which the next piece overwrites. Nothing locks the file: the caller must make
/// sure that only one process appends.
#[derive(Debug)]
pub(crate) struct Log {
    file: File,
    /// End of the last complete piece.
    end: u64,
    /// True if nothing can follow the last complete piece.
    is_cut: bool,
}

/// The header of a piece, and the position of its contents.
///
/// A million pieces may be in memory, so this type is as small as possible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Piece {
    /// The header, for an index.
    pub(crate) head: [u8; HEAD],
    /// Position of the contents in the file.
    pub(crate) start: u64,
    /// Number of bytes of the contents.
    pub(crate) length: u32,
    /// Number by which the reader identifies the log.
    pub(crate) log: u32,
}

impl Log {
    /// Opens a log to append to it, and creates the log if it does not exist.
    pub(crate) fn open(path: &Path, seal: Seal) -> io::Result<Self> {
        let end = if path.exists() { pieces(path, seal, 0)?.end } else { 0 };
        let file = File::options().read(true).write(true).create(true).truncate(false).open(path)?;
        let mut log = Self { file, end, is_cut: false };
        if end < START {
            log.end = 0;
            log.append(&start(seal))?;
        }
        Ok(log)
    }

    /// Appends a piece, completely or not at all.
    pub(crate) fn push(&mut self, head: [u8; HEAD], contents: &[u8]) -> io::Result<()> {
        let length = u32::try_from(contents.len()).map_err(io::Error::other)?;
        let mut bytes = Vec::with_capacity(BEFORE + contents.len());
        bytes.extend_from_slice(&MARK);
        bytes.extend_from_slice(&head);
        bytes.extend_from_slice(&length.to_le_bytes());
        bytes.extend_from_slice(&check(&bytes));
        bytes.extend_from_slice(&blake3::hash(contents).as_bytes()[..16]);
        bytes.extend_from_slice(contents);
        self.append(&bytes)
    }

    /// Writes after the last complete piece. If the write fails, the incomplete bytes are removed, at the
    /// latest before the next write.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        if !self.is_cut {
            self.file.set_len(self.end)?;
        }
        self.file.seek(SeekFrom::Start(self.end))?;
        let written = self.file.write_all(bytes);
        self.is_cut = written.is_ok() || self.file.set_len(self.end).is_ok();
        written.inspect(|()| self.end += bytes.len() as u64)
    }

    /// Waits until the system has stored everything.
    pub(crate) fn sync(&self) -> io::Result<()> {
        self.file.sync_data()
    }
}

/// The complete pieces of a log from a position on.
#[derive(Debug)]
pub(crate) struct Pieces {
    pub(crate) found: Vec<Piece>,
    /// End of the last piece.
    pub(crate) end: u64,
    /// True if bytes that are not a piece precede a piece.
    pub(crate) is_damaged: bool,
}

/// Finds the complete pieces of a log from a position on: 0, or the end of an earlier reading. The checksums
/// of the contents are not compared.
///
/// # Errors
/// If the file cannot be read, or has another format or version ([`io::ErrorKind::InvalidData`]).
pub(crate) fn pieces(path: &Path, seal: Seal, from: u64) -> io::Result<Pieces> {
    let mut pieces = Pieces { found: Vec::new(), end: from, is_damaged: false };
    let mut file = File::open(path)?;
    let length = file.seek(SeekFrom::End(0))?;
    if from >= length {
        return Ok(pieces);
    }
    file.seek(SeekFrom::Start(from))?;
    let mut input = BufReader::with_capacity(1 << 16, file);
    if from == 0 && !begins(&mut input, seal)? {
        return Ok(pieces);
    }
    pieces.end = from.max(START);
    while let Some(piece) = next(&mut input, pieces.end, length)? {
        pieces.is_damaged |= piece.start - BEFORE as u64 != pieces.end;
        pieces.end = piece.start + u64::from(piece.length);
        pieces.found.push(piece);
    }
    Ok(pieces)
}

/// Reads the contents of a piece, or returns an error if they are damaged.
pub(crate) fn read_piece(file: &mut File, piece: &Piece) -> io::Result<Result<Vec<u8>, Damage>> {
    let mut bytes = vec![0; 16 + piece.length as usize];
    file.seek(SeekFrom::Start(piece.start - 16))?;
    match file.read_exact(&mut bytes) {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(Err(Damage::Cut)),
        read => read?,
    }
    let contents = bytes.split_off(16);
    Ok(if blake3::hash(&contents).as_bytes()[..16] == bytes { Ok(contents) } else { Err(Damage::Changed) })
}

/// Returns whether a log begins with the right bytes; false if it is cut short before their end.
fn begins(input: &mut impl Read, seal: Seal) -> io::Result<bool> {
    let mut start = Vec::new();
    input.take(START).read_to_end(&mut start)?;
    let expected = self::start(seal);
    if expected == start {
        return Ok(true);
    }
    if expected.starts_with(&start) {
        return Ok(false);
    }
    let reason = "it is of another format, or of another version of it";
    Err(io::Error::new(io::ErrorKind::InvalidData, reason))
}

/// Finds the next complete piece at a position or after it, and moves to its end.
fn next(input: &mut BufReader<File>, place: u64, length: u64) -> io::Result<Option<Piece>> {
    if length.saturating_sub(place) < BEFORE as u64 {
        return Ok(None);
    }
    let mut before = [0; BEFORE];
    input.read_exact(&mut before)?;
    let piece = match piece_of(&before, place, length) {
        Some(piece) => piece,
        None => match search(input, place, length)? {
            Some(piece) => piece,
            None => return Ok(None),
        },
    };
    input.seek_relative(i64::from(piece.length))?;
    Ok(Some(piece))
}

/// Finds a complete piece after bytes that are not a piece.
fn search(input: &mut BufReader<File>, place: u64, length: u64) -> io::Result<Option<Piece>> {
    let mut rest = Vec::new();
    input.seek(SeekFrom::Start(place))?;
    input.read_to_end(&mut rest)?;
    let mut places = rest.windows(BEFORE).enumerate().filter(|(_, bytes)| bytes.starts_with(&MARK));
    let found = places.find_map(|(at, bytes)| piece_of(bytes.first_chunk()?, place + at as u64, length));
    if let Some(piece) = found {
        input.seek(SeekFrom::Start(piece.start))?;
    }
    Ok(found)
}

/// Returns the complete piece that begins at a position of a file of this length, or `None` if no complete
/// piece begins there.
fn piece_of(before: &[u8; BEFORE], place: u64, length: u64) -> Option<Piece> {
    let (checked, rest) = before.split_at(4 + HEAD + 4);
    let head = *checked[4..].first_chunk()?;
    let size = u32::from_le_bytes(*checked.last_chunk()?);
    let start = place + BEFORE as u64;
    let is_whole = before.starts_with(&MARK) && check(checked) == rest[..8];
    (is_whole && start + u64::from(size) <= length).then_some(Piece { head, start, length: size, log: 0 })
}

/// Returns the bytes before the first piece.
fn start(seal: Seal) -> Vec<u8> {
    seal.seal(&[])[..START as usize].to_vec()
}

fn check(bytes: &[u8]) -> [u8; 8] {
    blake3::hash(bytes).as_bytes().as_chunks().0[0]
}
