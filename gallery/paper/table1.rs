//! The paper's Table I: effective inelasticities from the mean energy changes at the transitions, beside the
//! printed ones.
//!
//! ```text
//! cargo run --release -p gallery --bin table1 -- --out out
//! cargo run --release -p gallery --bin table1 -- --study out/fig5_phase_diagram-0.015625-coarse
//! ```
//!
//! With `--study`, the lines that the example `fig5_phase_diagram` has found are averaged as in the paper,
//! and shown beside the printed ones. The energy change of each point comes from the closed form at its
//! friction and inelasticity. The table has the mean and the standard deviation over the points of a line.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::ParameterError;
use granular_edmd::collision::Frictional;
use granular_edmd::kinetic::{Maxwellian, effective_inelasticity, mean_energy_change};
use granular_edmd::statistics::RunningMean;

use gallery::command_line;
use gallery::paper::{Row, TABLE_1};
use gallery::results::Results;

/// Effective inelasticity of every transition (paper, Table I, by Eq. (9)).
#[derive(Parser)]
struct Arguments {
    /// Folder of a phase diagram with its `transitions.csv`; may be given once for each gravity.
    #[arg(long)]
    study: Vec<PathBuf>,
    /// Changes nothing, since the whole table takes no time.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

/// Half of the last printed digit, and a little more for numbers that lie exactly there.
const HALF_DIGIT: f64 = 0.5e-3 + 1e-12;

/// Returns the effective inelasticity that follows from the mean energy change.
fn effective(row: &Row) -> Result<f64, ParameterError> {
    effective_inelasticity(row.change.0, 1.0)
}

/// Returns the error that follows from the error of the mean energy change, by the slope of Eq. (9),
/// $`1/(4(1-2q))`$.
fn error(row: &Row) -> Result<f64, ParameterError> {
    Ok(row.change.1 / (4.0 * (1.0 - 2.0 * effective(row)?)))
}

/// Returns whether one column follows from the other. Both are printed to three decimals.
fn verdict(row: &Row) -> Result<&'static str, ParameterError> {
    let (change, printed) = (row.change.0, row.effective.0);
    let least = effective_inelasticity(change + HALF_DIGIT, 1.0)?;
    let most = effective_inelasticity(change - HALF_DIGIT, 1.0)?;
    let direct = (effective(row)? - printed).abs() <= HALF_DIGIT;
    let rounding = least <= printed + HALF_DIGIT && printed - HALF_DIGIT <= most;
    Ok(match (direct, rounding) {
        (true, _) => "same digits",
        (false, true) => "same within the rounding of <dE>",
        (false, false) => "differs",
    })
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
        let rule = Frictional::from_inelasticity(inelasticity, inelasticity, friction)?;
        points.push(Point { gravity, transition, rule });
    }
    Ok(points)
}

/// The energy change per collision and the effective inelasticity over the points of a line.
///
/// The table's "±" is the standard deviation of the points, not the error of their mean: the scatter along
/// the line tests the paper's hypothesis.
struct LineAverage {
    energy_change: RunningMean,
    effective_inelasticity: RunningMean,
}

impl LineAverage {
    /// Averages over the rules at which the transition was seen, each in a Maxwellian gas.
    fn of(line: &[Frictional]) -> Result<Self, ParameterError> {
        let gas = Maxwellian::new(1.0)?;
        let energy_change: RunningMean = line.iter().map(|rule| mean_energy_change(rule, &gas)).collect();
        let effective = |rule| effective_inelasticity(mean_energy_change(rule, &gas), 1.0);
        let effective_inelasticity = line.iter().map(effective).collect::<Result<_, _>>()?;
        Ok(Self { energy_change, effective_inelasticity })
    }
}

/// Returns the average over the points of a line, or `None` if there are none.
fn measured(row: &Row, points: &[Point]) -> Result<Option<LineAverage>, ParameterError> {
    let of = points
        .iter()
        .filter(|point| point.gravity == row.gravity && point.transition == row.line.to_string());
    let line: Vec<Frictional> = of.map(|point| point.rule).collect();
    if line.is_empty() { Ok(None) } else { LineAverage::of(&line).map(Some) }
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
    gallery::say!(
        "g         transition   <dE>              q_eff             printed         verdict   (T_0 = 1)"
    );
    gallery::say!("±: the scatter along a line of transitions, not the error of its mean");
    for row in &TABLE_1 {
        print(row)?;
        let measured = measured(row, &points)?;
        measured.iter().for_each(print_measured);
        let (effective, error, verdict) = (effective(row)?, error(row)?, verdict(row)?);
        let place = (row.gravity, row.line.to_string());
        table.serialize((
            place,
            row.change,
            effective,
            error,
            row.effective,
            verdict,
            cells(measured.as_ref()),
        ))?;
    }
    arguments.results.finish_table("table1", table, None)
}

fn print(row: &Row) -> Result<(), ParameterError> {
    let (effective, error, verdict) = (effective(row)?, error(row)?, verdict(row)?);
    let (gravity, transition) = (row.gravity, row.line.to_string());
    let ((change, spread), (printed, printed_error)) = (row.change, row.effective);
    gallery::say!(
        "{gravity:<8}  {transition:<10}  {change:.3} ± {spread:.3}   {effective:.4} ± {error:.4}   {printed:.3} ± {printed_error:.3}   {verdict}"
    );
    Ok(())
}

fn print_measured(average: &LineAverage) {
    let text = |mean: &RunningMean, digits| {
        format!("{:.digits$} ± {:.digits$}", mean.mean(), mean.standard_deviation())
    };
    let (change, effective) = (&average.energy_change, &average.effective_inelasticity);
    let points = format!("{} points", change.count());
    gallery::say!("{:>20}  {}   {}", points, text(change, 3), text(effective, 4));
}

/// Returns the last columns: the number of points, and mean and standard deviation of both quantities.
fn cells(average: Option<&LineAverage>) -> (Option<u64>, [Option<f64>; 4]) {
    let Some(average) = average else { return (None, [None; 4]) };
    let (change, effective) = (&average.energy_change, &average.effective_inelasticity);
    let both = [change, effective].map(|mean| [mean.mean(), mean.standard_deviation()]);
    (Some(change.count()), [both[0][0], both[0][1], both[1][0], both[1][1]].map(Some))
}
