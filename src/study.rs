//! Studies: many runs, planned as data and kept in a folder, which you can watch, stop, resume and spread
//! over processes.
//!
//! An [`Experiment`] is the system under study. It is a serializable type of your own: its fields are the
//! parameters, and its methods define the simulation, the measurements, and the columns of the tables. A
//! [`Plan`] says what to do with it: a [`Protocol`] says when to sample, a [`Ramp`] takes one parameter up or
//! down, each [`Axis`] adds a dimension to a grid of independent ramps, and each point of the grid may be
//! repeated. A [`Study`] is a plan in a folder. [`Study::run`] does the values that are missing, on all cores
//! with the feature `rayon`, in any number of processes. It writes each finished value at once, as a
//! [`Record`].
//!
//! The paper's system is an experiment like any other: [`vibrated_box`].
//!
//! # Promises
//! 1. A value is a function of plan, index and seed: the files of a complete study have the same bytes for
//!    any number of threads and processes, however often these were interrupted or killed. Only `log.jsonl`,
//!    which holds wall-clock times, differs.
//! 2. A file is whole or absent. A study names a damaged file and does its value again, and never reads it as
//!    data.
//! 3. Any number of processes can run a study at the same time, started at any time; one of them does each
//!    ramp. They need a file system whose locks all of them see, such as a local one, or NFS from version 4
//!    on.
//! 4. A study writes only into a folder that is empty or its own, and changes or removes no file but its own.
//! 5. If a run cannot progress, the [`Outcome`] of its value says so, and the study goes on.
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

/// Version of this crate. Another version may have other results.
const CRATE_VERSION: &str = env!("CARGO_PKG_VERSION");

/// A [`Plan`] in a folder, with the records of its finished values.
///
/// See [the module](crate::study) for an example and the promises.
#[doc(alias("parameter scan", "ensemble", "campaign"))]
#[derive(Debug, Clone)]
pub struct Study<E> {
    folder: Folder,
    plan: Plan<E>,
    /// Hash of the plan, which ties a record to its study.
    hash: [u8; 32],
}

impl<E: Experiment> Study<E> {
    /// Creates a new study in a folder, which must be empty if it exists.
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
    /// If the folder holds no study, its plan is not one of this experiment, or it cannot be read.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, StudyError> {
        let folder = Folder::new(folder.as_ref())?;
        if !folder.holds_study() {
            return Err(StudyError::Missing { path: folder.root().to_owned() });
        }
        let unreadable = |source| StudyError::Unreadable { path: folder.plan(), source };
        // The experiments were tried when the plan was put there.
        let plan = Plan::from_toml_unproven(&folder.read_plan()?).map_err(unreadable)?;
        Self::in_folder(folder, plan)
    }

    /// Opens the study in a folder, or creates a new one.
    ///
    /// So the same command starts a study and goes on with it, also in several processes at the same time.
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

    /// Opens or creates the study of a plan whose experiments have not been tried yet. It tries them, unless
    /// the folder holds the same plan: then they were tried when that plan was put there. To try them takes
    /// seconds in large studies, and each of many processes would do it again.
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

    /// Checks that the plan in the folder is still this one, since somebody may have changed it.
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

    /// Returns the folder of the study.
    pub fn folder(&self) -> &Path {
        self.folder.root()
    }

    /// Returns the plan of the study.
    pub const fn plan(&self) -> &Plan<E> {
        &self.plan
    }

    /// Returns the progress of a ramp.
    ///
    /// # Errors
    /// If there is no such ramp.
    pub fn status(&self, ramp: usize) -> Result<RampStatus, StudyError> {
        self.check_ramp(ramp)?;
        Ok(if self.folder.is_done(ramp) {
            RampStatus::Done
        } else if self.folder.is_taken(ramp) {
            RampStatus::Running
        } else if self.folder.is_begun(ramp) {
            RampStatus::Begun
        } else {
            RampStatus::Waiting
        })
    }

    /// Checks that there is a ramp of this index.
    fn check_ramp(&self, ramp: usize) -> Result<(), StudyError> {
        let ramps = self.plan.ramp_count();
        if ramp < ramps { Ok(()) } else { Err(StudyError::NoSuchRamp { ramp, ramps }) }
    }

    fn origin(&self, ramp: usize, value: usize) -> Origin {
        let seed = self.plan.ramp_seed(ramp);
        Origin { study: self.hash, version: CRATE_VERSION.to_owned(), ramp, value, seed }
    }

    /// Checks that a file belongs to this study and this place in it.
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
    /// All values of the ramp have a record.
    Done,
    /// A process is doing the ramp.
    Running,
    /// A process has begun the ramp, and none is doing it now.
    Begun,
    /// No process has begun the ramp.
    Waiting,
}
