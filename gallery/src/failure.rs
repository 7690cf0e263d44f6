//! Failures of the examples.

use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::io;
use std::path::Path;
use std::process::ExitCode;

use granular_edmd::ParameterError;
use granular_edmd::simulation::RunError;

/// The reason why an example ends early.
#[derive(Debug)]
pub enum Failure {
    /// The flags cannot be used; the exit code is 2.
    Usage(String),
    /// The flags can be used, but the run failed; the exit code is 1.
    Run(String),
}

impl Failure {
    /// Creates the failure of flags that cannot be used.
    pub fn usage(message: impl Display) -> Self {
        Self::Usage(message.to_string())
    }

    /// Creates the failure of a run, or of writing its results.
    pub fn run(message: impl Display) -> Self {
        Self::Run(message.to_string())
    }

    /// Returns the exit code.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(if matches!(self, Self::Usage(_)) { 2 } else { 1 })
    }
}

impl Display for Failure {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let (Self::Usage(message) | Self::Run(message)) = self;
        formatter.write_str(message)
    }
}

impl Error for Failure {}

impl From<ParameterError> for Failure {
    fn from(error: ParameterError) -> Self {
        Self::usage(error)
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        Self::run(error)
    }
}

/// Converts an error of a run, with its sources in the text.
impl From<Box<dyn Error>> for Failure {
    fn from(error: Box<dyn Error>) -> Self {
        let chain = std::iter::successors(Some(&*error), |&error| error.source());
        Self::Run(chain.map(ToString::to_string).collect::<Vec<_>>().join(": "))
    }
}

/// Names the file in an error about it.
pub fn named<T>(path: &Path, result: io::Result<T>) -> io::Result<T> {
    result.map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))
}
