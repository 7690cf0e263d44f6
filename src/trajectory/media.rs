//! Files that grow by whole pieces.

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use super::errors::RecordError;
use crate::file::Locked;

/// Bytes that can be appended and cut off: a file, or its stand-in for tests.
pub(super) trait Medium: Write + Seek {
    /// Cuts the bytes to this length.
    fn cut(&mut self, length: u64) -> io::Result<()>;
}

impl Medium for Locked {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.file().set_len(length)
    }
}

/// A file that grows by whole pieces. If a write fails, the piece is cut off again.
#[derive(Debug)]
pub(super) struct Growing<M: Medium> {
    medium: M,
    length: u64,
    /// The ending that follows the last whole piece.
    ending: Vec<u8>,
}

impl<M: Medium> Growing<M> {
    /// Resumes writing after the first `length` bytes, which this ending follows. The first write cuts off
    /// all other bytes.
    pub(super) const fn new(medium: M, length: u64, ending: Vec<u8>) -> Self {
        Self { medium, length, ending }
    }

    pub(super) const fn length(&self) -> u64 {
        self.length
    }

    pub(super) const fn medium(&self) -> &M {
        &self.medium
    }

    /// Adds a piece, and replaces the last ending by a new one. If that fails, the medium is as before.
    pub(super) fn push(&mut self, piece: &[u8], ending: &[u8]) -> io::Result<()> {
        let written = self.write(&[piece, ending].concat());
        if written.is_err() {
            // A failure of this repair is ignored: the first error is the one to report, and the next reader
            // finds the last whole piece by itself.
            let before = self.ending.clone();
            let _ = self.medium.cut(self.length).and_then(|()| self.write(&before));
            return written;
        }
        self.length += piece.len() as u64;
        self.ending = ending.to_vec();
        Ok(())
    }

    /// Writes into the pieces that are there already.
    pub(super) fn overwrite(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
        self.medium.seek(SeekFrom::Start(place))?;
        self.medium.write_all(bytes)
    }

    /// Writes after the last whole piece, and cuts off what may follow.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.medium.seek(SeekFrom::Start(self.length))?;
        self.medium.write_all(bytes)?;
        self.medium.cut(self.length + bytes.len() as u64)
    }
}

/// Creates a new file, locked for one recorder.
pub(super) fn create(path: &Path) -> Result<Locked, RecordError> {
    let made = File::options().read(true).write(true).create_new(true).open(path);
    let file = made.map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => RecordError::Exists { path: path.to_owned() },
        _ => RecordError::io("create", path)(error),
    })?;
    locked(file, path)
}

/// Opens a file, locked for one recorder.
pub(super) fn reopen(path: &Path) -> Result<Locked, RecordError> {
    let file = File::options().read(true).write(true).open(path);
    locked(file.map_err(RecordError::io("open", path))?, path)
}

/// Locks a file; the lock ends with the process at the latest.
fn locked(file: File, path: &Path) -> Result<Locked, RecordError> {
    Locked::take_if_possible(file).map_err(|_| RecordError::Locked { path: path.to_owned() })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// A drive with room for this many bytes.
    struct Small {
        bytes: Cursor<Vec<u8>>,
        room: usize,
    }

    impl Seek for Small {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.bytes.seek(to)
        }
    }

    impl Write for Small {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let left = self.room.saturating_sub(self.bytes.position() as usize);
            if left == 0 && !bytes.is_empty() {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.bytes.write(&bytes[..left.min(bytes.len())])
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Medium for Small {
        fn cut(&mut self, length: u64) -> io::Result<()> {
            self.bytes.get_mut().truncate(length as usize);
            Ok(())
        }
    }

    /// Writes pieces of ten bytes, each with an ending of two that names the piece, to drives of many sizes.
    /// After a failure the medium is as it was, and once there is room the same piece can be written.
    #[test]
    fn a_full_disk_keeps_whole_pieces() {
        for room in 0..60 {
            let mut file = Growing::new(Small { bytes: Cursor::default(), room }, 0, Vec::new());
            let mut whole = Vec::new();
            for piece in b'0'.. {
                let before = file.medium().bytes.get_ref().clone();
                if file.push(&[piece; 10], &[piece; 2]).is_err() {
                    assert_eq!(file.medium().bytes.get_ref(), &before, "{room}");
                    assert_eq!(usize::from(piece - b'0'), room.saturating_sub(2) / 10);
                    file.medium.room = 1000;
                    file.push(&[piece; 10], &[piece; 2]).unwrap();
                    whole.extend([piece; 12]);
                    assert_eq!(file.medium().bytes.get_ref(), &whole);
                    break;
                }
                whole.extend([piece; 10]);
                assert_eq!(file.length(), whole.len() as u64);
            }
        }
    }
}
