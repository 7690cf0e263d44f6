//! The store of a study: blocks of ramps, each with a log of their records. The process that runs a block has
//! the lock of its log.
//!
//! A process appends each finished value to the log of its block, as a whole piece with a checksum. If the
//! process is killed, its lock ends, and another process continues the log.

mod log;

use std::fs::{File, TryLockError};
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use log::{HEAD, Log, Piece};
use serde::de::DeserializeOwned;

use super::StudyError;
use super::folder::{BLOCKS, decoded, try_lock};

/// Largest number of blocks. With 64 processes, a few percent of the time is lost at the end, when some
/// processes have a block left and the others none. The folder of a study stays below a thousand files.
const MOST_BLOCKS: usize = 960;

/// Most seconds of work on finished values that a power failure may cost a thread.
const AT_RISK: f32 = 0.1;

/// The blocks of a study.
///
/// Ramps go around: with 960 blocks, ramps 0, 960, 1920 and so on are in block 0. Batch engines that start
/// one ramp after the other thus have their processes in different blocks.
#[derive(Debug, Clone)]
pub(super) struct Store {
    blocks: Arc<[Mutex<Block>]>,
    /// Number of all ramps.
    ramps: usize,
}

/// The log of a block, and the entries that were read from it.
#[derive(Debug)]
struct Block {
    log: Log,
    /// One entry for each ramp and value, in order.
    entries: Vec<Entry>,
    /// Seconds of work whose records are not yet synced to the disk.
    at_risk: f32,
}

/// A block that this process runs. Dropping the value releases the block.
#[derive(Debug)]
pub(super) struct Claim<'a> {
    store: &'a Store,
    block: usize,
}

impl Drop for Claim<'_> {
    fn drop(&mut self) {
        self.store.block(self.block).log.leave();
    }
}

impl Store {
    pub(super) fn new(root: &Path, ramps: usize) -> Self {
        let path = |number: usize| root.join(BLOCKS).join(format!("{number:04}.log"));
        let blocks = (0..ramps.clamp(1, MOST_BLOCKS)).map(|number| Mutex::new(Block::new(path(number))));
        Self { blocks: blocks.collect(), ramps }
    }

    /// Returns the block of a ramp.
    pub(super) fn block_of(&self, ramp: usize) -> usize {
        ramp % self.blocks.len()
    }

    pub(super) fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// Returns the ramps of a block.
    pub(super) fn ramps_of(&self, block: usize) -> impl Iterator<Item = usize> + Clone + use<> {
        (block..self.ramps).step_by(self.blocks.len())
    }

