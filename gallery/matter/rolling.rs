//! Rolling friction: disks that roll to rest, and grains that flow down a rough slope more slowly.
//!
//! A lone disk rolls on a floor. Rolling friction of the coefficient μ exerts the torque `μmgR` on it, so it
//! decelerates at `2μg/3`, as a disk in lasting contact would. In another run, 140 grains flow down a slope,
//! and a line across it counts them.
//!
//! ```text
//! cargo run --release -p gallery --bin rolling
//! cargo run --release -p gallery --bin rolling -- --coefficients 0,0.3 --time 200 --out rolling
//! ```
//!
//! The example writes `rolling.svg`, `rolling.png` and `rolling.csv`. Literature: K. Iwashita and M. Oda, J.
//! Eng. Mech. 124, 285 (1998); N. Estrada, A. Taboada and F. Radjaï, Phys. Rev. E 78, 021301 (2008).

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::boundary::Container;
use granular_edmd::collision::RollingFriction;
use granular_edmd::observable::{Crossings, measured_by};
use granular_edmd::prelude::*;

use gallery::command_line::{self, Failure, non_negative, positive};
use gallery::faces::{GAP, faces};
use gallery::look::{BLUE, INK, Look, Mark, QUIET, SKY, VERMILION};
use gallery::panel::{self, Margins, Place, SMALL};
use gallery::progress::Progress;
use gallery::results::Results;
use gallery::sheet::Sheet;

