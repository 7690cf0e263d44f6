//! Studies: many runs, planned as data, watched, stopped, resumed, and kept.
//!
//! A [`Specification`] says what is done: a [`System`], a [`Protocol`] to sample it, a [`Ramp`] of one parameter up or
//! down, and a sweep of independent ramps over the grid of its [`Axis`]es. A [`Study`] is a specification in a folder.
//! [`Study::run`] does what is not done yet, on all cores with the feature `rayon`; each finished value is written at
//! once, as a [`Record`].
//!
//! # Promises
//! 1. A value is a function of specification, index and seed: the files of a complete study are the same bytes on any
//!    number of threads, and however often it was interrupted or killed. Only `log.jsonl`, which has the times, differs.
//! 2. A file is whole or not there. A damaged one is named and done again, never read as data.
//! 3. One process at a time runs a study; another is told so.
//! 4. A run that cannot progress is an [`Outcome`] of its value: the study goes on.
//!
//! ```
//! use granular_edmd::study::{Base, Control, Course, Parameter, Protocol, Ramp, Specification, Study, System};
//!
//! let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
//! let system = System::new(30, 10.0, base).with_height(30.0).with_gravity(0.0156).with_contact_duration(1e-4);
//! let ramp = Ramp::new(Parameter::Friction, vec![0.01, 0.02], Course::Up);
//! let specification = Specification::new(system, Protocol::new(10, 4, 5), 1)?.with_ramp(ramp)?;
//!
//! # let folder = std::env::temp_dir().join(format!("granular-edmd-study-{}", std::process::id()));
//! let study = Study::open_or_create(&folder, &specification)?;
//! let summary = study.run(&Control::default())?;
//! assert!(summary.is_complete());
//! for record in study.records() {
//!     let record = record?;
//!     println!("{:?} {:?}", record.system().get(Parameter::Friction), record.mean(|sample| sample.height));
//!     assert_eq!(record.samples().len(), 4);
//! }
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod base;
mod control;
mod errors;
mod file;
mod folder;
mod lock;
mod parameter;
mod protocol;
mod ramp;
mod record;
mod rule;
mod runner;
mod sample;
mod specification;
mod system;
mod tables;
mod value;

use std::path::Path;

pub use base::{Base, Sides};
pub use control::{Control, Progress, Summary};
pub use errors::{SpecificationError, StudyError};
pub use parameter::Parameter;
pub use protocol::Protocol;
pub use ramp::{Axis, Course, Leg, Ramp};
pub use record::{Outcome, Record};
pub use sample::Sample;
pub use specification::Specification;
pub use system::System;

use folder::Folder;
use record::Origin;

/// Version of this crate: another one may have other results.
const CRATE_VERSION: &str = env!("CARGO_PKG_VERSION");

/// A [`Specification`] in a folder, with the records of what has been done of it.
///
/// See [the module](crate::study) for an example and for what it promises.
#[derive(Debug, Clone)]
pub struct Study {
    folder: Folder,
    specification: Specification,
    /// Hash of the specification: what ties a record to its study.
    hash: [u8; 32],
}

impl Study {
    /// A new study in a folder, which is made if it is not there.
    ///
    /// # Errors
    /// If the folder holds a study already or cannot be written.
    pub fn create(folder: impl AsRef<Path>, specification: &Specification) -> Result<Self, StudyError> {
        let folder = Folder::new(folder.as_ref());
        if folder.holds_study() {
            return Err(StudyError::Exists { path: folder.root().to_owned() });
        }
        folder.create(specification)?;
        Self::in_folder(folder, specification.clone())
    }

    /// The study in a folder.
    ///
    /// # Errors
    /// If there is none, or it cannot be read.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, StudyError> {
        let folder = Folder::new(folder.as_ref());
        if !folder.holds_study() {
            return Err(StudyError::Missing { path: folder.root().to_owned() });
        }
        let specification = folder.read_specification()?;
        Self::in_folder(folder, specification)
    }

    /// The study in a folder, or a new one: the same command starts a study and goes on with it.
    ///
    /// # Errors
    /// If the folder holds a study with another specification, or cannot be read or written.
    pub fn open_or_create(
        folder: impl AsRef<Path>,
        specification: &Specification,
    ) -> Result<Self, StudyError> {
        let path = folder.as_ref();
        if !Folder::new(path).holds_study() {
            return Self::create(path, specification);
        }
        let study = Self::open(path)?;
        if study.specification == *specification {
            Ok(study)
        } else {
            Err(StudyError::Different { path: path.to_owned() })
        }
    }

    fn in_folder(folder: Folder, specification: Specification) -> Result<Self, StudyError> {
        let hash = *blake3::hash(specification.to_toml()?.as_bytes()).as_bytes();
        Ok(Self { folder, specification, hash })
    }

    /// Its folder.
    pub fn folder(&self) -> &Path {
        self.folder.root()
    }

    /// What it does.
    pub const fn specification(&self) -> &Specification {
        &self.specification
    }

    /// The record of a value; `None` if it is not finished.
    ///
    /// # Errors
    /// If the file is damaged, of another study, or cannot be read.
    pub fn record(&self, ramp: usize, value: usize) -> Result<Option<Record>, StudyError> {
        let path = self.folder.record(ramp, value);
        let Some(record) = file::read_sealed::<Record>(&path)? else { return Ok(None) };
        self.check_origin(&record.origin, ramp, value, &path)?;
        record.check(&self.specification).map_err(|reason| file::damaged(&path, reason))?;
        Ok(Some(record))
    }

    /// All finished records, ramp by ramp, read one by one.
    pub fn records(&self) -> impl Iterator<Item = Result<Record, StudyError>> {
        self.places().filter_map(|(ramp, value)| self.record(ramp, value).transpose())
    }

    /// The indices of all ramps and values.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let values = self.specification.values();
        (0..self.specification.ramps()).flat_map(move |ramp| (0..values).map(move |value| (ramp, value)))
    }

    fn origin(&self, ramp: usize, value: usize) -> Origin {
        let seed = self.specification.ramp_seed(ramp);
        Origin { study: self.hash, version: CRATE_VERSION.to_owned(), ramp, value, seed }
    }

    /// That a file is of this study and this place.
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
