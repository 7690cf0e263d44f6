//! A shock before a piston: its profile, its speed, and the jump across it.
//!
//! A piston that moves at constant speed into a gas of elastic disks at rest drives a shock ahead of itself.
//! Mass, momentum and energy are conserved across it (Rankine and Hugoniot): the three jumps follow from the
//! equation of state, and are drawn beside what the disks do. The gas is periodic upward.
//!
//! ```text
//! cargo run --release -p gallery --bin shock
//! cargo run --release -p gallery --bin shock -- --pistons 1,4 --gases 20 --out shock
//! ```
//!
//! The example writes `shock.svg`, `shock.png` and `shock.csv`. Literature: D. Henderson, Mol. Phys. 30, 971
//! (1975), for the pressure; arXiv:1108.0879 for shocks of hard disks.

use std::error::Error;
use std::f64::consts::PI;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::prelude::*;
use granular_edmd::statistics::RunningMean;
use granular_edmd::wall::Triangular;

use gallery::command_line::{self, Failure, positive};
use gallery::faces::faces;
use gallery::look::{BLUE, INK, Look, Mark, ORANGE, QUIET, SKY, VERMILION};
use gallery::panel::{self, Margins, Place};
use gallery::results::Results;
use gallery::sheet::Sheet;

/// A shock before a piston in a gas of hard disks, compared with Rankine and Hugoniot.
#[derive(Parser)]
struct Arguments {
    /// Speeds of the piston, in √(T/m); the last one is drawn.
    #[arg(long, value_delimiter = ',', default_value = "0.5,1,1.5,2,3,4", value_parser = positive)]
    pistons: Vec<f64>,
    /// Number of gases whose mean is taken.
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u64).range(2..))]
    gases: u64,
    /// Takes the mean of two gases.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

/// Length and height of the channel, and number of disks: a packing fraction of 0.1.
const LENGTH: f64 = 240.0;
const HEIGHT: f64 = 60.0;
const DISKS: usize = 1826;

/// Way of the shock at which the measurement begins and ends.
const WAY: [f64; 2] = [60.0, 160.0];

/// Width of the bins of a profile.
const BIN: f64 = 4.0;
const BINS: usize = (LENGTH / BIN) as usize;

/// The state behind a shock, and its speed.
#[derive(Clone, Copy)]
struct Shock {
    speed: f64,
    density: f64,
    temperature: f64,
}

/// What the gases did under one piston.
struct Pushed {
    piston: f64,
    theory: Shock,
    /// Speed, density and temperature.
    found: [RunningMean; 3],
    /// Number of disks, momentum and twice the energy in each bin, of all gases.
    bins: Vec<[f64; 3]>,
    shot: Vec<Disk>,
    time: f64,
}

fn density() -> f64 {
    DISKS as f64 / ((LENGTH - 1.0) * HEIGHT)
}

/// Returns the pressure of a gas of disks of diameter 1, by Henderson's equation.
fn pressure(density: f64, temperature: f64) -> f64 {
    let filled = 0.25 * PI * density;
    density * temperature * (1.0 + 0.125 * filled * filled) / (1.0 - filled).powi(2)
}

/// Returns the shock that a piston of this speed drives into the gas, at temperature 1. With the energy T of
/// a disk, U = u n₁/(n₁ - n₀), p₁ = p₀ + n₀Uu and T₁ = 1 + (p₁ + p₀)(1/n₀ - 1/n₁)/2.
fn rankine_hugoniot(piston: f64) -> Shock {
    let (before, ahead) = (density(), pressure(density(), 1.0));
    let behind = |density: f64| {
        let speed = piston * density / (density - before);
        let pushed = ahead + before * speed * piston;
        let temperature = 1.0 + 0.5 * (pushed + ahead) * (1.0 / before - 1.0 / density);
        (Shock { speed, density, temperature }, pushed)
    };
    let (mut low, mut high) = (1.0001 * before, 3.0 * before);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        let (shock, pushed) = behind(middle);
        if pressure(middle, shock.temperature) < pushed { low = middle } else { high = middle }
    }
    behind(low).0
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let gases = if arguments.quick { 2 } else { arguments.gases };
    let pushed = arguments.pistons.iter().map(|&piston| pushed(piston, gases));
    let pushed = pushed.collect::<Result<Vec<_>, _>>().map_err(Failure::run)?;
    write(arguments, &pushed).map_err(Failure::run)
}