    /// Claims a block and reads what others have added to it, or returns `None` if another process or thread
    /// has the block.
    pub(super) fn claim(&self, block: usize) -> Result<Option<Claim<'_>>, StudyError> {
        let mut found = self.block(block);
        let Some(file) = try_lock(&found.log.path)? else { return Ok(None) };
        found.entries.clear();
        let pieces = found.log.begin(file).map_err(|error| failed("write", &found.log.path, error))?;
        for piece in pieces {
            found.add(piece);
        }
        Ok(Some(Claim { store: self, block }))
    }

    /// Returns the ramps of all blocks that processes are running.
    pub(super) fn taken(&self) -> impl Iterator<Item = usize> {
        let taken = (0..self.blocks.len()).filter(|&block| is_taken(&self.block(block).log.path));
        taken.flat_map(|block| self.ramps_of(block))
    }

    /// Reads what other processes have added.
    pub(super) fn refresh(&self) -> Result<(), StudyError> {
        (0..self.blocks.len()).try_for_each(|block| self.refresh_block(block))
    }

    /// Reads what other processes have added to a block.
    pub(super) fn refresh_block(&self, block: usize) -> Result<(), StudyError> {
        self.block(block).refresh()
    }

    /// Returns the error of a log that is unreadable in part. That part may have held any record of its
    /// block.
    pub(super) fn damage(&self, block: usize) -> Option<StudyError> {
        let Log { path, is_damaged, .. } = &self.block(block).log;
        is_damaged.then(|| StudyError::damaged(path, "a part of it is no record"))
    }

    /// Returns the path of the log that holds the records of a ramp, for use in error messages.
    pub(super) fn log_of(&self, ramp: usize) -> PathBuf {
        self.of_ramp(ramp).log.path.clone()
    }

    /// Returns the error for a damaged record.
    pub(super) fn damaged(&self, entry: &Entry, reason: impl std::fmt::Display) -> StudyError {
        let Head { ramp, value, .. } = entry.head();
        StudyError::damaged(&self.log_of(ramp), format!("value {value} of ramp {ramp}: {reason}"))
    }

    /// Reads the contents of an entry.
    pub(super) fn read<T: DeserializeOwned>(&self, entry: &Entry) -> Result<T, StudyError> {
        let block = self.of_ramp(entry.head().ramp);
        let read = block.log.contents(entry).map_err(StudyError::io("read", &block.log.path))?;
        drop(block);
        let contents = read.map_err(|_| "its checksum does not match");
        contents.and_then(|contents| decoded(&contents)).map_err(|reason| self.damaged(entry, reason))
    }

    /// Appends the encoded record of a value to the log of its block, which this process has claimed.
    pub(super) fn push(&self, head: Head, contents: &[u8]) -> Result<(), StudyError> {
        self.of_ramp(head.ramp).push(head, contents)
    }

    /// Waits until the system has stored all records of a block that this process has claimed.
    pub(super) fn sync(&self, block: usize) -> Result<(), StudyError> {
        self.block(block).sync()
    }

    /// Returns the entry of the record of a value.
    pub(super) fn find(&self, ramp: usize, value: usize) -> Option<Entry> {
        let block = self.of_ramp(ramp);
        let place = block.entries.binary_search_by_key(&(ramp, value), Entry::place).ok()?;
        Some(block.entries[place]).filter(Entry::is_record)
    }

    /// Iterates over the entries of all records of some ramps, in order.
    pub(super) fn of(&self, ramps: Range<usize>) -> impl Iterator<Item = Entry> {
        ramps.flat_map(|ramp| self.of_ramp(ramp).of(ramp).copied().collect::<Vec<_>>())
    }

    /// Iterates over the headers of all records.
    pub(super) fn heads(&self) -> impl Iterator<Item = Head> {
        self.of(0..self.ramps).map(|entry| entry.head())
    }

    /// Returns whether all values of a ramp have a record.
    pub(super) fn is_done(&self, ramp: usize) -> bool {
        let block = self.of_ramp(ramp);
        let found = block.of(ramp).map(Entry::head);
        let mut whole = found.enumerate().take_while(|(index, head)| head.value == *index);
        whole.any(|(_, head)| head.has(Head::LAST))
    }

    fn of_ramp(&self, ramp: usize) -> MutexGuard<'_, Block> {
        self.block(self.block_of(ramp))
    }

    fn block(&self, block: usize) -> MutexGuard<'_, Block> {
        self.blocks[block].lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Block {
    const fn new(path: PathBuf) -> Self {
        Self { log: Log::new(path), entries: Vec::new(), at_risk: 0.0 }
    }

    fn refresh(&mut self) -> Result<(), StudyError> {
        let news = self.log.news().map_err(|error| failed("read", &self.log.path, error))?;
        for piece in news {
            self.add(piece);
        }
        Ok(())
    }

    /// Adds an entry, in place of an earlier one of the same value.
    fn add(&mut self, entry: Entry) {
        if self.entries.last().is_none_or(|last| last.place() < entry.place()) {
            return self.entries.push(entry);
        }
        match self.entries.binary_search_by_key(&entry.place(), Entry::place) {
            Ok(place) => self.entries[place] = entry,
            Err(place) => self.entries.insert(place, entry),
        }
    }

    /// Iterates over the entries of the records of a ramp, in order.
    fn of(&self, ramp: usize) -> impl Iterator<Item = &Entry> {
        let [from, to] =
            [ramp, ramp + 1].map(|ramp| self.entries.partition_point(|entry| entry.place() < (ramp, 0)));
        self.entries[from..to].iter().filter(|entry| entry.is_record())
    }

    fn push(&mut self, head: Head, contents: &[u8]) -> Result<(), StudyError> {
        let piece = self.log.push(head.bytes(), contents).map_err(StudyError::io("write", &self.log.path))?;
        self.add(piece);
        // Not every record is synced, since syncing a disk can take longer than running a value again.
        self.at_risk += head.seconds.max(0.0);
        if self.at_risk > AT_RISK { self.sync() } else { Ok(()) }
    }

    fn sync(&mut self) -> Result<(), StudyError> {
        self.at_risk = 0.0;
        self.log.sync().map_err(StudyError::io("write", &self.log.path))
    }
}

