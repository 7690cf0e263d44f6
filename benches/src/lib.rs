//! Parts that the measurements share: the paper's box in a settled state, and settings from the
//! environment.
#![allow(clippy::missing_errors_doc, reason = "each program ends with the error that it gets")]

pub mod ask;
pub mod state;

use std::path::PathBuf;
use std::process::ExitCode;

pub use state::Outcome;

/// Reports a failure in one line on standard error.
pub fn report(outcome: Outcome<()>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Returns the processor, the system and the load of the machine.
pub fn machine() -> String {
    let known = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = known.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let name = name.map_or("unknown processor", |(_, name)| name);
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{name}, {processors} processors, load {}; {}", load(), std::env::consts::OS)
}

/// Prints how this program was compiled, and how busy the machine is.
pub fn print_circumstances() {
    let wide = if cfg!(target_feature = "avx2") {
        "with AVX2"
    } else {
        "without AVX2: RUSTFLAGS=\"-C target-cpu=native\" makes it a little faster"
    };
    println!("Compiled {wide}. Load of the machine: {}.", load());
}

/// Returns the number of processes that ran or waited in the last minute. This process is one of them.
pub fn load() -> String {
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split_whitespace().next().unwrap_or("unknown").to_owned()
}

/// Returns the path of a folder of this name for temporary builds and files of a program, beside the folders
/// in which cargo keeps the programs.
pub fn working_folder(name: &str) -> Outcome<PathBuf> {
    let program = std::env::current_exe()?;
    let built = program.ancestors().nth(2).ok_or("the program lies in no folder of cargo's")?;
    Ok(built.join(name))
}
