//! The speed of this crate as a multiple of the speed of a plain event-driven simulation of the same system.
//!
//! ```sh
//! # A dilute and a dense state; with GRID=1 the κ–q plane of Fig. 5 at both gravities.
//! cargo run --release -p tools --bin ratio
//! ```
//!
//! The plain simulation is `tools/plain`, built for the processor at hand. This crate is measured as users
//! get it without compiler flags, and built for the processor at hand. The program builds itself both ways,
//! whatever its own flags are.
//!
//! Machines are noisy and no two are alike. Therefore, the programs run alternately, and the median of the
//! ratios of their numbers of disk collisions per second counts. Each program starts from its own lattice,
//! settles for a number of oscillations of the base, and is measured for the same number of oscillations by
//! the wall clock. `ROUNDS` and `OSCILLATIONS` change the number and the length of the measurements. At a
//! smaller gravity, the measurement is longer, since flights are longer.

mod itself;

use std::process::ExitCode;
use std::time::Instant;

use benches::Outcome;
use benches::ask;
use benches::state::{DENSE, DILUTE, State, oscillate};
use granular_edmd::speed::Quartiles;
use itself::Built;

/// The speed of one of the programs in a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Speed {
    /// Number of collisions of two disks per second.
    per_second: f64,
    /// Number of collisions of two disks per oscillation. The numbers of all programs are alike if they are
    /// in the same state.
    per_oscillation: f64,
}

/// The plan of the measurement: its number of rounds, its length, and its states.
struct Plan {
    rounds: u32,
    oscillations: u32,
    states: Vec<State>,
}

/// A function that measures the speed in a state, from a seed, for a number of oscillations.
type Measure = Box<dyn Fn(&State, u64, u32) -> Outcome<Speed>>;

/// A program that is measured.
struct Program {
    name: &'static str,
    measure: Measure,
}

fn main() -> ExitCode {
    benches::report(itself::asked_for().unwrap_or_else(run))
}

fn run() -> Outcome<()> {
    let plan = Plan::asked_for()?;
    let programs = programs()?;
    println!("Load of the machine: {}.", benches::load());
    print_head(&plan);
    for state in &plan.states {
        let rounds = (0..plan.rounds).map(|round| measure(&plan, state, &programs, round));
        print_rows(state, &programs, &rounds.collect::<Outcome<Vec<_>>>()?);
    }
    Ok(())
}

/// Builds the programs: this crate for the processor at hand and without flags, and the plain simulation.
fn programs() -> Outcome<Vec<Program>> {
    if ask::is_test() {
        return Ok(vec![Program { name: "as built", measure: Box::new(ours) }]);
    }
    let mut programs = Vec::new();
    for (name, program, flags, folder) in [
        ("native", "ratio", "-C target-cpu=native", "ratio-native"),
        ("no flags", "ratio", "", "ratio-default"),
        ("plain", "plain", "-C target-cpu=native", "ratio-native"),
    ] {
        let built = Built::new(program, flags, folder)?;
        let measure = move |state: &State, seed, oscillations| built.measure(state, seed, oscillations);
        programs.push(Program { name, measure: Box::new(measure) });
    }
    Ok(programs)
}

impl Plan {
    fn asked_for() -> Outcome<Self> {
        let grid = ask::flag("GRID");
        let (rounds, oscillations) = match (ask::is_test(), grid) {
            (true, _) => (1, 20),
            (false, true) => (3, 400),
            (false, false) => (9, 2000),
        };
        let states = if grid { plane() } else { vec![DILUTE, DENSE] };
        let (rounds, oscillations) =
            (ask::number("ROUNDS", rounds)?, ask::number("OSCILLATIONS", oscillations)?);
        Ok(Self { rounds, oscillations, states })
    }

    /// Returns the number of oscillations that has the same number of flights at any gravity.
    fn oscillations_at(&self, gravity: f64) -> u32 {
        (f64::from(self.oscillations) * DILUTE.gravity / gravity).round() as u32
    }
}

/// Returns states over the plane of Fig. 5, from the most dilute gas to the collapse.
fn plane() -> Vec<State> {
    let mut states = Vec::new();
    for gravity in [0.015_625, 0.002_025] {
        for inelasticity in [0.0, 0.05, 0.1, 0.15] {
            let frictions = [0.01, 0.03, 0.06, 0.1, 0.3, 1.0];
            states.extend(frictions.map(|friction| State { gravity, friction, inelasticity }));
        }
    }
    states
}

/// Measures all programs, one after another. The first program changes from round to round.
fn measure(plan: &Plan, state: &State, programs: &[Program], round: u32) -> Outcome<Vec<Speed>> {
    let (seed, oscillations) = (u64::from(round) + 1, plan.oscillations_at(state.gravity));
    let first = round as usize % programs.len();
    let order = (first..programs.len()).chain(0..first);
    let mut speeds =
        order.map(|k| (programs[k].measure)(state, seed, oscillations)).collect::<Outcome<Vec<_>>>()?;
    speeds.rotate_right(first);
    Ok(speeds)
}

/// Runs this crate for `oscillations` oscillations to settle from the lattice, and for as many to measure.
fn ours(state: &State, seed: u64, oscillations: u32) -> Outcome<Speed> {
    let mut run = state.settled(seed, oscillations)?;
    let (start, before) = (Instant::now(), run.counters().disk_collisions);
    oscillate(&mut run, oscillations)?;
    let (seconds, after) = (start.elapsed().as_secs_f64(), run.counters().disk_collisions);
    let collisions = (after - before) as f64;
    Ok(Speed { per_second: collisions / seconds, per_oscillation: collisions / f64::from(oscillations) })
}

fn print_head(plan: &Plan) {
    let Plan { rounds, oscillations, .. } = plan;
    println!(
        "Medians (and quartiles) of {rounds} rounds of {oscillations} oscillations, after as many to settle."
    );
    println!();
    println!("| state | program | of native | of the plain one | collisions per second | per oscillation |");
    println!("|---|---|---|---|---|---|");
}

/// Prints a row for each program.
fn print_rows(state: &State, programs: &[Program], rounds: &[Vec<Speed>]) {
    let plain = programs.iter().position(|program| program.name == "plain");
    for (k, Program { name, .. }) in programs.iter().enumerate() {
        let median =
            |number: fn(&Speed) -> f64| Quartiles::of(rounds.iter().map(|round| number(&round[k]))).median;
        let (rate, level) = (median(|speed| speed.per_second) / 1e6, median(|speed| speed.per_oscillation));
        let of = |other: usize| {
            let ratios = rounds.iter().map(|round| round[k].per_second / round[other].per_second);
            if other == k { "1".to_owned() } else { Quartiles::of(ratios).to_string() }
        };
        let of_plain = plain.map_or_else(|| "–".to_owned(), of);
        println!("| {state} | {name} | {} | {of_plain} | {rate:.2} million | {level:.0} |", of(0));
    }
}
