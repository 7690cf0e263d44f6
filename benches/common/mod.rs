//! What the measurements share: the paper's box in a settled state, medians, and what the environment asks for.
#![allow(dead_code, reason = "each bench takes what it needs")]

pub(crate) mod ask;
pub(crate) mod quartiles;
pub(crate) mod state;
pub(crate) mod stopwatch;

use std::process::ExitCode;

pub(crate) use state::Outcome;

/// One line on standard error if it did not work out.
pub(crate) fn report(outcome: Outcome<()>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// How this was compiled, and how busy the machine is.
pub(crate) fn print_circumstances() {
    let wide = if cfg!(target_feature = "avx2") {
        "with AVX2"
    } else {
        "without AVX2: RUSTFLAGS=\"-C target-cpu=native\" makes it faster"
    };
    println!("Compiled {wide}. Load of the machine: {}.", load());
}

/// Processes that ran or waited in the last minute, of which one is this.
pub(crate) fn load() -> String {
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split_whitespace().next().unwrap_or("unknown").to_owned()
}
