//! The mean energy loss of the Maxwellian gas and of the simulated one, side by side: the paper's central
//! quantity, compared with a simulation of the paper's own system.
//!
//! ```text
//! cargo run --release -p gallery --bin energy_loss_in_run
//! ```
//!
//! The example writes `energy_loss_in_run.svg`, `energy_loss_in_run.png` and `energy_loss_in_run.csv`.

use std::error::Error;
use std::f64::consts::TAU;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::kinetic::{Maxwellian, mean_energy_change};
use granular_edmd::observable::EnergyChangeProfile;
use granular_edmd::prelude::*;
use granular_edmd::statistics::BlockedMean;

use gallery::command_line;
use gallery::look::Look;
use gallery::panel::{self, COLUMN, Margins, Place};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Mean energy loss of the Maxwellian gas and of the simulated one, for seven frictions.
#[derive(Parser)]
struct Arguments {
    /// Seed of the initial velocities.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Settles and measures for 200 oscillations each, not for 2000 each.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

impl Arguments {
    /// Returns the number of oscillations before the measurement, which is also the number during it.
    fn oscillations(&self) -> f64 {
        if self.quick { 200.0 } else { 2000.0 }
    }
}

/// Number of parts of the measured time; the scatter of the parts gives the errors.
const PARTS: u32 = 80;

/// Energy changes and temperatures by height.
struct Measured {
    profile: Sampled<EnergyChangeProfile>,
    /// Relative energy change and ratio of temperatures in each part.
    parts: [BlockedMean; 2],
}

/// Returns a number of the whole run with its error, and a star if that is only a lower bound.
fn with_error(whole: Option<f64>, error: &Estimate) -> String {
    let mark = if error.is_converged() { ' ' } else { '*' };
    format!("{:.4} ± {:.4}{mark}", whole.unwrap_or(f64::NAN), error.standard_error())
}

/// A point of the picture: ⟨dE⟩/T of the gases and of the run.
struct Point {
    friction: f64,
    equal: f64,
    of_run: f64,
    run: f64,
    error: f64,
}

/// One of the energy changes of a point.
type Quantity = fn(&Point) -> f64;

const COLUMNS: [&str; 9] = [
    "friction",
    "equal_temperatures",
    "rotational_temperature_of_run",
    "run",
    "run_error",
    "run_converged",
    "ratio_of_temperatures",
    "ratio_error",
    "ratio_converged",
];

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    arguments.results.make_folder()?;
    let mut table = arguments.results.table("energy_loss_in_run", &COLUMNS)?;
    gallery::say!("N = 1000, 60 x 150, g = 0.015625, A = 0.1, omega = 10, q = 0");
    gallery::say!(
        "<dE>/T over disk-disk collisions: Maxwellian gas with all temperatures equal, with the rotational"
    );
    gallery::say!(
        "temperature of the run, and the run itself, each collision over the temperature of its layer;"
    );
    gallery::say!("± is the standard error from blocks of the run, * a lower bound of it");
    gallery::say!("{:>8} {:>10} {:>10} {:>18} {:>18}", "kappa", "equal T", "T_rot", "run", "T_rot/T");
    let mut points = Vec::new();
    for friction in [0.01, 0.03, 0.05, 0.07, 0.1, 0.3, 1.0] {
        let rule = Frictional::from_inelasticity(0.0, 0.0, friction)?;
        let Measured { profile, parts } = measured(arguments, rule)?;
        let (change, ratio) = (profile.relative_energy_change(), profile.rotational_ratio());
        let [of_change, of_ratio] = parts.map(|part| part.estimate());
        let gas = Maxwellian::new(1.0)?;
        let equal = mean_energy_change(&rule, &gas);
        let of_run = mean_energy_change(&rule, &gas.with_rotational_temperature(ratio.unwrap_or(1.0))?);
        let shown = [with_error(change, &of_change), with_error(ratio, &of_ratio)];
        gallery::say!("{friction:8} {equal:10.4} {of_run:10.4} {:>18} {:>18}", shown[0], shown[1]);
        let errors = [of_change, of_ratio].map(|error| (error.standard_error(), error.is_converged()));
        table.serialize((friction, equal, of_run, change, errors[0], ratio, errors[1]))?;
        let run = change.unwrap_or(f64::NAN);
        points.push(Point { friction, equal, of_run, run, error: of_change.standard_error() });
    }
    arguments.results.finish_table("energy_loss_in_run", table, Some(&draw(&points)))
}

