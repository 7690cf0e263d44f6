//! Files of recorders, which grow by complete pieces.

use std::fs::File;
use std::io;
use std::path::Path;

use super::RecordError;
use crate::file::{Growing, Locked};

/// Creates a new file, locked for one recorder, or opens an existing empty file if this is allowed.
pub(super) fn create(path: &Path, may_exist: bool) -> Result<Growing<Locked>, RecordError> {
    let mut options = File::options();
    options.read(true).write(true).create(may_exist).create_new(!may_exist);
    let file = options.open(path).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => RecordError::Exists { path: path.to_owned() },
        _ => RecordError::io("create", path)(error),
    })?;
    let file = locked(file, path)?;
    if file.file().metadata().is_ok_and(|there| there.len() > 0) {
        return Err(RecordError::Exists { path: path.to_owned() });
    }
    Ok(Growing::new(path, file, 0, Vec::new()))
}

/// Returns whether a recorder compresses a file with this name.
pub(super) fn is_gzip(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "gz")
}

/// Waits until the system has stored everything.
pub(super) fn sync(file: &Growing<Locked>) -> Result<(), RecordError> {
    file.medium.file().sync_all().map_err(RecordError::io("write to", &file.path))
}

/// Opens a file, locked for one recorder.
pub(super) fn reopen(path: &Path) -> Result<Locked, RecordError> {
    let file = File::options().read(true).write(true).open(path);
    locked(file.map_err(RecordError::io("open", path))?, path)
}

/// Locks a file; the lock ends with the process at the latest.
fn locked(file: File, path: &Path) -> Result<Locked, RecordError> {
    Locked::take_if_possible(file).map_err(|_| RecordError::Locked { path: path.to_owned() })
}
