//! A chute: grains that flow down a rough slope, and how their speed grows with the height above the ground.
//!
//! 600 grains on a ground of half disks, periodic along the slope, under gravity 1 that is tilted. Below some
//! angle they stop, above another they accelerate, and between the two the flow is steady.
//!
//! ```text
//! cargo run --release -p gallery --bin chute
//! cargo run --release -p gallery --bin chute -- --angles 18,21,24 --time 600 --out chute
//! ```
//!
//! The example writes `chute.svg`, `chute.png` and `chute.csv`. Literature: GDR MiDi, Eur. Phys. J. E 14, 341
//! (2004); L. E. Silbert et al., Phys. Rev. E 64, 051302 (2001).

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::boundary::{Container, Region};
use granular_edmd::observable::{FieldCell, Grid};
use granular_edmd::prelude::*;

use gallery::command_line::{self, Failure, positive};
use gallery::faces::{GAP, faces};
use gallery::look::{DARK_TO_LIGHT, INK, Look};
use gallery::panel::{self, Margins, Place, SMALL};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Speed of grains on a rough slope as a function of height.
#[derive(Parser)]
struct Arguments {
    /// Angles of the slope, in degrees.
    #[arg(long, value_delimiter = ',', default_value = "16,18,20,22", value_parser = positive)]
    angles: Vec<f64>,
    /// Time for which each profile is measured, after an equal time to settle, in units of √(d/g).
    #[arg(long, default_value_t = 100.0, value_parser = positive)]
    time: f64,
    /// Measures for a time of 10 at most.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const GRAINS: usize = 600;

/// Number of the bumps of the ground, half disks of diameter 1, and their distance.
const BUMPS: u32 = 30;
const PITCH: f64 = 1.35;
const WIDTH: f64 = BUMPS as f64 * PITCH;

/// Height of the picture and of the profiles, and their number of layers.
const TOP: f64 = 24.0;
const LAYERS: usize = 24;

struct Flow {
    angle: f64,
    /// Height, speed along the slope, and share of the mean number of grains, of each layer.
    profile: Vec<[f64; 3]>,
    shot: Vec<Disk>,
    ground: Vec<Disk>,
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let flows = arguments.angles.iter().map(|&angle| flow(arguments, angle));
    let flows = flows.collect::<Result<Vec<_>, _>>().map_err(Failure::run)?;
    write(arguments, &flows).map_err(Failure::run)
}

/// Lets grains flow down a slope of this angle, and measures them.
fn flow(arguments: &Arguments, angle: f64) -> Result<Flow, Box<dyn Error>> {
    let bump = |k: u32| Disk::new(DVec2::new(PITCH * (0.5 + f64::from(k)), 0.0), 0.5);
    let bumps = (0..BUMPS).map(bump).collect::<Result<Vec<_>, _>>()?;
    let ground = Container::open(WIDTH)?.with_periodic_sides()?.with_pegs(bumps.iter().copied())?;
    let disks = initial::scattered(&ground, GRAINS, 0.5, 30.0, 1)?;
    let rule = LeastRebound::new(Frictional::from_restitution(0.7, 0.0, 0.5)?, 0.05)?;
    let gravity = Gravity::tilted(1.0, angle.to_radians())?;
    let mut run = Simulation::builder(rule, ground).disks(disks).gravity(gravity).build()?;

    let time = if arguments.quick { arguments.time.min(10.0) } else { arguments.time };
    let mut progress = Progress::of(format!("slope of {angle}°")).until(2.0 * time);
    run.run_until(time, &mut progress)?;
    let region = Region::new(DVec2::ZERO, DVec2::new(WIDTH, TOP));
    let fields = Fields::new(Grid::new(region, 1, LAYERS)?);
    let mut fields = Sampled::new(fields, SampleTimes::every(0.5)?);
    run.run_until(2.0 * time, &mut (&mut fields, &mut progress))?;
    gallery::output::warn(&run.warnings());
    let fullest = fields.iter().map(|cell| cell.count).max().unwrap_or(1).max(1) as f64;
    let layer = |cell: FieldCell| [cell.center.y, cell.velocity.x, cell.count as f64 / fullest];
    let profile: Vec<_> = fields.iter().filter(|cell| cell.count > 0).map(layer).collect();
    let fastest = profile.iter().filter(|layer| layer[2] > 0.2).map(|layer| layer[1]).fold(0.0, f64::max);
    gallery::say!("slope of {angle}°: the surface flows at {fastest:.2} √(gd)");
    Ok(Flow { angle, profile, shot: run.disks(), ground: bumps })
}

fn write(arguments: &Arguments, flows: &[Flow]) -> Result<(), Box<dyn Error>> {
    let mut table = arguments.results.table("chute", &["angle", "height", "speed", "filling"])?;
    for Flow { angle, profile, .. } in flows {
        for [height, speed, filling] in profile {
            table.serialize((angle, height, speed, filling))?;
        }
    }
    let numbers: Vec<_> = flows.iter().map(|flow| (flow.angle, &flow.profile)).collect();
    arguments.results.finish("chute", table, &draw(flows), &serde_json::json!({ "profiles": numbers }))
}

const MARGINS: Margins = [62.0, 16.0, 28.0, 58.0];
const HEADER: f64 = 66.0;
const HEIGHT: f64 = 460.0;

/// Draws the grains on the steepest slope, and the profiles of all.
fn draw(flows: &[Flow]) -> Sheet {
    let unit = (HEIGHT - MARGINS[2] - MARGINS[3]) / TOP;
    let frame = WIDTH * unit + MARGINS[0] + MARGINS[1];
    let mut sheet = Sheet::new(frame + 480.0, HEADER + HEIGHT);
    let about = "600 grains of diameter d, r = 0.7, κ = 0.5; periodic along the slope";
    sheet.header(MARGINS[0], "Grains on a rough slope", &[about]);
    let fastest = flows.iter().flat_map(|flow| &flow.profile).map(|layer| layer[1]).fold(0.1, f64::max);
    let place = Place { x: 0.0, y: HEADER, width: frame, height: HEIGHT };
    if let Some(Flow { angle, shot, ground, .. }) = flows.last() {
        let layout = panel::axes((0.0, WIDTH), (0.0, TOP));
        let layout = layout.with_x_label("down the slope, in diameters").with_y_label("height, in diameters");
        let quarter = |grain: &Disk| (4.0 * grain.velocity().x / fastest).clamp(0.0, 3.0) as usize;
        let color = |grain: &Disk| DARK_TO_LIGHT[quarter(grain)];
        let plots = vec![faces(shot.iter(), unit, GAP, color), faces(ground.iter(), unit, GAP, |_| INK)];
        sheet.panel(place, MARGINS, plots, layout);
        let text = format!("slope of {angle}°; dark to light: speed, in quarters of the largest");
        sheet.text(MARGINS[0], HEADER + 20.0, SMALL, INK, &text);
    }
    let place = Place { x: frame, width: 480.0, ..place };
    let layout = panel::axes((0.0, 1.05 * fastest), (0.0, TOP));
    let layout = layout.with_x_label("speed, in √(gd)").with_y_label("height, in diameters");
    let look = |number: usize| Look::number(number).with_size(3.5);
    // The mean of a layer with few grains is not drawn.
    let layers = |flow: &Flow| -> Vec<_> {
        flow.profile.iter().filter(|layer| layer[2] > 0.2).map(|layer| (layer[1], layer[0])).collect()
    };
    let curves = flows.iter().enumerate().map(|(number, flow)| look(number).curve(layers(flow))).collect();
    let panel = sheet.panel(place, MARGINS, curves, layout);
    for (number, flow) in flows.iter().enumerate() {
        sheet.marks(&panel, look(number), layers(flow));
    }
    let names: Vec<_> = flows.iter().map(|flow| format!("slope of {}°", flow.angle)).collect();
    let names: Vec<_> = names.iter().enumerate().map(|(k, name)| (look(k), name.as_str())).collect();
    sheet.legend_inside(&panel, &names);
    sheet
}
