//! The number that governs the transitions of the paper's Fig. 5: its Table I, from ramps at the paper's
//! length.
//!
//! The example reads the tables of ramps that `docs/reproduction/*/run` has made, and averages along each
//! transition line: the paper's ⟨dE⟩ of a gas with equal temperatures, the same with the ratio of
//! temperatures in the run, and the energy change of the collisions in the run. The smaller the scatter along
//! a line, the better the number governs the transition. It writes `transition_lines` as a table and a
//! picture, and the phase diagrams `fig5_full_length-…`; for each of the other questions, it writes a table
//! with its name, such as `transition_lines-walls.csv`.
//!
//! ```text
//! cargo run --release -p gallery --all-features --bin transition_lines -- lines
//! cargo run --release -p gallery --all-features --bin transition_lines -- walls
//! cargo run --release -p gallery --all-features --bin transition_lines -- criteria
//! cargo run --release -p gallery --all-features --bin transition_lines -- dependences
//! ```

mod criteria;
mod dependences;
mod local;
mod numbers;
#[path = "../fig5_phase_diagram/picture.rs"]
mod phase_diagram;
mod picture;
mod ramps;
mod walls;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};

use clap::{Parser, ValueEnum};
use granular_edmd_study::analysis::TransitionLine;
use rayon::prelude::*;

use gallery::command_line::{self, Failure};
use gallery::paper::{Row, TABLE_1};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::runs;
use numbers::{Number, average};
use ramps::{Crossing, Ramp};

/// Averages along the transition lines of Fig. 5 (paper, Table I), from ramps at the paper's length.
#[derive(Parser)]
struct Arguments {
    /// The question.
    #[arg(value_enum, default_value = "lines")]
    question: Question,
    /// A study, or a folder of studies; can be repeated. By default, the kept runs for the question.
    #[arg(long, value_name = "FOLDER")]
    ramps: Vec<PathBuf>,
    /// Oscillations to settle at a crossing, and equally many to measure the losses there.
    #[arg(long, default_value_t = 3000)]
    oscillations: u32,
    /// Measures only every tenth crossing, for the question `lines`; the other questions measure none.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Question {
    /// Which number governs the transitions?
    Lines,
    /// Table I if the walls lose nothing along the normal, or if only the base loses nothing.
    Walls,
    /// The lines under other criteria for the names of states.
    Criteria,
    /// What else moves the transitions?
    Dependences,
}

impl Question {
    /// Returns the folders of the ramps that answer the question.
    fn folders(self) -> Vec<PathBuf> {
        let names: &[&str] = match self {
            Self::Lines | Self::Criteria => &["full-length"],
            Self::Walls => &["walls", "full-length", "full-length-elastic-walls"],
            Self::Dependences => &["dependences"],
        };
        names.iter().map(|name| runs::folder(name)).collect()
    }
}

fn main() -> ExitCode {
    command_line::main(|arguments: &Arguments| {
        let given = !arguments.ramps.is_empty();
        let folders = if given { arguments.ramps.clone() } else { arguments.question.folders() };
        let mut ramps = Vec::new();
        for folder in folders {
            ramps.extend(ramps::read(&folder).map_err(Failure::usage)?);
        }
        arguments.results.make_folder()?;
        let done = match arguments.question {
            Question::Lines => lines(&ramps, arguments),
            Question::Walls => walls::print(&ramps, &arguments.results),
            Question::Criteria => criteria::print(&ramps, &arguments.results),
            Question::Dependences => dependences::print(&ramps, &arguments.results),
        };
        done.map_err(Failure::run)
    })
}

/// The numbers that may govern the transitions.
const GOVERNING: [Number; 4] =
    [Number::EqualTemperatures, Number::MeasuredRatio, Number::LocalRatio, Number::InTheRun];

/// A choice of the crossings that are averaged.
struct Choice {
    name: &'static str,
    takes: fn(&Ramp, &Crossing) -> bool,
}

