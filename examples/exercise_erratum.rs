//! Checks the answers to the exercise on the erratum of Eq. (6), `docs/guide/exercise_erratum.md`.
//!
//! ```text
//! cargo run --release -p granular-edmd --example exercise_erratum > erratum.csv
//!
//! cargo run --release -p granular-edmd --example exercise_erratum -- FACTOR JUMP FRICTION INELASTICITY
//! ```
//!
//! The first command writes the curves of the exercise's figure. An answer is a number such as 0.25, or a
//! fraction such as 1/4. The program computes the right answers from the collision rule and from the mean
//! energy change.

use std::process::ExitCode;

use granular_edmd::collision::{CollisionRule, Contact, Frictional};
use granular_edmd::kinetic::{Maxwellian, friction_of_largest_loss, mean_energy_change, sticking_fraction};

const QUESTIONS: [&str; 4] = [
    "the factor of q_t (1 - q_t) m v_t²",
    "the jump j > 0 of the printed dE from sticking to sliding, in κ² q_t (1 - q_n)² / (1 - q_t) m v_n²",
    "the friction of the largest loss at q = 0.1",
    "the inelasticity above which the printed form has no local maximum",
];

fn main() -> anyhow::Result<ExitCode> {
    let answers: Vec<f64> = std::env::args().skip(1).map(|text| number(&text)).collect::<Result<_, _>>()?;
    if answers.is_empty() {
        return curves();
    }
    anyhow::ensure!(answers.len() == 4, "four numbers are asked for, not {}: {QUESTIONS:?}", answers.len());
    let truths = [factor()?, jump()?, friction()?, last_maximum()?];
    let mut all = true;
    for ((question, answer), truth) in QUESTIONS.iter().zip(answers).zip(truths) {
        // A figure can be read off to about five percent.
        let right = (answer / truth - 1.0).abs() < 0.05;
        println!("{}  {question}: {answer}", if right { "right" } else { "WRONG" });
        all &= right;
    }
    Ok(if all { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Reads a number or a fraction.
fn number(text: &str) -> anyhow::Result<f64> {
    let (numerator, denominator) = text.split_once('/').unwrap_or((text, "1"));
    let part = |text: &str| text.trim().parse::<f64>().ok();
    let value = part(numerator).zip(part(denominator)).map(|(above, below)| above / below);
    let value = value.filter(|value| value.is_finite());
    value.ok_or_else(|| anyhow::anyhow!("{text}: expected a number or a fraction, such as 0.25 or 1/4"))
}

/// Returns the energy change of a collision of the paper's disks, of mass 1.
fn energy_change(rule: &Frictional, closing_speed: f64, slip_speed: f64) -> f64 {
    let contact = Contact::new(closing_speed, slip_speed, 0.5, 1.0 / 6.0);
    rule.impulse(&contact).energy_change(&contact)
}

/// Returns the factor in the energy that a sticking collision loses by its slip.
fn factor() -> anyhow::Result<f64> {
    let (rule, slip) = (Frictional::from_inelasticity(0.0, 0.2, 10.0)?, 0.3);
    Ok(-energy_change(&rule, 1.0, slip) / (0.2 * 0.8 * slip * slip))
}

/// Returns the jump of the energy change at the threshold of sliding: the rule, which already slides, minus
/// the printed form, which still sticks.
fn jump() -> anyhow::Result<f64> {
    let (normal, tangential, friction) = (0.1, 0.2, 0.3);
    let rule = Frictional::from_inelasticity(normal, tangential, friction)?;
    let threshold = 3.0 * friction * (1.0 - normal) / (1.0 - tangential);
    let printed = -normal * (1.0 - normal) - tangential * (1.0 - tangential) * threshold * threshold;
    let unit = friction * friction * tangential * (1.0 - normal) * (1.0 - normal) / (1.0 - tangential);
    Ok((energy_change(&rule, 1.0, threshold * (1.0 + 1e-9)) - printed) / unit)
}

fn friction() -> anyhow::Result<f64> {
    let rule = Frictional::from_inelasticity(0.1, 0.1, 1.0)?;
    friction_of_largest_loss(&rule, &Maxwellian::new(1.0)?).ok_or_else(|| anyhow::anyhow!("no largest loss"))
}

/// Returns the mean loss under the rule, and the mean loss with three times the tangential term of sticking,
/// as printed.
fn losses(inelasticity: f64, friction: f64) -> anyhow::Result<(f64, f64)> {
    let rule = Frictional::from_inelasticity(inelasticity, inelasticity, friction)?;
    let gas = Maxwellian::new(1.0)?;
    let sticking = 2.0 * inelasticity * (1.0 - inelasticity) * sticking_fraction(&rule, &gas).powi(3);
    let loss = -mean_energy_change(&rule, &gas);
    Ok((loss, loss + 2.0 * sticking))
}

fn frictions() -> impl Iterator<Item = f64> {
    (0..=1200).map(|step| 0.01 * 10_f64.powf(f64::from(step) / 400.0))
}

/// Finds by bisection the inelasticity above which the printed form has no largest loss.
fn last_maximum() -> anyhow::Result<f64> {
    let (mut with, mut without) = (0.01, 0.2);
    while without - with > 1e-4 {
        let middle = 0.5 * (with + without);
        let losses = frictions().map(|friction| Ok(losses(middle, friction)?.1));
        let losses: Vec<f64> = losses.collect::<anyhow::Result<_>>()?;
        let falls = losses.windows(2).any(|pair| pair[1] < pair[0]);
        (with, without) = if falls { (middle, without) } else { (with, middle) };
    }
    Ok(with)
}

/// Prints the curves of the figure.
fn curves() -> anyhow::Result<ExitCode> {
    println!("inelasticity,friction,by_the_rule,as_printed");
    for inelasticity in [0.0, 0.05, 0.1, 0.2] {
        for friction in frictions() {
            let (rule, printed) = losses(inelasticity, friction)?;
            println!("{inelasticity},{friction},{rule},{printed}");
        }
    }
    Ok(ExitCode::SUCCESS)
}
