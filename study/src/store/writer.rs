//! The log of one process, with a second file of readable lines, which is locked.

use std::fs::TryLockError;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use granular_edmd::file::Locked;

use super::index::Head;
use super::log::Log;
use super::{SEAL, failed, logs};
use crate::StudyError;
use crate::seed::anywhere;
use crate::whole::open_lock;

/// Seconds of work that a loss of power may cost.
const AT_RISK: f32 = 0.1;

/// A log that this process alone writes.
#[derive(Debug)]
pub(super) struct Writer {
    path: PathBuf,
    log: Log,
    lines: Locked,
    /// True if the last line is complete.
    is_whole: bool,
    /// Seconds of work that are not synced.
    at_risk: f32,
}

impl Writer {
    /// Opens a log that no process is writing, or creates a new log.
    pub(super) fn open(folder: &Path) -> Result<Self, StudyError> {
        let mut known = logs(folder)?;
        known.sort();
        let count = known.len();
        known.rotate_left(anywhere(count));
        let names =
            known.into_iter().chain((count..).map(|number| folder.join(format!("{number:04}.records"))));
        for path in names {
            let lines = path.with_extension("jsonl");
            match Locked::take(open_lock(&lines)?) {
                Ok(lines) => {
                    let log = Log::open(&path, SEAL).map_err(|error| failed("write", &path, error))?;
                    return Ok(Self { path, log, lines, is_whole: false, at_risk: 0.0 });
                }
                Err(TryLockError::WouldBlock) => {}
                Err(TryLockError::Error(source)) => return Err(StudyError::NoLock { path: lines, source }),
            }
        }
        Err(StudyError::NoLock { path: folder.to_owned(), source: io::ErrorKind::WouldBlock.into() })
    }

    /// Appends a piece, and a line.
    pub(super) fn push(&mut self, head: Head, contents: &[u8], line: Option<&str>) -> Result<(), StudyError> {
        self.log.push(head.bytes(), contents).map_err(StudyError::io("write", &self.path))?;
        // Syncing a disk can take longer than running a value again.
        self.at_risk += head.seconds.max(0.0);
        if self.at_risk > AT_RISK {
            self.sync()?;
        }
        if let Some(line) = line {
            self.note(line);
        }
        Ok(())
    }

    pub(super) fn sync(&mut self) -> Result<(), StudyError> {
        self.at_risk = 0.0;
        self.log.sync().map_err(StudyError::io("write", &self.path))
    }

    /// Adds a line. A failure is ignored, since a line that cannot be written must not cost the work.
    pub(super) fn note(&mut self, line: &str) {
        let whole = if self.is_whole { Ok(self.lines.file()) } else { to_last_line_end(self.lines.file()) };
        self.is_whole = whole.and_then(|mut end| end.write_all(format!("{line}\n").as_bytes())).is_ok();
    }
}

/// Moves to the end of the last complete line, and removes everything after it.
fn to_last_line_end(mut file: &std::fs::File) -> io::Result<&std::fs::File> {
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
