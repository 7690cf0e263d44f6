//! The paper's Fig. 3: order parameters while friction grows step by step.
//!
//! The system has 1000 disks in the vibrated box, with `g = 0.015625` and `q = 0`, so friction alone loses
//! energy. Friction goes up from 0.005 in steps of 0.005, and each value starts from the last state of the
//! previous one. One roll sets in and changes its sense now and then. At about 0.06 it gives way to two
//! rolls.
//!
//! ```text
//! cargo run --release --features serde --example fig3_order_parameters -- --quick
//! ```
//!
//! The example writes `fig3_order_parameters.png` and the tables of the study. After an interruption, the
//! same command goes on.

#[path = "../common/mod.rs"]
mod common;
#[path = "../studies/mod.rs"]
mod studies;

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::study::vibrated_box::{Convection, Sample, VibratedBox};
use granular_edmd::study::{Course, Plan, PlanError, Protocol, Ramp, Study};
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::figure::Figure;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;

/// Order parameters while friction grows step by step (paper, Fig. 3).
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: studies::Common,
    /// Up and down again, to see the hysteresis.
    #[arg(long)]
    down: bool,
}

/// Friction of the first value, and the step to the next value.
const STEP: f64 = 0.005;

type Record = granular_edmd::study::Record<VibratedBox>;

impl Arguments {
    fn plan(&self) -> Result<Plan<VibratedBox>, PlanError> {
        let experiment = studies::vibrated_box(0.015_625);
        // The paper keeps each value for 100 000 oscillations, and draws all samples, those of the transient
        // included.
        let protocol =
            if self.common.quick { Protocol::new(0, 200, 50) } else { Protocol::new(0, 1000, 100) };
        let frictions: Vec<f64> = (1..=15).map(|step| f64::from(step) * STEP).collect();
        let course = if self.down { Course::UpAndDown } else { Course::Up };
        let ramp = Ramp::new("friction", frictions, course);
        Plan::new(experiment, protocol, self.common.seed)?.with_ramp(ramp)
    }
}

fn main() -> ExitCode {
    common::command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let name = if arguments.down { "fig3_order_parameters-down" } else { "fig3_order_parameters" };
    let Some(study) = arguments.common.complete(name, &arguments.plan()?)? else { return Ok(()) };
    let records: Vec<Record> = study.records().collect::<Result<_, _>>()?;
    print(&records);
    arguments.common.finish(figure(&records, &study), &study, "fig3_order_parameters.png")
}

/// Prints means over the second half of each value, as in the paper.
fn print(records: &[Record]) {
    println!("friction    Psi1   |Psi1|    Psi2   (noise at rest)");
    for record in records {
        let second_half = &record.samples()[record.samples().len() / 2..];
        let mean = |quantity: fn(&Sample) -> f64| {
            second_half.iter().map(quantity).sum::<f64>() / second_half.len() as f64
        };
        println!(
            "{:8.3}  {:6.3}   {:6.3}  {:6.3}   ({:.3})",
            friction(record),
            mean(|sample| sample.one_roll),
            mean(|sample| sample.one_roll.abs()),
            mean(|sample| sample.two_rolls),
            record.thermal_noise()
        );
    }
}

const fn friction(record: &Record) -> f64 {
    record.experiment().friction
}

/// Draws both order parameters, one above the other, in bins of equal friction. Bin `k` is centered at
/// `k + 1`.
fn figure(records: &[Record], study: &Study<VibratedBox>) -> Figure {
    let cycles = study.plan().protocol().cycles();
    let title = format!("g = 0.015625, q = 0, N = 1000; {cycles} oscillations for each value of κ");
    let (first, one) = panel(records, |sample| sample.one_roll, "Ψ₁");
    let (second, two) = panel(records, |sample| sample.two_rolls, "Ψ₂");
    Figure::new(2, 1)
        .with_plots(vec![first, second])
        .with_layouts(vec![one.with_title(title), two])
        .with_cell_size(1000.0, 360.0)
}

fn panel(records: &[Record], quantity: fn(&Sample) -> f64, name: &str) -> (Vec<Plot>, Layout) {
    let samples = |(bin, record): (usize, &Record)| -> Vec<(f64, f64)> {
        let count = record.samples().len() as f64;
        let place = |index: usize| bin as f64 + 0.5 + (index as f64 + 0.5) / count;
        record.samples().iter().enumerate().map(|(index, sample)| (place(index), quantity(sample))).collect()
    };
    let points: Vec<(f64, f64)> = records.iter().enumerate().flat_map(samples).collect();
    let dots = ScatterPlot::new().with_data(points).with_color("rgb(30,80,180)").with_size(1.1);
    let edges = (1..records.len()).map(|edge| edge as f64 + 0.5).map(|edge| [(edge, -0.25), (edge, 0.25)]);
    let edge = |ends: [(f64, f64); 2]| {
        Plot::Line(LinePlot::new().with_data(ends).with_color("rgb(215,215,215)").with_stroke_width(0.8))
    };
    let mut plots: Vec<Plot> = edges.map(edge).collect();
    plots.push(Plot::Scatter(dots));
    let layout = Layout::new((0.5, records.len() as f64 + 0.5), (-0.25, 0.25))
        .with_y_axis_min(-0.25)
        .with_y_axis_max(0.25)
        .with_x_axis_min(0.5)
        .with_x_axis_max(records.len() as f64 + 0.5)
        .with_x_categories(records.iter().map(|record| format!("{:.3}", friction(record))).collect())
        .with_x_label("friction κ")
        .with_y_label(name)
        .with_show_grid(false)
        .with_box_axes();
    (plots, layout)
}
