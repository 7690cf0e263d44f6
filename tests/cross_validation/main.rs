//! The engine against a plain independent simulation of the same system, over a grid of friction,
//! inelasticity and gravity.
//!
//! ```text
//! REFERENCE=path/of/the/program cargo test --release --test cross_validation -- --ignored --nocapture
//! ```
//!
//! `REFERENCE` is a program that takes the flags `--k0`, `--q`, `--g`, `--tc`, `--seed`, `--periods`, ... and
//! prints one `pt` and one `k=` line for each interval; see `reference.rs`. Nothing of it is part of this
//! crate.

mod engine;
mod means;
mod reference;
mod statistics;

use std::error::Error;

use means::{Means, QUANTITIES};
use statistics::{Comparison, expected_sum};

/// Friction, inelasticity and gravity of a run.
#[derive(Debug, Clone, Copy)]
struct Point {
    friction: f64,
    inelasticity: f64,
    gravity: f64,
}

/// Number of disks. Both programs have the same box, base and contact duration, the same distribution of
/// initial states, and the same times of settling and sampling. Their random numbers differ.
const DISKS: usize = 1000;
const WIDTH: f64 = 60.0;
const HEIGHT: f64 = 150.0;
const CONTACT_DURATION: f64 = 1e-6;
/// Time between two samples, in oscillations.
const INTERVAL: u32 = 10;
const SETTLE: u32 = 1500;
const SAMPLES: u32 = 200;
/// Number of independent runs of each program.
const RUNS: u64 = 6;

/// Returns the points of the grid. The point without friction and inelasticity is left out: nothing takes
/// away the energy that the base gives, so it has no steady state.
fn grid() -> Vec<Point> {
    let mut points = Vec::new();
    for gravity in [0.015_625, 0.002_025] {
        for inelasticity in [0.0, 0.05, 0.1] {
            for friction in [0.0, 0.03, 0.07, 0.3] {
                if friction + inelasticity > 0.0 {
                    points.push(Point { friction, inelasticity, gravity });
                }
            }
        }
    }
    points
}

#[test]
#[ignore = "needs the program REFERENCE, and a quarter of an hour"]
fn the_engine_agrees_with_a_plain_simulation() -> Result<(), Box<dyn Error>> {
    let program = std::env::var("REFERENCE").map_err(|_| "REFERENCE must name the other program")?;
    let mut comparisons = Vec::new();
    println!("| g | q | κ | two rolls | {} |", QUANTITIES.map(|quantity| quantity.name).join(" | "));
    println!("|---|---|---|---|{}", "---|".repeat(QUANTITIES.len()));
    for point in grid() {
        let ours = runs(|seed| engine::run(point, seed))?;
        let theirs = runs(|seed| reference::run(&program, point, seed))?;
        let compared = QUANTITIES.map(|quantity| Comparison::of(&ours, &theirs, quantity.of));
        let Point { friction, inelasticity, gravity } = point;
        let cells = compared.map(|one| one.to_string()).join(" | ");
        let two_rolls = format!("{}, {}", count_two_rolls(&ours), count_two_rolls(&theirs));
        println!("| {gravity} | {inelasticity} | {friction} | {two_rolls} | {cells} |");
        comparisons.push(compared);
    }
    QUANTITIES.iter().enumerate().for_each(|(index, quantity)| {
        let of_quantity: Vec<Comparison> = comparisons.iter().map(|compared| compared[index]).collect();
        judge(quantity.name, &of_quantity);
    });
    Ok(())
}

fn runs(run: impl Fn(u64) -> Result<Means, Box<dyn Error>>) -> Result<Vec<Means>, Box<dyn Error>> {
    (1..=RUNS).map(run).collect()
}

/// Returns the number of runs in which two rolls are stronger than one. If this is neither 0 nor all, runs
/// took different branches.
fn count_two_rolls(runs: &[Means]) -> usize {
    runs.iter().filter(|means| means.two_rolls > means.one_roll).count()
}

/// Checks that the deviations of all points together are as large as chance makes them.
///
/// If the means are equal, each deviation follows Student's t, and the sum of squares has a known mean and
/// variance. Five standard deviations above the mean has a chance of one in some thousands, because the tail
/// of t² is longer than a Gaussian's. An error of one standard error in each point would be as far out.
fn judge(name: &str, comparisons: &[Comparison]) {
    let known: Vec<f64> = comparisons.iter().filter_map(Comparison::deviation).collect();
    let sum: f64 = known.iter().map(|deviation| deviation * deviation).sum();
    let largest = known.iter().fold(0.0, |most: f64, deviation| most.max(deviation.abs()));
    let (expected, scatter) = expected_sum(known.len(), 2 * (RUNS - 1));
    println!(
        "{name}: {} points, sum of t² {sum:.1}, expected {expected:.1} ± {scatter:.1}, largest |t| {largest:.1}",
        known.len()
    );
    assert!(sum < expected + 5.0 * scatter, "{name}");
}
