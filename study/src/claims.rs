//! Claims: locks on a fixed number of files decide which process runs which ramps.

use std::fs::{File, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use granular_edmd::file::Locked;

use super::StudyError;
use super::folder::{files_in, open_lock};

/// Number of lock files.
const LOCKS: usize = 256;

/// Largest number of blocks of ramps. A process claims whole blocks. With 64 processes, a few percent of the
/// time is lost at the end, when some processes have a block left and the others none.
const BLOCKS: usize = 2048;

/// The right to run a block of ramps. The claim ends with the process, even if the process is killed.
///
/// The lock file is never deleted. Otherwise, two processes could hold locks on two different files of the
/// same name.
#[derive(Debug)]
pub(super) struct Claim(Locked);

/// The result of a claim.
#[derive(Debug)]
pub(super) enum Claimed {
    /// This process has the ramps.
    Ours(Claim),
    /// Another process has the ramps.
    Theirs,
    /// Another process runs other ramps, whose lock file is the same.
    Collision,
}

/// The folder of the lock files.
#[derive(Debug, Clone)]
pub(super) struct Claims {
    folder: PathBuf,
    /// Number of all ramps.
    ramps: usize,
    /// Number of ramps in a block.
    size: usize,
}

impl Claims {
    pub(super) fn new(root: &Path, ramps: usize) -> Self {
        Self { folder: root.join("locks"), ramps, size: ramps.div_ceil(BLOCKS).max(1) }
    }

    /// Returns the blocks into which the ramps are divided.
    pub(super) fn blocks(&self) -> impl Iterator<Item = Range<usize>> {
        (0..self.ramps).step_by(self.size).map(|first| first..self.ramps.min(first + self.size))
    }

    fn file(&self, ramp: usize) -> PathBuf {
        self.folder.join(format!("{:03}", ramp / self.size % LOCKS))
    }

    /// Claims ramps of one block.
    pub(super) fn claim(&self, ramps: &Range<usize>) -> Result<Claimed, StudyError> {
        let path = self.file(ramps.start);
        let file = open_lock(&path)?;
        match Locked::take(file) {
            Ok(locked) => {
                let written = tell(&locked, &format!("{}..{}\n", ramps.start, ramps.end));
                written.map_err(StudyError::io("write", &path))?;
                Ok(Claimed::Ours(Claim(locked)))
            }
            Err(TryLockError::WouldBlock) => {
                let held = held(&path);
                let are_theirs = held.is_none_or(|held| held.start < ramps.end && ramps.start < held.end);
                Ok(if are_theirs { Claimed::Theirs } else { Claimed::Collision })
            }
            Err(TryLockError::Error(source)) => Err(StudyError::NoLock { path, source }),
        }
    }

    /// Returns the ramps that processes are running, as far as the locks show.
    pub(super) fn taken(&self) -> Result<Vec<Range<usize>>, StudyError> {
        let paths = files_in(&self.folder)?.into_iter().map(|file| file.path());
        Ok(paths.filter(|path| is_taken(path)).filter_map(|path| held(&path)).collect())
    }
}

/// Returns whether a process holds the lock on a file.
fn is_taken(path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    let locked = file.try_lock_shared();
    let _ = file.unlock();
    matches!(locked, Err(TryLockError::WouldBlock))
}

impl Drop for Claim {
    fn drop(&mut self) {
        let _ = tell(&self.0, "");
    }
}

/// Writes to a lock file the ramps that it protects.
fn tell(lock: &Locked, text: &str) -> io::Result<()> {
    let mut file = lock.file();
    file.set_len(0)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(text.as_bytes())
}

/// Returns the ramps that a lock file names, or `None` if it names none.
fn held(path: &Path) -> Option<Range<usize>> {
    // The holder may be about to write the ramps.
    (0..20).find_map(|_| {
        let mut text = String::new();
        File::open(path).ok()?.read_to_string(&mut text).ok()?;
        let (first, end) = text.strip_suffix('\n').and_then(|text| text.split_once("..")).or_else(|| {
            std::thread::sleep(Duration::from_millis(1));
            None
        })?;
        Some(first.parse().ok()?..end.parse().ok()?)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_seen_by_others_until_it_ends() {
        let root = std::env::temp_dir().join(format!("granular-edmd-claims-{}", std::process::id()));
        let claims = Claims::new(&root, 10_000);
        let all: Vec<Range<usize>> = claims.blocks().collect();
        assert_eq!((all.len(), &all[1], all.last()), (2000, &(5..10), Some(&(9995..10_000))));
        let Claimed::Ours(claim) = claims.claim(&all[1]).unwrap() else { panic!("it is free") };
        assert!(matches!(claims.claim(&(7..8)).unwrap(), Claimed::Theirs));
        assert!(matches!(claims.claim(&all[1 + LOCKS]).unwrap(), Claimed::Collision));
        assert_eq!(claims.taken().unwrap(), vec![Range { start: 5, end: 10 }]);
        drop(claim);
        assert_eq!(claims.taken().unwrap(), []);
        assert!(matches!(claims.claim(&(7..8)).unwrap(), Claimed::Ours(_)));
        std::fs::remove_dir_all(&root).unwrap();
    }
}
