//! A cascade of collisions: one moving disk excites a gas at rest.
//!
//! The disks that move form a blast that keeps its energy, so the numbers of moving disks and of collisions
//! grow as powers of time, as t and t^(3/2) in two dimensions.
//!
//! ```text
//! cargo run --release -p gallery --bin cascade
//! cargo run --release -p gallery --bin cascade -- --gases 30 --out cascade
//! ```
//!
//! The example writes `cascade.svg`, `cascade.png` and `cascade.csv`. Literature: T. Antal, P. L. Krapivsky
//! and S. Redner, Phys. Rev. E 78, 030301 (2008), arXiv:0805.3783.

use std::error::Error;
use std::f64::consts::PI;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::prelude::*;
use granular_edmd::statistics::RunningMean;

use gallery::command_line::{self, Failure};
use gallery::faces::faces;
use gallery::look::{BLUE, GREEN, Look, Mark, ORANGE, SKY, VERMILION};
use gallery::panel::{self, Margins, Place};
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Moving disks and collisions after one disk has been set in motion in a gas at rest.
#[derive(Parser)]
struct Arguments {
    /// Number of gases whose mean is taken.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u64).range(2..))]
    gases: u64,
    /// Takes the mean of two gases, for an eighth of the time.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const DISKS: usize = 40_000;
const PACKING: f64 = 0.3;

/// Times of the samples are powers of √2 up to 2 to this number, in units of d over the speed of the disk.
const LAST: i32 = 12;

/// The sample that is drawn, when about a thousand disks move.
const SHOWN: i32 = 15;

/// Half the side of the square around the start that is drawn.
const AROUND: f64 = 45.0;

/// Means over the gases at a time.
struct Sample {
    time: f64,
    moving: RunningMean,
    collisions: RunningMean,
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let (gases, last) = if arguments.quick { (2, LAST - 3) } else { (arguments.gases, LAST) };
    let (samples, shot) = cascade(gases, 2 * last).map_err(Failure::run)?;
    write(arguments, &samples, &shot).map_err(Failure::run)
}

/// Returns the means up to a sample, and the disks that are drawn, with positions relative to the start.
fn cascade(gases: u64, last: i32) -> Result<(Vec<Sample>, Vec<Disk>), Box<dyn Error>> {
    let side = (0.25 * PI * DISKS as f64 / PACKING).sqrt();
    let time = |number: i32| 2_f64.powf(0.5 * f64::from(number));
    let sample = |number| Sample {
        time: time(number),
        moving: RunningMean::default(),
        collisions: RunningMean::default(),
    };
    let mut samples: Vec<Sample> = (2..=last).map(sample).collect();
    let mut shot = Vec::new();
    for seed in 0..gases {
        let container = Container::periodic(side, side)?;
        let mut disks = initial::scattered(&container, DISKS, 0.5, side, seed)?;
        disks[0] = disks[0].with_velocity(DVec2::X)?;
        let start = disks[0].position();
        let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
        for sample in &mut samples {
            run.run_until(sample.time, &mut ())?;
            let disks = run.disks();
            sample.moving.push(disks.iter().filter(|disk| is_moving(disk)).count() as f64);
            sample.collisions.push(run.counters().disk_collisions as f64);
            if seed == 0 && sample.time == time(SHOWN) {
                let about = |disk: Disk| {
                    let away = disk.position() - start;
                    disk.with_position(away - side * (away / side).round())
                };
                shot = disks.into_iter().map(about).collect::<Result<_, _>>()?;
            }
        }
    }
    Ok((samples, shot))
}

fn is_moving(disk: &Disk) -> bool {
    disk.velocity() != DVec2::ZERO
}

fn write(arguments: &Arguments, samples: &[Sample], shot: &[Disk]) -> Result<(), Box<dyn Error>> {
    let mut table = arguments.results.table("cascade", &["time", "moving", "moving_error", "collisions"])?;
    for Sample { time, moving, collisions } in samples {
        table.serialize((time, moving.mean(), moving.standard_error(), collisions.mean()))?;
    }
    let [first, last] = [2 * samples.len() / 3, samples.len() - 1].map(|number| &samples[number]);
    let slope = |of: fn(&Sample) -> f64| (of(last) / of(first)).ln() / (last.time / first.time).ln();
    gallery::say!(
        "from t = {:.0} to {:.0}: moving disks as t^{:.3}, collisions as t^{:.3}; theory 1, 3/2",
        first.time,
        last.time,
        slope(|sample| sample.moving.mean()),
        slope(|sample| sample.collisions.mean())
    );
    arguments.results.finish_table("cascade", table, Some(&draw(samples, shot)))
}

const MARGINS: Margins = [66.0, 16.0, 14.0, 58.0];
const HEADER: f64 = 66.0;
const COLUMN: f64 = 500.0;

/// Draws the disks around the start, and both numbers beside lines of the slopes 1 and 3/2.
fn draw(samples: &[Sample], shot: &[Disk]) -> Sheet {
    let mut sheet = Sheet::new(2.0 * COLUMN, HEADER + COLUMN);
    let about =
        "Elastic disks at packing fraction 0.3; light ones have not moved yet; orange ones are the fastest";
    sheet.header(MARGINS[0], "One moving disk in a gas at rest", &[about]);
    let place = Place { x: 0.0, y: HEADER, width: COLUMN, height: COLUMN };
    let unit = (COLUMN - MARGINS[0] - MARGINS[1]) / (2.0 * AROUND);
    let layout = panel::axes((-AROUND, AROUND), (-AROUND, AROUND)).with_x_label("x, in diameters");
    let inside = |disk: &&Disk| disk.position().abs().max_element() < AROUND;
    let color = |disk: &Disk| match disk.velocity().length() {
        0.0 => "#dde3ea",
        speed if speed < 0.01 => SKY,
        speed if speed < 0.04 => BLUE,
        _ => ORANGE,
    };
    let plots = vec![faces(shot.iter().filter(inside), unit, 0.2, color)];
    sheet.panel(place, MARGINS, plots, layout.with_y_label("y, in diameters"));
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return sheet };
    let ends = [first.time, last.time];
    let axes = panel::axes((0.8 * ends[0], 1.25 * ends[1]), (1.0, 3.0 * last.collisions.mean()));
    let layout = axes.with_log_x().with_log_y().with_x_label("time, in d over the first speed");
    let looks = [Look::marks(BLUE, Mark::Disk), Look::marks(GREEN, Mark::Square)];
    let theory = Look::line(VERMILION, "8 4");
    // The powers hold for long times, so the lines go through the last points.
    let line = |number: f64, exponent: f64| {
        theory.curve(
            ends.map(|time| (time, number * (time / ends[1]).powf(exponent)))
                .into_iter()
                .filter(|point| point.1 > 1.0),
        )
    };
    let curves = vec![line(last.moving.mean(), 1.0), line(last.collisions.mean(), 1.5)];
    let panel = sheet.panel(Place { x: COLUMN, ..place }, MARGINS, curves, layout.with_y_label("number"));
    sheet.marks(&panel, looks[0], samples.iter().map(|sample| (sample.time, sample.moving.mean())));
    sheet.marks(&panel, looks[1], samples.iter().map(|sample| (sample.time, sample.collisions.mean())));
    let names = [(looks[0], "moving disks"), (looks[1], "collisions"), (theory, "t and t³ᐟ²")];
    sheet.legend((panel.place.x + 16.0, panel.place.y + 28.0), &names);
    sheet
}
