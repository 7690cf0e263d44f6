//! The program `granular-edmd`, as a function that the script of the wheel calls.

use std::ffi::OsString;

use edmd_study::cli;
use pyo3::prelude::*;

/// Runs the program with these arguments, of which the first is its name, and returns its exit code.
#[pyfunction]
pub(crate) fn run_program(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cli::main_from(arguments, cli::example))
}
