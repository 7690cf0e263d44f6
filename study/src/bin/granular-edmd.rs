//! The command `granular-edmd`, which runs studies of the paper's box from plans in TOML.

use std::process::ExitCode;

use granular_edmd_study::cli;

fn main() -> ExitCode {
    cli::main(cli::example)
}
