//! Files that grow by whole pieces.

use std::fs::{File, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use super::errors::RecordError;

/// Bytes that can grow and be cut: a file, or what stands for one in tests.
pub(super) trait Medium: Write + Seek {
    /// Cuts the bytes to this length.
    fn cut(&mut self, length: u64) -> io::Result<()>;
}

impl Medium for File {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.set_len(length)
    }
}

/// A file that grows by whole pieces: if a write fails, the piece is cut off again.
#[derive(Debug)]
pub(super) struct Growing<M> {
    medium: M,
    length: u64,
}

impl<M: Medium> Growing<M> {
    /// Goes on in a medium after so many bytes. What follows them is cut off by the first write.
    pub(super) const fn new(medium: M, length: u64) -> Self {
        Self { medium, length }
    }

    pub(super) const fn length(&self) -> u64 {
        self.length
    }

    pub(super) const fn medium(&self) -> &M {
        &self.medium
    }

    /// Adds a piece, and an ending that the next piece replaces. If that fails, the medium ends with the last
    /// whole piece.
    pub(super) fn push(&mut self, piece: &[u8], ending: &[u8]) -> io::Result<()> {
        let written = self.write(&[piece, ending].concat());
        if written.is_err() {
            // A failure to cut is ignored: the first error is the one to report, and the next reader finds the
            // last whole piece by itself.
            let _ = self.medium.cut(self.length).and_then(|()| self.write(ending));
            return written;
        }
        self.length += piece.len() as u64;
        Ok(())
    }

    /// Writes after the last whole piece, and cuts off what may follow.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.medium.seek(SeekFrom::Start(self.length))?;
        self.medium.write_all(bytes)?;
        self.medium.cut(self.length + bytes.len() as u64)
    }
}

/// Makes a new file for a recorder alone.
pub(super) fn create(path: &Path) -> Result<File, RecordError> {
    let made = File::options().read(true).write(true).create_new(true).open(path);
    let file = made.map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => RecordError::Exists { path: path.to_owned() },
        _ => RecordError::io("create", path)(error),
    })?;
    locked(file, path)
}

/// Opens a file for a recorder alone.
pub(super) fn reopen(path: &Path) -> Result<File, RecordError> {
    let file = File::options().read(true).write(true).open(path);
    locked(file.map_err(RecordError::io("open", path))?, path)
}

/// Takes the lock of a file, which ends with the process at the latest. It goes without where there are no
/// locks, and where a lock would keep others from reading.
fn locked(file: File, path: &Path) -> Result<File, RecordError> {
    match if cfg!(unix) { file.try_lock() } else { Ok(()) } {
        Err(TryLockError::WouldBlock) => Err(RecordError::Locked { path: path.to_owned() }),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// A disk on which there is room for so many bytes.
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

    /// Pieces of ten bytes and an ending of two on a disk of any size: after a failure, the whole pieces and
    /// the ending are there, and once there is room the same piece is written.
    #[test]
    fn a_full_disk_keeps_whole_pieces() {
        for room in 0..60 {
            let mut file = Growing::new(Small { bytes: Cursor::default(), room }, 0);
            let mut whole = Vec::new();
            let failed = (0..10).find(|&piece| file.push(&[b'0' + piece; 10], b"..").is_err()).unwrap();
            assert_eq!(usize::from(failed), room.saturating_sub(2) / 10);
            (0..failed).for_each(|piece| whole.extend([b'0' + piece; 10]));
            assert_eq!(file.length(), whole.len() as u64);
            let bytes = file.medium().bytes.get_ref();
            assert!(bytes.starts_with(&whole) && bytes.len() <= whole.len() + 2, "{room}");
            file.medium.room = 1000;
            file.push(&[b'0' + failed; 10], b"..").unwrap();
            whole.extend([b'0' + failed; 10]);
            assert_eq!(file.medium().bytes.get_ref(), &[whole.as_slice(), b".."].concat());
        }
    }
}
