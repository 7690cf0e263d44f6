//! Claims: the locks of a limited number of files decide which process runs which ramps.

use std::fs::{File, TryLockError};
use std::ops::Range;
use std::path::{Path, PathBuf};

use granular_edmd::file::Locked;

use super::StudyError;
use super::folder::{files_in, try_lock};

/// Largest number of blocks of ramps, each with its lock file. A process claims whole blocks. With 64
/// processes, a few percent of the time is lost at the end, when some processes have a block left and the
/// others none. The folder of a study stays below a thousand files.
const BLOCKS: usize = 960;

/// The lock files of the blocks.
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
        (0..self.ramps.div_ceil(self.size)).map(|block| self.block(block))
    }

    fn block(&self, block: usize) -> Range<usize> {
        block * self.size..self.ramps.min((block + 1) * self.size)
    }

    /// Returns whether a block has several ramps, so that its lock may be held for another ramp.
    pub(super) const fn is_shared(&self) -> bool {
        self.size > 1
    }

    /// Claims the block of a ramp, or returns `None` if another process has it.
    pub(super) fn claim(&self, ramp: usize) -> Result<Option<Locked>, StudyError> {
        try_lock(&self.folder.join(format!("{:04}", ramp / self.size)))
    }

    /// Returns the blocks of ramps that processes are running.
    pub(super) fn taken(&self) -> Result<Vec<Range<usize>>, StudyError> {
        let taken = files_in(&self.folder)?.into_iter().filter(|file| is_taken(&file.path()));
        let numbers = taken.filter_map(|file| file.file_name().to_str()?.parse().ok());
        Ok(numbers.filter(|block| *block < BLOCKS).map(|block| self.block(block)).collect())
    }
}

/// Returns whether a process holds the lock on a file.
fn is_taken(path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    let locked = file.try_lock_shared();
    let _ = file.unlock();
    matches!(locked, Err(TryLockError::WouldBlock))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_seen_by_others_until_it_ends() {
        let root = std::env::temp_dir().join(format!("granular-edmd-claims-{}", std::process::id()));
        let claims = Claims::new(&root, 9_997);
        let all: Vec<Range<usize>> = claims.blocks().collect();
        assert_eq!((all.len(), &all[1], all.last()), (909, &(11..22), Some(&(9988..9_997))));
        let claim = claims.claim(11).unwrap().unwrap();
        assert!(claims.claim(17).unwrap().is_none());
        assert!(claims.claim(22).unwrap().is_some());
        assert_eq!(claims.taken().unwrap(), vec![Range { start: 11, end: 22 }]);
        drop(claim);
        assert_eq!(claims.taken().unwrap(), []);
        assert!(claims.claim(17).unwrap().is_some());
        std::fs::remove_dir_all(&root).unwrap();
    }
}
