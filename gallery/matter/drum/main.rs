//! A drum, half full, that turns: how steep the surface is, and how the grains flow.
//!
//! The rim is a circle whose surface turns, with pins that stick out and turn with it. Deep in the drum the
//! grains turn as a body, and at the surface a layer flows down, as in simulations of soft disks
//! (H. Oba and M. Otsuki, arXiv:2407.19466). The faster the drum turns, the steeper the surface is. The angle
//! depends on the Froude number `Ω²R/g` (A. Brucks et al., Phys. Rev. E 75, 032301 (2007)).
//!
//! Unlike in a real drum, grains lie on each other by collisions, not by lasting contacts. Collisions slower
//! than 0.1 lose nothing (`ElasticBelow`), so grains keep a little heat, and the angle depends on the remedy:
//! if slow collisions have no friction, it is 6° less. There are no avalanches with rests between them, since
//! the drum must turn fast, once in 50 to 200 times the time in which a grain falls half its diameter. These
//! are Froude numbers of rolling to cataracting (J. Mellmann, Powder Technol. 118, 251 (2001)). The drum is
//! 24 grains wide, and there are no front and back walls.
//!
//! ```text
//! cargo run --release -p gallery --bin drum
//! cargo run --release -p gallery --bin drum -- --rates 0.06 --pins 0 --turns 3 --out smooth
//! ```
//!
//! The example writes `drum.svg`, `drum.png` and `drum.csv`.

mod measure;
mod picture;

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use granular_edmd::boundary::{Brick, Domain, WallError};
use granular_edmd::collision::{ElasticBelow, TangentialResponse};
use granular_edmd::initial::Radii;
use granular_edmd::prelude::*;
use granular_edmd::statistics::BlockedMean;

use gallery::command_line::{self, Failure, positive, whole};
use gallery::flow;
use gallery::progress::Progress;
use gallery::results::Results;
use measure::{Depths, Slope};

/// A drum, half full, that turns: the angle of the surface, and the flow.
#[derive(Parser)]
struct Arguments {
    /// Angular velocities of the drum, in √(g/d).
    #[arg(long, value_delimiter = ',', default_value = "0.03,0.06,0.12", value_parser = positive)]
    rates: Vec<f64>,
    /// Radius of the drum, in diameters of the largest grain.
    #[arg(long, default_value_t = 12.0, value_parser = positive)]
    radius: f64,
    /// Number of pins on the rim; 0 for a smooth rim.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u16).range(0..=200))]
    pins: u16,
    /// Number of turns during which the drum is measured, after half a turn.
    #[arg(long, default_value_t = 1.5, value_parser = positive)]
    turns: f64,
    /// Closing speed below which collisions lose nothing.
    #[arg(long, default_value_t = 0.1, value_parser = positive)]
    speed: f64,
    /// Coefficient of friction.
    #[arg(long, default_value_t = 0.5, value_parser = positive)]
    friction: f64,
    /// Samples per turn.
    #[arg(long, default_value_t = 200, value_parser = whole::<100_000>)]
    samples: u64,
    /// Seed of positions and velocities.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Measures only the last of the rates, for at most a quarter of a turn.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

/// Length by which pins stick out of the rim.
const PIN: f64 = 0.6;

/// Smallest radius of a drum in which there is a surface.
const LEAST_RADIUS: f64 = 3.0;

/// Share of a turn that is not measured.
const SPIN_UP: f64 = 0.5;

/// The motion of the grains in a drum.
struct Turned {
    rate: f64,
    froude: f64,
    /// Numbers of turns, and the surface at these times.
    surfaces: Vec<(f64, Slope)>,
    angle: Estimate,
    /// Standard deviation of the angle over time.
    scatter: f64,
    depths: Depths,
    flow: Sampled<Fields>,
    /// The grains at the end, and how many turns the drum has done.
    disks: Vec<Disk>,
    turns: f64,
}

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.radius < LEAST_RADIUS {
        let message = format!("--radius {}: at least {LEAST_RADIUS} is needed", arguments.radius);
        return Err(Failure::usage(message));
    }
    arguments.results.make_folder()?;
    let mut drums = Vec::new();
    let skipped = if arguments.quick { arguments.rates.len().saturating_sub(1) } else { 0 };
    for &rate in arguments.rates.iter().skip(skipped) {
        let since = Instant::now();
        let drum = turned(arguments, rate).map_err(Failure::run)?;
        gallery::say!("{drum}; {:.1} s", since.elapsed().as_secs_f64());
        drums.push(drum);
    }
    write(arguments, &drums).map_err(Failure::run)
}

