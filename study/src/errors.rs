//! The errors of a study, its plan and its files.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use granular_edmd::boundary::WallError;
use granular_edmd::initial::PlacementError;
use granular_edmd::observable::ObserverError;
use granular_edmd::simulation::{BuildError, CheckpointError, RunError};
use granular_edmd::{ParameterError, Violation};
use thiserror::Error;

/// The error of an experiment that cannot be built or changed.
///
/// `?` converts errors of both packages, I/O errors and texts into this type, and [`new`](Self::new) converts
/// any other error. The message is the message of the cause.
///
/// ```
/// use granular_edmd::collision::Smooth;
/// use granular_edmd_study::ExperimentError;
///
/// fn rule(loss: f64) -> Result<Smooth, ExperimentError> {
///     if loss == 0.25 {
///         return Err("a quarter is too much".into());
///     }
///     Ok(Smooth::from_inelasticity(loss)?)
/// }
/// assert_eq!(rule(0.25).unwrap_err().to_string(), "a quarter is too much");
/// assert!(rule(0.7).unwrap_err().to_string().starts_with("normal inelasticity"));
///
/// let number = "ten".parse::<f64>().map_err(ExperimentError::new);
/// assert_eq!(number.unwrap_err().to_string(), "invalid float literal");
/// ```
#[derive(Debug, Error)]
#[error(transparent)]
pub struct ExperimentError(Box<dyn std::error::Error + Send + Sync>);

impl ExperimentError {
    /// Creates an error from its cause.
    pub fn new(cause: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        Self(cause.into())
    }
}

macro_rules! from_causes {
    ($($cause:ty),+) => {
        $(impl From<$cause> for ExperimentError {
            fn from(cause: $cause) -> Self {
                Self::new(cause)
            }
        })+
    };
}

from_causes! {
    &str, String, io::Error, ParameterError, WallError, PlacementError, BuildError, RunError,
    CheckpointError, Violation, ObserverError, PlanError, StudyError
}

#[cfg(feature = "cli")]
from_causes! { granular_edmd_files::RecordError, granular_edmd_files::ReadError }

/// The error of a plan that cannot be run.
///
/// A message does not repeat its [source](std::error::Error::source): report the whole chain.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A number of the protocol, or the seed, is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The text is not a plan, the plan cannot be written as text, or the plan has a name or a value that
    /// cannot be used.
    #[error("{0}")]
    Refused(String),
    /// The experiment rejects the parameters of a value.
    #[error("the experiment cannot be{place}")]
    Experiment {
        /// The parameters that vary, with their values; empty if no parameter varies.
        place: String,
        /// The reason.
        source: ExperimentError,
    },
}

/// An error in creating, opening, running or reading a study.
///
/// A message does not repeat its [source](std::error::Error::source): report the whole chain.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The plan cannot be carried out.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A file cannot be used as a plan of this experiment.
    #[error("{} cannot be used as a plan of this experiment", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: PlanError,
    },
    /// The path of the folder is empty.
    #[error("the path of a study's folder is empty; take `.` for this folder")]
    NoPath,
    /// A folder or a file cannot be used for this purpose: for example, the folder holds other files, no
    /// study, or a study already; the file belongs to another plan; or the code that made a record has
    /// changed since.
    #[error("{} {reason}", path.display())]
    Refused {
        /// The folder or the file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// The study has no such ramp.
    #[error("there is no ramp {ramp}: the study has {count}, counted from 0")]
    Absent {
        /// The requested index.
        ramp: usize,
        /// The number of ramps.
        count: usize,
    },
    /// A file or folder cannot be read or written.
    #[error("cannot {action} {}", path.display())]
    Io {
        /// The action that failed: `read`, `write`, `create` or `remove`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The error that the system returned.
        source: io::Error,
    },
    /// A file cannot be locked: some network file systems have no locks.
    #[error(
        "cannot lock {}; run the study on a file system with locks, such as a disk of each node, and join the parts",
        path.display()
    )]
    NoLock {
        /// The file.
        path: PathBuf,
        /// The error that the system returned.
        source: io::Error,
    },
    /// The folder holds a study with another plan.
    #[error("{} holds a study with another plan; choose another folder: {}", path.display(), listed(differences))]
    Different {
        /// The folder.
        path: PathBuf,
        /// The fields in which the plans differ.
        differences: Vec<Difference>,
    },
    /// A file was truncated or altered, or belongs to another value or study.
    #[error("{} is damaged: {reason}; run the study with a check of its records to redo it", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The description of the damage.
        reason: String,
    },
    /// The code that may continue the study has other results or another revision of the experiment than this
    /// program.
    #[error(
        "{} holds a study of other code: {}; take a new folder, or accept the change if its values can be compared",
        path.display(), listed(differences)
    )]
    Code {
        /// The folder.
        path: PathBuf,
        /// The fields that differ, such as `results` (of this crate), `revision` (of the experiment) and
        /// `columns`.
        differences: Vec<Difference>,
    },
    /// A value cannot be started, or the state from which it starts cannot be resumed.
    #[error("value {value} of ramp {ramp} cannot start")]
    Build {
        /// Index of the ramp.
        ramp: usize,
        /// Index of the value in the ramp.
        value: usize,
        /// The reason.
        source: ExperimentError,
    },
    /// The contents of a file cannot be encoded.
    #[error("the contents of {} cannot be encoded", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// The reason, whose type is not part of the public API.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}

