//! The small files of a study. Each file is complete or absent, and the file of an unfinished value is
//! sealed.

use std::fs::{self, DirEntry, File};
use std::io;
use std::path::Path;

use granular_edmd::file::{Damage, Seal, is_temporary, write_whole};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::StudyError;

/// Mark of an unfinished value, and the version of the format that this crate writes and reads.
const SEAL: Seal = Seal::new(*b"GRANPART", 5);

/// Writes a file, completely or not at all.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    write_whole(path, bytes).map_err(StudyError::io("write", path))
}

/// Opens the file of a lock, and creates it and its folder if necessary.
pub(crate) fn open_lock(path: &Path) -> Result<File, StudyError> {
    let mut options = File::options();
    options.read(true).write(true).create(true).truncate(false);
    let opened = options.open(path);
    let opened = match (&opened, path.parent()) {
        (Err(error), Some(folder)) if error.kind() == io::ErrorKind::NotFound => {
            create(folder)?;
            options.open(path)
        }
        _ => opened,
    };
    opened.map_err(StudyError::io("write", path))
}

/// Creates a folder, with the folders that contain it.
pub(crate) fn create(folder: &Path) -> Result<(), StudyError> {
    fs::create_dir_all(folder).map_err(StudyError::io("create", folder))
}

/// Returns data for a file as bytes, which read back as they were written.
pub(crate) fn encoded<T: DeserializeOwned + Serialize>(
    path: &Path,
    data: &impl Serialize,
) -> Result<Vec<u8>, StudyError> {
    let refused = |source| StudyError::Encode { path: path.to_owned(), source };
    let contents = postcard::to_stdvec(data).map_err(|error| refused(error.into()))?;
    let again = postcard::from_bytes::<T>(&contents).and_then(|read| postcard::to_stdvec(&read));
    if again.is_ok_and(|again| again == contents) {
        return Ok(contents);
    }
    let reason = "a sample or observer does not read back as it is written: its type must not have \
                  `#[serde(untagged)]`, `flatten`, `skip` or `skip_serializing_if`";
    Err(refused(reason.into()))
}

/// Reads data that [`encoded`] has made.
pub(crate) fn decoded<T: DeserializeOwned>(contents: &[u8]) -> Result<T, &'static str> {
    match postcard::take_from_bytes(contents) {
        Ok((data, [])) => Ok(data),
        Ok(_) => Err("there is more in it than there should be"),
        Err(_) => Err("its contents make no sense"),
    }
}

/// Writes data with a magic number, a version and a checksum.
pub(crate) fn write_sealed<T: DeserializeOwned + Serialize>(
    path: &Path,
    data: &impl Serialize,
) -> Result<(), StudyError> {
    write(path, &SEAL.seal(&encoded::<T>(path, data)?))
}

/// Reads data that [`write_sealed`] has written, or returns `None` if the file does not exist.
pub(crate) fn read_sealed<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, StudyError> {
    let Some(bytes) = if_there("read", path, fs::read(path))? else { return Ok(None) };
    let contents = SEAL.open(&bytes).map_err(|broken| match broken {
        Damage::Foreign => "it does not begin as a value half done",
        Damage::Version(_) => "it has another version of the format",
        Damage::Cut => "it was cut",
        _ => "its checksum does not match",
    });
    contents.and_then(decoded).map(Some).map_err(|reason| damaged(path, reason))
}

pub(crate) fn damaged(path: &Path, reason: impl Into<String>) -> StudyError {
    StudyError::Damaged { path: path.to_owned(), reason: reason.into() }
}

/// Removes a file if it exists.
pub(crate) fn remove(path: &Path) -> Result<(), StudyError> {
    if_there("remove", path, fs::remove_file(path)).map(drop)
}

/// Returns the system's result for a file or folder, or `None` if nothing with this name exists.
pub(crate) fn if_there<T>(
    action: &'static str,
    path: &Path,
    answer: io::Result<T>,
) -> Result<Option<T>, StudyError> {
    match answer {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        answer => answer.map(Some).map_err(StudyError::io(action, path)),
    }
}

/// Returns the files in a folder; none if it does not exist.
pub(crate) fn files_in(folder: &Path) -> Result<Vec<DirEntry>, StudyError> {
    let files = if_there("read", folder, fs::read_dir(folder))?.into_iter().flatten();
    files.collect::<io::Result<_>>().map_err(StudyError::io("read", folder))
}

/// Removes the temporary files that a killed process has left in a folder, and nothing else. The folder must
/// be locked.
pub(crate) fn remove_temporaries(folder: &Path) -> Result<(), StudyError> {
    let mut files = files_in(folder)?;
    files.retain(|file| is_temporary(&file.file_name()) && file.file_type().is_ok_and(|kind| kind.is_file()));
    files.iter().try_for_each(|file| remove(&file.path()))
}
