//! The folder of a study, with its plan, its provenance and its unfinished values.
//!
//! A process that writes plan or tables holds the lock of the folder. The next process that holds it knows
//! that the writer of a temporary file there is dead.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use granular_edmd::file::{Locked, is_temporary};

use super::provenance::Provenance;
use super::whole::{self, damaged, files_in, if_there};
use super::{PlanError, StudyError};

/// Text of the README in the folder of a study.
const ABOUT: &str = include_str!("folder.txt");

const PLAN: &str = "plan.toml";
const PROVENANCE: &str = "provenance.json";
const README: &str = "README.txt";
const LOGS: &str = "logs";
const UNFINISHED: &str = "unfinished";
/// The folder of the records of version 0.3.
const RAMPS: &str = "ramps";
const LOCK: &str = "lock";
const OUTDATED: &str = "holds a study of version 0.3, whose records this version does not read; \
    finish it by version 0.3 (`cargo install granular-edmd@0.3 --features cli`), or take a new folder: its tables stay as they are";

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
        self.root.join(PLAN)
    }

    /// Returns the path of the file that keeps an unfinished value.
    pub(super) fn partial(&self, ramp: usize, value: usize) -> PathBuf {
        self.root.join(UNFINISHED).join(format!("{ramp:04}-{value:04}"))
    }

    /// Returns the ramp and value indices of the unfinished values.
    pub(super) fn unfinished(&self) -> Result<HashSet<[usize; 2]>, StudyError> {
        let mut found = HashSet::new();
        for file in files_in(&self.root.join(UNFINISHED))? {
            let name = file.file_name();
            let place = name.to_str().and_then(|name| name.split_once('-'));
            found.extend(place.and_then(|(ramp, value)| Some([ramp.parse().ok()?, value.parse().ok()?])));
        }
        Ok(found)
    }

    /// Removes the remaining files of unfinished values once all values are finished.
    fn clear_unfinished(&self) -> Result<(), StudyError> {
        let unfinished = self.unfinished()?;
        unfinished.iter().try_for_each(|[ramp, value]| whole::remove(&self.partial(*ramp, *value)))?;
        let folder = self.root.join(UNFINISHED);
        if folder.exists() {
            whole::remove_temporaries(&folder)?;
            // A user may keep other files in this folder.
            let _ = fs::remove_dir(&folder);
        }
        Ok(())
    }

    /// Returns an error if the folder has records of version 0.3, which this version does not read.
    pub(super) fn check_format(&self) -> Result<(), StudyError> {
        if self.root.join(RAMPS).exists() && !self.root.join(LOGS).exists() {
            return Err(StudyError::refused(&self.root, OUTDATED));
        }
        Ok(())
    }

    /// Returns whether the folder holds a study. A plan alone is not a study: a user may keep plans there,
    /// among other files. A study has a lock beside its plan from the beginning, soon a README, and then
    /// ramps. A copy of a study may lack some of these.
    pub(super) fn holds_study(&self) -> bool {
        let has_lock = self.root.join(LOCK).metadata().is_ok_and(|lock| is_lock(&lock));
        let has_others = || [README, LOGS, RAMPS].iter().any(|name| self.root.join(name).exists());
        self.plan().exists() && (has_lock || has_others())
    }

    /// Writes a plan to the folder, and creates the folder if needed. Returns false if the folder already has
    /// a plan.
    ///
    /// The plan is checked under the lock: of processes that start together, one checks, and the others wait.
    pub(super) fn create(
        &self,
        plan: &str,
        provenance: &Provenance,
        check: impl FnOnce() -> Result<(), PlanError>,
    ) -> Result<bool, StudyError> {
        self.check_free()?;
        whole::create(&self.root)?;
        let _lock = self.take_lock()?;
        let is_new = !self.plan().exists();
        if is_new {
            check()?;
        }
        whole::remove_temporaries(&self.root)?;
        if is_new {
            whole::write(&self.plan(), plan.as_bytes())?;
        }
        // If a process is killed here, the folder has a plan but no provenance and no records.
        if !self.root.join(LOGS).exists() && !self.provenance_file().exists() {
            whole::write(&self.provenance_file(), provenance.text().as_bytes())?;
        }
        self.write_about()?;
        Ok(is_new)
    }

    pub(super) fn provenance_file(&self) -> PathBuf {
        self.root.join(PROVENANCE)
    }

    /// Returns the provenance of the study, or `None` if its file is missing.
    pub(super) fn provenance(&self) -> Result<Option<Provenance>, StudyError> {
        let path = self.provenance_file();
        let text = if_there("read", &path, fs::read_to_string(&path))?;
        let read = text.map(|text| serde_json::from_str(&text)).transpose();
        read.map_err(|reason| damaged(&path, format!("it is no provenance ({reason})")))
    }

    /// Replaces the provenance.
    pub(super) fn replace_provenance(&self, provenance: &Provenance) -> Result<(), StudyError> {
        let _lock = self.take_lock()?;
        whole::write(&self.provenance_file(), provenance.text().as_bytes())
    }

    /// Writes the README of the folder, if it is missing or cut short. An edited README stays.
    fn write_about(&self) -> Result<(), StudyError> {
        let path = self.root.join(README);
        let is_cut = |found: Vec<u8>| found.len() < ABOUT.len() && ABOUT.as_bytes().starts_with(&found);
        if path.exists() && !fs::read(&path).is_ok_and(is_cut) {
            return Ok(());
        }
        whole::write(&path, ABOUT.as_bytes())
    }

    /// Checks that the folder has a plan, or nothing but a lock and temporary files, which are written before
    /// a plan.
    fn check_free(&self) -> Result<(), StudyError> {
        if !self.root.is_dir() {
            // The attempt to create it gives the error, if that fails.
            return Ok(());
        }
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

    pub(super) fn read_plan(&self) -> Result<String, StudyError> {
        fs::read_to_string(self.plan()).map_err(StudyError::io("read", &self.plan()))
    }

    /// Returns whether all ramps are finished and in the tables.
    pub(super) fn is_complete(&self) -> bool {
        self.complete().exists()
    }

    /// Removes the mark of a complete study before a value is written that the tables may lack.
    pub(super) fn mark_incomplete(&self) -> Result<(), StudyError> {
        whole::remove(&self.complete())
    }

    /// Marks that all ramps are in the tables. The caller holds the lock of the study.
    pub(super) fn mark_complete(&self) -> Result<(), StudyError> {
        self.clear_unfinished()?;
        whole::write(&self.complete(), b"")
    }

    fn complete(&self) -> PathBuf {
        self.root.join("complete")
    }

    fn take_lock(&self) -> Result<Locked, StudyError> {
        let path = self.root.join(LOCK);
        let file = fs::File::options().read(true).write(true).create(true).truncate(false).open(&path);
        let file = file.map_err(StudyError::io("write", &path))?;
        Locked::wait(file).map_err(|source| StudyError::NoLock { path, source })
    }

    /// Waits for the lock of the whole study, and locks the study in order to write tables.
    pub(super) fn lock(&self) -> Result<Locked, StudyError> {
        let lock = self.take_lock()?;
        whole::remove_temporaries(&self.root)?;
        // The process that wrote the plan may have been killed before it wrote the README.
        self.write_about()?;
        Ok(lock)
    }
}

/// Returns whether a file with the name of a lock is a lock, and thus empty.
fn is_lock(file: &fs::Metadata) -> bool {
    file.is_file() && file.len() == 0
}
