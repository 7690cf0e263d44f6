//! The store of a study: logs of records, one log for each process that ran at the same time as others.
//!
//! A process appends each finished value to its own log, as a whole piece with a checksum. Readers merge all
//! logs by ramp and value. A log outlives its process: the next process continues it.

mod claims;
mod index;
mod log;
mod writer;

use std::collections::HashSet;
use std::fs::{DirEntry, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use granular_edmd::file::Seal;
use serde::de::DeserializeOwned;

pub(super) use claims::{Claimed, Claims, blocks};
pub(super) use index::{Entries, Entry, Head, Marks};
use log::{Log, read_piece};
use writer::Writer;

use super::StudyError;
use super::whole::{damaged, decoded, encoded, files_in};

/// Mark of a log of records, and the version of the format that this crate writes and reads.
const SEAL: Seal = Seal::new(*b"GRANSTUD", 5);

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

impl Store {
    pub(super) fn new(root: &Path) -> Self {
        Self { folder: root.join("logs"), state: Arc::default() }
    }

    /// Reads the new entries of all processes, and returns all entries.
    pub(super) fn refreshed(&self) -> Result<Arc<Entries>, StudyError> {
        self.state().refresh(&self.folder)
    }

    /// Returns all entries that were read so far.
    pub(super) fn known(&self) -> Arc<Entries> {
        Arc::clone(&self.state().entries)
    }

    /// Returns the log that has an entry, for errors.
    pub(super) fn log_of(&self, entry: &Entry) -> PathBuf {
        self.state().logs[entry.log as usize].path.clone()
    }

    /// Returns a log with an unreadable part, which may have held any record.
    pub(super) fn damage(&self) -> Option<StudyError> {
        let state = self.state();
        let found = state.logs.iter().find(|log| log.is_damaged)?;
        Some(damaged(&found.path, "a part of it is no record"))
    }

    /// Reads the contents of an entry.
    pub(super) fn read<T: DeserializeOwned>(&self, entry: &Entry) -> Result<T, StudyError> {
        let Head { ramp, value, .. } = entry.head();
        let (path, contents) = {
            let mut state = self.state();
            let log = &mut state.logs[entry.log as usize];
            let file = match &mut log.file {
                Some(file) => Ok(file),
                none => File::open(&log.path).map(|file| none.insert(file)),
            };
            (log.path.clone(), file.and_then(|file| read_piece(file, entry)))
        };
        let contents = contents.map_err(StudyError::io("read", &path))?;
        let read = contents.map_err(|_| "its checksum does not match");
        read.and_then(|contents| decoded(&contents))
            .map_err(|reason| damaged(&path, format!("value {value} of ramp {ramp}: {reason}")))
    }

    /// Appends the record of a value, and a readable line to the log.
    pub(super) fn append<T: DeserializeOwned + serde::Serialize>(
        &self,
        head: Head,
        record: &impl serde::Serialize,
        line: &str,
    ) -> Result<(), StudyError> {
        self.push(head, &encoded::<T>(&self.folder, record)?, Some(line))
    }

    /// Marks values as unfinished.
    pub(super) fn void(&self, ramp: usize, values: impl Iterator<Item = usize>) -> Result<(), StudyError> {
        for value in values {
            let head = Head { ramp, value, edition: 0, marks: Marks::VOID, seconds: f32::NAN };
            self.push(head, &[], None)?;
        }
        self.refreshed().map(drop)
    }

    fn push(&self, head: Head, contents: &[u8], line: Option<&str>) -> Result<(), StudyError> {
        let mut state = self.state();
        let before = state.entries.latest(head.ramp, head.value);
        let edition = before.map_or(0, |entry| entry.head().edition + 1);
        state.writer(&self.folder)?.push(Head { edition, ..head }, contents, line)
    }

    /// Adds a line to the log for people.
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
    fn refresh(&mut self, folder: &Path) -> Result<Arc<Entries>, StudyError> {
        let known: HashSet<&Path> = self.logs.iter().map(|log| log.path.as_path()).collect();
        let found: Vec<PathBuf> = logs(folder)?.into_iter().filter(|path| !known.contains(&**path)).collect();
        let new = found.into_iter().map(|path| LogFile { path, end: 0, is_damaged: false, file: None });
        self.logs.extend(new);
        let sorted = self.entries.count();
        for (number, log) in self.logs.iter_mut().enumerate() {
            let entries = &mut self.entries;
            let show = |piece| Arc::make_mut(entries).push(Entry { log: number as u32, ..piece });
            // The file is opened anew each time, since a client of NFS asks for the present length only then.
            let read = Log::each(&log.path, SEAL, log.end, show);
            let (end, is_damaged) = read.map_err(|error| failed("read", &log.path, error))?;
            log.end = end;
            log.is_damaged |= is_damaged;
        }
        if self.entries.count() > sorted {
            Arc::make_mut(&mut self.entries).settle(sorted);
        }
        Ok(Arc::clone(&self.entries))
    }

    fn writer(&mut self, folder: &Path) -> Result<&mut Writer, StudyError> {
        match &mut self.writer {
            Some(writer) => Ok(writer),
            none => Ok(none.insert(Writer::open(folder)?)),
        }
    }
}

/// Returns the logs in a folder.
fn logs(folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let mut found: Vec<PathBuf> = files_in(folder)?.iter().map(DirEntry::path).collect();
    found.retain(|path| path.extension().is_some_and(|ending| ending == "records"));
    Ok(found)
}

/// Returns the error of a log that cannot be read or written, or is of another format.
fn failed(action: &'static str, path: &Path, error: io::Error) -> StudyError {
    match error.kind() {
        io::ErrorKind::InvalidData => damaged(path, error.to_string()),
        _ => StudyError::io(action, path)(error),
    }
}
