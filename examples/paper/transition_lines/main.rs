//! Which number governs the transitions of the paper's Fig. 5? Its Table I, from ramps at the paper's length.
//!
//! The example reads the tables of ramps that `docs/reproduction/*/run` has made, and averages along each
//! transition line: the paper's ⟨dE⟩ of a gas of equal temperatures, the same with the ratio of temperatures
//! that the run has, and the energy change of the collisions in the run. The smaller the scatter along a
//! line, the better the number governs the transition. It writes `transition_lines` as a table and a picture,
//! and the phase diagrams `fig5_full_length-…`; for the other two questions `transition_lines-walls.csv` and
//! `transition_lines-dependences.csv`.
//!
//! ```text
//! cargo run --release --features serde --example transition_lines -- lines
//! cargo run --release --features serde --example transition_lines -- walls
//! cargo run --release --features serde --example transition_lines -- dependences
//! ```

#[path = "../../common/mod.rs"]
mod common;
mod dependences;
mod local;
mod numbers;
#[path = "../fig5_phase_diagram/picture.rs"]
mod phase_diagram;
mod picture;
mod ramps;
#[path = "../../studies/mod.rs"]
mod studies;

use std::collections::BTreeMap;
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use granular_edmd::ParameterError;
use granular_edmd::kinetic::effective_inelasticity;
use granular_edmd::statistics::RunningMean;

use common::command_line::{self, Failure};
use common::paper::{Row, TABLE_1};
use common::progress::Progress;
use common::results::Results;
use numbers::{Number, average, formatted};
use ramps::{Crossing, Ramp};

/// Averages along the transition lines of Fig. 5 (paper, Table I), from ramps at the paper's length.
#[derive(Parser)]
struct Arguments {
    /// The question.
    #[arg(value_enum, default_value = "lines")]
    question: Question,
    /// Folder of the ramps; that of the question in docs/reproduction unless given.
    #[arg(long, value_name = "FOLDER")]
    ramps: Option<PathBuf>,
    /// Measures every tenth crossing only; the other two questions measure none.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Question {
    /// Which number governs the transitions?
    Lines,
    /// What if the walls lose nothing along the normal, or only the base does?
    Walls,
    /// What else moves the transitions?
    Dependences,
}

impl Question {
    const fn folder(self) -> &'static str {
        match self {
            Self::Lines => "docs/reproduction/full-length",
            Self::Walls => "docs/reproduction/walls",
            Self::Dependences => "docs/reproduction/dependences",
        }
    }
}

fn main() -> ExitCode {
    command_line::main(|arguments: &Arguments| {
        let folder = arguments.ramps.clone().unwrap_or_else(|| arguments.question.folder().into());
        let ramps = ramps::read(&folder).map_err(Failure::usage)?;
        if ramps.is_empty() {
            return Err(Failure::usage(format_args!("{} has no tables of ramps", folder.display())));
        }
        arguments.results.make_folder()?;
        let done = match arguments.question {
            Question::Lines => lines(&ramps, arguments),
            Question::Walls => walls(&ramps, &arguments.results),
            Question::Dependences => dependences::print(&ramps, &arguments.results),
        };
        done.map_err(Failure::run)
    })
}

/// The numbers that may govern the transitions.
const GOVERNING: [Number; 4] =
    [Number::EqualTemperatures, Number::MeasuredRatio, Number::LocalRatio, Number::InTheRun];

/// Ramps along one parameter, or frictions on one side of the largest loss.
struct Choice {
    name: &'static str,
    takes: fn(&Ramp, &Crossing) -> bool,
}

/// The rules by which crossings are averaged; each crossing counts alike.
const CHOICES: [Choice; 4] = [
    Choice { name: "ramps in q, all frictions", takes: |ramp, _| !ramp.along_friction },
    Choice {
        name: "ramps in q, friction below 0.3",
        takes: |ramp, at| !ramp.along_friction && at.friction < 0.3,
    },
    Choice {
        name: "ramps in friction, below 0.3",
        takes: |ramp, at| ramp.along_friction && at.friction < 0.3,
    },
    Choice { name: "all crossings", takes: |_, _| true },
];

