//! The folder of a study: its plan, its provenance, its unfinished values, and the mark of a complete study.
//! Each of these files is complete or absent.
//!
//! A process that writes the plan or the tables holds the folder's lock. The next process that holds the lock
//! knows that the writer of any temporary file in the folder is dead.

use std::ffi::OsString;
use std::fs::{self, DirEntry, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use granular_edmd::file::{Damage, Locked, Seal, is_temporary, write_whole};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::StudyError;

/// Text of the README in the folder of a study.
const ABOUT: &str = include_str!("folder.txt");

const README: &str = "README.txt";
pub(super) const BLOCKS: &str = "blocks";
const UNFINISHED: &str = "unfinished";
const LOCK: &str = "lock";

/// Magic number of the file of an unfinished value, and the version of the format that this crate writes and
/// reads.
const SEAL: Seal = Seal::new(*b"GRANPART", 6);

/// The folder of a study.
#[derive(Debug, Clone)]
pub(super) struct Folder {
    root: PathBuf,
}

impl Folder {
    pub(super) fn new(root: &Path) -> Result<Self, StudyError> {
        if root.as_os_str().is_empty() { Err(StudyError::NoPath) } else { Ok(Self { root: root.to_owned() }) }
    }

    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    pub(super) fn plan(&self) -> PathBuf {
        self.root.join("plan.toml")
    }

    /// Returns the path of the file that keeps an unfinished value.
    pub(super) fn partial(&self, ramp: usize, value: usize) -> PathBuf {
        self.root.join(UNFINISHED).join(format!("{ramp:04}-{value:04}"))
    }

    /// Returns the ramp and value indices of the unfinished values.
    pub(super) fn unfinished(&self) -> Result<Vec<[usize; 2]>, StudyError> {
        let names = files_in(&self.root.join(UNFINISHED))?.into_iter().map(|file| file.file_name());
        let place = |name: OsString| {
            let (ramp, value) = name.to_str()?.split_once('-')?;
            Some([ramp.parse().ok()?, value.parse().ok()?])
        };
        Ok(names.filter_map(place).collect())
    }

    /// Returns whether the folder holds a study. A plan alone is not a study: a user may keep plans there,
    /// among other files. A study has a lock file beside its plan from the beginning, soon a README, and then
    /// records. A copy of a study may lack some of these.
    pub(super) fn holds_study(&self) -> bool {
        let has_lock = self.root.join(LOCK).metadata().is_ok_and(|lock| is_lock(&lock));
        let has_others = || [README, BLOCKS].iter().any(|name| self.root.join(name).exists());
        self.plan().exists() && (has_lock || has_others())
    }

    pub(super) fn provenance(&self) -> PathBuf {
        self.root.join("provenance.json")
    }

    /// Returns the path of the mark that all ramps are finished and in the tables. The mark is removed before
    /// a value is written that the tables may lack.
    pub(super) fn complete(&self) -> PathBuf {
        self.root.join("complete")
    }

    /// Writes the README if it is missing, and the provenance if it is missing and the folder
    /// has no records. An edited README stays. The caller holds the lock.
    pub(super) fn put(&self, provenance: &str) -> Result<(), StudyError> {
        let path = self.root.join(README);
        if !path.exists() {
            write(&path, ABOUT.as_bytes())?;
        }
        if self.provenance().exists() || self.root.join(BLOCKS).exists() {
            return Ok(());
        }
        write(&self.provenance(), provenance.as_bytes())
    }

    /// Creates the folder if needed. Checks that it has a plan, or nothing but a lock and temporary files,
    /// which are written before a plan.
    pub(super) fn check_free(&self) -> Result<(), StudyError> {
        create(&self.root)?;
        for entry in files_in(&self.root)? {
            let name = entry.file_name();
            let is_lock = name == LOCK && entry.metadata().is_ok_and(|lock| is_lock(&lock));
            // Another process may have written the plan while the folder was read.
            if !is_lock && !is_temporary(&name) && !self.holds_study() {
                let name = name.display();
                let reason = format!("holds other files ({name}) and no study; choose an empty folder");
                return Err(StudyError::refused(&self.root, reason));
            }
        }
        Ok(())
    }

    /// Returns the text of the plan.
    pub(super) fn read_plan(&self) -> Result<String, StudyError> {
        fs::read_to_string(self.plan()).map_err(StudyError::io("read", &self.plan()))
    }

    /// Writes the mark that all ramps are in the tables, and removes the files of unfinished values that are
    /// left. The caller holds the lock of the study.
    pub(super) fn mark_complete(&self) -> Result<(), StudyError> {
        for [ramp, value] in self.unfinished()? {
            remove(&self.partial(ramp, value))?;
        }
        let folder = self.root.join(UNFINISHED);
        if folder.exists() {
            remove_temporaries(&folder)?;
            // A user may keep other files in this folder.
            let _ = fs::remove_dir(&folder);
        }
        write(&self.complete(), b"")
    }

    /// Waits for the lock of the whole study, in order to write to its folder.
    pub(super) fn lock(&self) -> Result<Locked, StudyError> {
        let path = self.root.join(LOCK);
        let lock = Locked::wait(open_lock(&path)?).map_err(|source| StudyError::NoLock { path, source })?;
        remove_temporaries(&self.root)?;
        Ok(lock)
    }
}

/// Returns whether a file with the name of a lock file is one: a lock file is empty.
fn is_lock(file: &fs::Metadata) -> bool {
    file.is_file() && file.len() == 0
}

/// Writes a file, completely or not at all.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    write_whole(path, bytes).map_err(StudyError::io("write", path))
}