/// The entry of a record, or of a value that counts as unfinished.
pub(super) type Entry = Piece;

impl Entry {
    pub(super) fn head(&self) -> Head {
        let number = |at: usize| u32::from_le_bytes(std::array::from_fn(|byte| self.head[at + byte]));
        Head {
            ramp: number(0) as usize,
            value: number(4) as usize,
            marks: number(8),
            seconds: f32::from_bits(number(12)),
        }
    }

    fn place(&self) -> (usize, usize) {
        let Head { ramp, value, .. } = self.head();
        (ramp, value)
    }

    fn is_record(&self) -> bool {
        !self.head().has(Head::VOID)
    }
}

/// The header of a record in a log. Of several records of a value, the last one counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Head {
    pub(super) ramp: usize,
    pub(super) value: usize,
    /// The marks of the record: a sum of the constants of this type.
    pub(super) marks: u32,
    /// Wall-clock seconds that the value took; NaN if the value was taken over from another study.
    pub(super) seconds: f32,
}

impl Head {
    /// The mark of a value that counts as unfinished.
    pub(super) const VOID: u32 = 1;
    /// The mark of the last value of its ramp.
    pub(super) const LAST: u32 = 2;
    /// The mark of a value that stalled, failed or reached a limit.
    pub(super) const FAILED: u32 = 4;
    /// The mark of a value whose run has warnings.
    pub(super) const WARNED: u32 = 8;

    pub(super) const fn has(&self, mark: u32) -> bool {
        self.marks & mark != 0
    }

    fn bytes(&self) -> [u8; HEAD] {
        let mut bytes = [0; HEAD];
        // A plan has at most a million values, and a refinement adds some thousands in each ramp.
        bytes[..4].copy_from_slice(&(self.ramp as u32).to_le_bytes());
        bytes[4..8].copy_from_slice(&(self.value as u32).to_le_bytes());
        bytes[8..12].copy_from_slice(&self.marks.to_le_bytes());
        bytes[12..].copy_from_slice(&self.seconds.to_le_bytes());
        bytes
    }
}

/// Returns whether a process holds the lock on a file.
fn is_taken(path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    let locked = file.try_lock_shared();
    let _ = file.unlock();
    matches!(locked, Err(TryLockError::WouldBlock))
}

/// Returns the error for a log that cannot be read or written, or has another format.
fn failed(action: &'static str, path: &Path, error: io::Error) -> StudyError {
    match error.kind() {
        io::ErrorKind::InvalidData => StudyError::damaged(path, error.to_string()),
        _ => StudyError::io(action, path)(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_seen_by_others_until_it_ends() {
        let root = std::env::temp_dir().join(format!("granular-edmd-claims-{}", std::process::id()));
        let [one, other] = [(); 2].map(|()| Store::new(&root, 1000));
        assert!(one.block_count() == 960 && one.ramps_of(7).eq([7, 967]));
        let claim = one.claim(7).unwrap().unwrap();
        assert!(other.claim(7).unwrap().is_none() && other.claim(8).unwrap().is_some());
        assert!(other.taken().eq([7, 967]));
        let head = Head { ramp: 967, value: 0, marks: Head::LAST, seconds: 0.0 };
        one.push(head, b"record").unwrap();
        drop(claim);
        assert!(one.push(head, b"record").is_err(), "nobody writes to a block without its lock");
        assert_eq!(other.taken().count(), 0);
        let _claim = other.claim(7).unwrap().unwrap();
        assert!(other.is_done(967) && !other.is_done(7));
        std::fs::remove_dir_all(&root).unwrap();
    }
}
