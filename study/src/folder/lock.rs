//! Locks, which let one process at a time write into a folder.

use std::fs::{File, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use granular_edmd::file::Locked;

use crate::StudyError;

/// The right to write into a folder. It ends with the process, even if that is killed.
///
/// The file of the lock stays. If it were removed, two processes could hold the locks of two different files
/// of the same name.
#[derive(Debug)]
pub(crate) struct Lock(Locked);

impl Lock {
    /// Takes the lock of a file; returns `None` if somebody has it.
    pub(super) fn try_take(path: &Path) -> Result<Option<Self>, StudyError> {
        match Locked::take(open(path)?) {
            Ok(file) => Ok(Some(Self(file))),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(error)) => Err(unlocked(path)(error)),
        }
    }

    /// Waits until no other process has the lock of a file, and takes it.
    pub(super) fn take(path: &Path) -> Result<Self, StudyError> {
        Locked::wait(open(path)?).map(Self).map_err(unlocked(path))
    }

    /// Returns whether a process has the lock of a file; false if the system does not tell.
    pub(crate) fn is_taken(path: &Path) -> bool {
        let Ok(file) = File::open(path) else { return false };
        let locked = file.try_lock_shared();
        let _ = file.unlock();
        matches!(locked, Err(TryLockError::WouldBlock))
    }

    /// Writes a byte at this place of the file of the lock.
    pub(super) fn put(&self, place: u64, byte: u8) -> io::Result<()> {
        let mut file = self.0.file();
        file.seek(SeekFrom::Start(place))?;
        file.write_all(&[byte])
    }

    /// Returns whether nothing was ever logged under this lock.
    pub(crate) fn is_fresh(&self) -> bool {
        self.0.file().metadata().is_ok_and(|file| file.len() == 0)
    }

    /// Adds a line to the file of the lock, which is its log. A log that cannot be written is no reason to
    /// lose work, so a failure is ignored.
    ///
    /// If a kill or a full drive has cut the last line short, it is removed first, so that every line is
    /// whole. Only the holder of the lock writes, so appending is safe on network file systems, too.
    pub(crate) fn append(&mut self, line: &str) {
        let _ =
            to_last_line_end(self.0.file()).and_then(|mut end| end.write_all(format!("{line}\n").as_bytes()));
    }
}

/// Returns the error of a file that the system does not lock.
fn unlocked(path: &Path) -> impl FnOnce(io::Error) -> StudyError {
    move |source| StudyError::NoLock { path: path.to_owned(), source }
}

fn open(path: &Path) -> Result<File, StudyError> {
    let mut options = File::options();
    options.read(true).write(true).create(true).truncate(false);
    options.open(path).map_err(StudyError::io("write", path))
}

/// Goes to the end of the last whole line, and removes what follows it.
fn to_last_line_end(mut file: &File) -> io::Result<&File> {
    let end = file.seek(SeekFrom::End(0))?;
    let mut last = [b'\n'];
    if end > 0 {
        file.seek(SeekFrom::Start(end - 1))?;
        file.read_exact(&mut last)?;
    }
    if last != [b'\n'] {
        let mut bytes = Vec::new();
        file.rewind()?;
        file.read_to_end(&mut bytes)?;
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        file.set_len(whole as u64)?;
        file.seek(SeekFrom::End(0))?;
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_line_that_was_cut_short_goes() {
        let path = std::env::temp_dir().join(format!("granular-edmd-log-{}", std::process::id()));
        for (before, after) in [("", ""), ("half", ""), ("one\n", "one\n"), ("one\nhal", "one\n")] {
            fs::write(&path, before).unwrap();
            let mut lock = Lock::try_take(&path).unwrap().unwrap();
            assert_eq!(lock.is_fresh(), before.is_empty());
            lock.append("next");
            assert!(Lock::is_taken(&path));
            drop(lock);
            assert!(!Lock::is_taken(&path));
            assert_eq!(fs::read_to_string(&path).unwrap(), format!("{after}next\n"));
            fs::remove_file(&path).unwrap();
        }
    }
}