/// Returns an error with its sources, in one line.
pub(super) fn chain(error: &dyn std::error::Error) -> String {
    let sources = std::iter::successors(error.source(), |&source| source.source()).map(ToString::to_string);
    std::iter::once(error.to_string()).chain(sources).collect::<Vec<_>>().join(": ")
}

impl PlanError {
    /// Returns the error for a parameter that cannot vary, with the given reason.
    pub(super) fn varied(parameter: &str, reason: impl fmt::Display) -> Self {
        Self::Refused(format!("{parameter} {reason}"))
    }

    /// Returns the error for a text that is not TOML, or not a plan.
    pub(super) fn toml(error: &impl fmt::Display) -> Self {
        Self::Refused(shortened(&error.to_string()))
    }
}

/// Shortens the lines of a message that quotes its input.
pub(super) fn shortened(message: &str) -> String {
    const LONGEST: usize = 160;
    let short = |line: &str| match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} …", &line[..end]),
        None => line.to_owned(),
    };
    message.trim().lines().map(short).collect::<Vec<_>>().join("\n")
}

impl StudyError {
    /// Returns a function that turns an error of the system into an error that names the action and the file.
    pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_owned(), source }
    }

    /// Returns a function that adds the file name to the error of a plan.
    pub(super) fn unreadable(path: &Path) -> impl FnOnce(PlanError) -> Self {
        move |source| Self::Unreadable { path: path.to_owned(), source }
    }

    /// Returns an error if the plan in a folder differs from the given one.
    pub(super) fn if_different(path: &Path, differences: Vec<Difference>) -> Result<(), Self> {
        let path = path.to_owned();
        if differences.is_empty() { Ok(()) } else { Err(Self::Different { path, differences }) }
    }

    /// Returns the error for a folder or a file that cannot be used.
    pub(super) fn refused(path: &Path, reason: impl Into<String>) -> Self {
        Self::Refused { path: path.to_owned(), reason: reason.into() }
    }

    /// Returns the error for a file that was truncated or altered.
    pub(super) fn damaged(path: &Path, reason: impl Into<String>) -> Self {
        Self::Damaged { path: path.to_owned(), reason: reason.into() }
    }

    /// Returns the error for a record whose rule, walls or revision differ from the experiment's present
    /// ones, because the code has changed.
    pub(super) fn changed(path: &Path, part: &str) -> Self {
        let now = "than the experiment has now at these parameters; take a new folder for changed code";
        Self::refused(path, format!("was made with another {part} {now}"))
    }

    /// Returns the error for a file that belongs to another plan.
    pub(super) fn foreign(path: &Path) -> Self {
        Self::refused(path, "is of another plan than that in its folder; take a new folder for a new one")
    }
}

/// A field in which two plans differ.
///
/// The value of an absent field is `None`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Difference {
    /// The name of the field, preceded by the names of the groups that contain the field.
    pub field: String,
    /// The field's value in the plan of the folder.
    pub old: Option<String>,
    /// The field's value in the given plan.
    pub new: Option<String>,
}

impl fmt::Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = |value: &Option<String>| value.clone().unwrap_or_else(|| "absent".to_owned());
        write!(formatter, "{} is {} there and {} here", self.field, text(&self.old), text(&self.new))
    }
}

/// Returns the first differences as text.
fn listed(differences: &[Difference]) -> String {
    const FIRST: usize = 5;
    let first: Vec<String> = differences.iter().take(FIRST).map(ToString::to_string).collect();
    let more = differences.len().saturating_sub(FIRST);
    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
    format!("{}{more}", first.join(", "))
}
