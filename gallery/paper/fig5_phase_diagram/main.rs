//! The paper's Fig. 5: convective states in the plane of friction and inelasticity.
//!
//! The system has 1000 disks in the vibrated box. For each inelasticity, friction goes up step by step, and
//! each value starts from the last state of the previous one. For some inelasticities, friction also comes
//! down again from the other end. Each point gets the name of its state. The transitions lie between
//! neighbors of different states.
//!
//! ```text
//! cargo run --release -p gallery --all-features --bin fig5_phase_diagram -- --quick
//! cargo run --release -p gallery --all-features --bin fig5_phase_diagram -- --size full
//! ```
//!
//! The example writes `fig5_phase_diagram.svg` and `.png`, `points.csv` and `transitions.csv`, which the
//! example `table1` reads, beside the studies `up` and `down`. Ctrl-C stops the example, which saves all that
//! was done and draws it. The same command then continues.

mod picture;
mod plan;
mod plane;
mod states;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd_study::Study;
use granular_edmd_study::vibrated_box::VibratedBox;

use gallery::results::Results;
use picture::{Crossing, Diagram, State};
use plan::{Gravity, Part, Size};

/// Convective states in the plane of friction and inelasticity (paper, Fig. 5).
#[derive(Parser)]
struct Arguments {
    /// Gravity, one of the paper's two.
    #[arg(long, value_enum, default_value = "0.015625")]
    gravity: Gravity,
    /// The size of the diagram.
    #[arg(long, value_enum, default_value = "coarse")]
    size: Size,
    /// The same as `--size quick`.
    #[arg(long, conflicts_with = "size")]
    quick: bool,
    /// Draws the finished points and computes nothing, even while another process computes the rest.
    #[arg(long)]
    draw: bool,
    /// Draws the points of a table, such as those in docs/reproduction, and computes nothing.
    #[arg(long, value_name = "FILE", conflicts_with = "draw")]
    points: Option<PathBuf>,
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    results: Results,
}

impl Arguments {
    fn size(&self) -> Size {
        if self.quick { Size::Quick } else { self.size }
    }

    /// Returns the folder of this gravity and size.
    fn folder(&self) -> PathBuf {
        self.results.path(&format!("fig5_phase_diagram-{}-{}", self.gravity.value(), self.size().name()))
    }
}

fn main() -> ExitCode {
    gallery::command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    arguments.results.make_folder()?;
    let folder = arguments.folder();
    let parts = plan::parts(arguments.size(), arguments.gravity, arguments.seed)?;
    if let Some(table) = &arguments.points {
        let drawn = states::read(table)?;
        let (crossings, caption) =
            (states::crossings(&states::lines(&drawn)?), caption(arguments, &parts, drawn.len()));
        return draw(arguments, &caption, &drawn, &crossings);
    }
    if !arguments.draw {
        for part in &parts {
            if gallery::studies::complete(&folder.join(part.folder), &part.plan, None)?.is_none() {
                break;
            }
        }
    }
    let started = parts.iter().filter(|part| folder.join(part.folder).is_dir());
    let studies: Vec<Study<VibratedBox>> =
        started.map(|part| Study::open(folder.join(part.folder))).collect::<Result<_, _>>()?;
    if studies.is_empty() {
        return Err(format!("--draw: there is no study in {}", folder.display()).into());
    }
    let points = states::points(&studies)?;
    let drawn = states::drawn(&points);
    let lines = states::lines(&drawn)?;
    let gravity = arguments.gravity.value();
    states::write_points(&points, gravity, &folder)?;
    states::write_lines(&lines, gravity, &folder)?;
    let caption = caption(arguments, &parts, points.len());
    draw(arguments, &caption, &drawn, &states::crossings(&lines))?;
    gallery::say!("wrote points.csv and transitions.csv to {}", folder.display());
    let tables = ["points", "transitions"].map(|name| (name, folder.join(name).with_extension("csv")));
    arguments.results.write_tables_as_json(&tables)
}

fn draw(
    arguments: &Arguments,
    caption: &str,
    states: &[State],
    crossings: &[Crossing],
) -> Result<(), Box<dyn Error>> {
    let gravity = arguments.gravity.value();
    let title = format!("Convective states at g = {gravity}");
    let folder = arguments.folder();
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    picture::draw(&Diagram { gravity, title: &title, notes: caption, states, crossings })?
        .write(&folder.join("fig5_phase_diagram"))?;
    gallery::say!("{caption}");
    gallery::say!("wrote fig5_phase_diagram.svg and fig5_phase_diagram.png to {}", folder.display());
    Ok(())
}

fn caption(arguments: &Arguments, parts: &[Part], finished: usize) -> String {
    let total: usize = parts.iter().map(|part| part.plan.ramp_count() * part.plan.value_count()).sum();
    let cycles = parts[0].plan.protocol().cycles();
    let unfinished =
        if finished < total { format!(", {finished} of {total} points so far") } else { String::new() };
    format!(
        "N = 1000, box 60 × 150, bi-parabolic base A = 0.1, ω = 10,\n\
         contact duration 1e-4, seed {}{unfinished};\n\
         {cycles} oscillations for each point, the first half discarded",
        arguments.seed
    )
}
