//! The Brazil nut: a large disk among small ones, in a shaken box.
//!
//! An intruder of the same density starts on the floor and rises, carried by the flow between the rough
//! walls; at the top it may dive again. A heavy one starts on top and sinks. 600 grains of diameter 1 lie
//! some twenty layers deep, and the floor shakes them with `A = 1`, `ω = 2`, `g = 1`, that is, an
//! acceleration of 4 g.
//!
//! ```text
//! cargo run --release -p gallery --bin brazil_nut
//! cargo run --release -p gallery --bin brazil_nut -- --sizes 3,8 --heavy 6 --out nuts
//! ```
//!
//! The example writes `brazil_nut.svg`, `brazil_nut.png` and `brazil_nut.csv`. Literature: A. Rosato et al.,
//! Phys. Rev. Lett. 58, 1038 (1987); J. B. Knight et al., Phys. Rev. Lett. 70, 3728 (1993) for the flow; D.
//! C. Hong et al., Phys. Rev. Lett. 86, 3423 (2001) for disks that sink.

use std::error::Error;
use std::f64::consts::TAU;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::Kind;
use granular_edmd::boundary::Container;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::OfKind;
use granular_edmd::prelude::*;
use kuva::prelude::{Layout, Plot};

use gallery::command_line::{self, Failure, non_negative, positive};
use gallery::faces::{GAP, faces};
use gallery::look::{INK, Look, QUIET, VERMILION};
use gallery::panel::{self, Margins, Place, SMALL};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// A large disk among small ones, in a shaken box: how high it is over time.
#[derive(Parser)]
struct Arguments {
    /// Diameters of the intruders that start on the floor, in diameters of a grain.
    #[arg(long, value_delimiter = ',', default_value = "2,4,6", value_parser = positive)]
    sizes: Vec<f64>,
    /// Density of one more intruder, of diameter 4, that starts on top if it is above 1; 0 for none.
    #[arg(long, default_value_t = 4.0, value_parser = non_negative)]
    heavy: f64,
    /// Oscillations of the floor.
    #[arg(long, default_value_t = 500, value_parser = clap::value_parser!(u32).range(4..=1_000_000))]
    oscillations: u32,
    /// Seed of the initial velocities.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Runs for 100 oscillations at most, in which the intruders of the same density rise.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const INTRUDER: Kind = Kind::new(1);
const GRAINS: usize = 600;
const WIDTH: f64 = 30.0;

/// Amplitude of the base.
const AMPLITUDE: f64 = 1.0;

/// Diameter of the largest intruder.
const LARGEST: f64 = 16.0;

/// Height below which the grains are packed at first.
const PACKED: f64 = 24.0;

/// Number of samples per oscillation, and number of samples that are averaged for a point of the picture.
const SAMPLES: u32 = 20;
const POINT: usize = 2 * SAMPLES as usize;

/// An intruder and what it did.
struct Nut {
    diameter: f64,
    density: f64,
    /// Oscillations, height of the intruder, mean height of the grains.
    heights: Vec<[f64; 3]>,
    start: Vec<Disk>,
    /// The time at which the intruder was highest, in oscillations, and the disks at that time.
    highest: (f64, Vec<Disk>),
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let light = arguments.sizes.iter().map(|&diameter| (diameter, 1.0));
    let heavy = (arguments.heavy > 0.0).then_some((4.0, arguments.heavy));
    let mut nuts = Vec::new();
    for (diameter, density) in light.chain(heavy) {
        if diameter > LARGEST {
            let message = format!("--sizes {diameter}: the box has room for a diameter of {LARGEST}");
            return Err(Failure::usage(message));
        }
        let nut = shaken(arguments, diameter, density).map_err(Failure::run)?;
        gallery::say!("{nut}");
        nuts.push(nut);
    }
    write(arguments, &nuts).map_err(Failure::run)
}

/// Shakes an intruder among the grains, and returns its path.
fn shaken(arguments: &Arguments, diameter: f64, density: f64) -> Result<Nut, Box<dyn Error>> {
    let floor = Sinusoidal::new(AMPLITUDE, 2.0)?;
    let container = Container::open(WIDTH)?.with_motion(Wall::Floor, floor)?;
    let start = initial_disks(&container, diameter, density, arguments.seed)?;
    // Grains lie on each other for short times, so the rule needs a contact duration.
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.3)?, 1e-3)?;
    let mut simulation = Simulation::builder(rule, container).disks(start.clone()).gravity(1.0).build()?;

    let heights = (OfKind::new(INTRUDER, CenterOfMass), OfKind::new(Kind::DEFAULT, CenterOfMass));
    let period = TAU / 2.0;
    let mut series = Series::new(heights, SampleTimes::every(period / f64::from(SAMPLES))?);
    let (mut top, mut highest) = (0.0, (0.0, start.clone()));
    let mut watch = on_sample(SampleTimes::every(period)?, |snapshot: &Snapshot<'_>| {
        let height = OfKind::new(INTRUDER, CenterOfMass).measure(snapshot).y;
        if height > top {
            (top, highest) = (height, (snapshot.time() / period, snapshot.disks().to_vec()));
        }
    });
    let oscillations = if arguments.quick { arguments.oscillations.min(100) } else { arguments.oscillations };
    let end = period * f64::from(oscillations);
    let mut progress = Progress::of(format!("diameter {diameter}")).until(end);
    simulation.run_until(end, &mut (&mut series, &mut watch, &mut progress))?;
    gallery::output::warn(&simulation.warnings());

    let point = |(k, part): (usize, &[(DVec2, DVec2)])| {
        let mean = |of: fn(&(DVec2, DVec2)) -> f64| part.iter().map(of).sum::<f64>() / POINT as f64;
        [2.0 * (k as f64 + 0.5), mean(|heights| heights.0.y), mean(|heights| heights.1.y)]
    };
    let heights = series.values().chunks_exact(POINT).enumerate().map(point).collect();
    Ok(Nut { diameter, density, heights, start, highest })
}

