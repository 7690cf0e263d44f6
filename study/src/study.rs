//! A study: a plan in a folder, and the code that may continue it. Creating and opening check both.

use std::fs;
use std::path::Path;

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::{Fingerprint, RESULTS};

use super::experiment::record::{Maker, Origin};
use super::folder::{Folder, if_there, write};
use super::parameters::{self, tree};
use super::store::Store;
use super::{Difference, Experiment, Plan, StudyError};

/// A [`Plan`] in a folder, with the records of its finished values.
///
/// See [the module](crate) for an example and the promises.
#[doc(alias("parameter scan", "ensemble", "campaign"))]
#[derive(Debug, Clone)]
pub struct Study<E> {
    pub(super) folder: Folder,
    pub(super) store: Store,
    pub(super) plan: Plan<E>,
    /// The text of the plan in its file.
    text: String,
    /// Hash of the plan, which ties a record to its study.
    hash: blake3::Hash,
    /// The maker of this program's records.
    maker: Maker,
    /// Keys of the makers whose records the study accepts, separated by blanks; empty before the check of the
    /// code.
    accepted: String,
}

impl<E: Experiment> Study<E> {
    /// Creates a new study in a folder, which must be empty if it exists.
    ///
    /// # Errors
    /// If the folder holds a study or anything else, or cannot be written.
    pub fn create(folder: impl AsRef<Path>, plan: &Plan<E>) -> Result<Self, StudyError> {
        let study = Self::in_folder(Folder::new(folder.as_ref())?, plan.clone())?;
        if study.folder.holds_study() || !study.put_plan(true)? {
            return Err(StudyError::refused(study.folder(), "holds a study already"));
        }
        study.checked()
    }

    /// Opens the study in a folder.
    ///
    /// # Errors
    /// If the folder holds no study or cannot be read, if the plan was changed or belongs to another
    /// experiment, or if other code made the study ([`StudyError::Code`]).
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, StudyError> {
        Self::found_in(folder.as_ref())?.checked()
    }

    /// Opens the study in a folder, or creates a new one.
    ///
    /// The same call thus starts a study and continues it, also in several processes at the same time.
    ///
    /// # Errors
    /// If the folder holds a study with another plan, a study that other code made ([`StudyError::Code`]), or
    /// other files but no study, or if the folder cannot be read or written.
    pub fn open_or_create(folder: impl AsRef<Path>, plan: &Plan<E>) -> Result<Self, StudyError> {
        Self::open_or_put(folder.as_ref(), plan.clone(), true)
    }

    /// Opens the study in a folder. If there is none, writes the plan to the folder. Before, it checks the
    /// experiments of a plan that is not yet proven.
    ///
    /// An existing plan is not checked again, since it was checked when it was written: the check takes
    /// seconds in large studies, and each of many processes would repeat it.
    pub(super) fn open_or_put(folder: &Path, plan: Plan<E>, is_proven: bool) -> Result<Self, StudyError> {
        let study = Self::in_folder(Folder::new(folder)?, plan)?;
        if !study.folder.holds_study() || !study.folder.provenance().exists() {
            study.put_plan(is_proven)?;
        }
        study.checked()
    }

    fn checked(self) -> Result<Self, StudyError> {
        Ok(Self { accepted: self.check_unchanged()?, ..self })
    }

    /// Allows this program to continue a study that other code made, and returns the differences between the
    /// two. The list is empty if the program was allowed to continue already.
    ///
    /// The study's finished values stay unchanged. Each record keeps the mark of the code that made the
    /// record, and the column `made_by` of `values.csv` shows this mark. Values from before and after the
    /// change can thus be distinguished, and you decide whether they can be compared.
    ///
    /// # Errors
    /// If the folder holds no study, or cannot be read or written.
    pub fn accept_changes(folder: impl AsRef<Path>) -> Result<Vec<Difference>, StudyError> {
        let study = Self::found_in(folder.as_ref())?;
        let before = study.read_provenance()?;
        let mut now = study.provenance();
        if let Some(before) = &before {
            now.accepted = format!("{} {}", before.accepted, now.accepted);
        }
        let differences = now.differences(before.as_ref());
        if !differences.is_empty() {
            let _lock = study.folder.lock()?;
            write(&study.folder.provenance(), now.text().as_bytes())?;
        }
        Ok(differences)
    }

