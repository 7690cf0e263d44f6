//! The folder of a study, with its files and the locks of the processes that write them.
//!
//! A process that writes into the folder of a study or of a ramp holds the lock of that folder. So the next
//! holder of the lock knows that the writer of a temporary file there is dead.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::errors::StudyError;
use super::file;
use super::lock::{self, Lock};
use super::log;
use crate::file::is_temporary;

/// Text of the README in the folder of a study, for somebody who comes across it.
const ABOUT: &str = "\
A study by granular-edmd (event-driven molecular dynamics of frictional, inelastic, rotating disks).

plan.toml             what is simulated: experiment, protocol, ramp, sweep, repeats, seed
values.csv            a row for each value: parameters, means, standard errors, counts
samples.csv           a row for each sample
points.csv            a row for each value, all repeats of it together
transitions.csv       a row for each transition that a refined ramp brackets
columns.csv           the names and units of all columns of all tables
ramps/R/V.record      value V of ramp R (0000/0000.record is the first): samples, counts and last state, with a checksum
ramps/R/V.partial     a value half done
ramps/R/value.json    the swept parameters of ramp R, if the study was prepared for an engine that goes by folders
ramps/R/done          there once all values of ramp R have a record
ramps/R/lock          locked while a process does ramp R
done                  there once all ramps are done and in the tables
log.jsonl             when values were finished, and the seconds that they took; not a result
lock                  locked while a process makes the plan or the tables

Tables are written when all ramps are done, or on demand. Lost or damaged files come back, the same bytes, when the study is
run again by the same version. Any number of processes may run it at the same time.
";