/// Returns the intruder, on the floor or on top if it is heavy, and the grains around it, packed at random.
fn initial_disks(
    container: &Container,
    diameter: f64,
    density: f64,
    seed: u64,
) -> Result<Vec<Disk>, Box<dyn Error>> {
    let radius = 0.5 * diameter;
    let height = if density > 1.0 { PACKED + 1.0 + radius } else { 1.01 + radius };
    let intruder = Disk::new(DVec2::new(0.5 * WIDTH, height), radius)?;
    let intruder = intruder.with_mass(density * diameter * diameter)?.with_kind(INTRUDER);
    let around = container.clone().with_pegs([intruder])?;
    let grains = initial::disks_from_radii([0.5; GRAINS], 1.0)?;
    let mut disks = initial::packed_mix(&around, grains, PACKED, seed)?;
    disks.push(intruder);
    Ok(initial::with_maxwellian_velocities(disks, 0.1, seed)?)
}

impl std::fmt::Display for Nut {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [first, .., last] = self.heights.as_slice() else {
            return formatter.write_str("too short a run");
        };
        let highest = self.heights.iter().map(|[_, nut, _]| *nut).fold(0.0, f64::max);
        write!(
            formatter,
            "diameter {}, density {}: height {:.1} at first, {highest:.1} at most, {:.1} in the end (the grains: {:.1})",
            self.diameter, self.density, first[1], last[1], last[2]
        )
    }
}

fn write(arguments: &Arguments, nuts: &[Nut]) -> Result<(), Box<dyn Error>> {
    let columns = ["diameter", "density", "oscillations", "intruder_height", "grain_height"];
    let mut table = arguments.results.table("brazil_nut", &columns)?;
    for nut in nuts {
        for heights in &nut.heights {
            table.serialize((nut.diameter, nut.density, heights))?;
        }
    }
    let nut = |nut: &Nut| serde_json::json!({ "diameter": nut.diameter, "density": nut.density, "heights": nut.heights });
    let numbers = nuts.iter().map(nut).collect();
    arguments.results.finish("brazil_nut", table, &draw(nuts)?, &numbers)
}

const MARGINS: Margins = [62.0, 16.0, 28.0, 58.0];
const HEADER: f64 = 92.0;
const HEIGHT: f64 = 440.0;

const BELOW: f64 = 330.0;

