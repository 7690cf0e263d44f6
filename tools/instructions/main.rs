//! The run whose instructions `.ci/instructions` counts: a standard state that goes on for a while.

use std::process::ExitCode;

use benches::Outcome;
use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::simulation::Limits;
use granular_edmd::{Simulation, speed};

/// Number of collisions, with disks or walls, in the part that is counted.
const COLLISIONS: u64 = 100_000;

fn main() -> ExitCode {
    benches::report(run())
}

fn run() -> Outcome<()> {
    match std::env::args().nth(1).as_deref() {
        Some("dilute") => count(speed::dilute()?),
        Some("dense") => count(speed::dense()?),
        Some("gas_0.1") => count(speed::gas(0.1)?),
        Some("gas_0.3") => count(speed::gas(0.3)?),
        Some("gas_0.65") => count(speed::gas(0.65)?),
        Some("mixture") => count(speed::mixture()?),
        Some("vessel") => count(speed::vessel()?),
        _ => Err("which state: dilute, dense, gas_0.1, gas_0.3, gas_0.65, mixture or vessel?".into()),
    }
}

/// Prints the number of collisions of two disks in the part that is counted.
fn count<R: CollisionRule, B: Boundary>(mut run: Simulation<R, B>) -> Outcome<()> {
    let before = run.counters().disk_collisions;
    counted_part(&mut run)?;
    println!("{}", run.counters().disk_collisions - before);
    Ok(())
}

/// Runs the part that is counted. Callgrind finds it by this name.
#[inline(never)]
fn counted_part<R: CollisionRule, B: Boundary>(run: &mut Simulation<R, B>) -> Outcome<()> {
    run.run(&Limits::until(f64::MAX).with_most_collisions(COLLISIONS), &mut ())?;
    Ok(())
}