/// The paper does not say which points of its lines it averaged.
const CHOICES: [Choice; 6] = [
    Choice { name: "ramps in inelasticity", takes: |ramp, _| !ramp.along_friction },
    Choice { name: "ramps in friction", takes: |ramp, _| ramp.along_friction },
    Choice { name: "friction below 0.3", takes: |_, at| at.friction < 0.3 },
    Choice { name: "friction of 0.3 and more", takes: |_, at| at.friction >= 0.3 },
    Choice { name: "friction from 0.02 to 0.5", takes: |_, at| (0.02..=0.5).contains(&at.friction) },
    Choice { name: "all crossings", takes: |_, _| true },
];

/// Prints each line under each rule, and writes all crossings.
fn lines(ramps: &[Ramp], arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let step = if arguments.quick { 10 } else { 1 };
    let mut crossings: Vec<_> = crossings(ramps)?.into_iter().step_by(step).collect();
    let (progress, all) = (Progress::of("crossings"), crossings.len() as u64);
    let done = AtomicU64::new(0);
    // The runs are independent, so any order of them gives the same numbers.
    crossings.par_iter_mut().try_for_each(|(ramp, at)| {
        let local = local::measure(ramp, at, arguments.oscillations).map_err(|error| error.to_string())?;
        at.local = Some(local);
        progress.show(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        Ok::<_, String>(())
    })?;
    drop(progress);
    for Row { gravity, line, change: (mean, deviation), .. } in TABLE_1 {
        gallery::say!("\ng = {gravity}, {line}: paper {mean:.3} ± {deviation:.3}");
        for choice in &CHOICES {
            let is_of =
                |ramp: &Ramp, at: &Crossing| is_of(ramp, at, gravity, line) && (choice.takes)(ramp, at);
            let of_line: Vec<_> = crossings.iter().filter(|(ramp, at)| is_of(ramp, at)).collect();
            if of_line.is_empty() {
                continue;
            }
            gallery::say!("  {}", choice.name);
            for number in GOVERNING {
                gallery::say!("    {:34}{}", number.name(), average(number, &of_line)?);
            }
        }
    }
    for (gravity, name) in
        [(0.015_625, "fig5_full_length-0.015625"), (0.002_025, "fig5_full_length-0.002025")]
    {
        picture::draw_diagram(gravity, ramps, &crossings)?.write(&arguments.results.path(name))?;
    }
    write_crossings(&crossings, &arguments.results)
}

fn is_of(ramp: &Ramp, at: &Crossing, gravity: f64, line: TransitionLine) -> bool {
    ramp.gravity() == gravity && at.line == line
}

fn crossings(ramps: &[Ramp]) -> Result<Vec<(&Ramp, Crossing)>, Box<dyn Error>> {
    let mut all = Vec::new();
    for ramp in ramps {
        all.extend(ramp.crossings()?.into_iter().map(|at| (ramp, at)));
    }
    Ok(all)
}

fn write_crossings(crossings: &[(&Ramp, Crossing)], results: &Results) -> Result<(), Box<dyn Error>> {
    let columns = [
        "study",
        "gravity",
        "oscillations",
        "line",
        "rising",
        "along",
        "friction",
        "inelasticity",
        "half_width",
        "temperature_ratio",
        "equal_temperatures",
        "measured_ratio",
        "local_ratio",
        "in_the_run",
    ];
    let mut table = results.table("transition_lines", &columns)?;
    for (ramp, at) in crossings {
        let along = if ramp.along_friction { "friction" } else { "inelasticity" };
        // The half width of a friction is the half width of its logarithm, times the friction.
        let half_width = at.half_width * if ramp.along_friction { at.friction } else { 1.0 };
        let numbers: Vec<f64> = GOVERNING.iter().map(|number| number.at(at)).collect::<Result<_, _>>()?;
        let rounded =
            [at.friction, at.inelasticity, half_width, at.temperature_ratio].into_iter().chain(numbers);
        let rounded: Vec<String> = rounded.map(|value| format!("{value:.5}")).collect();
        let line = at.line.to_string();
        table.serialize((&ramp.study, ramp.gravity(), ramp.oscillations, line, at.rising, along, rounded))?;
    }
    results.finish_table("transition_lines", table, Some(&picture::draw(crossings)?))
}
