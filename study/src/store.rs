//! The store of a study: logs of records, one log for each process that ran at the same time as others.
//!
//! A process appends each finished value to its own log, as a whole piece with a checksum. Readers merge all
//! logs by ramp and value. A log outlives its process: the next process continues it.

mod log;

use std::collections::HashSet;
use std::fs::{DirEntry, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use granular_edmd::file::{Locked, Seal};
use serde::de::DeserializeOwned;

use super::StudyError;
use super::folder::{decoded, files_in, try_lock};
use super::parameters::anywhere;
use log::{HEAD, Log, Piece, pieces, read_piece};

/// Mark of a log of records, and the version of the format that this crate writes and reads.
const SEAL: Seal = Seal::new(*b"GRANSTUD", 6);

/// Most seconds of work on finished values that a power failure may cost a process.
const AT_RISK: f32 = 0.1;

/// The logs in the folder of a study.
#[derive(Debug, Clone)]
pub(super) struct Store {
    folder: PathBuf,
    state: Arc<Mutex<State>>,
}

#[derive(Debug, Default)]
struct State {
    logs: Vec<LogFile>,
    entries: Arc<Entries>,
    /// The log of this process; `None` until the process writes.
    writer: Option<Writer>,
}

/// A log, up to the point to which it was read.
#[derive(Debug)]
struct LogFile {
    path: PathBuf,
    end: u64,
    is_damaged: bool,
    file: Option<File>,
}

/// A log that this process alone writes, and its second file, which holds readable lines. The lock is on the
/// second file.
#[derive(Debug)]
struct Writer {
    path: PathBuf,
    log: Log,
    lines: Locked,
    /// True if the last line is complete.
    is_whole: bool,
    /// Seconds of work whose records are not yet synced to the disk.
    at_risk: f32,
}

impl Store {
    pub(super) fn new(root: &Path) -> Self {
        Self { folder: root.join("logs"), state: Arc::default() }
    }

    /// Reads the new entries of all processes, and returns all entries.
    pub(super) fn refreshed(&self) -> Result<Arc<Entries>, StudyError> {
        let state = &mut *self.state();
        let known: HashSet<&Path> = state.logs.iter().map(|log| log.path.as_path()).collect();
        let mut found = logs(&self.folder)?;
        found.retain(|path| !known.contains(&**path));
        let new = found.into_iter().map(|path| LogFile { path, end: 0, is_damaged: false, file: None });
        state.logs.extend(new);
        let sorted = state.entries.0.len();
        for (number, log) in state.logs.iter_mut().enumerate() {
            // Each time, the file is opened anew, since an NFS client asks for the present length only when
            // it opens a file.
            let read = pieces(&log.path, SEAL, log.end).map_err(|error| failed("read", &log.path, error))?;
            log.end = read.end;
            log.is_damaged |= read.is_damaged;
            if !read.found.is_empty() {
                let new = read.found.into_iter().map(|piece| Entry { log: number as u32, ..piece });
                Arc::make_mut(&mut state.entries).0.extend(new);
            }
        }
        if state.entries.0.len() > sorted {
            Arc::make_mut(&mut state.entries).settle(sorted);
        }
        Ok(Arc::clone(&state.entries))
    }

    /// Returns all entries that were read so far.
    pub(super) fn known(&self) -> Arc<Entries> {
        Arc::clone(&self.state().entries)
    }

    /// Returns the error of a log that is unreadable in part, if there is such a log. That part may have held
    /// any record.
    pub(super) fn damage(&self) -> Option<StudyError> {
        let state = self.state();
        let found = state.logs.iter().find(|log| log.is_damaged)?;
        Some(StudyError::damaged(&found.path, "a part of it is no record"))
    }

    /// Returns the path of the log that holds `entry`, for use in error messages.
    pub(super) fn log_of(&self, entry: &Entry) -> PathBuf {
        self.state().logs[entry.log as usize].path.clone()
    }

    /// Returns the error for a damaged record.
    pub(super) fn damaged(&self, entry: &Entry, reason: impl std::fmt::Display) -> StudyError {
        let Head { ramp, value, .. } = entry.head();
        StudyError::damaged(&self.log_of(entry), format!("value {value} of ramp {ramp}: {reason}"))
    }

    /// Reads the contents of an entry.
    pub(super) fn read<T: DeserializeOwned>(&self, entry: &Entry) -> Result<T, StudyError> {
        let mut state = self.state();
        let LogFile { path, file, .. } = &mut state.logs[entry.log as usize];
        let opened = match file {
            Some(file) => Ok(file),
            none => File::open(&*path).map(|file| none.insert(file)),
        };
        let read = opened.and_then(|file| read_piece(file, entry)).map_err(StudyError::io("read", path))?;
        drop(state);
        let contents = read.map_err(|_| "its checksum does not match");
        contents.and_then(|contents| decoded(&contents)).map_err(|reason| self.damaged(entry, reason))
    }

    /// Appends the encoded record of a value to the log of this process.
    pub(super) fn push(&self, head: Head, contents: &[u8]) -> Result<(), StudyError> {
        let mut state = self.state();
        let before = state.entries.latest(head.ramp, head.value);
        let edition = before.map_or(0, |entry| entry.head().edition + 1);
        state.writer(&self.folder)?.push(Head { edition, ..head }, contents)
    }

    /// Adds a readable line to the log's second file.
    pub(super) fn note(&self, line: &str) -> Result<(), StudyError> {
        self.state().writer(&self.folder).map(|writer| writer.note(line))
    }

    /// Waits until the system has stored all records of this process.
    pub(super) fn sync(&self) -> Result<(), StudyError> {
        self.state().writer.as_mut().map_or(Ok(()), Writer::sync)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn writer(&mut self, folder: &Path) -> Result<&mut Writer, StudyError> {
        match &mut self.writer {
            Some(writer) => Ok(writer),
            none => Ok(none.insert(Writer::open(folder)?)),
        }
    }
}

impl Writer {
    /// Opens a log that no process is writing, or creates a new log.
    fn open(folder: &Path) -> Result<Self, StudyError> {
        let mut known = logs(folder)?;
        known.sort();
        let count = known.len();
        known.rotate_left(anywhere(count));
        let names =
            known.into_iter().chain((count..).map(|number| folder.join(format!("{number:04}.records"))));
        for path in names {
            if let Some(lines) = try_lock(&path.with_extension("jsonl"))? {
                let log = Log::open(&path, SEAL).map_err(|error| failed("write", &path, error))?;
                return Ok(Self { path, log, lines, is_whole: false, at_risk: 0.0 });
            }
        }
        Err(StudyError::NoLock { path: folder.to_owned(), source: io::ErrorKind::WouldBlock.into() })
    }

    /// Appends a piece.
    fn push(&mut self, head: Head, contents: &[u8]) -> Result<(), StudyError> {
        self.log.push(head.bytes(), contents).map_err(StudyError::io("write", &self.path))?;
        // Not every record is synced, since syncing a disk can take longer than running a value again.
        self.at_risk += head.seconds.max(0.0);
        if self.at_risk > AT_RISK {
            self.sync()?;
        }
        Ok(())
    }

    fn sync(&mut self) -> Result<(), StudyError> {
        self.at_risk = 0.0;
        self.log.sync().map_err(StudyError::io("write", &self.path))
    }

    /// Adds a line. An error is ignored: a log line that cannot be written must not abort the work.
    fn note(&mut self, line: &str) {
        let whole = if self.is_whole { Ok(self.lines.file()) } else { to_last_line_end(self.lines.file()) };
        self.is_whole = whole.and_then(|mut end| end.write_all(format!("{line}\n").as_bytes())).is_ok();
    }
}

/// Moves to the end of the last complete line, and removes everything after it.
fn to_last_line_end(mut file: &File) -> io::Result<&File> {
    let mut bytes = Vec::new();
    file.rewind()?;
    file.read_to_end(&mut bytes)?;
    let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1) as u64;
    if whole < bytes.len() as u64 {
        file.set_len(whole)?;
    }
    file.seek(SeekFrom::Start(whole))?;
    Ok(file)
}

/// All entries, one for each ramp and value, in order.
#[derive(Debug, Clone, Default)]
pub(super) struct Entries(Vec<Entry>);

impl Entries {
    /// Sorts all entries. The first `sorted` entries are in order already.
    fn settle(&mut self, sorted: usize) {
        let key = |entry: &Entry| (entry.place(), std::cmp::Reverse(entry.head().edition));
        // If most entries are sorted already, a stable sort takes only linear time. It needs additional
        // memory.
        match sorted {
            0 => self.0.sort_unstable_by_key(key),
            _ => self.0.sort_by_key(key),
        }
        self.0.dedup_by_key(|entry| entry.place());
    }

    /// Returns the entry of a value, even if the value counts as unfinished.
    fn latest(&self, ramp: usize, value: usize) -> Option<&Entry> {
        let place = self.0.binary_search_by_key(&(ramp, value), Entry::place).ok()?;
        Some(&self.0[place])
    }

    /// Returns the record of a value.
    pub(super) fn find(&self, ramp: usize, value: usize) -> Option<&Entry> {
        self.latest(ramp, value).filter(|entry| !entry.head().has(Head::VOID))
    }

    /// Iterates over the records of some ramps.
    pub(super) fn of(&self, ramps: std::ops::Range<usize>) -> impl Iterator<Item = &Entry> {
        let [from, to] =
            [ramps.start, ramps.end].map(|ramp| self.0.partition_point(|entry| entry.place() < (ramp, 0)));
        self.0[from..to].iter().filter(|entry| !entry.head().has(Head::VOID))
    }

    /// Iterates over the headers of all records.
    pub(super) fn heads(&self) -> impl Iterator<Item = Head> {
        self.0.iter().map(Entry::head).filter(|head| !head.has(Head::VOID))
    }

    /// Returns whether all values of a ramp have a record.
    pub(super) fn is_done(&self, ramp: usize) -> bool {
        let found = self.of(ramp..ramp + 1).map(Entry::head);
        let mut whole = found.enumerate().take_while(|(index, head)| head.value == *index);
        whole.any(|(_, head)| head.has(Head::LAST))
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
            edition: number(8) as u16,
            marks: (number(8) >> 16) as u16,
            seconds: f32::from_bits(number(12)),
        }
    }

    fn place(&self) -> (usize, usize) {
        let Head { ramp, value, .. } = self.head();
        (ramp, value)
    }
}

