//! Checks the answers to the exercise on convection rolls, `docs/guide/exercise_rolls.md`.
//!
//! ```text
//! cargo run --release --example exercise_rolls -- FRICTION_OF_ONE_ROLL FRICTION_OF_TWO_ROLLS
//! ```
//!
//! Nothing is looked up: the paper's box is run below and above each answer, for some ten seconds in all, and
//! the states that are found there are compared.

use std::process::ExitCode;

use granular_edmd::observable::Temperatures;
use granular_edmd::prelude::*;
use granular_edmd_study::analysis::{ConvectiveRegime, StateCriteria, thermal_noise};

/// Oscillations of each run. The first half settles.
const OSCILLATIONS: u32 = 5000;

fn main() -> anyhow::Result<ExitCode> {
    let answers: Vec<f64> = std::env::args().skip(1).map(|text| friction(&text)).collect::<Result<_, _>>()?;
    let [one_roll, two_rolls] = answers[..] else {
        anyhow::bail!("two frictions are asked for: where one roll begins, and where two begin");
    };
    // A continuous transition is not sharp in a box of 1000 disks; the other one is.
    let runs = [
        (one_roll / 1.7, ConvectiveRegime::NoRoll),
        (one_roll * 1.7, ConvectiveRegime::OneRoll),
        (two_rolls / 1.3, ConvectiveRegime::OneRoll),
        (two_rolls * 1.3, ConvectiveRegime::TwoRolls),
    ];
    let mut all = true;
    for (friction, expected) in runs {
        let found = regime(friction)?;
        let right = found == expected;
        println!(
            "{}  κ = {friction:.4}: {found}, {expected} expected",
            if right { "right" } else { "WRONG" }
        );
        all &= right;
    }
    Ok(if all { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Reads a coefficient of friction.
fn friction(text: &str) -> anyhow::Result<f64> {
    text.parse().map_err(|_| anyhow::anyhow!("{text}: expected a number, such as 0.02"))
}

/// Returns the state of the paper's box at g = 0.015625 and q = 0.
fn regime(friction: f64) -> anyhow::Result<ConvectiveRegime> {
    let base = BiParabolic::new(0.1, 10.0)?;
    let oscillation = std::f64::consts::TAU / base.angular_frequency();
    let container = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, base)?;
    let disks = initial::lattice(&container, 1000, 0.5)?;
    let disks = initial::with_maxwellian_velocities(disks, 0.5, 1)?;
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.0, 0.0, friction)?, 1e-4)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;

    let half = f64::from(OSCILLATIONS / 2) * oscillation;
    simulation.run_until(half, &mut ())?;
    let mut series = Series::new((OrderParameters, Temperatures), SampleTimes::every(10.0 * oscillation)?);
    simulation.run_until(2.0 * half, &mut series)?;
    let (orders, temperatures): (Vec<_>, Vec<_>) = series.values().iter().copied().unzip();
    let vertical = temperatures.iter().map(|each| each.vertical).sum::<f64>() / temperatures.len() as f64;
    let noise = thermal_noise(vertical, 1.0, 1000)?;
    Ok(StateCriteria::default().classify(&orders, noise, None)?.regime())
}
