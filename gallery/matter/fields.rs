//! Density, flow and temperatures of the paper's system on a grid, averaged over time: the rolls.
//!
//! 1000 disks in the vibrated box, `g = 0.015625`, `q = 0`. The first half of the run is discarded.
//!
//! ```text
//! cargo run --release -p gallery --bin fields
//! cargo run --release -p gallery --bin fields -- --friction 0.04 --out one_roll
//! ```
//!
//! The example writes `fields.svg`, `fields.png` and `fields.csv`.

use std::error::Error;
use std::f64::consts::TAU;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use clap::Parser;
use granular_edmd::boundary::Region;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{FieldCell, Fields, Grid, Heading};
use granular_edmd::prelude::*;
use kuva::plot::heatmap::ColorMap;
use kuva::prelude::{Heatmap, Layout, Plot, TickAlign, TickFormat};

use gallery::command_line::{self, Failure, non_negative};
use gallery::flow::Arrows;
use gallery::look::{self, INK};
use gallery::panel::{self, MEDIUM, Margins, Place};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Density, flow and temperatures of the paper's vibrated box on a grid, averaged over time.
#[derive(Parser)]
struct Arguments {
    /// Friction.
    #[arg(long, default_value_t = 0.07, value_parser = non_negative)]
    friction: f64,
    /// Oscillations of the base; the first half is discarded.
    #[arg(long, default_value_t = 40_000, value_parser = clap::value_parser!(u64).range(100..=10_000_000))]
    oscillations: u64,
    /// Seed of the initial velocities.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Runs for 200 oscillations at most.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

impl Arguments {
    fn oscillations(&self) -> u64 {
        if self.quick { self.oscillations.min(200) } else { self.oscillations }
    }
}

/// Width and height of the box.
const BOX: DVec2 = DVec2::new(60.0, 150.0);

/// Time between two samples, in oscillations: not a whole number, so that all phases of the base are seen.
const INTERVAL: f64 = 0.99;

/// Columns and rows of the grids: fine for the maps, coarse for the arrows.
const FINE: (usize, usize) = (24, 60);
const COARSE: (usize, usize) = (10, 25);

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let start = Instant::now();
    let (fine, coarse) = measured(arguments).map_err(Failure::run)?;
    gallery::say!("{} samples in {:.1} s", fine.samples(), start.elapsed().as_secs_f64());
    write(arguments, &fine, &coarse).map_err(Failure::run)
}

/// Returns the fields in the second half of a run, on both grids.
fn measured(arguments: &Arguments) -> Result<(Sampled<Fields>, Sampled<Fields>), Box<dyn Error>> {
    let base = BiParabolic::new(0.1, 10.0)?;
    let oscillation = TAU / base.angular_frequency();
    let container = Container::closed(BOX.x, BOX.y)?.with_motion(Wall::Floor, base)?;
    let disks = initial::lattice(&container, 1000, 0.5)?;
    let disks = initial::with_maxwellian_velocities(disks, 0.5, arguments.seed)?;
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.0, 0.0, arguments.friction)?, 1e-4)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;
    let end = arguments.oscillations() as f64 * oscillation;
    let mut progress = Progress::of("run").until(end);
    simulation.run_until(0.5 * end, &mut progress)?;
    let times = SampleTimes::every(INTERVAL * oscillation)?.starting_at(0.5 * end)?;
    let region = Region::new(DVec2::ZERO, BOX);
    let mut fields = (
        Sampled::new(Fields::new(Grid::new(region, FINE.0, FINE.1)?), times),
        Sampled::new(Fields::new(Grid::new(region, COARSE.0, COARSE.1)?), times),
    );
    simulation.run_until(end, &mut (&mut fields, &mut progress))?;
    gallery::output::warn(&simulation.warnings());
    Ok(fields)
}

fn write(arguments: &Arguments, fine: &Fields, coarse: &Fields) -> Result<(), Box<dyn Error>> {
    let columns = fine.headings();
    let columns: Vec<&str> = columns.iter().map(Heading::name).collect();
    let mut table = arguments.results.table("fields", &columns)?;
    fine.rows().try_for_each(|row| table.serialize(row))?;
    arguments.results.finish_table("fields", table, Some(&draw(arguments, fine, coarse)))
}

const MARGINS: Margins = [56.0, 14.0, 6.0, 60.0];
const BAR_MARGINS: Margins = [56.0, 14.0, 34.0, 28.0];
const HEADER: f64 = 92.0;
const BAR: f64 = 80.0;

/// Length of a diameter on the sheet.
const UNIT: f64 = 3.3;

/// Share of the disks of the fullest cell below which a cell stays white, since its averages are noise.
const ENOUGH: f64 = 0.05;

/// A map of a field: its name, its value in a cell, the range of its colors for the smallest and the largest
/// value, and the color of a share of that range.
struct Map {
    name: &'static str,
    value: fn(&FieldCell) -> f64,
    range: fn(f64, f64) -> (f64, f64),
    color: fn(f64) -> String,
}

/// The map that has the arrows.
const FLOW: usize = 1;

fn maps() -> [Map; 4] {
    let viridis = |share| ColorMap::Viridis.map(share);
    let inferno = |share| ColorMap::Inferno.map(share);
    [
        Map {
            name: "packing fraction",
            value: |cell| cell.packing_fraction,
            range: |_, high| (0.0, high),
            color: viridis,
        },
        Map {
            name: "velocity upward, in Aω",
            value: |cell| cell.velocity.y,
            range: |low, high| (-high.max(-low), high.max(-low)),
            color: |share| look::diverging(2.0 * share - 1.0),
        },
        Map {
            name: "log₁₀ T, translational",
            value: |cell| cell.translational_temperature.log10(),
            range: |low, high| (low, high),
            color: inferno,
        },
        Map {
            name: "log₁₀ T, rotational",
            value: |cell| cell.rotational_temperature.log10(),
            range: |low, high| (low, high),
            color: inferno,
        },
    ]
}

