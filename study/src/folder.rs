//! The folder of a study, with its files and the locks of the processes that write them.
//!
//! A process that writes into the folder of a study or of a ramp holds the lock of that folder. So whoever
//! holds the lock next knows that the writer of a temporary file there is dead.

mod lock;
mod marks;
pub(super) mod sealed;

use std::fs::{self, File};
use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::thread;

use granular_edmd::file::is_temporary;

use super::provenance::Provenance;
use super::{PlanError, StudyError};

pub(super) use lock::Lock;
pub(super) use marks::Mark;

/// Text of the README in the folder of a study.
const ABOUT: &str = "\
A study by granular-edmd (event-driven molecular dynamics of frictional, inelastic, rotating disks).

plan.toml             what is simulated: experiment, protocol, ramp, sweep, repeats, seed
provenance.json       what began it: program, versions, target, revision of the experiment
values.csv            a row for each value: parameters, means, standard errors, counts
samples.csv           a row for each sample
points.csv            a row for each value, all repeats of it together
transitions.csv       a row for each transition that a refined ramp brackets
columns.csv           the names and units of all columns of all tables
ramps/R/V.record      value V of ramp R (0000/0000.record is the first): samples and counts, with a checksum
ramps/R/V.partial     a value half done
ramps/R/log.jsonl     when values were finished, and the seconds that they took; not a result. It is locked while
                      a process does ramp R
done                  a letter for each ramp: d once all its values have a record, f if some of these stalled or failed
complete              there once all ramps are done and in the tables
lock                  locked while a process makes the plan or the tables

Tables are written when all ramps are done, or on demand. Lost or damaged files come back, the same bytes, when the study is
run again with --verify. Any number of processes may run it at the same time.
";