    fn found_in(folder: &Path) -> Result<Self, StudyError> {
        let folder = Folder::new(folder)?;
        if !folder.holds_study() {
            return Err(StudyError::refused(folder.root(), "holds no study"));
        }
        let plan = Self::plan_in(&folder)?;
        Self::in_folder(folder, plan)
    }

    /// Reads the plan in a folder. The experiments are not checked again: they were checked when the plan was
    /// written.
    fn plan_in(folder: &Folder) -> Result<Plan<E>, StudyError> {
        Plan::from_toml_unproven(&folder.read_plan()?).map_err(StudyError::unreadable(&folder.plan()))
    }

    pub(super) fn in_folder(folder: Folder, plan: Plan<E>) -> Result<Self, StudyError> {
        let text = plan.to_toml()?;
        let hash = blake3::hash(text.as_bytes());
        let version = env!("CARGO_PKG_VERSION").to_owned();
        let (revision, columns) = (E::revision(), columns::<E>());
        let maker = Maker { version, results: RESULTS, revision, columns };
        let store = Store::new(folder.root(), plan.ramp_count());
        Ok(Self { folder, store, plan, text, hash, maker, accepted: String::new() })
    }

    /// Writes the plan to the folder. Returns false if the folder already has a plan.
    ///
    /// The plan is checked under the lock: of the processes that start at the same time, one checks the plan,
    /// and the others wait.
    fn put_plan(&self, is_proven: bool) -> Result<bool, StudyError> {
        self.folder.check_free()?;
        let _lock = self.folder.lock()?;
        let is_new = !self.folder.plan().exists();
        if is_new {
            if !is_proven {
                self.plan.check_experiments()?;
            }
            write(&self.folder.plan(), self.text.as_bytes())?;
        }
        // If a process is killed here, the folder has a plan but no provenance and no records.
        self.folder.put(&self.provenance().text())?;
        Ok(is_new)
    }

    /// Returns the provenance that this program gives to a study.
    pub(super) fn provenance(&self) -> Provenance {
        let (experiment, maker) = (&self.plan.parts.experiment, &self.maker);
        let program = std::env::current_exe().ok();
        let program = program.as_deref().and_then(|path| path.file_stem()).unwrap_or_default();
        let rule = experiment.rule().ok().and_then(|rule| rule.fingerprint());
        let boundary = experiment.boundary().ok().and_then(|boundary| boundary.fingerprint());
        let [rule, boundary] =
            [rule, boundary].map(|part| part.map_or_else(|| "unknown".to_owned(), |part| part.to_string()));
        Provenance {
            results: maker.results.to_string(),
            revision: maker.revision.to_string(),
            columns: maker.columns.to_string(),
            rule,
            boundary,
            version: maker.version.clone(),
            program: program.to_string_lossy().into_owned(),
            target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
            plan: self.hash.to_hex().to_string(),
            accepted: maker.key(),
        }
    }

    /// Reads the provenance, or returns `None` if its file is missing. The provenance must belong to this
    /// plan.
    fn read_provenance(&self) -> Result<Option<Provenance>, StudyError> {
        let path = self.folder.provenance();
        let text = if_there("read", &path, fs::read_to_string(&path))?;
        let Some(text) = text else { return Ok(None) };
        let provenance: Provenance = serde_json::from_str(&text)
            .map_err(|reason| StudyError::damaged(&path, format!("it is no provenance ({reason})")))?;
        if provenance.plan == self.hash.to_hex().as_str() {
            return Ok(Some(provenance));
        }
        Err(StudyError::foreign(&path))
    }

