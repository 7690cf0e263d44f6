//! The run whose instructions `.ci/instructions` counts: a standard state that is run for a while.

mod states;

use std::process::ExitCode;

use benches::Outcome;
use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::{CollisionRule, Elastic};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::SampleTimes;
use granular_edmd::simulation::{Inlet, Limits};
use granular_edmd::{Disk, Simulation, initial, speed};

/// Number of collisions, with disks or walls, in the part that is counted.
const COLLISIONS: u64 = 100_000;

fn main() -> ExitCode {
    benches::report(run())
}

fn run() -> Outcome<()> {
    match std::env::args().nth(1).as_deref() {
        Some("dilute") => count(speed::dilute()?),
        Some("dense") => count(speed::dense()?),
        Some("gas_0.1") => count(states::gas(0.1)?),
        Some("gas_0.3") => count(states::gas(0.3)?),
        Some("gas_0.65") => count(states::gas(0.65)?),
        Some("mixture") => count(states::mixture()?),
        Some("vessel") => count(states::vessel()?),
        Some("shower_1e3") => count(shower(1e3)?),
        Some("shower_1e5") => count(shower(1e5)?),
        _ => Err("which state: dilute, dense, gas_0.1, gas_0.3, gas_0.65, mixture, vessel, shower_1e3 or \
                  shower_1e5?"
            .into()),
    }
}

/// Prints the number of collisions of two disks, or of removals, in the part that is counted.
fn count<R: CollisionRule, B: Boundary>(mut run: Simulation<R, B>) -> Outcome<()> {
    let before = *run.counters();
    counted_part(&mut run)?;
    let counters = run.counters().since(&before);
    println!("{}", counters.disk_collisions + counters.removals);
    Ok(())
}

/// Creates a shower of about `drops` drops onto a floor that removes them, with as many new drops as removed
/// ones. Drops do not meet each other, so the work for a drop does not depend on their number.
fn shower(drops: f64) -> Outcome<Simulation<Elastic, Container>> {
    const TOP: f64 = 2.0;
    let width = (drops / TOP).round();
    let container = Container::open(width)?.absorbing(Wall::Floor)?;
    let at_rest = initial::scattered(&container, drops as usize, 0.1, TOP, 1)?;
    let falling: Vec<Disk> =
        at_rest.iter().map(|drop| drop.with_velocity(DVec2::NEG_Y)).collect::<Result<_, _>>()?;
    let (drop, places) = (falling[0].with_id(0)?, [DVec2::new(1.0, TOP), DVec2::new(width - 1.0, TOP)]);
    let mut run = Simulation::builder(Elastic, container).disks(falling).build()?;
    run.add_inlet(Inlet::new(places, [drop], SampleTimes::every(1.0 / width)?, 1)?)?;
    run.run_until(0.2, &mut ())?;
    Ok(run)
}

/// Runs the part that is counted. Callgrind finds it by this name.
#[inline(never)]
fn counted_part<R: CollisionRule, B: Boundary>(run: &mut Simulation<R, B>) -> Outcome<()> {
    run.run(&Limits::collisions(COLLISIONS), &mut ())?;
    Ok(())
}