const PLAN: &str = "plan.toml";
const PROVENANCE: &str = "provenance.json";
const README: &str = "README.txt";
const RAMPS: &str = "ramps";
const LOCK: &str = "lock";

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

    /// Returns the log of a ramp, whose lock is that of the ramp.
    pub(super) fn log_of(&self, ramp: usize) -> PathBuf {
        self.ramp(ramp).join("log.jsonl")
    }

    /// Returns whether the folder holds a study. A plan alone is not a study: somebody may keep plans there,
    /// among other files. A study has a lock beside its plan from the first moment, soon a README, and then
    /// ramps. A copy of a study may lack some of these.
    pub(super) fn holds_study(&self) -> bool {
        let has_lock = self.root.join(LOCK).metadata().is_ok_and(|lock| is_lock(&lock));
        let has_others = || [README, RAMPS].iter().any(|name| self.root.join(name).exists());
        self.plan().exists() && (has_lock || has_others())
    }

    /// Puts a plan into the folder, which it creates if needed; returns false if there is a plan already.
    ///
    /// The plan is checked under the lock: of processes that start together, one checks, and the others wait.
    pub(super) fn create(
        &self,
        plan: &str,
        provenance: &Provenance,
        check: impl FnOnce() -> Result<(), PlanError>,
    ) -> Result<bool, StudyError> {
        self.check_free()?;
        fs::create_dir_all(&self.root).map_err(StudyError::io("create", &self.root))?;
        let _lock = Lock::take(&self.root.join(LOCK))?;
        if !self.plan().exists() {
            check()?;
        }
        sealed::remove_temporaries(&self.root)?;
        let is_new = sealed::publish(&self.plan(), plan.as_bytes())?;
        // If a process was killed here, there is a plan without a provenance, and no ramps. If there are
        // ramps, an older version made the folder, and its provenance is not known.
        if !self.root.join(RAMPS).exists() {
            sealed::publish(&self.provenance_file(), provenance.text().as_bytes())?;
        }
        self.write_about()?;
        Ok(is_new)
    }

    pub(super) fn provenance_file(&self) -> PathBuf {
        self.root.join(PROVENANCE)
    }

    /// Returns the provenance of the study; an empty one if the file is missing.
    pub(super) fn provenance(&self) -> Result<Provenance, StudyError> {
        let path = self.provenance_file();
        let text = sealed::if_there("read", &path, fs::read_to_string(&path))?;
        Ok(Provenance::of_text(text.unwrap_or_default()))
    }

    /// Replaces the provenance.
    pub(super) fn replace_provenance(&self, provenance: &Provenance) -> Result<(), StudyError> {
        let _lock = Lock::take(&self.root.join(LOCK))?;
        sealed::write(&self.provenance_file(), provenance.text().as_bytes())
    }

    /// Writes the README of the folder, if it is missing or cut short. An edited one stays.
    fn write_about(&self) -> Result<(), StudyError> {
        let path = self.root.join(README);
        match fs::read(&path) {
            Ok(found) if found.len() < ABOUT.len() && ABOUT.as_bytes().starts_with(&found) => {
                sealed::write(&path, ABOUT.as_bytes())
            }
            _ => sealed::publish(&path, ABOUT.as_bytes()).map(drop),
        }
    }

    /// Checks that the folder has a plan, or only a lock and temporary files, which are written before a
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
            let is_lock = name == LOCK && entry.metadata().is_ok_and(|lock| is_lock(&lock));
            if !is_lock && !is_temporary(&name) {
                return Ok(Some(name.to_string_lossy().into_owned()));
            }
        }
        Ok(None)
    }

    pub(super) fn read_plan(&self) -> Result<String, StudyError> {
        fs::read_to_string(self.plan()).map_err(StudyError::io("read", &self.plan()))
    }

    /// Takes the lock of a ramp; returns `None` if another process runs the ramp. The flag tells whether
    /// nothing was ever run there.
    pub(super) fn take(&self, ramp: usize) -> Result<Option<(Lock, bool)>, StudyError> {
        let folder = self.ramp(ramp);
        let is_new = create(&folder)?;
        let Some(lock) = Lock::try_take(&self.log_of(ramp))? else { return Ok(None) };
        // Another process may have run the ramp since this one made its folder.
        let is_fresh = is_new && lock.is_fresh();
        if !is_fresh {
            sealed::remove_temporaries(&folder)?;
        }
        Ok(Some((lock, is_fresh)))
    }

    /// Returns for each of this many ramps whether a process has ever looked into it. One call of the system
    /// tells of hundreds of them.
    pub(super) fn all_begun(&self, ramps: usize) -> Result<Vec<bool>, StudyError> {
        let mut all = vec![false; ramps];
        let folder = self.root.join(RAMPS);
        for entry in sealed::if_there("read", &folder, fs::read_dir(&folder))?.into_iter().flatten() {
            let name = entry.map_err(StudyError::io("read", &folder))?.file_name();
            let ramp = name.to_str().and_then(|name| name.parse::<usize>().ok());
            if let Some(is_begun) = ramp.and_then(|ramp| all.get_mut(ramp)) {
                *is_begun = true;
            }
        }
        Ok(all)
    }

    /// Reads the beginnings of the first records of some ramps, many at a time, and forgets them. From a disk
    /// that has to look for each of a million small files, the system thus has them sooner.
    pub(super) fn read_ahead(&self, ramps: Range<usize>) {
        const READERS: usize = 16;
        thread::scope(|scope| {
            for reader in 0..READERS.min(ramps.len()) {
                let own = ramps.clone().skip(reader).step_by(READERS);
                // Without a thread, nothing is read ahead.
                let _ = thread::Builder::new().spawn_scoped(scope, || {
                    for ramp in own {
                        let _ = File::open(self.record(ramp, 0)).and_then(|mut file| file.read(&mut [0; 64]));
                    }
                });
            }
        });
    }

    /// Removes the records of a ramp from this value on, the last one first, so that no gap remains if the
    /// process is killed. The caller holds the lock of the ramp.
    pub(super) fn remove_records(&self, ramp: usize, from: usize) -> Result<(), StudyError> {
        let end = (from..usize::MAX).find(|value| !self.record(ramp, *value).exists()).unwrap_or(from);
        (from..end).rev().try_for_each(|value| sealed::remove(&self.record(ramp, value)))
    }

    /// Returns the seconds that the values of a ramp took, by its log; `None` for those that were taken over.
    pub(super) fn logged(&self, ramp: usize) -> Vec<Option<f64>> {
        let text = fs::read_to_string(self.log_of(ramp)).unwrap_or_default();
        let seconds = |line: &str| {
            let (_, rest) = line.split_once(r#""seconds":"#)?;
            rest.split([',', '}']).next()?.parse::<f64>().ok()
        };
        text.lines().filter(|line| line.contains(r#""value":"#)).map(seconds).collect()
    }

    /// Returns whether all ramps are done and in the tables.
    pub(super) fn is_complete(&self) -> bool {
        self.complete().exists()
    }

    /// Removes the mark of a complete study before a value is written that the tables may lack.
    pub(super) fn mark_incomplete(&self) -> Result<(), StudyError> {
        sealed::remove(&self.complete())
    }

    /// Marks that all ramps are in the tables. The caller holds the lock of the study.
    pub(super) fn mark_complete(&self) -> Result<(), StudyError> {
        sealed::write(&self.complete(), b"")
    }

    fn complete(&self) -> PathBuf {
        self.root.join("complete")
    }

    /// Waits for the lock of the whole study, and takes it to write tables.
    pub(super) fn lock(&self) -> Result<Lock, StudyError> {
        let lock = Lock::take(&self.root.join(LOCK))?;
        sealed::remove_temporaries(&self.root)?;
        // The process that put the plan here may have been killed before it wrote the README.
        self.write_about()?;
        Ok(lock)
    }
}

/// Creates a folder, and those that contain it; returns whether it is new.
pub(super) fn create(folder: &Path) -> Result<bool, StudyError> {
    let made = match fs::create_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => fs::create_dir_all(folder),
        made => made,
    };
    match made {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
        made => made.map(|()| true).map_err(StudyError::io("create", folder)),
    }
}

/// Returns whether a file of the name of a lock is one: it is empty.
fn is_lock(file: &fs::Metadata) -> bool {
    file.is_file() && file.len() == 0
}
