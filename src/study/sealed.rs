//! Files that are whole or not there: written atomically, with a version and a checksum.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::errors::StudyError;

/// First bytes of a record.
const MAGIC: [u8; 8] = *b"GRANSTUD";

/// Version of the format that this crate writes and reads.
const VERSION: u32 = 1;

/// Ending of files that are being written.
const TEMPORARY: &str = "tmp";

/// Writes a file, whole or not at all. Whoever writes holds the lock of the study: nobody else takes the same name.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".");
    name.push(TEMPORARY);
    let temporary = path.with_file_name(name);
    write_synced(&temporary, bytes)
        .and_then(|()| fs::rename(&temporary, path))
        .map_err(StudyError::io("write", path))
}

fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Writes data with magic, version and checksum.
pub(super) fn write_sealed(path: &Path, data: &impl Serialize) -> Result<(), StudyError> {
    let contents = postcard::to_stdvec(data)?;
    let mut bytes = Vec::with_capacity(MAGIC.len() + 4 + 32 + contents.len());
    bytes.extend_from_slice(&MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(blake3::hash(&contents).as_bytes());
    bytes.extend_from_slice(&contents);
    write(path, &bytes)
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
    let rest = bytes.strip_prefix(&MAGIC).ok_or("it does not begin as a record")?;
    let (version, rest) = rest.split_first_chunk::<4>().ok_or("it was cut")?;
    if u32::from_le_bytes(*version) != VERSION {
        return Err("it has another version of the format");
    }
    let (checksum, contents) = rest.split_first_chunk::<32>().ok_or("it was cut")?;
    if blake3::hash(contents) != blake3::Hash::from_bytes(*checksum) {
        return Err("its checksum does not match");
    }
    postcard::from_bytes(contents).map_err(|_| "its contents make no sense")
}

/// Removes a file, if it is there.
pub(super) fn remove(path: &Path) -> Result<(), StudyError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(StudyError::io("remove", path)(error)),
        _ => Ok(()),
    }
}

/// Removes what a killed process was writing in a folder.
pub(super) fn remove_temporaries(folder: &Path) -> Result<(), StudyError> {
    let unfinished = |path: &PathBuf| path.extension().is_some_and(|ending| ending == TEMPORARY);
    files(folder)?.iter().filter(|path| unfinished(path)).try_for_each(|path| remove(path))
}

/// What a folder holds.
fn files(folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let entries = fs::read_dir(folder).and_then(|entries| {
        entries.map(|entry| entry.map(|entry| entry.path())).collect::<io::Result<Vec<_>>>()
    });
    entries.map_err(StudyError::io("read", folder))
}
