//! The command line of the examples, and its errors in one line.

use std::fs;
use std::path::Path;
use std::process::{ExitCode, exit};

use clap::Parser;

pub use crate::failure::Failure;
use crate::output;

/// Parses the command line, runs an example and reports its failure, if any.
pub fn main<A: Parser, E: Into<Failure>>(run: impl FnOnce(&A) -> Result<(), E>) -> ExitCode {
    match run(&parse()).map_err(Into::into).and_then(|()| output::end()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::complain(format_args!("error: {failure}"));
            failure.exit_code()
        }
    }
}

/// Creates the folder for the results if it does not exist.
pub fn make_folder(out: &Path) -> Result<(), Failure> {
    fs::create_dir_all(out).map_err(|error| Failure::run(format_args!("--out {}: {error}", out.display())))
}

/// Parses the command line. A mistake ends the program with one line and exit code 2.
fn parse<A: Parser>() -> A {
    // A negative number is reported by the flag that cannot take it, not as an unknown flag.
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

/// Returns a message of clap without the usage that follows it.
fn in_one_line(message: &str) -> String {
    let told = message.lines().map(str::trim);
    let told = told.take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"));
    let told = told.filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    // The message of the standard library about a text that is not a whole number.
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
