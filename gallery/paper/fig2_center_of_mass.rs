//! The paper's Fig. 2: height of the center of mass over a thermal base, against friction.
//!
//! The system has 500 disks in a narrow open box, with `q = 0.025` and `g = 0.002`. The column is lowest
//! where a collision loses most energy, at a friction of about 0.3. The paper does not say what its base does
//! to tangential and angular velocity. A full thermal base is the default; `--slip` gives one with slip.
//!
//! ```text
//! cargo run --release -p gallery --all-features --bin fig2_center_of_mass -- --quick
//! ```
//!
//! The example writes `fig2_center_of_mass.svg` and `.png`, and the tables of the study. After an
//! interruption, the same command continues.

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::statistics::Estimate;
use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Axis, Plan, PlanError, Protocol, Record, Study};

use gallery::look::{LOOKS, Look, QUIET};
use gallery::panel::{self, COLUMN, Margins, Place};
use gallery::sheet::Sheet;

/// Height of the center of mass against friction (paper, Fig. 2).
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: gallery::studies::Common,
    /// Uses a base that redraws the normal velocity only.
    #[arg(long)]
    slip: bool,
}

/// Frictions of a full run.
const FRICTIONS: [f64; 15] = [0.0, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 1.0, 2.0, 3.0, 6.0, 10.0];

/// Frictions of a short run.
const FEW_FRICTIONS: [f64; 7] = [0.0, 0.03, 0.1, 0.3, 0.6, 2.0, 10.0];

impl Arguments {
    fn plan(&self) -> Result<Plan<VibratedBox>, PlanError> {
        let base = Base::Thermal { temperature: 1.0, slip: self.slip };
        let experiment = VibratedBox::new(500, 25.0, base)
            .with_gravity(0.002)
            .with_inelasticity(0.025)
            .with_contact_duration(1e-5);
        let (protocol, frictions) = if self.common.quick {
            (Protocol::new(10_000, 200, 50)?, FEW_FRICTIONS.to_vec())
        } else {
            (Protocol::new(20_000, 1_000, 100)?, FRICTIONS.to_vec())
        };
        Plan::new(experiment, protocol, self.common.seed)?.with_axis(Axis::new("friction", frictions)?)
    }
}

/// A point of the figure.
struct Point {
    friction: f64,
    height: Estimate,
}

fn main() -> ExitCode {
    gallery::command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let name = if arguments.slip { "fig2_center_of_mass-slip" } else { "fig2_center_of_mass" };
    let Some(study) = arguments.common.complete(name, &arguments.plan()?)? else { return Ok(()) };
    let points = points(&study)?;
    print(&points);
    arguments.common.finish(&draw(&points, arguments.slip), &study, "fig2_center_of_mass")
}

fn points(study: &Study<VibratedBox>) -> Result<Vec<Point>, Box<dyn Error>> {
    let point = |record: Record<VibratedBox>| {
        let height = record.mean(|sample| sample.height);
        Point { friction: record.experiment().friction, height }
    };
    Ok(study.records().map(|record| record.map(point)).collect::<Result<_, _>>()?)
}

fn print(points: &[Point]) {
    gallery::say!("friction   Y_cm ± standard error of correlated samples");
    for Point { friction, height } in points {
        gallery::say!("{friction:8}  {height:.2}");
    }
    if let Some(lowest) = points.iter().min_by(|a, b| a.height.mean().total_cmp(&b.height.mean())) {
        gallery::say!("lowest at friction {}: {:.2}", lowest.friction, lowest.height.mean());
    }
}

const MARGINS: Margins = [64.0, 18.0, 10.0, 60.0];
const HEIGHT: f64 = 400.0;
const HEADER: f64 = 66.0;

/// Frictions at the edges of the picture.
const EDGES: (f64, f64) = (0.007, 14.0);

fn draw(points: &[Point], slip: bool) -> Sheet {
    let mut sheet = Sheet::new(COLUMN, HEADER + HEIGHT);
    let slip = if slip { " with slip" } else { "" };
    let title = format!("A column over a thermal base{slip}");
    sheet.header(MARGINS[0], &title, &["N = 500, width 25, g = 0.002, q = 0.025"]);
    // The axis is logarithmic, so the value without friction is drawn as a line.
    let drawn = || points.iter().filter(|point| point.friction > 0.0);
    let place = |point: &Point| (point.friction, point.height.mean());
    let (rough, smooth) = (LOOKS[0], Look::line(QUIET, "8 4"));
    let mut plots = vec![rough.with_width(1.0).curve(drawn().map(place))];
    let mut names = vec![(rough.without_line(), "κ > 0, with standard error")];
    if !drawn().all(|point| point.height.is_converged()) {
        names.push((rough.without_line().open(), "the same, the error a lower bound"));
    }
    if let Some(at) = points.iter().find(|point| point.friction == 0.0) {
        plots.push(smooth.curve([EDGES.0, EDGES.1].map(|friction| (friction, at.height.mean()))));
        names.push((smooth, "κ = 0"));
    }
    let layout = panel::axes(EDGES, heights(points)).with_log_x();
    let layout = layout.with_x_label("friction κ").with_y_label("center of mass, in diameters σ");
    let frame = Place { x: 0.0, y: HEADER, width: COLUMN, height: HEIGHT };
    let panel = sheet.panel(frame, MARGINS, plots, layout);
    let bar = |point: &Point| {
        let (mean, error) = (point.height.mean(), point.height.standard_error());
        [mean - error, mean + error].map(|height| (point.friction, height))
    };
    sheet.bars(&panel, rough, drawn().map(bar));
    for point in drawn() {
        let look = if point.height.is_converged() { rough } else { rough.open() };
        sheet.marks(&panel, look, [place(point)]);
    }
    sheet.legend_inside(&panel, &names);
    sheet
}

/// Returns the range of the heights with their errors, from zero to whole tens.
fn heights(points: &[Point]) -> (f64, f64) {
    let bar =
        |point: &Point| [-1.0, 1.0].map(|sign| point.height.mean() + sign * point.height.standard_error());
    let (_, high) = panel::ends(points.iter().flat_map(bar));
    (0.0, 10.0 * (0.1 * high + 0.2).ceil())
}