/// Turns a drum, and measures it once it has settled.
fn turned(arguments: &Arguments, rate: f64) -> Result<Turned, Box<dyn Error>> {
    let rule = Frictional::from_inelasticity(0.1, 0.1, arguments.friction)?;
    // Slow contacts hold the surfaces of the grains together. Without that, they would slide.
    let rule =
        ElasticBelow::new(rule, arguments.speed)?.with_tangential_response(TangentialResponse::Reversing);
    let drum = drum(arguments, rate)?;
    let disks = half_filled(arguments)?;
    let Domain { left, right, bottom, top, .. } = drum.domain();
    let mut simulation = Simulation::builder(rule, drum).disks(disks).gravity(1.0).build()?;
    let period = TAU / rate;
    let turns = if arguments.quick { arguments.turns.min(0.25) } else { arguments.turns };
    let end = (SPIN_UP + turns) * period;
    let mut progress = Progress::of(format!("rate {rate}")).until(end);
    simulation.run_until(SPIN_UP * period, &mut progress)?;

    let mut surfaces = Vec::new();
    let mut depths = Depths::new(arguments.radius);
    let times = SampleTimes::every(period / arguments.samples as f64)?.starting_at(SPIN_UP * period)?;
    let (low, high) = (DVec2::new(left, bottom), DVec2::new(right, top));
    let mut flow = flow::on_squares(low, high, (0.6 * (right - left)) as usize, times)?;
    let mut watch = on_sample(times, |snapshot: &Snapshot<'_>| {
        if let Some(surface) = Slope::of(snapshot.disks(), arguments.radius) {
            depths.add(snapshot.disks(), surface.angle);
            surfaces.push((snapshot.time() / period, surface));
        }
    });
    simulation.run_until(end, &mut (&mut watch, &mut flow, &mut progress))?;
    gallery::output::warn(&simulation.warnings());

    let mut angles = BlockedMean::new();
    for (_, surface) in &surfaces {
        angles.push(surface.angle.to_degrees());
    }
    let (angle, scatter) = (angles.estimate(), angles.ungrouped().standard_deviation());
    let (froude, disks) = (rate * rate * arguments.radius, simulation.disks());
    Ok(Turned { rate, froude, surfaces, angle, scatter, depths, flow, disks, turns: SPIN_UP + turns })
}

/// Returns the drum about the origin, which turns counterclockwise.
fn drum(arguments: &Arguments, rate: f64) -> Result<Container, WallError> {
    let rim = Part::drum(DVec2::ZERO, arguments.radius)?.with_rotation(DVec2::ZERO, rate)?;
    let vessel = Container::around([("rim", rim)])?;
    if arguments.pins == 0 {
        return Ok(vessel);
    }
    let pin = |k: u16| {
        let angle = TAU * f64::from(k) / f64::from(arguments.pins);
        Brick::point((arguments.radius - PIN) * DVec2::from_angle(angle))
    };
    let pins = (0..arguments.pins).map(pin).collect::<Result<Vec<_>, _>>()?;
    vessel.with_part("pins", Part::new(pins)?.with_rotation(DVec2::ZERO, rate)?)
}

/// Returns grains that fill the lower half of a drum that stands still.
fn half_filled(arguments: &Arguments) -> Result<Vec<Disk>, Box<dyn Error>> {
    /// Area fraction of grains that lie loosely.
    const LOOSE: f64 = 0.8;
    let room = 0.5 * PI * (arguments.radius - 0.5).powi(2);
    let count = LOOSE * room / (PI * 0.475 * 0.475);
    let radii = Radii::uniform(0.45, 0.5)?.draw(count as usize, arguments.seed);
    // Pins turn, and grains are packed only in vessels whose walls stand still.
    let still = Container::around([("rim", Part::drum(DVec2::ZERO, arguments.radius - PIN)?)])?;
    let disks = initial::disks_from_radii(radii, 1.0)?;
    let disks = initial::packed_mix(&still, disks, 0.35 * arguments.radius, arguments.seed)?;
    Ok(initial::with_maxwellian_velocities(disks, 0.01, arguments.seed)?)
}

impl std::fmt::Display for Turned {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { rate, froude, angle, scatter, depths, .. } = self;
        let (mean, error) = (angle.mean(), angle.standard_error());
        write!(formatter, "rate {rate}, Froude number {froude:.3}: angle {mean:.1}° ± {error:.1}°, ")?;
        write!(
            formatter,
            "scatter {scatter:.1}°; grains at the rim turn {:.2} times as fast; ",
            depths.grip(*rate)
        )?;
        write!(formatter, "{} grains", self.disks.len())
    }
}

fn write(arguments: &Arguments, drums: &[Turned]) -> Result<(), Box<dyn Error>> {
    let columns = ["rate", "turns", "angle_degrees", "height_in_middle"];
    let mut table = arguments.results.table("drum", &columns)?;
    for drum in drums {
        for (turns, surface) in &drum.surfaces {
            table.serialize((drum.rate, turns, surface.angle.to_degrees(), surface.middle))?;
        }
    }
    let drum = |drum: &Turned| {
        serde_json::json!({
            "rate": drum.rate, "froude": drum.froude, "angle": drum.angle.mean(),
            "standard_error": drum.angle.standard_error(), "converged": drum.angle.is_converged(),
            "scatter": drum.scatter, "grip": drum.depths.grip(drum.rate),
            "velocity_by_depth": drum.depths.profile(),
        })
    };
    let numbers = drums.iter().map(drum).collect();
    arguments.results.finish("drum", table, &picture::draw(arguments, drums), &numbers)
}
