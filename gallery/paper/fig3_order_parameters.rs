//! The paper's Fig. 3: order parameters while friction grows step by step.
//!
//! The system has 1000 disks in the vibrated box, with `g = 0.015625` and `q = 0`, so friction alone loses
//! energy. Friction goes up from 0.005 in steps of 0.005, and each value starts from the last state of the
//! previous one. One roll sets in and changes its sense now and then. At about 0.06 it gives way to two
//! rolls.
//!
//! ```text
//! cargo run --release -p gallery --all-features --bin fig3_order_parameters -- --quick
//! ```
//!
//! The example writes `fig3_order_parameters.svg` and `.png`, and the tables of the study. With `--down`, the
//! picture shows growing and falling friction. After an interruption, the same command continues.

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd_study::vibrated_box::{Sample, VibratedBox};
use granular_edmd_study::{Course, Leg, Plan, PlanError, Protocol, Ramp, Study};
use kuva::prelude::{Layout, TickFormat};

use gallery::look::{self, BLUE, INK, Look, Mark, NOISE, VERMILION};
use gallery::panel::{self, COLUMN, Place};
use gallery::sheet::Sheet;

/// Order parameters while friction grows step by step (paper, Fig. 3).
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: gallery::studies::Common,
    /// Lets friction grow and fall again, to show the hysteresis.
    #[arg(long)]
    down: bool,
}

/// Friction of the first value, and the step to the next value.
const STEP: f64 = 0.005;

type Record = granular_edmd_study::Record<VibratedBox>;

impl Arguments {
    fn plan(&self) -> Result<Plan<VibratedBox>, PlanError> {
        let experiment = gallery::studies::vibrated_box(0.015_625);
        // The paper keeps each value for 100 000 oscillations, and draws all samples, including the
        // transient.
        let protocol =
            if self.common.quick { Protocol::new(0, 200, 50) } else { Protocol::new(0, 1000, 100) }?;
        let frictions: Vec<f64> = (1..=15).map(|step| f64::from(step) * STEP).collect();
        let course = if self.down { Course::UpAndDown } else { Course::Up };
        let ramp = Ramp::new("friction", frictions, course)?;
        Plan::new(experiment, protocol, self.common.seed)?.with_ramp(ramp)
    }
}

fn main() -> ExitCode {
    gallery::command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let name = if arguments.down { "fig3_order_parameters-down" } else { "fig3_order_parameters" };
    let Some(study) = arguments.common.complete(name, &arguments.plan()?)? else { return Ok(()) };
    let records: Vec<Record> = study.records().collect::<Result<_, _>>()?;
    print(&records);
    arguments.common.finish(&draw(arguments, &records, &study), &study, "fig3_order_parameters")
}

/// Prints means over the second half of each value, as in the paper.
fn print(records: &[Record]) {
    gallery::say!("friction    Psi1   |Psi1|    Psi2   (noise at rest)");
    for record in records {
        let second_half = &record.samples()[record.samples().len() / 2..];
        let mean = |quantity: fn(&Sample) -> f64| {
            second_half.iter().map(quantity).sum::<f64>() / second_half.len() as f64
        };
        gallery::say!(
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

const LEFT: f64 = 70.0;
const HEADER: f64 = 164.0;
const HEIGHT: f64 = 190.0;
const BELOW: f64 = 60.0;

/// Largest order parameter of the picture.
const MOST: f64 = 0.25;

/// Looks of the samples: while friction grows, and while it falls.
const WAYS: [Look; 2] =
    [Look::marks(BLUE, Mark::Disk).with_size(1.2), Look::marks(VERMILION, Mark::Disk).with_size(1.2)];

/// An order parameter of a sample.
type Quantity = fn(&Sample) -> f64;

/// Draws both order parameters, one above the other, over friction.
fn draw(arguments: &Arguments, records: &[Record], study: &Study<VibratedBox>) -> Sheet {
    let mut sheet = Sheet::new(COLUMN, HEADER + 2.0 * HEIGHT + BELOW);
    let cycles = study.plan().protocol().cycles();
    let note = format!("N = 1000, g = 0.015625, q = 0; {cycles} oscillations at each κ");
    sheet.header(LEFT, "Order parameters while friction changes", &[&note]);
    let names: &[_] = if arguments.down {
        &["κ grows (left half of each value)", "κ falls (right half)"]
    } else {
        &["samples, κ grows"]
    };
    let names = WAYS.map(|look| look.with_size(3.5)).into_iter().zip(names.iter().copied());
    let noise = (NOISE, "two standard deviations of thermal noise");
    let names: Vec<_> = names.chain([noise]).collect();
    sheet.legend((LEFT, 106.0), &names);
    let quantities: [(Quantity, &str); 2] =
        [(|sample| sample.one_roll, "Ψ₁, one roll"), (|sample| sample.two_rolls, "Ψ₂, two rolls")];
    for (number, (quantity, name)) in quantities.into_iter().enumerate() {
        let place = Place { x: 0.0, y: HEADER + HEIGHT * number as f64, width: COLUMN, height: HEIGHT };
        add_panel(&mut sheet, place, records, quantity, layout(number == 1).with_y_label(name));
    }
    sheet
}

/// Returns the axes of a panel. Only the lowest panel has numbers and a name at its friction axis.
fn layout(lowest: bool) -> Layout {
    let layout = panel::axes((0.5 * STEP, 15.5 * STEP), (-MOST, MOST)).with_x_tick_step(0.01);
    let layout = layout.with_y_tick_step(0.1).with_y_tick_format(TickFormat::Fixed(1));
    if lowest {
        layout.with_x_tick_format(TickFormat::Fixed(2)).with_x_label("friction κ, static = dynamic")
    } else {
        layout.with_x_tick_format(TickFormat::Custom(std::sync::Arc::new(|_| String::new())))
    }
}

fn add_panel(sheet: &mut Sheet, place: Place, records: &[Record], quantity: Quantity, layout: Layout) {
    let place = Place { height: place.height + BELOW, ..place };
    let noise = noise(records);
    let panel = sheet.panel(place, [LEFT, 14.0, 8.0, BELOW], vec![look::noise(&noise)], layout);
    let both = records.iter().any(|record| record.leg() == Some(Leg::Down));
    for record in records {
        let down = record.leg() == Some(Leg::Down);
        let (from, to) = if both { if down { (0.02, 0.46) } else { (-0.46, -0.02) } } else { (-0.46, 0.46) };
        let count = record.samples().len() as f64;
        let at = |index: usize| friction(record) + STEP * (from + (to - from) * (index as f64 + 0.5) / count);
        let samples = record.samples().iter().enumerate();
        let samples = samples.map(|(index, sample)| (at(index), quantity(sample)));
        sheet.marks(&panel, WAYS[usize::from(down)], samples);
    }
    // The samples hide the band, so its edges are drawn over them.
    for sign in [-1.0, 1.0] {
        let edge = noise.iter().map(|&(friction, half)| panel.at((friction, sign * half)));
        sheet.line(edge.collect(), INK, 1.0);
    }
}

/// Returns half the height of the band in which nearly all samples of a gas without rolls would be.
fn noise(records: &[Record]) -> Vec<(f64, f64)> {
    let up = records.iter().filter(|record| record.leg() != Some(Leg::Down));
    let ends = |record: &Record| {
        [-0.5, 0.5].map(|end| (friction(record) + end * STEP, 2.0 * record.thermal_noise()))
    };
    up.flat_map(ends).collect()
}
