//! The paper's Table I: effective inelasticities from the mean energy changes at the transitions, beside the printed.
//!
//! ```text
//! cargo run --release --example table1 -- --out out
//! ```

use std::error::Error;
use std::path::PathBuf;

use clap::Parser;
use granular_edmd::ParameterError;
use granular_edmd::kinetic::effective_inelasticity;

/// Effective inelasticity of every transition (paper, Table I, by Eq. (9)).
#[derive(Parser)]
struct Arguments {
    /// Folder for the table.
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

/// A row as printed: gravity, transition, mean energy change and effective inelasticity with their errors.
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

/// Half of the last printed digit, and a little for numbers that lie exactly there.
const HALF_DIGIT: f64 = 0.5e-3 + 1e-12;

impl Row {
    fn effective(&self) -> Result<f64, ParameterError> {
        effective_inelasticity(self.change.0, 1.0)
    }

    /// The error of the mean energy change through the slope of Eq. (9), `$1/(4(1-2q))$`.
    fn error(&self) -> Result<f64, ParameterError> {
        Ok(self.change.1 / (4.0 * (1.0 - 2.0 * self.effective()?)))
    }

    /// Both columns are printed to three decimals: does the one follow from the other?
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

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    std::fs::create_dir_all(&arguments.out)?;
    let path = arguments.out.join("table1.csv");
    let mut table = csv::Writer::from_path(&path)?;
    table.write_record([
        "gravity",
        "transition",
        "mean_energy_change",
        "its_error",
        "effective_inelasticity",
        "error",
        "printed",
        "printed_error",
        "verdict",
    ])?;
    println!(
        "g         transition   <dE>              q_eff             printed         verdict   (T_0 = 1)"
    );
    for row in &TABLE {
        let (effective, error, verdict) = (row.effective()?, row.error()?, row.verdict()?);
        let (Row { gravity, transition, .. }, (change, spread), (printed, printed_error)) =
            (row, row.change, row.printed);
        println!(
            "{gravity:<8}  {transition:<10}  {change:.3} ± {spread:.3}   {effective:.4} ± {error:.4}   {printed:.3} ± {printed_error:.3}   {verdict}"
        );
        table.serialize((
            gravity,
            transition,
            change,
            spread,
            effective,
            error,
            printed,
            printed_error,
            verdict,
        ))?;
    }
    table.flush()?;
    println!("wrote {}", path.display());
    Ok(())
}
