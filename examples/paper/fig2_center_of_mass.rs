//! The paper's Fig. 2: height of the center of mass over a thermal base, against friction.
//!
//! The system has 500 disks in a narrow open box, with `q = 0.025` and `g = 0.002`. The column is lowest
//! where a collision loses most energy, at a friction of about 0.3. The paper does not say what its base does
//! to tangential and angular velocity. A full thermal base is the default; `--slip` gives one with slip.
//!
//! ```text
//! cargo run --release --features serde,rayon --example fig2_center_of_mass -- --quick
//! ```
//!
//! The example writes `fig2_center_of_mass.png` and the tables of the study. After an interruption, the same
//! command goes on.

#[path = "../common/mod.rs"]
mod common;
#[path = "../studies/mod.rs"]
mod studies;

use std::error::Error;
use std::process::ExitCode;
use std::sync::Arc;

use clap::Parser;
use granular_edmd::statistics::Estimate;
use granular_edmd::study::vibrated_box::{Base, VibratedBox};
use granular_edmd::study::{Axis, Plan, PlanError, Protocol, Record, Study};
use kuva::plot::legend::LegendPosition;
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::figure::Figure;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;

/// Height of the center of mass against friction (paper, Fig. 2).
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: studies::Common,
    /// A base that redraws the normal velocity only.
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
            (Protocol::new(10_000, 200, 50), FEW_FRICTIONS.to_vec())
        } else {
            (Protocol::new(20_000, 1_000, 100), FRICTIONS.to_vec())
        };
        Plan::new(experiment, protocol, self.common.seed)?.with_axis(Axis::new("friction", frictions))
    }
}

/// A point of the figure.
struct Point {
    friction: f64,
    height: Estimate,
}

fn main() -> ExitCode {
    common::command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let name = if arguments.slip { "fig2_center_of_mass-slip" } else { "fig2_center_of_mass" };
    let Some(study) = arguments.common.complete(name, &arguments.plan()?)? else { return Ok(()) };
    let points = points(&study)?;
    print(&points);
    arguments.common.finish(figure(&points, arguments.slip), &study, "fig2_center_of_mass.png")
}

fn points(study: &Study<VibratedBox>) -> Result<Vec<Point>, Box<dyn Error>> {
    let point = |record: Record<VibratedBox>| {
        let height = record.mean(|sample| sample.height);
        Point { friction: record.experiment().friction, height }
    };
    Ok(study.records().map(|record| record.map(point)).collect::<Result<_, _>>()?)
}

fn print(points: &[Point]) {
    println!("friction   Y_cm ± standard error of correlated samples");
    for Point { friction, height } in points {
        println!("{friction:8}  {height:.2}");
    }
    if let Some(lowest) = points.iter().min_by(|a, b| a.height.mean().total_cmp(&b.height.mean())) {
        println!("lowest at friction {}: {:.2}", lowest.friction, lowest.height.mean());
    }
}

fn figure(points: &[Point], slip: bool) -> Figure {
    // The axis is logarithmic, so the value without friction is drawn as a line.
    let drawn: Vec<&Point> = points.iter().filter(|point| point.friction > 0.0).collect();
    let places: Vec<(f64, f64)> = drawn.iter().map(|point| (point.friction, point.height.mean())).collect();
    let line =
        LinePlot::new().with_data(places.clone()).with_color("rgb(150,170,210)").with_stroke_width(1.2);
    let dots = ScatterPlot::new()
        .with_data(places)
        .with_y_err(drawn.iter().map(|point| point.height.standard_error()))
        .with_color("rgb(30,80,180)")
        .with_size(4.5)
        .with_legend("κ > 0");
    let mut plots = vec![Plot::Line(line), Plot::Scatter(dots)];
    if let Some(smooth) = points.iter().find(|point| point.friction == 0.0) {
        let level = [0.007, 14.0].map(|friction| (friction, smooth.height.mean()));
        let level = LinePlot::new()
            .with_data(level)
            .with_color("gray")
            .with_stroke_width(1.2)
            .with_dashed()
            .with_legend("κ = 0");
        plots.push(Plot::Line(level));
    }
    let base = if slip { "base with slip" } else { "thermal base" };
    let layout = Layout::auto_from_plots(&plots)
        .with_title(format!("N = 500, Lx = 25, g = 0.002, q = 0.025, {base}"))
        .with_x_label("friction κ")
        .with_y_label("height of the center of mass, in diameters")
        .with_log_x()
        .with_x_tick_format(TickFormat::Custom(Arc::new(|value| value.to_string())))
        .with_x_axis_min(0.007)
        .with_x_axis_max(14.0)
        .with_legend_position(LegendPosition::InsideBottomLeft)
        .with_y_axis_min(0.0)
        .with_show_grid(false)
        .with_box_axes();
    Figure::new(1, 1).with_plots(vec![plots]).with_layouts(vec![layout]).with_cell_size(820.0, 540.0)
}
