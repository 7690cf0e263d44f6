//! Errors of writing and reading.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use granular_edmd::ParameterError;
use granular_edmd::observable::ObserverError;

/// Returns a number with its first six digits, for messages.
pub(super) fn rounded(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// An error in recording a trajectory.
///
/// The file keeps its complete frames.
///
/// A message does not repeat its [source](std::error::Error::source): report the whole chain.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordError {
    /// A file or folder of this name exists already.
    #[error("{} already exists and is not overwritten; choose another name", path.display())]
    Exists {
        /// The path.
        path: PathBuf,
    },
    /// A file cannot be opened, read or written.
    #[error("cannot {action} {}", path.display())]
    Io {
        /// The action that failed.
        action: &'static str,
        /// The path.
        path: PathBuf,
        /// The error of the system or of the format.
        source: io::Error,
    },
    /// Another recorder writes to the file.
    #[error("another recorder writes to {}", path.display())]
    Locked {
        /// The path.
        path: PathBuf,
    },
    /// The file has no complete frame after which a recorder could continue.
    ///
    /// The file stays unchanged.
    #[error("{} has no complete frame to continue from; it is left unchanged", path.display())]
    NoFrame {
        /// The path.
        path: PathBuf,
    },
    /// The file belongs to another run, since it has another frame, or no frame, at a time of this run.
    ///
    /// The file stays unchanged.
    #[error("{} belongs to another run: it ends at time {:?}, and has {} at time {:?}", path.display(), .last,
        if *.is_there { "another frame" } else { "no frame" }, .time)]
    AnotherRun {
        /// The path.
        path: PathBuf,
        /// Time of the frame to be recorded.
        time: f64,
        /// Time of the last frame in the file.
        last: f64,
        /// True if the file has a frame at this time.
        is_there: bool,
    },
    /// The run begins after the time of a frame that the file lacks.
    #[error("{} ends at time {:?}, so a run from time {:?} on would leave out the frame at time {:?}; continue from an \
        earlier checkpoint, or accept the gap with SampleTimes::starting_at", path.display(), .last,
        .time, .missed)]
    Gap {
        /// The path.
        path: PathBuf,
        /// Time of the last frame in the file.
        last: f64,
        /// Time of the frame that would be missing.
        missed: f64,
        /// Time at which the run begins.
        time: f64,
    },
}

impl From<RecordError> for ObserverError {
    fn from(error: RecordError) -> Self {
        Self::new(error)
    }
}

impl RecordError {
    /// Returns a function that turns an error of the system into this error, with the action and the file.
    pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }

    /// Creates the error for a name that a format cannot use.
    pub(super) fn unusable(path: &Path, reason: &str) -> Self {
        Self::io("use", path)(io::Error::new(io::ErrorKind::InvalidInput, reason))
    }
}

/// An error in reading disks from a file.
///
/// Lines are counted from 1. A GSD file has no lines; there, the number of the disk counts as the line.
///
/// A message does not repeat its [source](std::error::Error::source): report the whole chain.
///
/// ```
/// use granular_edmd_files::Reader;
/// let error = Reader::new().read_from("x,y,radius\n1,1,0.5\n1.5,1,half\n".as_bytes()).unwrap_err();
/// assert_eq!(error.to_string(), "line 3: radius must be a number, but is \"half\"");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The contents of a file are not as its reader expects.
    #[error("cannot use {}", path.display())]
    File {
        /// The path.
        path: PathBuf,
        /// The error, which names the line.
        source: Box<ReadError>,
    },
    /// The file cannot be opened.
    #[error("cannot open {}", path.display())]
    Open {
        /// The path.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A frame of a binary file does not describe disks.
    #[error("frame {frame}, whose lines are its disks")]
    Frame {
        /// Number of the frame.
        frame: u64,
        /// The error, which names the disk.
        source: Box<ReadError>,
    },
    /// The input cannot be read, or is not text.
    #[error("cannot read line {line}: {cause}")]
    Io {
        /// Number of the line.
        line: usize,
        /// The error of the system or of the compression.
        cause: io::Error,
    },
    /// The input is cut short.
    #[error("the file ends after line {line}, where {what} should follow")]
    End {
        /// Number of the last line.
        line: usize,
        /// The name of the missing item.
        what: String,
    },
    /// A field of a line does not have the required form.
    #[error("line {line}: {what} must be {requirement}, but is {found:?}")]
    Unexpected {
        /// Number of the line.
        line: usize,
        /// The name of the wrong item.
        what: String,
        /// The condition that it should have met.
        requirement: String,
        /// The text in its place.
        found: String,
    },
    /// A field or a line is missing.
    #[error("line {line}: {what} is missing")]
    Missing {
        /// Number of the line.
        line: usize,
        /// The name of the missing item.
        what: String,
    },
    /// The numbers of a line do not describe a disk.
    #[error("line {line} does not describe a disk")]
    Disk {
        /// Number of the line.
        line: usize,
        /// The parameter that is out of range.
        source: ParameterError,
    },
    /// A name or value appears twice.
    #[error("line {line}: {what} is already in line {first}")]
    Doubled {
        /// Number of the second line.
        line: usize,
        /// Number of the first line.
        first: usize,
        /// The name and value that appear twice.
        what: String,
    },
    /// The center of a disk is outside the box in the file.
    #[error("line {line}: the disk at ({:?}, {:?}) is outside the box", .x, .y)]
    Outside {
        /// Number of the line.
        line: usize,
        /// Horizontal position of the center.
        x: f64,
        /// Vertical position of the center.
        y: f64,
    },
    /// A GSD file is damaged, or one of its frames does not describe disks.
    #[error("{reason}")]
    Gsd {
        /// The frame and the chunk, and the condition that the chunk should have met.
        reason: String,
    },
    /// Disks overlap by more than rounding, or by more than the reader's tolerance.
    #[error("line {line}: the disk overlaps the disk of line {other} by {:?}, a share of {:?} of their distance at \
        contact; it is the deepest of {count} such overlaps; {advice}",
        rounded(*.depth), rounded(*.share))]
    Overlap {
        /// Number of the line.
        line: usize,
        /// Number of the line of the other disk.
        other: usize,
        /// Depth of the overlap, the deepest of all.
        depth: f64,
        /// Depth of the overlap in units of the sum of the radii.
        share: f64,
        /// Number of overlaps, counted up to eight for each disk.
        count: usize,
        /// The settings that accept the overlaps, or the reason why none does.
        advice: &'static str,
    },
    /// The file does not have the frame.
    #[error("there is no frame with {wanted}: the file has {count}")]
    NoFrame {
        /// Number or step of the frame.
        wanted: String,
        /// Number of frames in the file.
        count: usize,
    },
}

impl ReadError {
    /// Creates the error for a field of the wrong form.
    pub(super) fn unexpected(
        line: usize,
        what: impl Into<String>,
        requirement: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        let short = |text: String| text.chars().take(60).collect();
        let (what, found) = (short(what.into()), short(found.into()));
        Self::Unexpected { line, what, requirement: requirement.into(), found }
    }

    /// Creates the error of a GSD file.
    pub(super) fn gsd(reason: impl Into<String>) -> Self {
        Self::Gsd { reason: reason.into() }
    }

    /// Creates the error for a missing field.
    pub(super) fn missing(line: usize, what: impl Into<String>) -> Self {
        Self::Missing { line, what: what.into() }
    }
}