const PLAN: &str = "plan.toml";
const README: &str = "README.txt";
const RAMPS: &str = "ramps";

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

    pub(super) fn ramp(&self, ramp: usize) -> PathBuf {
        self.root.join(RAMPS).join(format!("{ramp:04}"))
    }

    pub(super) fn record(&self, ramp: usize, value: usize) -> PathBuf {
        self.ramp(ramp).join(format!("{value:04}.record"))
    }

    pub(super) fn partial(&self, ramp: usize, value: usize) -> PathBuf {
        self.ramp(ramp).join(format!("{value:04}.partial"))
    }

    fn done(&self, ramp: usize) -> PathBuf {
        self.ramp(ramp).join("done")
    }

    /// Returns whether the folder holds a study. A plan alone is not a study: somebody may keep plans there,
    /// among other files. A study has a lock beside its plan from the first moment, soon a README, and then
    /// ramps. A copy of a study may lack some of these.
    pub(super) fn holds_study(&self) -> bool {
        let has_lock = self.root.join(lock::NAME).metadata().is_ok_and(|lock| is_lock(&lock));
        let has_others = || [README, RAMPS].iter().any(|name| self.root.join(name).exists());
        self.plan().exists() && (has_lock || has_others())
    }

    /// Puts a plan into the folder, which it creates if needed; returns false if there is a plan already.
    pub(super) fn create(&self, plan: &str) -> Result<bool, StudyError> {
        self.check_free()?;
        fs::create_dir_all(&self.root).map_err(StudyError::io("create", &self.root))?;
        let _lock = Lock::take(&self.root)?;
        file::remove_temporaries(&self.root)?;
        let is_new = file::publish(&self.plan(), plan.as_bytes())?;
        self.write_about()?;
        Ok(is_new)
    }

    /// Writes the README of the folder, if it is not there.
    fn write_about(&self) -> Result<(), StudyError> {
        file::publish(&self.root.join(README), ABOUT.as_bytes()).map(drop)
    }

    /// Checks that the folder has a plan, or nothing but a lock and temporary files, which come before a
    /// plan.
    fn check_free(&self) -> Result<(), StudyError> {
        let Some(stranger) = self.stranger()? else { return Ok(()) };
        // The plan may have come while the folder was read.
        if self.holds_study() {
            return Ok(());
        }
        Err(StudyError::Occupied { path: self.root.clone(), name: stranger })
    }

    fn stranger(&self) -> Result<Option<String>, StudyError> {
        let cannot_read = || StudyError::io("read", &self.root);
        let entries = match fs::read_dir(&self.root) {
            // There is no such folder. The attempt to create it gives the error, if that fails.
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                return Ok(None);
            }
            entries => entries.map_err(cannot_read())?,
        };
        for entry in entries {
            let entry = entry.map_err(cannot_read())?;
            let name = entry.file_name();
            let is_lock = name == lock::NAME && entry.metadata().is_ok_and(|lock| is_lock(&lock));
            if !is_lock && !is_temporary(&name) {
                return Ok(Some(name.to_string_lossy().into_owned()));
            }
        }
        Ok(None)
    }

    pub(super) fn read_plan(&self) -> Result<String, StudyError> {
        fs::read_to_string(self.plan()).map_err(StudyError::io("read", &self.plan()))
    }

    /// Takes the lock of a ramp, in its folder; returns `None` if somebody does the ramp.
    pub(super) fn take(&self, ramp: usize) -> Result<Option<Lock>, StudyError> {
        let folder = self.ramp(ramp);
        fs::create_dir_all(&folder).map_err(StudyError::io("create", &folder))?;
        let lock = Lock::try_take(&folder)?;
        if lock.is_some() {
            file::remove_temporaries(&folder)?;
        }
        Ok(lock)
    }

    pub(super) fn is_taken(&self, ramp: usize) -> bool {
        Lock::is_taken(&self.ramp(ramp))
    }

    /// Returns whether a process has ever begun a ramp. The folder alone does not say so, since it may have
    /// been prepared.
    pub(super) fn is_begun(&self, ramp: usize) -> bool {
        self.ramp(ramp).join(lock::NAME).exists()
    }

    pub(super) fn is_done(&self, ramp: usize) -> bool {
        self.done(ramp).exists()
    }

    /// Marks a ramp as done.
    pub(super) fn mark_done(&self, ramp: usize) -> Result<(), StudyError> {
        let path = self.done(ramp);
        if path.exists() { Ok(()) } else { file::write(&path, b"") }
    }

    /// Removes the mark that a ramp is done.
    pub(super) fn mark_undone(&self, ramp: usize) -> Result<(), StudyError> {
        file::remove(&self.done(ramp))
    }

    /// Returns whether all ramps are done and in the tables.
    pub(super) fn is_complete(&self) -> bool {
        self.complete().exists()
    }

    /// Marks that all ramps are in the tables.
    pub(super) fn mark_complete(&self) -> Result<(), StudyError> {
        let _lock = Lock::take(&self.root)?;
        if self.is_complete() { Ok(()) } else { file::write(&self.complete(), b"") }
    }

    /// Removes the mark that the study is complete, before a value comes that may not be in the tables.
    pub(super) fn mark_incomplete(&self) -> Result<(), StudyError> {
        file::remove(&self.complete())
    }

    fn complete(&self) -> PathBuf {
        self.root.join("done")
    }

    /// Writes tables, each to a file of its name.
    pub(super) fn write_tables<'a>(
        &self,
        tables: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<(), StudyError> {
        let _lock = Lock::take(&self.root)?;
        file::remove_temporaries(&self.root)?;
        // The process that put the plan here may have been killed before it wrote the README.
        self.write_about()?;
        tables
            .into_iter()
            .try_for_each(|(name, text)| file::write(&self.root.join(format!("{name}.csv")), text.as_bytes()))
    }

    /// Adds a line to the log.
    pub(super) fn log(&self, line: &str) -> Result<(), StudyError> {
        let path = self.root.join("log.jsonl");
        log::append(&path, line).map_err(StudyError::io("write", &path))
    }
}

/// Returns whether a file of the name of a lock is one: it is empty.
fn is_lock(file: &fs::Metadata) -> bool {
    file.is_file() && file.len() == 0
}
