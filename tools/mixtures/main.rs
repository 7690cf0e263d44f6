//! The time per collision in mixtures of sizes, divided by the time in a gas of the same number of equal
//! disks.
//!
//! ```sh
//! cargo run --release -p tools --bin mixtures                  # 1000 and 10 000 disks
//! DISKS=100000 cargo run --release -p tools --bin mixtures     # any number of disks
//! ```
//!
//! Each mixture is an elastic gas without gravity at an area fraction of 0.4 in a square box. It is compared
//! with two other gases: the same number of disks, all of the smallest size, at the same area fraction; and,
//! for two sizes, its small disks alone, in the same box. The gases run alternately, for `ROUNDS` intervals
//! of `COLLISIONS` collisions each, and the shortest time of each gas counts. With `DETAILS`, the numbers of
//! other events are printed, too.

mod gas;
mod mixture;

use std::fmt;
use std::process::ExitCode;

use benches::Outcome;
use benches::ask;
use gas::{Gas, side_for};
use mixture::{Distribution, Mixture, Sizes};

/// Collisions of each disk before the first interval.
const SETTLE: f64 = 6.0;

/// The plan of the measurement.
struct Plan {
    disks: Vec<usize>,
    ratios: Vec<f64>,
    spans: Vec<f64>,
    rounds: u32,
    /// Collisions in an interval.
    collisions: u32,
}

fn main() -> ExitCode {
    benches::report(run())
}

fn run() -> Outcome<()> {
    let plan = Plan::asked_for()?;
    benches::print_circumstances();
    println!(
        "Time per collision, divided by the time for as many equal disks, and for the small disks \
         alone in the same box; the shortest of {} intervals.",
        plan.rounds
    );
    for &disks in &plan.disks {
        let sizes = |sizes: &[Sizes], ratios: &[f64], title| print_table(&plan, disks, sizes, ratios, title);
        sizes(&Sizes::TWO, &plan.ratios, "large / small")?;
        sizes(&Distribution::ALL.map(Sizes::Many), &plan.spans, "largest / smallest")?;
    }
    Ok(())
}

impl Plan {
    fn asked_for() -> Outcome<Self> {
        if ask::is_test() {
            let (ratios, spans) = (vec![5.0], vec![10.0]);
            return Ok(Self { disks: vec![200], ratios, spans, rounds: 1, collisions: 100 });
        }
        let disks = match ask::number("DISKS", 0) {
            Ok(0) => vec![1000, 10_000],
            number => vec![number? as usize],
        };
        let (ratios, spans) = (vec![2.0, 5.0, 10.0, 20.0, 50.0], vec![10.0, 100.0]);
        let (rounds, collisions) = (ask::number("ROUNDS", 60)?, ask::number("COLLISIONS", 10_000)?);
        Ok(Self { disks, ratios, spans, rounds, collisions })
    }
}

/// Prints a row for each kind of mixture, with a column for each ratio.
fn print_table(plan: &Plan, disks: usize, sizes: &[Sizes], ratios: &[f64], title: &str) -> Outcome<()> {
    println!();
    println!("| {title}, N = {disks} | {} |", row(ratios.iter().map(|ratio| format!("{ratio}"))));
    println!("|---|{}", "---|".repeat(ratios.len()));
    for &sizes in sizes {
        let figures: Vec<String> = ratios
            .iter()
            .map(|&ratio| Ok(compare(plan, Mixture { sizes, ratio, disks })?.to_string()))
            .collect::<Outcome<_>>()?;
        println!("| {sizes} | {} |", row(figures.into_iter()));
    }
    Ok(())
}

fn row(cells: impl Iterator<Item = String>) -> String {
    cells.collect::<Vec<_>>().join(" | ")
}

/// The time per collision in a mixture, divided by the times in two other gases.
struct Ratios {
    /// Divided by the time among the same number of equal disks at the same area fraction.
    equal: f64,
    /// Divided by the time among the small disks of a mixture of two sizes, alone in the same box.
    small: Option<f64>,
}

impl fmt::Display for Ratios {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:.2}", self.equal)?;
        self.small.map_or(Ok(()), |small| write!(formatter, ", {small:.2}"))
    }
}

fn compare(plan: &Plan, mixture: Mixture) -> Outcome<Ratios> {
    let (radii, small) = (mixture.radii()?, mixture.small()?);
    let smallest = radii.iter().copied().fold(f64::INFINITY, f64::min);
    let equal = vec![smallest; radii.len()];
    let side = side_for(&radii);
    let mut gases = vec![Gas::of(equal.clone(), side_for(&equal), SETTLE)?, Gas::of(radii, side, SETTLE)?];
    if let Some(small) = small {
        gases.push(Gas::of(small, side, SETTLE)?);
    }
    let mut best = vec![f64::INFINITY; gases.len()];
    for _ in 0..plan.rounds {
        for (gas, best) in gases.iter_mut().zip(&mut best) {
            *best = gas.seconds_for(plan.collisions)?.min(*best);
        }
    }
    let mixed = best[1];
    if benches::ask::flag("DETAILS") {
        let (crossings, searches) = gases[1].bookkeeping();
        let nanoseconds = 1e9 * mixed / f64::from(plan.collisions);
        eprintln!(
            "{} {}: {nanoseconds:.0} ns, {crossings:.2} passages and {searches:.2} new searches per collision",
            mixture.sizes, mixture.ratio
        );
    }
    Ok(Ratios { equal: mixed / best[0], small: best.get(2).map(|alone| mixed / alone) })
}
