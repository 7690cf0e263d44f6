//! The paper's Fig. 5: convective states in the plane of friction and inelasticity.

mod plan;
#[path = "../studies/mod.rs"]
mod studies;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

use plan::{Gravity, Size};

/// Convective states in the plane of friction and inelasticity (paper, Fig. 5).
#[derive(Parser)]
struct Arguments {
    /// Folder for the studies, the picture and the tables.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// Gravity, one of the paper's two.
    #[arg(long, value_enum, default_value = "0.015625")]
    gravity: Gravity,
    /// How much is done.
    #[arg(long, value_enum, default_value = "full")]
    size: Size,
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> ExitCode {
    studies::end(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    for part in plan::parts(arguments.size, arguments.gravity, arguments.seed)? {
        if studies::complete(&arguments.out.join(part.folder), &part.specification)?.is_none() {
            break;
        }
    }
    Ok(())
}
