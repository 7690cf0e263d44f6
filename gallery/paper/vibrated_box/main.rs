//! The paper's system: frictional, inelastic disks in a box with a vibrating base.
//!
//! ```text
//! cargo run --release -p gallery --bin vibrated_box
//! cargo run --release -p gallery --bin vibrated_box -- --friction 0.07 --oscillations 10000 --out two_rolls
//! cargo run --release -p gallery --bin vibrated_box -- --help
//! ```

mod arguments;
mod experiment;
mod picture;
mod report;

use std::io::Write;
use std::process::ExitCode;

use crate::arguments::Arguments;
use gallery::command_line::{self, Failure};
use granular_edmd::observable::Table;

fn main() -> ExitCode {
    command_line::main(|arguments: &Arguments| {
        arguments.check()?;
        arguments.results.make_folder()?;
        let outcome = experiment::run(arguments)?;
        let (picture, numbers) = (picture::draw(arguments, &outcome), report::json(&outcome));
        let table = |out: &mut dyn Write| outcome.series.write_csv(out);
        let written = arguments.results.finish_with("vibrated_box", table, &picture, &numbers);
        report::print(&outcome);
        written.map_err(Failure::run)
    })
}
