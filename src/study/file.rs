//! The files of a study: whole or absent, and sealed where they hold records.

use std::fs;
use std::io;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::errors::StudyError;
use crate::file::{Broken, Seal, is_temporary, write_whole};

/// Mark of a record, and the version of the format that this crate writes and reads.
const SEAL: Seal = Seal { magic: *b"GRANSTUD", version: 2 };

/// Writes a file, whole or not at all.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    write_whole(path, bytes).map_err(StudyError::io("write", path))
}

/// Writes data with magic, version and checksum.
pub(super) fn write_sealed(path: &Path, data: &impl Serialize) -> Result<(), StudyError> {
    let contents = postcard::to_stdvec(data)
        .map_err(|error| StudyError::Encode { path: path.to_owned(), source: Box::new(error) })?;
    write(path, &SEAL.seal(&contents))
}

/// Reads data that [`write_sealed`] has written; `None` if there is no such file.
pub(super) fn read_sealed<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, StudyError> {
    let bytes = match fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(StudyError::io("read", path)(error)),
    };
    unseal(&bytes).map(Some).map_err(|reason| damaged(path, reason))
}

pub(super) fn damaged(path: &Path, reason: &'static str) -> StudyError {
    StudyError::Damaged { path: path.to_owned(), reason }
}

fn unseal<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, &'static str> {
    let contents = SEAL.open(bytes).map_err(|broken| match broken {
        Broken::Foreign => "it does not begin as a record",
        Broken::Version(_) => "it has another version of the format",
        Broken::Cut => "it was cut",
        Broken::Changed => "its checksum does not match",
    })?;
    match postcard::take_from_bytes(contents) {
        Ok((data, [])) => Ok(data),
        Ok(_) => Err("there is more in it than there should be"),
        Err(_) => Err("its contents make no sense"),
    }
}

/// Removes a file, if it is there.
pub(super) fn remove(path: &Path) -> Result<(), StudyError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(StudyError::io("remove", path)(error)),
        _ => Ok(()),
    }
}

/// Removes the temporary files that a killed process has left in a folder, and nothing else.
pub(super) fn remove_temporaries(folder: &Path) -> Result<(), StudyError> {
    let cannot_read = || StudyError::io("read", folder);
    for entry in fs::read_dir(folder).map_err(cannot_read())? {
        let entry = entry.map_err(cannot_read())?;
        if is_temporary(&entry.file_name()) && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            remove(&entry.path())?;
        }
    }
    Ok(())
}
