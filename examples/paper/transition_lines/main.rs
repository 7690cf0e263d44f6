//! Which number governs the transitions of the paper's Fig. 5? Its Table I, from ramps at the paper's length.
//!
//! The example reads the tables of ramps that `docs/reproduction/*/run` has made, and averages along each
//! transition line: the paper's ⟨dE⟩ of a gas of equal temperatures, the same with the ratio of temperatures
//! that the run has, and the energy change of the collisions in the run. The smaller the scatter along a
//! line, the better the number governs the transition.
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
mod ramps;

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use granular_edmd::kinetic::effective_inelasticity;

use common::command_line::{Failure, main as run_example, make_folder};
use numbers::{Number, TABLE, average, formatted};
use ramps::{Crossing, Ramp};

/// Averages along the transition lines of Fig. 5 (paper, Table I), from ramps at the paper's length.
#[derive(Parser)]
struct Arguments {
    /// The question.
    #[arg(value_enum, default_value = "lines")]
    question: Question,
    /// Folder of the ramps; that of the question in docs/reproduction unless given.
    #[arg(long)]
    ramps: Option<PathBuf>,
    /// Folder for the tables.
    #[arg(long, default_value = "out")]
    out: PathBuf,
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
    run_example(|arguments: &Arguments| {
        let folder = arguments.ramps.clone().unwrap_or_else(|| arguments.question.folder().into());
        let ramps = ramps::read(&folder).map_err(Failure::usage)?;
        if ramps.is_empty() {
            return Err(Failure::usage(format_args!("{} has no tables of ramps", folder.display())));
        }
        make_folder(&arguments.out)?;
        let out = &arguments.out;
        let done = match arguments.question {
            Question::Lines => lines(&ramps, out),
            Question::Walls => walls(&ramps),
            Question::Dependences => dependences::print(&ramps),
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
fn lines(ramps: &[Ramp], out: &Path) -> Result<(), Box<dyn Error>> {
    let mut crossings = crossings(ramps)?;
    for (done, (ramp, at)) in crossings.iter_mut().enumerate() {
        at.local = Some(local::measure(ramp.gravity, at)?);
        if (done + 1) % 10 == 0 {
            eprintln!("{} crossings measured", done + 1);
        }
    }
    write_crossings(&crossings, out)?;
    for (gravity, line, mean, deviation) in TABLE {
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
    println!("\nwrote {}", out.join("transition_lines.csv").display());
    Ok(())
}

fn crossings(ramps: &[Ramp]) -> Result<Vec<(&Ramp, Crossing)>, Box<dyn Error>> {
    let mut all = Vec::new();
    for ramp in ramps {
        all.extend(ramp.crossings()?.into_iter().map(|at| (ramp, at)));
    }
    Ok(all)
}

fn write_crossings(crossings: &[(&Ramp, Crossing)], out: &Path) -> Result<(), Box<dyn Error>> {
    let mut table = csv::Writer::from_path(out.join("transition_lines.csv"))?;
    table.write_record([
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
    ])?;
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
    Ok(table.flush()?)
}

/// Prints Table I under each assumption about the walls, and its distance from the paper's.
fn walls(ramps: &[Ramp]) -> Result<(), Box<dyn Error>> {
    let mut accounts: BTreeMap<String, Vec<(&Ramp, Crossing)>> = BTreeMap::new();
    for (ramp, at) in crossings(ramps)? {
        let name = ramp.study.split("-gravity-").next().unwrap_or_default();
        accounts.entry(name.to_owned()).or_default().push((ramp, at));
    }
    for (name, crossings) in &accounts {
        for number in [Number::EqualTemperatures, Number::AsPrinted] {
            println!("\n{name}, {}", number.name());
            print_account(crossings, number)?;
        }
    }
    Ok(())
}

fn print_account(crossings: &[(&Ramp, Crossing)], number: Number) -> Result<(), Box<dyn Error>> {
    let mut squares = 0.0;
    for (gravity, line, mean, deviation) in TABLE {
        let is_of = |ramp: &Ramp, at: &Crossing| ramp.gravity == gravity && at.line == line;
        let of_line: Vec<&Crossing> =
            crossings.iter().filter(|(ramp, at)| is_of(ramp, at)).map(|(_, at)| at).collect();
        let found = average(number, &of_line)?;
        squares += ((found.mean() - mean) / deviation).powi(2) / TABLE.len() as f64;
        let effective = effective_inelasticity(found.mean(), 1.0)?;
        println!(
            "  {gravity:<9} {:12} paper {mean:.3} ± {deviation:.3}  here {}  q_eff {effective:.4}",
            line.to_string(),
            formatted(&found)
        );
    }
    println!("  rms deviation {:.2} of the paper's standard deviations", squares.sqrt());
    Ok(())
}
