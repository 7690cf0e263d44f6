//! Parts that the measurements share: the paper's box in a settled state, medians, and settings from the
//! environment.
#![allow(dead_code, reason = "each bench takes what it needs")]

pub(crate) mod ask;
pub(crate) mod quartiles;
pub(crate) mod state;
pub(crate) mod stopwatch;

use std::process::ExitCode;

pub(crate) use state::Outcome;

/// Reports a failure in one line on standard error.
pub(crate) fn report(outcome: Outcome<()>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints how this program was compiled, and how busy the machine is.
pub(crate) fn print_circumstances() {
    let wide = if cfg!(target_feature = "avx2") {
        "with AVX2"
    } else {
        "without AVX2: RUSTFLAGS=\"-C target-cpu=native\" makes it a little faster"
    };
    println!("Compiled {wide}. Load of the machine: {}.", load());
}

/// Returns the number of processes that ran or waited in the last minute. This process is one of them.
pub(crate) fn load() -> String {
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split_whitespace().next().unwrap_or("unknown").to_owned()
}