/// Prints each line under each rule, and writes all crossings.
fn lines(ramps: &[Ramp], arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let step = if arguments.quick { 10 } else { 1 };
    let mut crossings: Vec<_> = crossings(ramps)?.into_iter().step_by(step).collect();
    let (progress, all) = (Progress::of("crossings"), crossings.len() as u64);
    for (done, (ramp, at)) in (1..).zip(&mut crossings) {
        at.local = Some(local::measure(ramp.gravity, at)?);
        progress.show(done, all);
    }
    drop(progress);
    for Row { gravity, line, change: (mean, deviation), .. } in TABLE_1 {
        println!("\ng = {gravity}, {line}: paper {mean:.3} ± {deviation:.3}");
        for choice in &CHOICES {
            let of_line: Vec<&Crossing> = crossings
                .iter()
                .filter(|(ramp, at)| ramp.gravity == gravity && at.line == line && (choice.takes)(ramp, at))
                .map(|(_, at)| at)
                .collect();
            if of_line.is_empty() {
                continue;
            }
            println!("  {}", choice.name);
            for number in GOVERNING {
                println!("    {:34}{}", number.name(), formatted(&average(number, &of_line)?));
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
        // The half width of a friction is that of its logarithm times the friction.
        let half_width = at.half_width * if ramp.along_friction { at.friction } else { 1.0 };
        let numbers: Vec<f64> = GOVERNING.iter().map(|number| number.at(at)).collect::<Result<_, _>>()?;
        let rounded =
            [at.friction, at.inelasticity, half_width, at.temperature_ratio].into_iter().chain(numbers);
        let rounded: Vec<String> = rounded.map(|value| format!("{value:.5}")).collect();
        let line = at.line.to_string();
        table.serialize((&ramp.study, ramp.gravity, ramp.oscillations, line, at.rising, along, rounded))?;
    }
    results.finish_table("transition_lines", table, Some(&picture::draw(crossings)?))
}

/// Prints Table I under each assumption about the walls, and its distance from the paper's.
fn walls(ramps: &[Ramp], results: &Results) -> Result<(), Box<dyn Error>> {
    const NAME: &str = "transition_lines-walls";
    let columns =
        ["study", "number", "gravity", "line", "points", "mean_energy_change", "standard_deviation"];
    let mut table = results.table(NAME, &columns)?;
    let mut accounts: BTreeMap<String, Vec<(&Ramp, Crossing)>> = BTreeMap::new();
    for (ramp, at) in crossings(ramps)? {
        let name = ramp.study.split("-gravity-").next().unwrap_or_default();
        accounts.entry(name.to_owned()).or_default().push((ramp, at));
    }
    for (name, crossings) in &accounts {
        for number in [Number::EqualTemperatures, Number::AsPrinted] {
            println!("\n{name}, {}", number.name());
            for (gravity, line, found) in print_account(crossings, number)? {
                let (points, mean, deviation) = (found.count(), found.mean(), found.standard_deviation());
                table.serialize((name, number.name(), gravity, line, points, mean, deviation))?;
            }
        }
    }
    results.finish_table(NAME, table, None)
}

/// A row of Table I as it was found: gravity, line, and the average along it.
type Found = (f64, String, RunningMean);

fn print_account(crossings: &[(&Ramp, Crossing)], number: Number) -> Result<Vec<Found>, ParameterError> {
    let (mut squares, mut rows) = (0.0, Vec::new());
    for Row { gravity, line, change: (mean, deviation), .. } in TABLE_1 {
        let is_of = |ramp: &Ramp, at: &Crossing| ramp.gravity == gravity && at.line == line;
        let of_line: Vec<&Crossing> =
            crossings.iter().filter(|(ramp, at)| is_of(ramp, at)).map(|(_, at)| at).collect();
        if of_line.is_empty() {
            continue;
        }
        let found = average(number, &of_line)?;
        squares += ((found.mean() - mean) / deviation).powi(2);
        let effective = effective_inelasticity(found.mean(), 1.0)?;
        println!(
            "  {gravity:<9} {:12} paper {mean:.3} ± {deviation:.3}  here {}  q_eff {effective:.4}",
            line.to_string(),
            formatted(&found)
        );
        rows.push((gravity, line.to_string(), found));
    }
    println!(
        "  rms deviation {:.2} of the paper's standard deviations",
        (squares / rows.len() as f64).sqrt()
    );
    Ok(rows)
}
