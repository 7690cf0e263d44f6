//! Tables of docs/validation.md, written by the tests that make them.

use std::fs::{create_dir_all, write};
use std::path::Path;

/// Prints a table, and writes it to the folder that `VALIDATION` names, if any, for `.ci/validation`.
pub fn table(name: &str, lines: &str) {
    println!("{lines}");
    let Some(folder) = std::env::var_os("VALIDATION") else { return };
    create_dir_all(&folder).expect("the folder of measured values");
    write(Path::new(&folder).join(name.to_owned() + ".md"), lines).expect("a file of a table");
}
