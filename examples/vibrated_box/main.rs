//! The paper's system: frictional, inelastic disks in a box with a vibrating base.
//!
//! ```text
//! cargo run --release --example vibrated_box
//! cargo run --release --example vibrated_box -- --friction 0.07 --oscillations 10000 --out two_rolls
//! cargo run --release --example vibrated_box -- --help
//! ```

mod arguments;
#[path = "../common/mod.rs"]
mod common;
mod experiment;
mod picture;
mod report;

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use crate::arguments::Arguments;
use crate::common::command_line::{self, Failure};
use crate::experiment::Outcome;

fn main() -> ExitCode {
    command_line::main(|arguments: &Arguments| {
        check(arguments)?;
        write(arguments, &experiment::run(arguments)?)
    })
}

/// Checks everything that can be known to fail before a long run.
fn check(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { every, oscillations, out, .. } = arguments;
    if every > oscillations {
        return Err(Failure::usage(format_args!(
            "--every {every}: no sample is taken in --oscillations {oscillations}"
        )));
    }
    if arguments.gravity == 0.0 && arguments.height.0.is_none() {
        return Err(Failure::usage("--gravity 0: without gravity the box needs a --height"));
    }
    if let Some(folder) = arguments.json.as_ref().and_then(|json| json.parent())
        && !folder.as_os_str().is_empty()
        && !folder.is_dir()
    {
        return Err(Failure::run(format_args!("--json: there is no folder {}", folder.display())));
    }
    command_line::make_folder(out)
}

/// Writes all results.
fn write(arguments: &Arguments, outcome: &Outcome) -> Result<(), Failure> {
    write_json(arguments, outcome)?;
    let table = arguments.out.join("vibrated_box.csv");
    report::write_table(&table, &outcome.samples).map_err(|error| cannot_write(&table, error))?;
    let picture = arguments.out.join("vibrated_box.png");
    let png = picture::draw(arguments, outcome).map_err(|error| cannot_write(&picture, error))?;
    fs::write(&picture, png).map_err(|error| cannot_write(&picture, error))?;
    let summary = report::summary(arguments, outcome);
    let summary = format!("{summary}{:<24} {}, {}\n", "written", picture.display(), table.display());
    if arguments.json_to_standard_output() {
        print(&mut io::stderr(), &summary)
    } else {
        print(&mut io::stdout(), &summary)
    }
}

fn write_json(arguments: &Arguments, outcome: &Outcome) -> Result<(), Failure> {
    let Some(path) = &arguments.json else { return Ok(()) };
    let json = format!("{:#}\n", report::json(arguments, outcome));
    if arguments.json_to_standard_output() {
        print(&mut io::stdout(), &json)
    } else {
        fs::write(path, json).map_err(|error| cannot_write(path, error))
    }
}

fn print(target: &mut impl Write, text: &str) -> Result<(), Failure> {
    target.write_all(text.as_bytes()).map_err(|error| Failure::run(format_args!("cannot print: {error}")))
}

fn cannot_write(path: &Path, error: impl std::fmt::Display) -> Failure {
    Failure::run(format_args!("cannot write {}: {error}", path.display()))
}
