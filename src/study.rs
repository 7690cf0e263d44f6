//! Studies: many runs, planned as data, watched, stopped, resumed, spread over processes, and kept.
//!
//! An [`Experiment`] is what is studied: a serializable type of your own, whose fields are the parameters and
//! whose methods say what is simulated, what is measured, and which columns the tables have. A [`Plan`] says
//! what is done with it: a [`Protocol`] to sample it, a [`Ramp`] of one parameter up or down, a sweep of
//! independent ramps over the grid of its [`Axis`]es, and repeats. A [`Study`] is a plan in a folder.
//! [`Study::run`] does what is not done yet, on all cores with the feature `rayon`, in any number of
//! processes; each finished value is written at once, as a [`Record`].
//!
//! The paper's system is an experiment like any other: [`vibrated_box`].
//!
//! # Promises
//! 1. A value is a function of plan, index and seed: the files of a complete study are the same bytes on any
//!    number of threads and processes, and however often they were interrupted or killed. Only `log.jsonl`,
//!    which has the times, differs.
//! 2. A file is whole or not there. A damaged one is named and done again, never read as data.
//! 3. Any number of processes run a study at the same time, started at any time: each ramp is done by one of
//!    them. They need a file system whose locks all of them see: local ones have that, as NFS has from
//!    version 4 on.
//! 4. A study writes into a folder that is empty or its own, and changes or removes no file but its own.
//! 5. A run that cannot progress is an [`Outcome`] of its value: the study goes on.
//!
//! ```
//! use granular_edmd::study::vibrated_box::{Base, VibratedBox};
//! use granular_edmd::study::{Control, Course, Plan, Protocol, Ramp, Study};
//!
//! let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
//! let experiment = VibratedBox::new(30, 10.0, base).with_height(30.0).with_contact_duration(1e-4);
//! let experiment = experiment.with_gravity(0.0156);
//! let ramp = Ramp::new("friction", [0.01, 0.02], Course::Up);
//! let plan = Plan::new(experiment, Protocol::new(10, 4, 5), 1)?.with_ramp(ramp)?;
//!
//! # let folder = std::env::temp_dir().join(format!("granular-edmd-study-{}", std::process::id()));
//! let study = Study::open_or_create(&folder, &plan)?;
//! let summary = study.run(&Control::default())?;
//! assert!(summary.is_complete());
//! for record in study.records() {
//!     let record = record?;
//!     println!("{} {}", record.experiment().friction, record.mean(|sample| sample.height));
//!     assert_eq!(record.samples().len(), 4);
//! }
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "cli")]
pub mod cli;
mod column;
mod control;
mod errors;
mod experiment;
mod file;
mod folder;
mod lock;
mod log;
mod measurement;
mod parameters;
mod plan;
mod point;
mod protocol;
mod ramp;
mod reading;
mod record;
mod refinement;
mod runner;
mod scalar;
mod tables;
pub mod vibrated_box;
mod workspace;

use std::path::Path;

pub use column::{Column, Table};
pub use control::{Control, Progress, Summary};
pub use errors::{PlanError, StudyError};
pub use experiment::{Experiment, ExperimentError, Run};
pub use parameters::Difference;
pub use plan::Plan;
pub use point::Point;
pub use protocol::Protocol;
pub use ramp::{Axis, Course, Leg, Ramp, Width};
pub use record::{Outcome, Record};
pub use refinement::Bracket;
pub use scalar::Scalar;

use folder::Folder;
use record::Origin;

/// Version of this crate: another one may have other results.
const CRATE_VERSION: &str = env!("CARGO_PKG_VERSION");

/// A [`Plan`] in a folder, with the records of what has been done of it.
///
/// See [the module](crate::study) for an example and for what it promises.
#[derive(Debug, Clone)]
pub struct Study<E> {
    folder: Folder,
    plan: Plan<E>,
    /// Hash of the plan: what ties a record to its study.
    hash: [u8; 32],
}

impl<E: Experiment> Study<E> {
    /// Makes a new study in a folder, which is made if it is not there and must be empty if it is.
    ///
    /// # Errors
    /// If the folder holds a study or anything else, or cannot be written.
    pub fn create(folder: impl AsRef<Path>, plan: &Plan<E>) -> Result<Self, StudyError> {
        let folder = Folder::new(folder.as_ref())?;
        if folder.holds_study() || !folder.create(&plan.to_toml()?)? {
            return Err(StudyError::Exists { path: folder.root().to_owned() });
        }
        Self::in_folder(folder, plan.clone())
    }

