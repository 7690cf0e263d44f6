//! The marks of ramps that are done: one file, with a letter for each ramp.
//!
//! So a process learns the state of all ramps by one read, however many there are. The file need not survive
//! a loss of power, so it is not synced: a ramp that lost its mark is looked at again.

use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

use super::{Folder, Lock, sealed};
use crate::StudyError;

const DONE: &str = "done";

/// The mark of a ramp, with its letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    /// A value is missing. The file has this also where nothing was ever written.
    Open = 0,
    /// All values have a record.
    Done = b'd' as isize,
    /// All values have a record, and some of them stalled or failed.
    Failed = b'f' as isize,
}

impl Folder {
    /// Returns the marks of these ramps.
    pub(crate) fn marks(&self, ramps: Range<usize>) -> Result<Vec<Mark>, StudyError> {
        let path = self.root.join(DONE);
        let letters = sealed::if_there("read", &path, read(&path))?.unwrap_or_default();
        let mark = |ramp| match letters.get(ramp) {
            Some(b'd') => Mark::Done,
            Some(b'f') => Mark::Failed,
            _ => Mark::Open,
        };
        Ok(ramps.map(mark).collect())
    }

    /// Marks a ramp.
    pub(crate) fn mark(&self, ramp: usize, mark: Mark) -> Result<(), StudyError> {
        let path = self.root.join(DONE);
        // Without a lock, a client of NFS may write old letters of other hosts beside this one.
        let lock = Lock::take(&path)?;
        lock.put(ramp as u64, mark as u8).map_err(StudyError::io("write", &path))
    }
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    let (mut file, mut letters) = (File::open(path)?, Vec::new());
    // This waits for a writer, which keeps readers out on some systems. Without locks, letters may be old.
    let _ = file.lock_shared();
    file.read_to_end(&mut letters)?;
    Ok(letters)
}
