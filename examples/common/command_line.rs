//! Reading the command line, and saying in one line what was wrong with it.

use std::fmt::Display;
use std::process::{ExitCode, exit};

use clap::Parser;

/// Why an example ends early.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The flags cannot be used: exit code 2.
    Usage(String),
    /// They could, and yet it did not work out: exit code 1.
    Run(String),
}

impl Failure {
    /// The flags cannot be used.
    pub(crate) fn usage(message: impl Display) -> Self {
        Self::Usage(message.to_string())
    }

    /// The run, or writing its results, failed.
    pub(crate) fn run(message: impl Display) -> Self {
        Self::Run(message.to_string())
    }

    /// One line on standard error, and the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        let (message, code) = match self {
            Self::Usage(message) => (message, 2),
            Self::Run(message) => (message, 1),
        };
        eprintln!("error: {message}");
        ExitCode::from(code)
    }
}

/// The command line; a mistake ends the program with one line and exit code 2.
pub(crate) fn parse<A: Parser>() -> A {
    A::try_parse().unwrap_or_else(|error| {
        if !error.use_stderr() {
            error.exit();
        }
        eprintln!("{}", in_one_line(&error.to_string()));
        exit(2);
    })
}

/// A message of clap's without the usage that follows it.
fn in_one_line(message: &str) -> String {
    let told = message.lines().map(str::trim);
    let told = told.take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"));
    told.filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

/// A number that is finite and above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    number(text, "finite and positive", |value| value > 0.0)
}

/// A number that is finite and not below zero.
pub(crate) fn non_negative(text: &str) -> Result<f64, String> {
    number(text, "finite and not negative", |value| value >= 0.0)
}

fn number(text: &str, requirement: &str, valid: impl Fn(f64) -> bool) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| "must be a number".to_owned())?;
    if value.is_finite() && valid(value) { Ok(value) } else { Err(format!("must be {requirement}")) }
}

/// A whole number from 1 to `MOST`.
pub(crate) fn whole<const MOST: u64>(text: &str) -> Result<u64, String> {
    let value = text.trim().parse().ok().filter(|value| (1..=MOST).contains(value));
    value.ok_or_else(|| format!("must be a whole number from 1 to {MOST}"))
}

/// A number as people write it: very large and very small ones with an exponent.
pub(crate) fn plain(value: f64) -> String {
    if value == 0.0 || (1e-4..1e7).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}
