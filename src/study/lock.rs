//! Locks, which let one process at a time write into a folder.

use std::fs::{File, TryLockError};
use std::path::Path;

use super::errors::StudyError;

/// Name of the file in each folder that is locked.
pub(super) const NAME: &str = "lock";

/// The right to write into a folder; it ends with the process at the latest, however the process ends.
///
/// The file stays, and stays empty. If it were removed, two processes could hold the locks of two different
/// files of the same name.
#[derive(Debug)]
pub(super) struct Lock {
    file: File,
}

impl Lock {
    /// Takes the lock of a folder; returns `None` if somebody has it.
    pub(super) fn try_take(folder: &Path) -> Result<Option<Self>, StudyError> {
        let path = folder.join(NAME);
        let file = open(&path)?;
        match file.try_lock() {
            Ok(()) => Ok(Some(Self { file })),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(error)) => Err(StudyError::io("lock", &path)(error)),
        }
    }

    /// Waits until nobody else has the lock of a folder, and takes it.
    pub(super) fn take(folder: &Path) -> Result<Self, StudyError> {
        let path = folder.join(NAME);
        let file = open(&path)?;
        file.lock().map_err(StudyError::io("lock", &path))?;
        Ok(Self { file })
    }

    /// Returns whether somebody has the lock of a folder; false if that cannot be found out.
    pub(super) fn is_taken(folder: &Path) -> bool {
        let Ok(file) = File::open(folder.join(NAME)) else { return false };
        match file.try_lock_shared() {
            Ok(()) => {
                let _ = file.unlock();
                false
            }
            Err(TryLockError::WouldBlock) => true,
            Err(TryLockError::Error(_)) => false,
        }
    }
}

fn open(path: &Path) -> Result<File, StudyError> {
    let mut options = File::options();
    options.read(true).write(true).create(true).truncate(false);
    options.open(path).map_err(StudyError::io("write", path))
}

impl Drop for Lock {
    fn drop(&mut self) {
        // A process that was forked meanwhile, to start another program, may have the file open, too.
        // Closing the file here would then not release the lock.
        let _ = self.file.unlock();
    }
}
