//! The run whose instructions `.ci/instructions` counts: a settled state, dilute or dense, that goes on for a
//! few oscillations.

use std::process::ExitCode;

use benches::state::{DENSE, DILUTE, Outcome, Run, oscillate};

fn main() -> ExitCode {
    match run() {
        Ok(collisions) => {
            println!("{collisions}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the program, and returns the number of collisions of two disks in the part that is counted.
fn run() -> Outcome<u64> {
    let (state, settle, oscillations) = match std::env::args().nth(1).as_deref() {
        Some("dilute") => (DILUTE, 200, 200),
        Some("dense") => (DENSE, 200, 100),
        _ => return Err("which state: dilute or dense?".into()),
    };
    let mut run = state.settled(1, settle)?;
    let before = run.counters().disk_collisions;
    counted_part(&mut run, oscillations)?;
    Ok(run.counters().disk_collisions - before)
}

/// Runs the part that is counted. Callgrind finds it by this name.
#[inline(never)]
fn counted_part(run: &mut Run, oscillations: u32) -> Outcome<()> {
    oscillate(run, oscillations)
}
