//! Logs: files that grow by complete pieces, each with a header, a checksum and contents.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::PathBuf;

use granular_edmd::file::{Damage, Locked};

/// First bytes of every log: its kind, and the version of the format.
const HEADING: [u8; START as usize] = *b"GRANSTUD\x07\0\0\0";

/// First bytes of every piece, by which the next piece is found after damage.
const MARK: [u8; 4] = *b"\xabPC\n";

/// Number of bytes in the header of a piece.
pub(crate) const HEAD: usize = 16;

/// Number of bytes before the contents of a piece: mark, header, length, a checksum of these three, and a
/// checksum of the contents.
const BEFORE: usize = 4 + HEAD + 4 + 8 + 16;

/// Number of bytes before the first piece.
pub(crate) const START: u64 = 12;

/// The number of the error with which Windows refuses to read a file that another process has locked.
const LOCKED_ON_WINDOWS: i32 = 33;

/// A log, up to the point to which it was read or written: a file to which the process appends that has
/// locked it, while any number of others may read.
///
/// A piece counts once it is whole. A writer that is killed, or a drive that is full, leaves no piece, or an
/// incomplete piece at the end, which the next piece overwrites.
#[derive(Debug)]
pub(crate) struct Log {
    pub(crate) path: PathBuf,
    /// End of the last complete piece.
    end: u64,
    /// True if bytes that are not a piece precede a piece.
    pub(crate) is_damaged: bool,
    /// The file, while this process appends to it.
    file: Option<Locked>,
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
}

impl Log {
    pub(crate) const fn new(path: PathBuf) -> Self {
        Self { path, end: 0, is_damaged: false, file: None, is_cut: false }
    }

    /// Returns the complete pieces that were added since the last reading. The checksums of the contents are
    /// not compared.
    ///
    /// # Errors
    /// If the file cannot be read, or has another format or version ([`io::ErrorKind::InvalidData`]).
    pub(crate) fn news(&mut self) -> io::Result<Vec<Piece>> {
        if self.file.is_some() {
            return Ok(Vec::new());
        }
        // Each time, the file is opened anew, since an NFS client asks for the present length only when it
        // opens a file.
        let found = File::open(&self.path).and_then(|file| self.read(&file));
        match found {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
            Err(error) if cfg!(windows) && error.raw_os_error() == Some(LOCKED_ON_WINDOWS) => Ok(Vec::new()),
            found => found,
        }
    }

    /// Begins to append to the file of this log, which this process has locked. Returns all its complete
    /// pieces.
    pub(crate) fn begin(&mut self, file: Locked) -> io::Result<Vec<Piece>> {
        (self.end, self.is_damaged, self.is_cut) = (0, false, false);
        let found = self.read(file.file())?;
        self.file = Some(file);
        if self.end < START {
            self.append(&HEADING)?;
        }
        Ok(found)
    }

    /// Releases the lock.
    pub(crate) fn leave(&mut self) {
        self.file = None;
    }

    fn read(&mut self, mut file: &File) -> io::Result<Vec<Piece>> {
        let (mut found, length) = (Vec::new(), file.seek(SeekFrom::End(0))?);
        if self.end >= length {
            return Ok(found);
        }
        file.seek(SeekFrom::Start(self.end))?;
        let mut input = BufReader::with_capacity(1 << 16, file);
        if self.end == 0 && !begins(&mut input)? {
            return Ok(found);
        }
        self.end = self.end.max(START);
        while let Some(piece) = next(&mut input, self.end, length)? {
            self.is_damaged |= piece.start - BEFORE as u64 != self.end;
            self.end = piece.start + u64::from(piece.length);
            found.push(piece);
        }
        Ok(found)
    }

    /// Appends a piece, completely or not at all.
    pub(crate) fn push(&mut self, head: [u8; HEAD], contents: &[u8]) -> io::Result<Piece> {
        let length = u32::try_from(contents.len()).map_err(io::Error::other)?;
        let mut bytes = Vec::with_capacity(BEFORE + contents.len());
        bytes.extend_from_slice(&MARK);
        bytes.extend_from_slice(&head);
        bytes.extend_from_slice(&length.to_le_bytes());
        bytes.extend_from_slice(&check(&bytes));
        bytes.extend_from_slice(&blake3::hash(contents).as_bytes()[..16]);
        bytes.extend_from_slice(contents);
        let start = self.end + BEFORE as u64;
        self.append(&bytes).map(|()| Piece { head, start, length })
    }

    /// Writes after the last complete piece. If the write fails, the incomplete bytes are removed, at the
    /// latest before the next write.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut file = self.locked()?.file();
        if !self.is_cut {
            file.set_len(self.end)?;
        }
        file.seek(SeekFrom::Start(self.end))?;
        let written = file.write_all(bytes);
        let is_cut = written.is_ok() || file.set_len(self.end).is_ok();
        self.is_cut = is_cut;
        written.inspect(|()| self.end += bytes.len() as u64)
    }

    /// Waits until the system has stored everything.
    pub(crate) fn sync(&self) -> io::Result<()> {
        self.locked()?.file().sync_data()
    }

    fn locked(&self) -> io::Result<&Locked> {
        self.file.as_ref().ok_or_else(|| io::Error::other("this process has not locked it"))
    }

    /// Reads the contents of a piece, or returns an error if they are damaged.
    pub(crate) fn contents(&self, piece: &Piece) -> io::Result<Result<Vec<u8>, Damage>> {
        match &self.file {
            Some(locked) => contents(locked.file(), piece),
            None => contents(&File::open(&self.path)?, piece),
        }
    }
}

fn contents(mut file: &File, piece: &Piece) -> io::Result<Result<Vec<u8>, Damage>> {
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
fn begins(input: &mut impl Read) -> io::Result<bool> {
    let mut start = Vec::new();
    input.take(START).read_to_end(&mut start)?;
    if HEADING.starts_with(&start) {
        return Ok(start.len() == HEADING.len());
    }
    let reason = "it is of another format, or of another version of it";
    Err(io::Error::new(io::ErrorKind::InvalidData, reason))
}

/// Finds the next complete piece at a position or after it, and moves to its end.
fn next(input: &mut BufReader<&File>, place: u64, length: u64) -> io::Result<Option<Piece>> {
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
fn search(input: &mut BufReader<&File>, place: u64, length: u64) -> io::Result<Option<Piece>> {
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
    (is_whole && start + u64::from(size) <= length).then_some(Piece { head, start, length: size })
}

fn check(bytes: &[u8]) -> [u8; 8] {
    blake3::hash(bytes).as_bytes().as_chunks().0[0]
}
