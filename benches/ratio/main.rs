//! The speed of this crate as a multiple of that of a plain event-driven simulation of the same system.
//!
//! ```sh
//! export RUSTFLAGS="-C target-cpu=native"
//! REFERENCE=path/to/its/folder cargo bench --bench ratio          # a dilute and a dense state
//! REFERENCE=path/to/its/folder GRID=1 cargo bench --bench ratio   # the κ–q plane of Fig. 5, both gravities
//! ```
//!
//! Machines are noisy and no two are alike. Therefore, the two programs run in turn, and the median of the
//! ratios of collisions of two disks per second counts. Each program starts from its own lattice, settles for
//! so many oscillations of the base, and is measured for as many oscillations by the wall clock. `ROUNDS` and
//! `OSCILLATIONS` change how often and how long it is measured. At a smaller gravity the measurement is
//! longer, as flights are.

#[path = "../common/mod.rs"]
mod common;
mod reference;

use std::process::ExitCode;
use std::time::Instant;

use common::Outcome;
use common::ask;
use common::quartiles::Quartiles;
use common::state::{DENSE, DILUTE, State, oscillate};
use reference::Reference;

/// The speed of one of the two programs in a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Speed {
    /// Number of collisions of two disks per second.
    per_second: f64,
    /// Number of collisions of two disks per oscillation. The numbers of both programs are alike if they are
    /// in the same state.
    per_oscillation: f64,
}

/// The plan of the measurement: how often, how long, and in which states.
struct Plan {
    rounds: u32,
    oscillations: u32,
    states: Vec<State>,
}

fn main() -> ExitCode {
    common::report(run())
}

fn run() -> Outcome<()> {
    let plan = Plan::asked_for()?;
    let reference = ask::path("REFERENCE").map(|folder| Reference::build(&folder)).transpose()?;
    common::print_circumstances();
    if reference.is_none() {
        println!("For ratios, set REFERENCE to the folder of the simulation to compare with.");
    }
    print_head(&plan);
    for state in &plan.states {
        let rounds = (0..plan.rounds).map(|round| measure(&plan, state, reference.as_ref(), round));
        print_row(state, &rounds.collect::<Outcome<Vec<_>>>()?);
    }
    Ok(())
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

    /// Returns the number of oscillations with as many flights at any gravity.
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

/// Measures both programs in turn. The first one to run changes from round to round.
fn measure(
    plan: &Plan,
    state: &State,
    reference: Option<&Reference>,
    round: u32,
) -> Outcome<(Speed, Option<Speed>)> {
    let (seed, oscillations) = (u64::from(round) + 1, plan.oscillations_at(state.gravity));
    let theirs = || reference.map(|it| it.measure(state, seed, oscillations)).transpose();
    if round.is_multiple_of(2) {
        let ours = ours(state, seed, oscillations)?;
        return Ok((ours, theirs()?));
    }
    let theirs = theirs()?;
    Ok((ours(state, seed, oscillations)?, theirs))
}

/// Runs this crate for so many oscillations to settle from the lattice, and for as many to measure.
fn ours(state: &State, seed: u64, oscillations: u32) -> Outcome<Speed> {
    let mut run = state.settled(seed, oscillations)?;
    let (start, before) = (Instant::now(), run.counters().collisions);
    oscillate(&mut run, oscillations)?;
    let (seconds, after) = (start.elapsed().as_secs_f64(), run.counters().collisions);
    let collisions = (after - before) as f64;
    Ok(Speed { per_second: collisions / seconds, per_oscillation: collisions / f64::from(oscillations) })
}

fn print_head(plan: &Plan) {
    let Plan { rounds, oscillations, .. } = plan;
    println!(
        "Medians (and quartiles) of {rounds} rounds of {oscillations} oscillations, after as many to settle."
    );
    println!();
    println!(
        "| state | ratio | collisions per second | the reference's | per oscillation | the reference's |"
    );
    println!("|---|---|---|---|---|---|");
}

fn print_row(state: &State, rounds: &[(Speed, Option<Speed>)]) {
    let both = || rounds.iter().filter_map(|&(ours, theirs)| Some((ours, theirs?)));
    let ratio = Quartiles::of(both().map(|(ours, theirs)| ours.per_second / theirs.per_second));
    let ratio = if ratio.median.is_nan() { "–".to_owned() } else { ratio.to_string() };
    let ours = columns(&rounds.iter().map(|round| round.0).collect::<Vec<_>>());
    let theirs = columns(&both().map(|round| round.1).collect::<Vec<_>>());
    println!("| {state} | {ratio} | {} | {} | {} | {} |", ours[0], theirs[0], ours[1], theirs[1]);
}

/// Returns the medians of both numbers, or dashes without measurements.
fn columns(speeds: &[Speed]) -> [String; 2] {
    let median = |number: fn(&Speed) -> f64| Quartiles::of(speeds.iter().map(number)).median;
    let rate = median(|speed| speed.per_second) / 1e6;
    let state = median(|speed| speed.per_oscillation);
    if rate.is_nan() {
        return ["–".to_owned(), "–".to_owned()];
    }
    [format!("{rate:.2} million"), format!("{state:.0}")]
}