    /// Checks that the folder has this plan, and that this program may continue the study. Returns the keys
    /// of the makers whose records the study accepts.
    pub(super) fn check_unchanged(&self) -> Result<String, StudyError> {
        if self.folder.read_plan()? != self.text {
            // Two files that differ may hold the same plan.
            let found = Self::plan_in(&self.folder)?;
            let differences = parameters::differences(&tree(&found)?, &tree(&self.plan)?);
            StudyError::if_different(self.folder.root(), differences)?;
        }
        let provenance = self.read_provenance()?;
        let differences = self.provenance().differences(provenance.as_ref());
        if differences.is_empty() {
            return Ok(provenance.map_or_else(String::new, |there| there.accepted));
        }
        Err(StudyError::Code { path: self.folder.root().to_owned(), differences })
    }

    /// Returns the folder of the study.
    pub fn folder(&self) -> &Path {
        self.folder.root()
    }

    /// Returns the plan of the study.
    pub const fn plan(&self) -> &Plan<E> {
        &self.plan
    }

    /// Checks that a ramp with this index exists.
    pub(super) fn check_ramp(&self, ramp: usize) -> Result<(), StudyError> {
        let count = self.plan.ramp_count();
        if ramp < count { Ok(()) } else { Err(StudyError::Absent { ramp, count }) }
    }

    pub(super) fn origin(&self, ramp: usize, value: usize) -> Origin {
        let seed = self.plan.ramp_seed(ramp);
        Origin { study: *self.hash.as_bytes(), maker: self.maker.clone(), ramp, value, seed }
    }

    /// Checks that a file belongs to this value of this study, and comes from code that the study accepts.
    pub(super) fn check_origin(
        &self,
        found: &Origin,
        ramp: usize,
        value: usize,
        path: &Path,
    ) -> Result<(), StudyError> {
        if found.study != *self.hash.as_bytes() {
            return Err(StudyError::foreign(path));
        }
        if (Origin { maker: found.maker.clone(), ..self.origin(ramp, value) }) != *found {
            return Err(StudyError::damaged(path, "it is of another value"));
        }
        if self.is_ours(found) || self.accepted.split(' ').any(|key| key == found.maker.key()) {
            return Ok(());
        }
        Err(StudyError::changed(path, "revision"))
    }

    /// Returns whether a file comes from code with the same results as this program.
    pub(super) fn is_ours(&self, found: &Origin) -> bool {
        found.maker.key() == self.maker.key()
    }
}

/// The file `provenance.json`: the code that may continue a study, which is the code that began the study or
/// was accepted last, and the code that was accepted earlier.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(super) struct Provenance {
    results: String,
    revision: String,
    columns: String,
    rule: String,
    boundary: String,
    version: String,
    program: String,
    target: String,
    /// Hash of the plan.
    plan: String,
    /// Keys of the makers whose records the study accepts, separated by blanks, the present one last.
    accepted: String,
}

/// The fields that decide whether a program may continue the study of a plan.
const DECIDING: [&str; 5] = ["results", "revision", "columns", "rule", "boundary"];

impl Provenance {
    /// Returns the text of the file.
    pub(super) fn text(&self) -> String {
        // Texts are always JSON.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Returns the deciding fields in which this provenance differs from the provenance in the folder.
    fn differences(&self, there: Option<&Self>) -> Vec<Difference> {
        let [old, new] = [there, Some(self)].map(|code| serde_json::to_value(code).unwrap_or_default());
        let all = DECIDING.map(|name| {
            let [old, new] = [&old, &new].map(|code| code[name].as_str().map(str::to_owned));
            Difference { field: name.to_owned(), old, new }
        });
        all.into_iter().filter(|field| field.old != field.new).collect()
    }
}

/// Returns a fingerprint of the names and units in all tables.
fn columns<E: Experiment>() -> Fingerprint {
    let heading = |hash: Fingerprint, name: &str, unit: &str| hash.text(name).text(unit);
    let columns = E::columns().iter().fold(Fingerprint::of("columns"), |hash, column| {
        let tables = f64::from(u8::from(column.in_samples) + 2 * u8::from(column.in_values));
        heading(hash, column.name(), column.unit()).number(tables)
    });
    E::tables().iter().fold(columns, |hash, table| {
        let hash = hash.text(table.name());
        table.columns().iter().fold(hash, |hash, column| heading(hash, column.name(), column.unit()))
    })
}
