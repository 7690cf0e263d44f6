//! Standard output, which a reader may close at any time.
//!
//! `println!` panics if the reader has gone, and then a program's files are not written. Here, a closed pipe
//! only ends the printing, and any other failure ends the program with an error, after its work.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use granular_edmd::simulation::Warning;

use crate::failure::Failure;

/// The reason why nothing is printed any more.
static FAILED: Mutex<Option<io::Error>> = Mutex::new(None);

/// True if standard output is only for the numbers as JSON, and everything else goes to standard error.
static FOR_JSON: AtomicBool = AtomicBool::new(false);

/// Prints a line, as `println!` does.
#[macro_export]
macro_rules! say {
    ($($text:tt)*) => { $crate::output::line(format_args!($($text)*)) };
}

/// Prints a line.
pub fn line(text: Arguments<'_>) {
    let mut failed = FAILED.lock().unwrap_or_else(PoisonError::into_inner);
    if failed.is_none() {
        let written = if FOR_JSON.load(Ordering::Relaxed) {
            writeln!(io::stderr(), "{text}")
        } else {
            writeln!(io::stdout(), "{text}")
        };
        *failed = written.err();
    }
}

/// Prints the warnings of a run on standard error.
pub fn warn(warnings: &[Warning]) {
    for warning in warnings {
        complain(format_args!("warning: {warning}"));
    }
}

/// Prints a line on standard error. A failure there is ignored, since no other place is left to report it.
pub fn complain(text: Arguments<'_>) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Reserves standard output for the numbers as JSON.
pub fn leave_to_json() {
    FOR_JSON.store(true, Ordering::Relaxed);
}

/// Prints the numbers as JSON.
pub fn json(text: &str) -> io::Result<()> {
    let written = writeln!(io::stdout(), "{text}").and_then(|()| io::stdout().flush());
    written.or_else(|error| if error.kind() == ErrorKind::BrokenPipe { Ok(()) } else { Err(error) })
}

/// Returns an error if printing has failed. A closed pipe is not a failure.
pub fn end() -> Result<(), Failure> {
    let failed = FAILED.lock().unwrap_or_else(PoisonError::into_inner).take();
    match failed.or_else(|| io::stdout().flush().err()) {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::run(format_args!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}