/// Disks and grains with rolling friction.
#[derive(Parser)]
struct Arguments {
    /// Coefficients of rolling friction.
    #[arg(long, value_delimiter = ',', default_value = "0,0.1,0.2,0.4", value_parser = non_negative)]
    coefficients: Vec<f64>,
    /// Time for which each flow is measured, after an equal time to settle, in units of √(d/g).
    #[arg(long, default_value_t = 80.0, value_parser = positive)]
    time: f64,
    /// Measures for a time of 10 at most.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const GRAINS: usize = 140;
const SLOPE: f64 = 20.0;

/// Number of the bumps of the slope, and their distance.
const BUMPS: u32 = 14;
const PITCH: f64 = 1.35;
const WIDTH: f64 = BUMPS as f64 * PITCH;
const TOP: f64 = 14.0;

/// Speed at which the lone disk rolls at first, and the time for which it is watched.
const SPEED: f64 = 2.0;
const LONG: f64 = 60.0;

struct Rolled {
    coefficient: f64,
    /// Times and speeds of the lone disk.
    speeds: Vec<(f64, f64)>,
    flux: Estimate,
    shot: Vec<Disk>,
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let rolled = |&coefficient: &f64| {
        let (speeds, (flux, shot)) = (speeds(coefficient)?, flow(arguments, coefficient)?);
        gallery::say!("μ = {coefficient}: {flux} grains flow in each unit of time");
        Ok(Rolled { coefficient, speeds, flux, shot })
    };
    let all = arguments.coefficients.iter().map(rolled).collect::<Result<Vec<_>, Box<dyn Error>>>();
    write(arguments, &all.map_err(Failure::run)?).map_err(Failure::run)
}

/// Returns the rule of all runs: a least rebound, friction 0.5, and rolling friction.
fn rule(coefficient: f64, least: f64) -> Result<impl CollisionRule, ParameterError> {
    RollingFriction::new(LeastRebound::new(Frictional::from_restitution(0.7, 0.0, 0.5)?, least)?, coefficient)
}

/// Lets a disk roll on a floor, and returns its speed over time.
fn speeds(coefficient: f64) -> Result<Vec<(f64, f64)>, Box<dyn Error>> {
    let container = Container::open(10.0)?.with_periodic_sides()?;
    let disk = Disk::new(DVec2::new(5.0, 0.5), 0.5)?.with_velocity(SPEED * DVec2::X)?;
    let disk = disk.with_angular_velocity(-SPEED / disk.radius())?;
    let mut run =
        Simulation::builder(rule(coefficient, 0.01)?, container).disks([disk]).gravity(1.0).build()?;
    let speed = measured_by(|snapshot: &Snapshot<'_>| snapshot.mean(|disk| disk.velocity().x));
    let mut series = Series::new(speed, SampleTimes::every(2.0)?);
    run.run_until(LONG, &mut series)?;
    Ok(series.iter().map(|(time, &speed)| (time, speed)).collect())
}

/// Returns the speed of a disk in lasting contact.
fn rolling_speed(coefficient: f64, time: f64) -> f64 {
    (SPEED - 2.0 / 3.0 * coefficient * time).max(0.0)
}

/// Returns the number of grains that flow down a slope per unit of time, and the grains at the end.
fn flow(arguments: &Arguments, coefficient: f64) -> Result<(Estimate, Vec<Disk>), Box<dyn Error>> {
    let ground = Container::open(WIDTH)?.with_periodic_sides()?.with_pegs(bumps()?)?;
    let grains = initial::disks_from_radii(initial::Radii::uniform(0.4, 0.5)?.draw(GRAINS, 1), 1.0)?;
    let disks = initial::scattered_mix(&ground, grains, 24.0, 1)?;
    let gravity = Gravity::tilted(1.0, SLOPE.to_radians())?;
    let mut run =
        Simulation::builder(rule(coefficient, 0.05)?, ground).disks(disks).gravity(gravity).build()?;
    let time = if arguments.quick { arguments.time.min(10.0) } else { arguments.time };
    let mut progress = Progress::of(format!("rolling friction {coefficient}")).until(2.0 * time);
    run.run_until(time, &mut progress)?;
    // Forward is to the left of the line, which points to the ground: down the slope.
    let line = [DVec2::new(0.5 * WIDTH, 10.0 * TOP), DVec2::new(0.5 * WIDTH, 0.0)];
    let times = SampleTimes::every(0.05 * time)?.starting_at(time)?;
    let mut crossings = Crossings::new(line, times)?;
    run.run_until(2.0 * time, &mut (&mut crossings, &mut progress))?;
    gallery::output::warn(&run.warnings());
    Ok((crossings.flux()?, run.disks()))
}

fn bumps() -> Result<Vec<Disk>, ParameterError> {
    (0..BUMPS).map(|k| Disk::new(DVec2::new(PITCH * (0.5 + f64::from(k)), 0.0), 0.5)).collect()
}

fn write(arguments: &Arguments, all: &[Rolled]) -> Result<(), Box<dyn Error>> {
    let mut table = arguments.results.table("rolling", &["coefficient", "flux", "flux_error"])?;
    for Rolled { coefficient, flux, .. } in all {
        table.serialize((coefficient, flux.mean(), flux.standard_error()))?;
    }
    arguments.results.finish_table("rolling", table, Some(&draw(all)?))
}

const MARGINS: Margins = [62.0, 16.0, 28.0, 58.0];
const HEADER: f64 = 100.0;
const HEIGHT: f64 = 330.0;
const COLUMN: f64 = 480.0;

/// Draws the speeds, the flow as a function of the coefficient, and the slope with the first and the last
/// coefficient.
fn draw(all: &[Rolled]) -> Result<Sheet, Box<dyn Error>> {
    let mut sheet = Sheet::new(2.0 * COLUMN, HEADER + 2.0 * HEIGHT);
    let about = "Grains of diameters from 0.8 d to d: r = 0.7, κ = 0.5, rolling friction μ; above, a disk on a floor; below, 140 on a rough slope of 20°, dark blue if slower than 0.5 √(gd), orange if faster than 1.5, light blue between";
    sheet.header(MARGINS[0], "Rolling friction", &[about]);
    let place = Place { x: 0.0, y: HEADER, width: COLUMN, height: HEIGHT };
    let layout = panel::axes((0.0, LONG), (0.0, 1.1 * SPEED)).with_x_label("time, in √(d/g)");
    let law = |one: &Rolled| {
        let speed = |k: u32| (0.1 * f64::from(k), rolling_speed(one.coefficient, 0.1 * f64::from(k)));
        Look::line(QUIET, "").with_width(1.2).curve((0..600).map(speed))
    };
    let layout = layout.with_y_label("speed of a disk, in √(gd)");
    let panel = sheet.panel(place, MARGINS, all.iter().map(law).collect(), layout);
    let look = |number: usize| Look::number(number).without_line().with_size(3.5);
    for (number, one) in all.iter().enumerate() {
        sheet.marks(&panel, look(number), one.speeds.iter().copied());
    }
    let names: Vec<_> = all.iter().map(|one| format!("μ = {}", one.coefficient)).collect();
    let names = names.iter().enumerate().map(|(number, name)| (look(number), name.as_str()));
    let names: Vec<_> = names.chain([(Look::line(QUIET, "").with_width(1.2), "2μg/3")]).collect();
    sheet.legend((panel.place.x + 0.7 * panel.place.width, panel.place.y + 44.0), &names);

    let widest = 1.1 * all.iter().map(|one| one.coefficient).fold(0.01, f64::max);
    let most = 1.2 * all.iter().map(|one| one.flux.mean()).fold(1.0, f64::max);
    let layout = panel::axes((-0.02, widest), (0.0, most)).with_x_label("rolling friction μ");
    let layout = layout.with_y_label("flow, in grains per √(d/g)");
    let panel = sheet.panel(Place { x: COLUMN, ..place }, MARGINS, Vec::new(), layout);
    let measured = Look::marks(BLUE, Mark::Disk);
    let ends = |one: &Rolled| {
        [-1.0, 1.0].map(|sign| (one.coefficient, one.flux.mean() + sign * one.flux.standard_error()))
    };
    sheet.bars(&panel, measured, all.iter().map(ends));
    sheet.marks(&panel, measured, all.iter().map(|one| (one.coefficient, one.flux.mean())));

    let place = Place { y: HEADER + HEIGHT, ..place };
    for (number, one) in [all.first(), all.last()].into_iter().flatten().enumerate() {
        draw_slope(&mut sheet, Place { x: number as f64 * COLUMN, ..place }, one)?;
    }
    Ok(sheet)
}

fn draw_slope(sheet: &mut Sheet, place: Place, one: &Rolled) -> Result<(), Box<dyn Error>> {
    let unit = (COLUMN - MARGINS[0] - MARGINS[1]) / WIDTH;
    let top = (HEIGHT - MARGINS[2] - MARGINS[3]) / unit;
    let layout = panel::axes((0.0, WIDTH), (0.0, top)).with_x_label("down the slope, in diameters");
    let color = |grain: &Disk| match grain.velocity().x {
        speed if speed < 0.5 => BLUE,
        speed if speed < 1.5 => SKY,
        _ => VERMILION,
    };
    let seen = one.shot.iter().filter(|grain| grain.position().y < top);
    let plots = vec![faces(seen, unit, GAP, color), faces(bumps()?.iter(), unit, GAP, |_| INK)];
    sheet.panel(place, MARGINS, plots, layout.with_y_label("height, in diameters"));
    let words = format!("μ = {}", one.coefficient);
    sheet.text(place.x + MARGINS[0], place.y + 20.0, SMALL, INK, &words);
    Ok(())
}
