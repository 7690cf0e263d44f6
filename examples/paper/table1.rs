//! The paper's Table I: effective inelasticities from the mean energy changes at the transitions, beside the
//! printed ones.
//!
//! ```text
//! cargo run --release --example table1 -- --out out
//! cargo run --release --example table1 -- --study out/fig5_phase_diagram-0.015625-coarse
//! ```
//!
//! With `--study`, the lines that the example `fig5_phase_diagram` has found are averaged as in the paper,
//! and shown beside the printed ones. The energy change of each point comes from the closed form at its
//! friction and inelasticity. The table has the mean and the standard deviation over the points of a line.

#[path = "../common/mod.rs"]
mod common;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::ParameterError;
use granular_edmd::analysis::{LineAverage, line_average};
use granular_edmd::collision::Frictional;
use granular_edmd::kinetic::{Maxwellian, effective_inelasticity};
use granular_edmd::statistics::RunningMean;

use common::command_line;
use common::results::Results;

/// Effective inelasticity of every transition (paper, Table I, by Eq. (9)).
#[derive(Parser)]
struct Arguments {
    /// Folder of a phase diagram with its `transitions.csv`; may be given once for each gravity.
    #[arg(long)]
    study: Vec<PathBuf>,
    /// Does the same: the whole table takes no time.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

/// A row as printed: gravity, transition, mean energy change and effective inelasticity, with their errors.
struct Row {
    gravity: f64,
    transition: &'static str,
    change: (f64, f64),
    printed: (f64, f64),
}

const fn row(gravity: f64, transition: &'static str, change: (f64, f64), printed: (f64, f64)) -> Row {
    Row { gravity, transition, change, printed }
}

const TABLE: [Row; 8] = [
    row(0.002_025, "0-1", (-0.090, 0.017), (0.023, 0.004)),
    row(0.002_025, "1-2(a)", (-0.351, 0.042), (0.097, 0.013)),
    row(0.002_025, "1-2(b)", (-0.377, 0.046), (0.105, 0.014)),
    row(0.002_025, "2-collapse", (-0.614, 0.036), (0.190, 0.014)),
    row(0.015_625, "0-1", (-0.047, 0.009), (0.012, 0.002)),
    row(0.015_625, "1-2(a)", (-0.137, 0.022), (0.035, 0.006)),
    row(0.015_625, "1-2(b)", (-0.147, 0.025), (0.038, 0.007)),
    row(0.015_625, "2-collapse", (-0.290, 0.037), (0.079, 0.011)),
];

/// Half of the last printed digit, and a little more for numbers that lie exactly there.
const HALF_DIGIT: f64 = 0.5e-3 + 1e-12;

impl Row {
    fn effective(&self) -> Result<f64, ParameterError> {
        effective_inelasticity(self.change.0, 1.0)
    }

    /// Returns the error that follows from that of the mean energy change, by the slope of Eq. (9),
    /// `$1/(4(1-2q))$`.
    fn error(&self) -> Result<f64, ParameterError> {
        Ok(self.change.1 / (4.0 * (1.0 - 2.0 * self.effective()?)))
    }

    /// Tells whether the one column follows from the other. Both are printed to three decimals.
    fn verdict(&self) -> Result<&'static str, ParameterError> {
        let least = effective_inelasticity(self.change.0 + HALF_DIGIT, 1.0)?;
        let most = effective_inelasticity(self.change.0 - HALF_DIGIT, 1.0)?;
        let direct = (self.effective()? - self.printed.0).abs() <= HALF_DIGIT;
        let rounding = least <= self.printed.0 + HALF_DIGIT && self.printed.0 - HALF_DIGIT <= most;
        Ok(match (direct, rounding) {
            (true, _) => "same digits",
            (false, true) => "same within the rounding of <dE>",
            (false, false) => "differs",
        })
    }
}

/// A point of a line that was found: its gravity, its transition, and the rule there.
struct Point {
    gravity: f64,
    transition: String,
    rule: Frictional,
}