fn gas(piston: f64, seed: u64) -> Result<Simulation<Elastic>, Box<dyn Error>> {
    let channel = Container::closed(LENGTH, HEIGHT)?.with_periodic_ends()?;
    let disks = initial::scattered(&channel, DISKS, 0.5, HEIGHT, seed)?;
    let disks = initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, seed)?)?;
    // From phase 0, a quarter of a period at constant speed.
    let way = 0.8 * LENGTH;
    let channel = channel.with_motion(Wall::Left, Triangular::new(way, 0.5 * PI * piston / way)?)?;
    Ok(Simulation::builder(Elastic, channel).disks(disks).build()?)
}

/// Pushes several gases and measures the shock: its speed by the growth of the momentum, n₀ U u for each unit
/// of height, density and temperature in the middle of the gas behind it.
fn pushed(piston: f64, gases: u64) -> Result<Pushed, Box<dyn Error>> {
    let theory = rankine_hugoniot(piston);
    let times = WAY.map(|way| way / theory.speed);
    let [back, front] = [piston * times[1], WAY[1]];
    let [from, to] = [0.2, 0.7].map(|share| back + share * (front - back));
    let momentum = |disks: &[Disk]| disks.iter().map(|disk| disk.velocity().x).sum::<f64>();
    let mut found = [RunningMean::default(); 3];
    let (mut bins, mut shot) = (vec![[0.0; 3]; BINS], Vec::new());
    for seed in 0..gases {
        let mut run = gas(piston, seed)?;
        run.run_until(times[0], &mut ())?;
        let first = momentum(&run.disks());
        run.run_until(times[1], &mut ())?;
        shot = run.disks();
        let pushed = (momentum(&shot) - first) / (HEIGHT * (times[1] - times[0]));
        found[0].push(pushed / (density() * piston));
        let inside: Vec<&Disk> = shot.iter().filter(|disk| (from..to).contains(&disk.position().x)).collect();
        found[1].push(inside.len() as f64 / (HEIGHT * (to - from)));
        let energy: f64 =
            inside.iter().map(|disk| (disk.velocity() - piston * DVec2::X).length_squared()).sum();
        found[2].push(0.5 * energy / inside.len() as f64);
        for disk in &shot {
            let bin = &mut bins[((disk.position().x / BIN) as usize).min(BINS - 1)];
            let velocity = disk.velocity();
            let values = [1.0, velocity.x, velocity.length_squared()];
            bin.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
    }
    Ok(Pushed { piston, theory, found, bins, shot, time: times[1] })
}

fn write(arguments: &Arguments, all: &[Pushed]) -> Result<(), Box<dyn Error>> {
    let columns = ["piston", "speed", "speed_error", "theory", "density", "theory_of_density"];
    let columns = [&columns[..], &["temperature", "theory_of_temperature"]].concat();
    let mut table = arguments.results.table("shock", &columns)?;
    for Pushed { piston, theory, found: [speed, density, temperature], .. } in all {
        gallery::say!(
            "u = {piston}: U = {:.3} ± {:.3}, theory {:.3}; n {:.4}, theory {:.4}; T {:.3}, theory {:.3}",
            speed.mean(),
            speed.standard_error(),
            theory.speed,
            density.mean(),
            theory.density,
            temperature.mean(),
            theory.temperature
        );
        let states = (density.mean(), theory.density, temperature.mean(), theory.temperature);
        table.serialize((piston, speed.mean(), speed.standard_error(), theory.speed, states))?;
    }
    let Some(last) = all.last() else { return Err("no piston".into()) };
    arguments.results.finish_table("shock", table, Some(&draw(all, last)))
}

const MARGINS: Margins = [66.0, 16.0, 14.0, 58.0];
/// The same for the panels below, whose numbers are wider.
const LOWER: Margins = [84.0, MARGINS[1], MARGINS[2], MARGINS[3]];
const HEADER: f64 = 66.0;
const WIDE: f64 = 1000.0;
const LOW: f64 = 330.0;

/// Draws the gas, its profiles, and the speeds of the shocks.
fn draw(all: &[Pushed], last: &Pushed) -> Sheet {
    let unit = (WIDE - MARGINS[0] - MARGINS[1]) / LENGTH;
    let tall = HEIGHT * unit + MARGINS[2] + MARGINS[3];
    let mut sheet = Sheet::new(WIDE, HEADER + tall + LOW);
    let about = format!(
        "Elastic disks at packing fraction 0.1; a piston comes from the left at {} thermal speeds √(T/m)",
        last.piston
    );
    sheet.header(MARGINS[0], "A shock before a piston", &[&about]);
    let place = Place { x: 0.0, y: HEADER, width: WIDE, height: tall };
    let layout = panel::axes((0.0, LENGTH), (0.0, HEIGHT)).with_x_label("x, in diameters");
    let color = |disk: &Disk| match disk.velocity().length() {
        speed if speed < 2.0 => BLUE,
        speed if speed < 4.0 => SKY,
        _ => ORANGE,
    };
    let at = last.piston * last.time;
    let wall = Look::line(INK, "").with_width(5.0).curve([(at, 0.0), (at, HEIGHT)]);
    let front = Look::line(VERMILION, "8 4").curve([(WAY[1], 0.0), (WAY[1], HEIGHT)]);
    let plots = vec![faces(last.shot.iter(), unit, 0.2, color), wall, front];
    sheet.panel(place, MARGINS, plots, layout.with_y_label("y, in diameters"));
    let third = |number: usize| Place {
        x: number as f64 * WIDE / 3.0,
        y: HEADER + tall,
        width: WIDE / 3.0,
        height: LOW,
    };
    let volume = BIN * HEIGHT * last.found[0].count() as f64;
    let profile = |of: fn([f64; 3], f64) -> f64| {
        let middle = |bin: usize| (bin as f64 + 0.5) * BIN;
        let full = (0..BINS).filter(move |&bin| middle(bin) > at + BIN && middle(bin) < LENGTH - BIN);
        full.map(|bin| (middle(bin), of(last.bins[bin], volume))).collect::<Vec<_>>()
    };
    let densities = profile(|[count, ..], volume| count / volume);
    let temperatures =
        profile(|[count, momentum, squares], _| 0.5 * (squares / count - (momentum / count).powi(2)));
    let theory = last.theory;
    draw_profile(&mut sheet, third(0), "density, in 1/d²", &densities, at, [theory.density, density()]);
    draw_profile(&mut sheet, third(1), "temperature, in T", &temperatures, at, [theory.temperature, 1.0]);
    draw_speeds(&mut sheet, third(2), all);
    sheet
}

/// Draws a profile beside the step of the theory from behind the shock to ahead of it.
fn draw_profile(
    sheet: &mut Sheet,
    place: Place,
    name: &str,
    profile: &[(f64, f64)],
    piston: f64,
    [behind, ahead]: [f64; 2],
) {
    let layout = panel::axes((0.0, LENGTH), (0.0, 1.25 * behind)).with_x_label("x, in diameters");
    let (measured, theory) = (Look::marks(BLUE, Mark::Disk).with_size(3.0), Look::line(VERMILION, "8 4"));
    let step = theory.curve([(piston, behind), (WAY[1], behind), (WAY[1], ahead), (LENGTH, ahead)]);
    let panel = sheet.panel(place, LOWER, vec![step], layout.with_y_label(name));
    sheet.marks(&panel, measured, profile.iter().copied());
}

fn draw_speeds(sheet: &mut Sheet, place: Place, all: &[Pushed]) {
    let fastest = 1.1 * all.iter().map(|pushed| pushed.piston).fold(0.5, f64::max);
    let highest = rankine_hugoniot(fastest).speed;
    let layout = panel::axes((0.0, fastest), (0.0, highest)).with_x_label("speed of the piston");
    let (measured, theory) = (Look::marks(BLUE, Mark::Disk), Look::line(VERMILION, "8 4"));
    let speeds = (1..=60).map(|step| fastest * f64::from(step) / 60.0);
    let curves = vec![
        theory.curve(speeds.map(|piston| (piston, rankine_hugoniot(piston).speed))),
        Look::line(QUIET, "1 3").with_width(1.2).curve([(0.0, 0.0), (fastest, fastest)]),
    ];
    let panel = sheet.panel(place, LOWER, curves, layout.with_y_label("speed of the shock"));
    let points = || all.iter().map(|pushed| (pushed.piston, &pushed.found[0]));
    let bar = |(x, speed): (f64, &RunningMean)| {
        [-1.0, 1.0].map(|side| (x, speed.mean() + side * speed.standard_error()))
    };
    sheet.bars(&panel, measured, points().map(bar));
    sheet.marks(&panel, measured, points().map(|(x, speed)| (x, speed.mean())));
    let names = [(measured, "disks"), (theory, "Rankine & Hugoniot")];
    sheet.legend((panel.place.x + 14.0, panel.place.y + 24.0), &names);
}