/// The header of a record in a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Head {
    pub(super) ramp: usize,
    pub(super) value: usize,
    /// If a value has several records, the one with the highest edition is used. Records of a value with
    /// equal editions have the same contents.
    edition: u16,
    /// The marks of the record: a sum of the constants of this type.
    marks: u16,
    /// Wall-clock seconds that the value took; NaN if the value was taken over from another study.
    pub(super) seconds: f32,
}

impl Head {
    /// The mark of a value that counts as unfinished.
    pub(super) const VOID: u16 = 1;
    /// The mark of the last value of its ramp.
    pub(super) const LAST: u16 = 2;
    /// The mark of a value that stalled, failed or reached a limit.
    pub(super) const FAILED: u16 = 4;
    /// The mark of a value whose run has warnings.
    pub(super) const WARNED: u16 = 8;

    pub(super) const fn new(ramp: usize, value: usize, marks: u16, seconds: f32) -> Self {
        Self { ramp, value, edition: 0, marks, seconds }
    }

    pub(super) const fn has(&self, mark: u16) -> bool {
        self.marks & mark != 0
    }

    fn bytes(&self) -> [u8; HEAD] {
        let mut bytes = [0; HEAD];
        // A plan has at most a million values, and a refinement adds some thousands in each ramp.
        bytes[..4].copy_from_slice(&(self.ramp as u32).to_le_bytes());
        bytes[4..8].copy_from_slice(&(self.value as u32).to_le_bytes());
        bytes[8..10].copy_from_slice(&self.edition.to_le_bytes());
        bytes[10..12].copy_from_slice(&self.marks.to_le_bytes());
        bytes[12..].copy_from_slice(&self.seconds.to_le_bytes());
        bytes
    }
}

/// Returns the logs in a folder.
fn logs(folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let mut found: Vec<PathBuf> = files_in(folder)?.iter().map(DirEntry::path).collect();
    // A copy of a log under another name is not a log.
    let is_numbered = |path: &Path| {
        path.file_stem().is_some_and(|stem| stem.as_encoded_bytes().iter().all(u8::is_ascii_digit))
    };
    found.retain(|path| path.extension().is_some_and(|ending| ending == "records") && is_numbered(path));
    Ok(found)
}

/// Returns the error for a log that cannot be read or written, or has another format.
fn failed(action: &'static str, path: &Path, error: io::Error) -> StudyError {
    match error.kind() {
        io::ErrorKind::InvalidData => StudyError::damaged(path, error.to_string()),
        _ => StudyError::io(action, path)(error),
    }
}