/// The columns of `transitions.csv` that are needed: gravity, line, friction and inelasticity.
type Columns = (f64, String, f64, f64);

fn read(folder: &Path) -> Result<Vec<Point>, Box<dyn Error>> {
    let path = folder.join("transitions.csv");
    let mut table = csv::Reader::from_path(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut points = Vec::new();
    for line in table.records() {
        let mut line = line?;
        line.truncate(4);
        let (gravity, transition, friction, inelasticity): Columns = line.deserialize(None)?;
        let rule =
            Frictional::from_inelasticity(inelasticity, inelasticity)?.with_friction(friction, friction)?;
        points.push(Point { gravity, transition, rule });
    }
    Ok(points)
}

/// Returns the average over the points of a line, or `None` if there are none.
fn measured(row: &Row, points: &[Point]) -> Result<Option<LineAverage>, ParameterError> {
    let of = points.iter().filter(|point| point.gravity == row.gravity && point.transition == row.transition);
    let line: Vec<Frictional> = of.map(|point| point.rule).collect();
    if line.is_empty() { Ok(None) } else { line_average(&line, &Maxwellian::new(1.0)?).map(Some) }
}

const COLUMNS: [&str; 14] = [
    "gravity",
    "transition",
    "mean_energy_change",
    "its_error",
    "effective_inelasticity",
    "error",
    "printed",
    "printed_error",
    "verdict",
    "measured_points",
    "measured_energy_change",
    "its_standard_deviation",
    "measured_effective_inelasticity",
    "standard_deviation",
];

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    arguments.results.make_folder()?;
    let mut points = Vec::new();
    for folder in &arguments.study {
        points.extend(read(folder)?);
    }
    let mut table = arguments.results.table("table1", &COLUMNS)?;
    println!(
        "g         transition   <dE>              q_eff             printed         verdict   (T_0 = 1)"
    );
    println!("±: the scatter along a line of transitions, not the error of its mean");
    for row in &TABLE {
        print(row)?;
        let measured = measured(row, &points)?;
        measured.iter().for_each(print_measured);
        let (effective, error, verdict) = (row.effective()?, row.error()?, row.verdict()?);
        let place = (row.gravity, row.transition);
        table.serialize((
            place,
            row.change,
            effective,
            error,
            row.printed,
            verdict,
            cells(measured.as_ref()),
        ))?;
    }
    arguments.results.finish_table("table1", table, None)
}

fn print(row: &Row) -> Result<(), ParameterError> {
    let (effective, error, verdict) = (row.effective()?, row.error()?, row.verdict()?);
    let (Row { gravity, transition, .. }, (change, spread), (printed, printed_error)) =
        (row, row.change, row.printed);
    println!(
        "{gravity:<8}  {transition:<10}  {change:.3} ± {spread:.3}   {effective:.4} ± {error:.4}   {printed:.3} ± {printed_error:.3}   {verdict}"
    );
    Ok(())
}

fn print_measured(average: &LineAverage) {
    let text = |mean: &RunningMean, digits| {
        format!("{:.digits$} ± {:.digits$}", mean.mean(), mean.standard_deviation())
    };
    let (change, effective) = (average.energy_change(), average.effective_inelasticity());
    let points = format!("{} points", change.count());
    println!("{:>20}  {}   {}", points, text(change, 3), text(effective, 4));
}

/// Returns the last columns: the number of points, and mean and standard deviation of both quantities.
fn cells(average: Option<&LineAverage>) -> (Option<u64>, [Option<f64>; 4]) {
    let Some(average) = average else { return (None, [None; 4]) };
    let (change, effective) = (average.energy_change(), average.effective_inelasticity());
    let both = [change, effective].map(|mean| [mean.mean(), mean.standard_deviation()]);
    (Some(change.count()), [both[0][0], both[0][1], both[1][0], both[1][1]].map(Some))
}
