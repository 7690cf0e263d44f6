//! Measured values of docs/validation.md, written by the tests that measure them.

use std::fmt::Display;
use std::fs::{OpenOptions, create_dir_all};
use std::io::Write;
use std::path::Path;
use std::thread;

/// Prints a value, and writes it to the file of the current test in the folder that `VALIDATION` names, if
/// any, for `.ci/validation`. A test has a file of its own, since tests run at the same time.
pub fn measured(quantity: &str, value: impl Display) {
    println!("{quantity}: {value}");
    let Some(folder) = std::env::var_os("VALIDATION") else { return };
    let test = thread::current().name().expect("a test runs in a thread of its name").replace("::", ".");
    create_dir_all(&folder).expect("the folder of measured values");
    let file = OpenOptions::new().append(true).create(true).open(Path::new(&folder).join(test + ".tsv"));
    writeln!(file.expect("a file of measured values"), "{quantity}\t{value}").expect("a measured value");
}
