//! Files that are complete or absent, and locks. Checkpoints and studies consist of such files, and other
//! packages can use them for their stores.
//!
//! ```
//! # #[cfg(feature = "serde")] {
//! use granular_edmd::file::{Damage, Seal, write_whole};
//!
//! const SEAL: Seal = Seal::new(*b"MY STORE", 1);
//! # let path = std::env::temp_dir().join(format!("granular-edmd-file-{}", std::process::id()));
//! // A reader never sees half of the file, even if this process is killed.
//! write_whole(&path, &SEAL.seal(b"contents"))?;
//! let mut bytes = std::fs::read(&path)?;
//! assert_eq!(SEAL.open(&bytes), Ok(b"contents".as_slice()));
//! // A byte that a broken disk has changed does not go unnoticed.
//! bytes[50] ^= 1;
//! assert_eq!(SEAL.open(&bytes), Err(Damage::Changed));
//! # std::fs::remove_file(&path)?;
//! # }
//! # Ok::<(), std::io::Error>(())
//! ```

#[cfg(feature = "serde")]
mod sealed;

#[cfg(feature = "serde")]
pub use sealed::{Damage, Draft, Seal, is_temporary, unique_name, write_whole};

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
