//! One process at a time.

use std::fs::{File, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::Path;

use super::errors::StudyError;

/// The right to write into a study; it ends with the process at the latest, however that ends.
#[derive(Debug)]
pub(super) struct Lock {
    file: File,
}

impl Lock {
    /// Takes the lock of the study in `folder`.
    pub(super) fn take(folder: &Path) -> Result<Self, StudyError> {
        let path = folder.join("lock");
        let mut options = File::options();
        options.read(true).write(true).create(true).truncate(false);
        let file = options.open(&path).map_err(StudyError::io("write", &path))?;
        match file.try_lock() {
            Ok(()) => {
                let mut lock = Self { file };
                lock.say(&std::process::id().to_string()).map_err(StudyError::io("write", &path))?;
                Ok(lock)
            }
            Err(TryLockError::WouldBlock) => {
                Err(StudyError::Locked { path: folder.to_owned(), process: holder(file) })
            }
            Err(TryLockError::Error(error)) => Err(StudyError::io("lock", &path)(error)),
        }
    }

    fn say(&mut self, text: &str) -> std::io::Result<()> {
        self.file.set_len(0)?;
        self.file.rewind()?;
        self.file.write_all(text.as_bytes())
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Whether or not the file can be emptied, the system takes the lock back. Closing it would not do that while a
        // process that was forked meanwhile, to start another program, has it open, too.
        let _ = self.say("");
        let _ = self.file.unlock();
    }
}

/// Who holds the lock, as far as its file tells.
fn holder(mut file: File) -> Option<u32> {
    let mut text = String::new();
    file.read_to_string(&mut text).ok()?;
    text.trim().parse().ok()
}
