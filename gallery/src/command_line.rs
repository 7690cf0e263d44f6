//! The command line of the examples, and errors in one line.

use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::fs;
use std::path::Path;
use std::process::{ExitCode, exit};

use clap::Parser;
use granular_edmd::ParameterError;
use granular_edmd::simulation::RunError;

use crate::output;

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

    /// Reports the failure in one line on standard error, and returns the exit code.
    pub fn report(&self) -> ExitCode {
        output::complain(format_args!("error: {self}"));
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

/// Tells an error of a run with its sources.
impl From<Box<dyn Error>> for Failure {
    fn from(error: Box<dyn Error>) -> Self {
        let chain = std::iter::successors(Some(&*error), |&error| error.source());
        Self::Run(chain.map(ToString::to_string).collect::<Vec<_>>().join(": "))
    }
}

/// Parses the command line, runs an example and reports its failure, if any.
pub fn main<A: Parser, E: Into<Failure>>(run: impl FnOnce(&A) -> Result<(), E>) -> ExitCode {
    match run(&parse()).map_err(Into::into).and_then(|()| output::end()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// Makes the folder for the results, if there is none.
pub fn make_folder(out: &Path) -> Result<(), Failure> {
    fs::create_dir_all(out).map_err(|error| Failure::run(format_args!("--out {}: {error}", out.display())))
}

/// Parses the command line. A mistake ends the program with one line and exit code 2.
fn parse<A: Parser>() -> A {
    // A negative number is told by the flag that cannot take it, and is no unknown flag.
    let matches = A::command().allow_negative_numbers(true).try_get_matches();
    matches.and_then(|matches| A::from_arg_matches(&matches)).unwrap_or_else(|error| {
        if !error.use_stderr() {
            error.exit();
        }
        output::complain(format_args!("{}", in_one_line(&error.to_string())));
        exit(2);
    })
}

const NO_WHOLE_NUMBER: &str = "must be a whole number, not below 0";

/// Returns a message of clap's without the usage that follows it.
fn in_one_line(message: &str) -> String {
    let told = message.lines().map(str::trim);
    let told = told.take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"));
    let told = told.filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    // What the standard library says of a text that is no whole number.
    let told = told.replace("invalid digit found in string", NO_WHOLE_NUMBER);
    let told = told.replace("cannot parse integer from empty string", NO_WHOLE_NUMBER);
    told.replace("number too large to fit in target type", "the number is too large")
}

/// Parses a number that is finite and above zero.
pub fn positive(text: &str) -> Result<f64, String> {
    number(text, "finite and positive", |value| value > 0.0)
}

/// Parses a number that is finite and not below zero.
pub fn non_negative(text: &str) -> Result<f64, String> {
    number(text, "finite and not negative", |value| value >= 0.0)
}

fn number(text: &str, requirement: &str, valid: impl Fn(f64) -> bool) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| "must be a number".to_owned())?;
    if value.is_finite() && valid(value) { Ok(value) } else { Err(format!("must be {requirement}")) }
}

/// Parses a whole number from 1 to `MOST`.
pub fn whole<const MOST: u64>(text: &str) -> Result<u64, String> {
    let value = text.trim().parse().ok().filter(|value| (1..=MOST).contains(value));
    value.ok_or_else(|| format!("must be a whole number from 1 to {MOST}"))
}

/// Formats a number as people write it, with an exponent only if it is very large or very small.
pub fn plain(value: f64) -> String {
    if value == 0.0 || (1e-4..1e7).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}
