//! The time per collision in vessels of few and many bricks, divided by the time in a plain box.
//!
//! ```sh
//! cargo run --release -p tools --bin vessels
//! ```
//!
//! Each vessel holds an elastic gas of 400 disks without gravity, at an area fraction of 0.4. The vessels run
//! alternately, for `ROUNDS` intervals of `COLLISIONS` collisions each, with disks or walls, and the shortest
//! time of each vessel counts.

use std::f64::consts::{PI, TAU};
use std::process::ExitCode;

use benches::{Outcome, ask};
use granular_edmd::boundary::{Boundary, Container, Part};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::BoxedBoundary;
use granular_edmd::speed::Meter;
use granular_edmd::{Simulation, initial};

const DISKS: usize = 400;
const RADIUS: f64 = 0.5;
const AREA_FRACTION: f64 = 0.4;

/// Radius of the pegs, so small that hundreds of them leave the gas its room.
const PEG: f64 = 0.05;

fn main() -> ExitCode {
    benches::report(run())
}

/// A gas in a vessel.
struct Gas {
    name: &'static str,
    run: Simulation<Elastic, BoxedBoundary>,
    best: f64,
}

impl Gas {
    fn new(name: &'static str, boundary: impl Boundary + Send + Sync + 'static) -> Outcome<Self> {
        let disks = initial::packed_mix(&boundary, disks()?, 1e3, 1)?;
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
        let boundary: BoxedBoundary = Box::new(boundary);
        let mut run = Simulation::builder(Elastic, boundary).disks(disks).build()?;
        run.run_until(10.0, &mut ())?;
        Ok(Self { name, run, best: f64::INFINITY })
    }

    fn stretch(&mut self, collisions: u32) -> Outcome<()> {
        let meter = Meter::start(&self.run);
        for _ in 0..collisions {
            self.run.step_until(1e9, &mut ())?;
        }
        self.best = self.best.min(meter.report(&self.run).seconds / f64::from(collisions));
        Ok(())
    }
}

fn disks() -> Outcome<Vec<granular_edmd::Disk>> {
    Ok(initial::disks_from_radii(vec![RADIUS; DISKS], 1.0)?)
}

/// Returns the area of the vessel.
fn area() -> f64 {
    DISKS as f64 * PI * RADIUS * RADIUS / AREA_FRACTION
}

fn square() -> Outcome<Container> {
    Ok(Container::closed(area().sqrt(), area().sqrt())?)
}

fn polygon(sides: u32) -> Outcome<Container> {
    let step = TAU / f64::from(sides);
    let radius = (area() / (0.5 * f64::from(sides) * step.sin())).sqrt();
    let corner = |k: u32| radius * DVec2::from_angle(step * (f64::from(k) + 0.5));
    Ok(Container::around([("polygon", Part::polygon((0..sides).map(corner))?)])?)
}

fn pegs(rows: u32) -> Outcome<Container> {
    let mut vessel = square()?;
    let pitch = area().sqrt() / f64::from(rows);
    for (row, column) in (0..rows).flat_map(|row| (0..rows).map(move |column| (row, column))) {
        let place = pitch * DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
        vessel.add_part(format!("peg {row} {column}"), Part::peg(place, PEG)?)?;
    }
    Ok(vessel)
}

fn run() -> Outcome<()> {
    let is_test = ask::is_test();
    let rounds = if is_test { 1 } else { ask::number("ROUNDS", 40)? };
    let collisions = if is_test { 100 } else { ask::number("COLLISIONS", 10_000)? };
    benches::print_circumstances();
    let mut gases = vec![
        Gas::new("box", square()?)?,
        Gas::new("box as a vessel", square()?)?,
        Gas::new("polygon of 4 sides", polygon(4)?)?,
        Gas::new("polygon of 40 sides", polygon(40)?)?,
        Gas::new("polygon of 400 sides", polygon(400)?)?,
        Gas::new("circle", Container::around([("drum", Part::drum(DVec2::ZERO, (area() / PI).sqrt())?)])?)?,
        Gas::new("box with 4 pegs", pegs(2)?)?,
        Gas::new("box with 36 pegs", pegs(6)?)?,
        Gas::new("box with 400 pegs", pegs(20)?)?,
    ];
    for _ in 0..rounds {
        for gas in &mut gases {
            gas.stretch(collisions)?;
        }
    }
    println!("\n| vessel | ns per collision | over the box | with walls |\n|---|---|---|---|");
    let plain = gases[0].best;
    for Gas { name, run, best } in &gases {
        let counters = run.counters();
        let walls =
            counters.wall_collisions as f64 / (counters.wall_collisions + counters.disk_collisions) as f64;
        println!("| {name} | {:.0} | {:.2} | {:.0} % |", 1e9 * best, best / plain, 100.0 * walls);
    }
    Ok(())
}
