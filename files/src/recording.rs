//! Files of recordings, which grow frame by frame, and by complete pieces.

use std::fs::{File, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::{Frame, RecordError};

/// The files that a recorder may open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// A file that does not exist yet.
    New,
    /// A file with frames.
    Old,
    /// A file with frames, an empty file, or none.
    Either,
}

/// The file of a recording or, for a series, the file of its times; with the times of the frames.
pub struct Recording {
    pub(super) file: Growing,
    pub(super) times: Vec<f64>,
    pub(super) layout: Box<dyn Layout + Send + Sync>,
}

impl Recording {
    /// Creates the recording in a file, or an error if the file should have frames and has none.
    pub(super) fn new(
        file: Growing,
        is_new: bool,
        times: Vec<f64>,
        layout: impl Layout + Send + Sync + 'static,
    ) -> Result<Self, RecordError> {
        if times.is_empty() && !is_new {
            return Err(RecordError::NoFrame { path: file.path.clone() });
        }
        Ok(Self { file, times, layout: Box::new(layout) })
    }
}

/// The arrangement of the bytes of frames in one or several files.
pub(super) trait Layout {
    /// Returns the bytes of a frame.
    fn make(&self, frame: &Frame<'_>, bytes: &mut Vec<u8>) -> io::Result<()>;

    /// Adds a frame. If that fails, the file is as before.
    fn push(&mut self, file: &mut Growing, frame: &Frame<'_>, bytes: &[u8]) -> Result<(), RecordError>;

    /// Returns whether the frame of this number has these bytes.
    fn has(&self, file: &Growing, number: usize, bytes: &[u8]) -> Result<bool, RecordError>;
}

/// A file that grows by complete pieces. If a write fails, the piece is cut off again.
///
/// On Unix, the file is locked for one recorder. Elsewhere, a lock could keep other programs from reading it.
#[derive(Debug)]
pub(super) struct Growing {
    pub(super) path: PathBuf,
    pub(super) file: File,
    /// Number of bytes up to the end of the last complete piece.
    pub(super) length: u64,
    /// The ending that follows the last complete piece.
    ending: Vec<u8>,
    /// True if nothing can follow the ending.
    is_cut: bool,
}

impl Growing {
    /// Opens a file, and returns it with the information whether it is empty.
    pub(super) fn open(path: &Path, start: Start) -> Result<(Self, bool), RecordError> {
        let mut options = File::options();
        options.read(true).write(true).create(start == Start::Either).create_new(start == Start::New);
        let file = options.open(path).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => RecordError::Exists { path: path.to_owned() },
            _ => RecordError::io("open", path)(error),
        })?;
        if cfg!(unix) && matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
            return Err(RecordError::Locked { path: path.to_owned() });
        }
        let is_empty = file.metadata().map_err(RecordError::io("open", path))?.len() == 0;
        let growing = Self { path: path.to_owned(), file, length: 0, ending: Vec::new(), is_cut: false };
        Ok((growing, is_empty && start != Start::Old))
    }

    /// Resumes writing after the first `length` bytes, which this ending follows. The first write cuts off
    /// all other bytes.
    pub(super) fn resume(&mut self, length: u64, ending: Vec<u8>) {
        (self.length, self.ending) = (length, ending);
    }

    /// Adds a piece, and replaces the last ending by a new one. If that fails, the file is as before.
    pub(super) fn push(&mut self, piece: &[u8], ending: &[u8]) -> Result<(), RecordError> {
        let written = self.write(&[piece, ending].concat());
        if written.is_err() {
            // A failure of this repair is ignored: the first error is the one to report, and the next reader
            // finds the last whole piece by itself.
            let before = self.ending.clone();
            let _ = self.file.set_len(self.length).and_then(|()| self.write(&before));
            return written.map_err(RecordError::io("write to", &self.path));
        }
        self.length += piece.len() as u64;
        self.ending = ending.to_vec();
        Ok(())
    }

    /// Writes after the last complete piece, and cuts off everything that may follow.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let is_covered = self.is_cut && bytes.len() >= self.ending.len();
        self.is_cut = false;
        self.write_at(self.length, bytes)?;
        if !is_covered {
            self.file.set_len(self.length + bytes.len() as u64)?;
        }
        self.is_cut = true;
        Ok(())
    }

    /// Writes bytes from a position on.
    pub(super) fn write_at(&self, place: u64, bytes: &[u8]) -> io::Result<()> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(place))?;
        file.write_all(bytes)
    }
}

impl Drop for Growing {
    fn drop(&mut self) {
        // A process that was forked in the meantime to start another program may also have the file open.
        // Closing the file here would then not release the lock.
        let _ = self.file.unlock();
    }
}
