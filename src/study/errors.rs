//! The errors of a study, its plan and its files.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::Parameter;
use crate::ParameterError;
use crate::boundary::WallError;
use crate::initial::PlacementError;
use crate::simulation::{BuildError, CheckpointError};

/// A specification that cannot be carried out.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SpecificationError {
    /// A value is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The disks do not fit.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A wall of the container cannot be so.
    #[error(transparent)]
    Wall(#[from] WallError),
    /// The text is not a specification.
    #[error("{0}")]
    Toml(String),
    /// The base has no such parameter.
    #[error("the base has no {parameter}")]
    NoSuchParameter {
        /// The parameter.
        parameter: Parameter,
    },
    /// The parameter cannot change with the disks in place.
    #[error("{parameter} cannot be ramped with the disks in place; sweep it instead")]
    NotRampable {
        /// The parameter.
        parameter: Parameter,
    },
    /// The parameter varies in two ways at once.
    #[error("{parameter} varies twice: each parameter can be ramped or swept once")]
    VariesTwice {
        /// The parameter.
        parameter: Parameter,
    },
    /// There are no values.
    #[error("{parameter} has no values")]
    NoValues {
        /// The parameter.
        parameter: Parameter,
    },
    /// A value is infinite or NaN.
    #[error("a value of {parameter} must be finite, but is {value}")]
    NotFinite {
        /// The parameter.
        parameter: Parameter,
        /// The value.
        value: f64,
    },
    /// The values of a ramp are out of order.
    #[error(
        "the values of a ramp must increase, but {parameter} has {value} after {before}; say `course` for the way"
    )]
    NotIncreasing {
        /// The parameter.
        parameter: Parameter,
        /// The value.
        value: f64,
        /// The one before it.
        before: f64,
    },
    /// There are more ramps or values than can be numbered.
    #[error("{count} ramps and values are too many: at most {most} are possible")]
    TooMany {
        /// The number of them.
        count: u128,
        /// The largest possible number.
        most: usize,
    },
}

/// A study cannot be made, opened, run or read.
///
/// A message does not repeat its [source](std::error::Error::source): report the whole chain.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The specification is no good.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
    /// A file or folder cannot be read or written.
    #[error("cannot {action} {}", path.display())]
    Io {
        /// The action that failed: `read`, `write`, `create`, `remove` or `lock`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The answer of the system.
        source: io::Error,
    },
    /// There is a study already.
    #[error("{} holds a study already", path.display())]
    Exists {
        /// The folder.
        path: PathBuf,
    },
    /// There is no study.
    #[error("{} holds no study", path.display())]
    Missing {
        /// The folder.
        path: PathBuf,
    },
    /// There is a study with another specification.
    #[error("{} holds a study with another specification; choose another folder", path.display())]
    Different {
        /// The folder.
        path: PathBuf,
    },
    /// Another process runs the study.
    #[error("the study in {} is being run by another process{}", path.display(), holder(*process))]
    Locked {
        /// The folder.
        path: PathBuf,
        /// The number of the process, if known.
        process: Option<u32>,
    },
    /// A file was cut or changed, or belongs elsewhere.
    #[error("{} is damaged: {reason}; run the study again to redo it", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The damage.
        reason: &'static str,
    },
    /// A record is of another specification: one of the two was changed by hand.
    #[error("{} is of another specification than that in its folder; take a new folder for a new one", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// A file was made by another version of this crate, whose results may differ.
    #[error("{} was made by version {found}, but this is version {known}; take a new folder", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// The version that made it.
        found: String,
        /// This version.
        known: &'static str,
    },
    /// A value cannot be started.
    #[error("value {value} of ramp {ramp} cannot start")]
    Build {
        /// Index of the ramp.
        ramp: usize,
        /// Index of the value in it.
        value: usize,
        /// The reason.
        source: BuildError,
    },
    /// A state cannot be resumed.
    #[error("value {value} of ramp {ramp} cannot go on")]
    Checkpoint {
        /// Index of the ramp.
        ramp: usize,
        /// Index of the value in it.
        value: usize,
        /// The reason.
        source: CheckpointError,
    },
    /// The contents of a file cannot be encoded.
    #[error("the contents of {} cannot be encoded", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// The reason; its type is an affair of this crate.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}

impl StudyError {
    /// Turns an error of the system into one that says where and what for.
    pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_owned(), source }
    }
}

fn holder(process: Option<u32>) -> String {
    process.map_or_else(String::new, |process| format!(", {process}"))
}