fn draw(arguments: &Arguments, fine: &Fields, coarse: &Fields) -> Sheet {
    let top = top(fine);
    let size = (UNIT * BOX.x + MARGINS[0] + MARGINS[1], UNIT * top + MARGINS[2] + MARGINS[3]);
    let mut sheet = Sheet::new(4.0 * size.0 + 10.0, HEADER + BAR + size.1);
    let arrows = Arrows::of(coarse, ENOUGH, 1.6);
    write_header(&mut sheet, arguments, fine, &arrows);
    for (column, map) in maps().iter().enumerate() {
        let x = column as f64 * size.0;
        let (low, high) = panel::ends(seen(fine).map(|cell| (map.value)(&cell)));
        let range = (map.range)(low, high);
        let place = Place { x, y: HEADER, width: size.0, height: BAR };
        draw_bar(&mut sheet, place, map, range);
        let mut plots = vec![heat_map(map, fine, range)];
        if column == FLOW {
            plots.push(arrows.plot(1.4));
        }
        let place = Place { x, y: HEADER + BAR, width: size.0, height: size.1 };
        let axes = panel::axes((0.0, BOX.x), (0.0, top));
        let axes = axes.with_x_tick_step(20.0).with_x_label("x / σ").with_tick_align(TickAlign::Outside);
        let axes = if column == 0 { axes.with_y_label("height / σ") } else { axes };
        sheet.panel(place, MARGINS, plots, axes);
    }
    sheet
}

fn write_header(sheet: &mut Sheet, arguments: &Arguments, fine: &Fields, arrows: &Arrows) {
    let title = format!("Density, flow and temperatures at κ = {}", arguments.friction);
    let system = "N = 1000, box 60 × 150, g = 0.015625, q = 0, base A = 0.1, ω = 10; temperatures in m(Aω)²";
    let protocol = format!(
        "{} samples in the second half of {} oscillations, seed {}; white: fewer than {} disks seen",
        fine.samples(),
        arguments.oscillations(),
        arguments.seed,
        enough(fine)
    );
    sheet.header(MARGINS[0], &title, &[system, &protocol]);
    if let Some((speed, length)) = arrows.scale() {
        sheet.arrow((700.0, 30.0), UNIT * length, &format!("velocity {speed} Aω"));
    }
}

/// Returns the height that is shown, a little more than the height of the highest cell with enough disks.
fn top(fields: &Fields) -> f64 {
    let highest = seen(fields).map(|cell| cell.center.y).fold(0.0, f64::max);
    (10.0 * (0.1 * highest + 0.5).ceil()).min(BOX.y)
}

/// Returns the number of disks that a cell needs.
fn enough(fields: &Fields) -> u64 {
    let fullest = fields.iter().map(|cell| cell.count).max().unwrap_or(0);
    (ENOUGH * fullest as f64).ceil().max(1.0) as u64
}

/// Iterates over the cells with enough disks.
fn seen(fields: &Fields) -> impl Iterator<Item = FieldCell> {
    let enough = enough(fields);
    fields.iter().filter(move |cell| cell.count >= enough)
}

/// Draws the colors of a range above the panel.
fn draw_bar(sheet: &mut Sheet, place: Place, map: &Map, range: (f64, f64)) {
    let shares = (0..64).map(|step| f64::from(step) / 63.0);
    let color = map.color;
    let bar = Heatmap::new()
        .with_data([shares])
        .with_color_map(ColorMap::Custom(Arc::new(color)))
        .with_x_range(range.0, range.1)
        .with_y_range(0.0, 1.0)
        .with_cell_size(1.0);
    let axes: Layout = panel::axes(range, (0.0, 1.0));
    let axes = axes.with_ticks(3).with_y_tick_step(2.0);
    let axes = axes.with_y_tick_format(TickFormat::Custom(Arc::new(|_| String::new())));
    sheet.panel(place, BAR_MARGINS, vec![bar.into()], axes);
    sheet.text(place.x + MARGINS[0], place.y + 26.0, MEDIUM, INK, map.name);
}

fn heat_map(map: &Map, fields: &Fields, range: (f64, f64)) -> Plot {
    let share = |cell: &FieldCell| ((map.value)(cell) - range.0) / (range.1 - range.0);
    let enough = enough(fields);
    let cells = fields.iter().map(|cell| if cell.count >= enough { share(&cell) } else { f64::NAN });
    let cells: Vec<f64> = cells.map(|share| if share.is_finite() { share } else { f64::NAN }).collect();
    // The heat map stretches its data over all its colors, but the bar does not.
    let (low, high) = panel::ends(cells.iter().copied());
    let color = map.color;
    let colors = move |stretched: f64| {
        if stretched.is_nan() { "#ffffff".to_owned() } else { color(low + stretched * (high - low)) }
    };
    let rows = (top(fields) * FINE.1 as f64 / BOX.y).round();
    Heatmap::new()
        .with_data(cells.chunks(FINE.0).take(rows as usize).map(<[f64]>::to_vec))
        .with_color_map(ColorMap::Custom(Arc::new(colors)))
        .with_x_range(0.0, BOX.x)
        .with_y_range(0.0, top(fields))
        .with_cell_size(1.0)
        .into()
}