/// Takes the lock of a file, or returns `None` if another process has it. The lock ends with the process,
/// even if the process is killed.
///
/// A lock file is never deleted. Otherwise, two processes could hold locks on two different files of the
/// same name.
pub(super) fn try_lock(path: &Path) -> Result<Option<Locked>, StudyError> {
    match Locked::take(open_lock(path)?) {
        Ok(locked) => Ok(Some(locked)),
        Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(source)) => Err(StudyError::NoLock { path: path.to_owned(), source }),
    }
}

/// Opens a lock file, and creates the file and its folder if necessary.
fn open_lock(path: &Path) -> Result<File, StudyError> {
    let open = || File::options().read(true).write(true).create(true).truncate(false).open(path);
    let opened = match (open(), path.parent()) {
        (Err(error), Some(folder)) if error.kind() == io::ErrorKind::NotFound => {
            create(folder)?;
            open()
        }
        (opened, _) => opened,
    };
    opened.map_err(StudyError::io("write", path))
}

/// Creates a folder, with the folders that contain it.
pub(super) fn create(folder: &Path) -> Result<(), StudyError> {
    fs::create_dir_all(folder).map_err(StudyError::io("create", folder))
}

/// Encodes data for a file. Checks that decoding and encoding again gives the same bytes.
pub(super) fn encoded<T: DeserializeOwned + Serialize>(
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
pub(super) fn decoded<T: DeserializeOwned>(contents: &[u8]) -> Result<T, &'static str> {
    match postcard::take_from_bytes(contents) {
        Ok((data, [])) => Ok(data),
        Ok(_) => Err("there is more in it than there should be"),
        Err(_) => Err("its contents make no sense"),
    }
}

/// Writes data with a magic number, a version and a checksum.
pub(super) fn write_sealed<T: DeserializeOwned + Serialize>(
    path: &Path,
    data: &impl Serialize,
) -> Result<(), StudyError> {
    write(path, &SEAL.seal(&encoded::<T>(path, data)?))
}

/// Reads data that [`write_sealed`] has written, or returns `None` if the file does not exist.
pub(super) fn read_sealed<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, StudyError> {
    let Some(bytes) = if_there("read", path, fs::read(path))? else { return Ok(None) };
    let contents = SEAL.open(&bytes).map_err(|broken| match broken {
        Damage::Foreign => "it does not begin as a value half done",
        Damage::Version(_) => "it has another version of the format",
        Damage::Cut => "it was cut",
        _ => "its checksum does not match",
    });
    contents.and_then(decoded).map(Some).map_err(|reason| StudyError::damaged(path, reason))
}

/// Removes a file if it exists.
pub(super) fn remove(path: &Path) -> Result<(), StudyError> {
    if_there("remove", path, fs::remove_file(path)).map(drop)
}

/// Returns the result of a file operation, or `None` if the file or folder does not exist.
pub(super) fn if_there<T>(
    action: &'static str,
    path: &Path,
    answer: io::Result<T>,
) -> Result<Option<T>, StudyError> {
    match answer {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        answer => answer.map(Some).map_err(StudyError::io(action, path)),
    }
}

/// Returns the files in a folder. The list is empty if the folder does not exist.
fn files_in(folder: &Path) -> Result<Vec<DirEntry>, StudyError> {
    let files = if_there("read", folder, fs::read_dir(folder))?.into_iter().flatten();
    files.collect::<io::Result<_>>().map_err(StudyError::io("read", folder))
}

/// Removes the temporary files that a killed process has left in a folder, and nothing else. The folder must
/// be locked.
fn remove_temporaries(folder: &Path) -> Result<(), StudyError> {
    let mut files = files_in(folder)?;
    files.retain(|file| is_temporary(&file.file_name()) && file.file_type().is_ok_and(|kind| kind.is_file()));
    files.iter().try_for_each(|file| remove(&file.path()))
}