/// Height of the part of the box that is shown, and its levels, with the base at its lowest.
const LEVELS: (f64, f64) = (-2.0, 32.0);

/// The largest height in the panel of curves, with room for their names.
const CURVES: f64 = 36.0;

/// The highest and the lowest position of the base.
const BASE: Look = Look::line(QUIET, "2 3").with_width(1.0);

/// The mean height of the grains.
const GRAIN: Look = Look::line(QUIET, "4 3").with_width(1.4);

/// Draws an intruder at the start and at its highest position, and all heights over time.
fn draw(nuts: &[Nut]) -> Result<Sheet, Box<dyn Error>> {
    let unit = (HEIGHT - MARGINS[2] - MARGINS[3]) / (LEVELS.1 - LEVELS.0);
    let frame = WIDTH * unit + MARGINS[0] + MARGINS[1];
    let mut sheet = Sheet::new(2.0 * frame, HEADER + HEIGHT + BELOW);
    let about = "600 grains of diameter d, A = d, ω = 2 √(g/d), q = 0.05, κ = 0.3, rough walls; dotted: highest and lowest place of the base";
    sheet.header(MARGINS[0], "A large disk among small ones, in a shaken box", &[about]);
    let Some(shown) = nuts.get(nuts.len() / 3) else { return Err("no intruder to draw".into()) };
    let (time, highest) = &shown.highest;
    let later = format!("highest, at {time:.0} oscillations");
    for (k, (disks, when)) in [(&shown.start, "at first"), (highest, &later)].into_iter().enumerate() {
        let place = Place { x: k as f64 * frame, y: HEADER, width: frame, height: HEIGHT };
        let layout = panel::axes((0.0, WIDTH), LEVELS).with_x_label("x, in diameters");
        let layout = if k == 0 { layout.with_y_label("height, in diameters") } else { layout };
        let color = |disk: &Disk| if disk.kind() == INTRUDER { VERMILION } else { "#a4abb3" };
        let base = |level: f64| BASE.curve([(0.0, level), (WIDTH, level)]);
        let plots = vec![base(-AMPLITUDE), base(AMPLITUDE), faces(disks.iter(), unit, GAP, color)];
        sheet.panel(place, MARGINS, plots, layout.with_x_tick_step(10.0));
        let words = format!("diameter {}, {when}", shown.diameter);
        sheet.text(place.x + MARGINS[0], HEADER + 20.0, SMALL, INK, &words);
    }
    let place = Place { x: 0.0, y: HEADER + HEIGHT, width: 2.0 * frame, height: BELOW };
    let panel = sheet.panel(place, MARGINS, lines(nuts), heights(nuts));
    let names: Vec<String> = nuts.iter().map(Nut::name).collect();
    let names = names.iter().map(String::as_str).enumerate().map(|(k, name)| (look(k), name));
    sheet.legend_inside(&panel, &names.chain([(GRAIN, "mean of the grains")]).collect::<Vec<_>>());
    Ok(sheet)
}

/// Returns the look of the curve of an intruder.
const fn look(number: usize) -> Look {
    Look::number(number).without_marks()
}

impl Nut {
    fn name(&self) -> String {
        let Self { diameter, density, .. } = self;
        if *density == 1.0 {
            format!("diameter {diameter}")
        } else {
            format!("diameter {diameter}, density {density}")
        }
    }
}

fn lines(nuts: &[Nut]) -> Vec<Plot> {
    let line = |(number, nut): (usize, &Nut)| {
        look(number).curve(nut.heights.iter().map(|[time, height, _]| (*time, *height)))
    };
    let grains = nuts.first().map(|nut| nut.heights.iter().map(|[time, _, grains]| (*time, *grains)));
    nuts.iter().enumerate().map(line).chain(grains.map(|points| GRAIN.curve(points))).collect()
}

fn heights(nuts: &[Nut]) -> Layout {
    let last =
        nuts.iter().filter_map(|nut| nut.heights.last()).map(|[time, ..]| time + 1.0).fold(1.0, f64::max);
    let layout = panel::axes((0.0, last), (0.0, CURVES));
    layout.with_x_label("oscillations").with_y_label("height of disk, in diameters")
}
