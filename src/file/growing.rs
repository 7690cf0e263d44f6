//! Files that grow by complete pieces.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::Locked;

/// A medium that can be written and cut off: a file, or a stand-in for tests.
pub(crate) trait Medium {
    /// Writes bytes from a position on.
    fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<()>;
    /// Cuts the medium to this length.
    fn cut(&mut self, length: u64) -> io::Result<()>;
}

impl Medium for Locked {
    fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
        let mut file = self.file();
        file.seek(SeekFrom::Start(place))?;
        file.write_all(bytes)
    }

    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.file().set_len(length)
    }
}

/// A file that grows by complete pieces. If a write fails, the piece is cut off again.
#[derive(Debug)]
pub(crate) struct Growing<M: Medium> {
    pub(crate) path: PathBuf,
    pub(crate) medium: M,
    pub(crate) length: u64,
    /// The ending that follows the last whole piece.
    ending: Vec<u8>,
    /// True if nothing can follow the ending.
    is_cut: bool,
}

impl<M: Medium> Growing<M> {
    /// Resumes writing after the first `length` bytes, which this ending follows. The first write cuts off
    /// all other bytes.
    pub(crate) fn new(path: &Path, medium: M, length: u64, ending: Vec<u8>) -> Self {
        Self { path: path.to_owned(), medium, length, ending, is_cut: false }
    }

    /// Adds a piece, and replaces the last ending by a new one. If that fails, the medium is as before.
    pub(crate) fn push(&mut self, piece: &[u8], ending: &[u8]) -> io::Result<()> {
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

    /// Writes after the last complete piece, and cuts off everything that may follow.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let is_covered = self.is_cut && bytes.len() >= self.ending.len();
        self.is_cut = false;
        self.medium.write_at(self.length, bytes)?;
        if !is_covered {
            self.medium.cut(self.length + bytes.len() as u64)?;
        }
        self.is_cut = true;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drive with room for a limited number of bytes.
    struct Small {
        bytes: Vec<u8>,
        room: usize,
    }

    impl Medium for Small {
        fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
            let place = place as usize;
            let fitting = &bytes[..bytes.len().min(self.room.saturating_sub(place))];
            self.bytes.truncate(place);
            self.bytes.extend(fitting);
            if fitting == bytes { Ok(()) } else { Err(io::ErrorKind::StorageFull.into()) }
        }

        fn cut(&mut self, length: u64) -> io::Result<()> {
            self.bytes.truncate(length as usize);
            Ok(())
        }
    }

    /// Writes pieces of ten bytes, each with an ending of two bytes that identifies the piece, to drives of
    /// many sizes. After a failure the medium is unchanged, and once there is room the same piece can be
    /// written.
    #[test]
    fn a_full_disk_keeps_whole_pieces() {
        for room in 0..60 {
            let mut file = Growing::new(Path::new(""), Small { bytes: Vec::new(), room }, 0, Vec::new());
            let mut whole = Vec::new();
            for piece in b'0'.. {
                let before = file.medium.bytes.clone();
                if file.push(&[piece; 10], &[piece; 2]).is_err() {
                    assert_eq!(file.medium.bytes, before, "{room}");
                    assert_eq!(usize::from(piece - b'0'), room.saturating_sub(2) / 10);
                    file.medium.room = 1000;
                    file.push(&[piece; 10], &[piece; 2]).unwrap();
                    whole.extend([piece; 12]);
                    assert_eq!(file.medium.bytes, whole);
                    break;
                }
                whole.extend([piece; 10]);
                assert_eq!(file.length, whole.len() as u64);
            }
        }
    }
}
