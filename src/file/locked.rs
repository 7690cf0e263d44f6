//! Files under a lock.

use std::fs::{File, TryLockError};
use std::io;

/// A file whose lock this process holds. Dropping the value releases the lock.
#[derive(Debug)]
pub struct Locked(File);

impl Locked {
    /// Waits until no other owner has the lock of a file, and locks the file.
    ///
    /// # Errors
    /// If the file system has no locks.
    pub fn wait(file: File) -> io::Result<Self> {
        file.lock()?;
        Ok(Self(file))
    }

    /// Locks a file, unless another owner holds the lock.
    ///
    /// # Errors
    /// If another owner holds the lock, or the file system has no locks.
    pub fn take(file: File) -> Result<Self, TryLockError> {
        file.try_lock()?;
        Ok(Self(file))
    }

    /// Returns the file.
    pub const fn file(&self) -> &File {
        &self.0
    }
}

impl Drop for Locked {
    fn drop(&mut self) {
        // A process that was forked in the meantime to start another program may also have the file open.
        // Closing the file here would then not release the lock.
        let _ = self.0.unlock();
    }
}
