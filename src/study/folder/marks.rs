//! The marks of ramps that are done: one file, with a letter for each ramp.
//!
//! So a process learns the state of all ramps by one read, however many there are. The file need not survive
//! a loss of power, so it is not synced: a ramp that lost its mark is looked at again.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;

use super::{Folder, Lock, sealed};
use crate::study::errors::StudyError;

const DONE: &str = "done";

/// The mark of a ramp, with its letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::study) enum Mark {
    /// A value is missing. The file has this also where nothing was ever written.
    Open = 0,
    /// All values have a record.
    Done = b'd' as isize,
    /// All values have a record, and some of them stalled or failed.
    Failed = b'f' as isize,
}

impl Folder {
    /// Returns the marks of these ramps.
    pub(in crate::study) fn marks(&self, ramps: Range<usize>) -> Result<Vec<Mark>, StudyError> {
        let path = self.root.join(DONE);
        let letters = File::open(&path).and_then(|file| read(file, &ramps));
        let mut letters = sealed::if_there("read", &path, letters)?.unwrap_or_default();
        letters.resize(ramps.len(), 0);
        let mark = |letter| match letter {
            b'd' => Mark::Done,
            b'f' => Mark::Failed,
            _ => Mark::Open,
        };
        Ok(letters.into_iter().map(mark).collect())
    }

    /// Marks a ramp.
    pub(in crate::study) fn mark(&self, ramp: usize, mark: Mark) -> Result<(), StudyError> {
        let path = self.root.join(DONE);
        // Without a lock, a client of NFS may write old letters of other hosts beside this one.
        let mut lock = Lock::take(&path)?;
        lock.put(ramp as u64, mark as u8).map_err(StudyError::io("write", &path))
    }
}

fn read(mut file: File, ramps: &Range<usize>) -> io::Result<Vec<u8>> {
    // This waits for a writer, which keeps readers out on some systems. Without locks, letters may be old.
    let _ = file.lock_shared();
    let mut letters = Vec::with_capacity(ramps.len());
    file.seek(SeekFrom::Start(ramps.start as u64))?;
    let read = (&file).take(ramps.len() as u64).read_to_end(&mut letters);
    let _ = file.unlock();
    read.map(|_| letters)
}