/// Measures the paper's box, once it has settled: the whole time, and its parts.
fn measured(arguments: &Arguments, rule: Frictional) -> Result<Measured, Box<dyn Error>> {
    let base = BiParabolic::new(0.1, 10.0)?;
    let oscillation = TAU / base.angular_frequency();
    let container = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, base)?;
    let disks =
        initial::with_maxwellian_velocities(initial::lattice(&container, 1000, 0.5)?, 0.5, arguments.seed)?;
    let name = format!("friction {}", rule.static_friction());
    let rule = ContactDuration::new(rule, 1e-4)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;
    let settled = arguments.oscillations() * oscillation;
    let mut progress = Progress::of(name).until(2.0 * settled);
    simulation.run_until(settled, &mut progress)?;
    let from = |start, every: f64| {
        let times = SampleTimes::every(every * oscillation)?.starting_at(start)?;
        EnergyChangeProfile::new(0.0, 150.0, 75).map(|profile| Sampled::new(profile, times))
    };
    let mut measured = Measured { profile: from(settled, 10.0)?, parts: Default::default() };
    for part in 0..PARTS {
        let at = |part: u32| settled + settled * f64::from(part) / f64::from(PARTS);
        let mut profile = from(at(part), 1.0)?;
        simulation.run_until(at(part + 1), &mut (&mut measured.profile, &mut profile, &mut progress))?;
        measured.parts[0].extend(profile.relative_energy_change());
        measured.parts[1].extend(profile.rotational_ratio());
    }
    gallery::output::warn(&simulation.warnings());
    Ok(measured)
}

const MARGINS: Margins = [80.0, 16.0, 10.0, 60.0];
const HEADER: f64 = 166.0;

/// Draws the three energy changes over friction, with the errors of the run.
fn draw(points: &[Point]) -> Sheet {
    let mut sheet = Sheet::new(COLUMN, HEADER + 380.0);
    let system = "N = 1000, box 60 × 150, g = 0.015625, A = 0.1, ω = 10, q = 0";
    sheet.header(MARGINS[0], "Mean energy change per collision", &[system]);
    let series: [(&str, Quantity); 3] = [
        ("Maxwellian gas, all temperatures equal", |point| point.equal),
        ("Maxwellian gas, rotational temperature of the run", |point| point.of_run),
        ("run, with standard errors", |point| point.run),
    ];
    let looks = || series.iter().enumerate().map(|(k, (name, value))| (Look::number(k), *name, value));
    let place = |value: &Quantity| -> Vec<(f64, f64)> {
        points.iter().map(|point| (point.friction, value(point))).collect()
    };
    let curves = looks().map(|(look, _, value)| look.with_width(1.2).curve(place(value))).collect();
    let lowest = points.iter().flat_map(|point| [point.equal, point.of_run, point.run - point.error]);
    let layout = panel::axes((0.007, 1.5), (1.1 * lowest.fold(0.0, f64::min), 0.0)).with_log_x();
    let layout = layout.with_x_label("friction κ").with_y_label("⟨dE⟩ / T");
    let frame = Place { x: 0.0, y: HEADER, width: COLUMN, height: 380.0 };
    let panel = sheet.panel(frame, MARGINS, curves, layout);
    let bar = |point: &Point| [-1.0, 1.0].map(|side| (point.friction, point.run + side * point.error));
    sheet.bars(&panel, Look::number(2), points.iter().map(bar));
    looks().for_each(|(look, _, value)| sheet.marks(&panel, look, place(value)));
    sheet.legend((16.0, 106.0), &looks().map(|(look, name, _)| (look, name)).collect::<Vec<_>>());
    sheet
}