    /// Opens the study in a folder.
    ///
    /// # Errors
    /// If there is none, or none of this experiment, or it cannot be read.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, StudyError> {
        let folder = Folder::new(folder.as_ref())?;
        if !folder.holds_study() {
            return Err(StudyError::Missing { path: folder.root().to_owned() });
        }
        let unreadable = |source| StudyError::Unreadable { path: folder.plan(), source };
        // Its experiments were tried when it was put there.
        let plan = Plan::from_toml_unproven(&folder.read_plan()?).map_err(unreadable)?;
        Self::in_folder(folder, plan)
    }

    /// Opens the study in a folder, or makes a new one: the same command starts a study and goes on with it,
    /// also in several processes at the same time.
    ///
    /// # Errors
    /// If the folder holds a study with another plan, or other files and no study, or cannot be read or
    /// written.
    pub fn open_or_create(folder: impl AsRef<Path>, plan: &Plan<E>) -> Result<Self, StudyError> {
        let folder = Folder::new(folder.as_ref())?;
        if !folder.holds_study() {
            folder.create(&plan.to_toml()?)?;
        }
        let study = Self::in_folder(folder, plan.clone())?;
        study.check_plan()?;
        Ok(study)
    }

    /// Does as [`Self::open_or_create`] with a plan whose experiments have not been tried: they are, unless
    /// they were when the same plan was put into the folder. In large studies that takes seconds, and each
    /// of many processes would do it.
    #[cfg(feature = "cli")]
    fn open_or_create_unproven(folder: &Path, plan: Plan<E>) -> Result<Self, StudyError> {
        let known = Folder::new(folder)?;
        if known.holds_study() && known.read_plan()? == plan.to_toml()? {
            return Self::in_folder(known, plan);
        }
        Self::open_or_create(folder, &plan.proven()?)
    }

    fn in_folder(folder: Folder, plan: Plan<E>) -> Result<Self, StudyError> {
        let hash = *blake3::hash(plan.to_toml()?.as_bytes()).as_bytes();
        Ok(Self { folder, plan, hash })
    }

    /// Checks that the plan in the folder is this one: it may have been changed since it was read.
    fn check_plan(&self) -> Result<(), StudyError> {
        let text = self.folder.read_plan()?;
        let ours = self.plan.to_toml()?;
        if text == ours {
            return Ok(());
        }
        let tree =
            |text: &str| text.parse::<toml::Table>().map_err(|error| PlanError::Toml(error.to_string()));
        let unreadable = |source| StudyError::Unreadable { path: self.folder.plan(), source };
        let differences = parameters::differences(&tree(&text).map_err(unreadable)?, &tree(&ours)?);
        if differences.is_empty()
            || Plan::<E>::from_toml(&text).and_then(|plan| plan.to_toml()).is_ok_and(|text| text == ours)
        {
            return Ok(());
        }
        Err(StudyError::Different { path: self.folder.root().to_owned(), differences })
    }

    /// Returns its folder.
    pub fn folder(&self) -> &Path {
        self.folder.root()
    }

    /// Returns its plan.
    pub const fn plan(&self) -> &Plan<E> {
        &self.plan
    }

    /// Returns how far a ramp is.
    pub fn status(&self, ramp: usize) -> RampStatus {
        if self.folder.is_done(ramp) {
            RampStatus::Done
        } else if self.folder.is_taken(ramp) {
            RampStatus::Running
        } else if self.folder.is_begun(ramp) {
            RampStatus::Begun
        } else {
            RampStatus::Waiting
        }
    }

    fn origin(&self, ramp: usize, value: usize) -> Origin {
        let seed = self.plan.ramp_seed(ramp);
        Origin { study: self.hash, version: CRATE_VERSION.to_owned(), ramp, value, seed }
    }

    /// Checks that a file is of this study and this place.
    fn check_origin(&self, found: &Origin, ramp: usize, value: usize, path: &Path) -> Result<(), StudyError> {
        if found.study != self.hash {
            return Err(StudyError::Foreign { path: path.to_owned() });
        }
        if (Origin { version: found.version.clone(), ..self.origin(ramp, value) }) == *found {
            Ok(())
        } else {
            Err(file::damaged(path, "it is of another value"))
        }
    }
}

/// Progress of a ramp.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RampStatus {
    /// All its values have a record.
    Done,
    /// A process does it now.
    Running,
    /// A process has begun it, and nobody does it now.
    Begun,
    /// Nothing has been done of it.
    Waiting,
}
