//! Measures of a gas, compared with theory: pair correlation at contact, pressure from collisions in the bulk
//! and on the walls, self-diffusion, velocities and their memory.
//!
//! ```text
//! cargo run --release -p gallery --bin measures
//! cargo run --release -p gallery --bin measures -- --packing-fraction 0.4 --seed 2
//! ```
//!
//! The gases are an elastic gas of 1000 disks in a periodic box, the same gas between walls, and a cooling
//! gas of smooth inelastic disks. Theory: Henderson's contact value (Mol. Phys. 30, 971 (1975)) and Enskog's
//! theory; for the cooling gas, van Noije and Ernst (Granular Matter 1, 57 (1998)).
//!
//! The example writes `measures.csv`, and `measures.svg` and `.png`: g(r), and the speeds of both gases.

mod picture;

use std::error::Error;
use std::f64::consts::PI;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::boundary::Boundary;
use granular_edmd::observable::Temperatures;
use granular_edmd::observable::{
    MeanSquaredDisplacement, PairCorrelation, Stress, TimeCorrelation, Velocities, VelocityDistribution,
    WallStress,
};
use granular_edmd::prelude::*;
use granular_edmd::simulation::RunError;

use gallery::command_line;
use gallery::results::Results;

/// Measures of a gas of hard disks, compared with theory.
#[derive(Parser)]
struct Arguments {
    /// Packing fraction of the gas, from 0.01 to 0.45.
    #[arg(long, default_value_t = 0.3, value_parser = packing_fraction)]
    packing_fraction: f64,
    /// Restitution of the gas that cools, from 0.5 to 1.
    #[arg(long, default_value_t = 0.6, value_parser = restitution)]
    restitution: f64,
    /// Seed of positions and velocities.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Runs for a tenth of the time.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

const DISKS: usize = 1000;

fn main() -> ExitCode {
    command_line::main(run)
}

fn packing_fraction(text: &str) -> Result<f64, String> {
    between(text, 0.01, 0.45)
}

fn restitution(text: &str) -> Result<f64, String> {
    between(text, 0.5, 1.0)
}

fn between(text: &str, low: f64, high: f64) -> Result<f64, String> {
    let value = command_line::positive(text)?;
    if (low..=high).contains(&value) { Ok(value) } else { Err(format!("must be from {low} to {high}")) }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    arguments.results.make_folder()?;
    let gas = Gas { packing: arguments.packing_fraction, seed: arguments.seed };
    let intervals = if arguments.quick { 100 } else { 1000 };
    gallery::say!("{DISKS} disks, packing fraction {}, {intervals} mean free times", gas.packing);
    gallery::say!("{:44} {:>24} {:>9}", "", "measured", "theory");
    let mut rows = Rows::default();
    let bulk = in_the_bulk(&gas, intervals, &mut rows)?;
    between_walls(&gas, intervals, &mut rows)?;
    let cooling = while_it_cools(arguments, intervals / 100, &mut rows)?;
    let mut table = arguments.results.table("measures", &["what", "measured", "standard_error", "theory"])?;
    rows.0.iter().try_for_each(|row| table.serialize(row))?;
    let picture = picture::draw(arguments, &gas, &bulk, &cooling);
    arguments.results.finish_table("measures", table, Some(&picture))
}

/// The rows of the table: what was measured, the value, its standard error, and what theory says.
#[derive(Default)]
struct Rows(Vec<(String, f64, Option<f64>, f64)>);

impl Rows {
    fn add(&mut self, what: &str, measured: f64, theory: f64) {
        gallery::say!("{what:44} {measured:24.4} {theory:9.4}");
        self.0.push((what.to_owned(), measured, None, theory));
    }

    fn add_estimate(&mut self, what: &str, measured: Estimate, theory: f64) {
        gallery::say!("{what:44} {measured:>24} {theory:9.4}");
        self.0.push((what.to_owned(), measured.mean(), Some(measured.standard_error()), theory));
    }
}

/// An elastic gas of disks of diameter and mass 1, at temperature 1.
struct Gas {
    packing: f64,
    seed: u64,
}

impl Gas {
    fn side(&self) -> f64 {
        (0.25 * PI * DISKS as f64 / self.packing).sqrt()
    }

    fn density(&self) -> f64 {
        4.0 * self.packing / PI
    }

    /// Returns the pair correlation at contact.
    fn contact_value(&self) -> f64 {
        (1.0 - 7.0 / 16.0 * self.packing) / (1.0 - self.packing).powi(2)
    }

    /// Returns the collisions per disk and time at temperature 1.
    fn collision_rate(&self) -> f64 {
        2.0 * PI.sqrt() * self.density() * self.contact_value()
    }

    fn settled<R: CollisionRule>(
        &self,
        container: Container,
        rule: R,
    ) -> Result<Simulation<R>, Box<dyn Error>> {
        let disks = initial::scattered(&container, DISKS, 0.5, container.domain().top, self.seed)?;
        let disks = initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, self.seed)?)?;
        let mut run = Simulation::builder(rule, container).disks(disks).build()?;
        collide(&mut run, 20)?;
        Ok(run)
    }
}

/// Runs until the disks have had `per_disk` more collisions each, on average.
fn collide<R: CollisionRule>(run: &mut Simulation<R>, per_disk: u64) -> Result<(), RunError> {
    let collisions = per_disk * DISKS as u64 / 2;
    run.run(&Limits::collisions(collisions), &mut ()).map(|_| ())
}

/// The data of the gas in the bulk that are drawn.
struct Bulk {
    pairs: Sampled<PairCorrelation>,
    velocities: Sampled<VelocityDistribution>,
}

fn in_the_bulk(gas: &Gas, intervals: u32, rows: &mut Rows) -> Result<Bulk, Box<dyn Error>> {
    let mut run = gas.settled(Container::periodic(gas.side(), gas.side())?, Elastic)?;
    let times = SampleTimes::every(1.0 / gas.collision_rate())?;
    let often = SampleTimes::every(0.1 / gas.collision_rate())?;
    let mut pairs = Sampled::new(PairCorrelation::new(4.0, 400)?, times);
    let mut displacement = MeanSquaredDisplacement::new(40, times)?;
    let mut memory = TimeCorrelation::new(Velocities, 1, often)?;
    let mut velocities = Sampled::new(VelocityDistribution::new(3.0, 30)?.about_mean(), times);
    let mut stress = Stress::new(times);
    let mut observers = (&mut pairs, (&mut displacement, &mut memory), &mut velocities, &mut stress);
    run.run_until(run.time() + f64::from(intervals) * times.interval(), &mut observers)?;
    gallery::output::warn(&run.warnings());

    let temperature = run.measure(&Temperatures).translational();
    let ideal = gas.density() * temperature;
    let compressibility = stress.tensor().pressure.mean() / ideal;
    let near: Vec<f64> = pairs.iter().skip(100).take(20).map(|(_, value)| value.mean()).collect();
    rows.add("pair correlation at contact", at_contact(&near), gas.contact_value());
    let expected = 1.0 + 2.0 * gas.packing * gas.contact_value();
    rows.add("p / nT, by the virial", compressibility, expected);
    rows.add_estimate("shear stress", stress.tensor().xy, 0.0);
    let enskog = temperature.sqrt() / (2.0 * PI.sqrt() * gas.density() * gas.contact_value());
    rows.add_estimate(
        "self-diffusion (Enskog is too small if dense)",
        displacement.diffusion_coefficient(),
        enskog,
    );
    let memory: Vec<f64> = memory.iter().map(|(_, value)| value.mean()).collect();
    let decay = (memory[0] / memory[1]).ln() * 10.0 * gas.collision_rate();
    let expected = gas.collision_rate() * temperature.sqrt();
    rows.add("decay of the velocity autocorrelation", decay, expected);
    rows.add_estimate("second cumulant of the velocities", velocities.second_cumulant(), 0.0);
    Ok(Bulk { pairs, velocities })
}

/// Returns the value at contact, where the bins begin, from a straight line fitted to the values in the bins.
fn at_contact(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let place = |at: usize| at as f64 + 0.5 - 0.5 * count;
    let mean = values.iter().sum::<f64>() / count;
    let slope: f64 = values.iter().enumerate().map(|(at, value)| place(at) * value).sum();
    let squares: f64 = (0..values.len()).map(|at| place(at) * place(at)).sum();
    mean - 0.5 * count * slope / squares
}

fn between_walls(gas: &Gas, intervals: u32, rows: &mut Rows) -> Result<(), Box<dyn Error>> {
    let side = gas.side();
    let container = Container::closed(side, side + 1.0)?.with_periodic_sides()?;
    let mut run = gas.settled(container, Elastic)?;
    let times = SampleTimes::every(1.0 / gas.collision_rate())?;
    let bulk = Region::new(DVec2::new(0.0, 5.0), DVec2::new(side, side - 4.0));
    let mut stress = Stress::new(times).within(bulk)?;
    let mut walls = WallStress::new(times).with_wall("floor", side)?.with_wall("lid", side)?;
    let end = run.time() + f64::from(intervals) * times.interval();
    run.run_until(end, &mut (&mut stress, &mut walls))?;
    gallery::output::warn(&run.warnings());
    for (what, wall) in [("pressure on the floor, and in the bulk", "floor"), ("pressure on the lid", "lid")]
    {
        if let Some(pressure) = walls.pressure(wall) {
            rows.add_estimate(what, pressure, stress.tensor().yy.mean());
        }
    }
    Ok(())
}

fn while_it_cools(
    arguments: &Arguments,
    gases: u32,
    rows: &mut Rows,
) -> Result<Sampled<VelocityDistribution>, Box<dyn Error>> {
    let r = arguments.restitution;
    let mut velocities =
        Sampled::new(VelocityDistribution::new(3.0, 30)?.about_mean(), SampleTimes::every(1.0)?);
    for seed in 0..u64::from(gases) {
        // The gas is so dilute that vortices, which are many mean free paths wide, do not fit into the box.
        let gas = Gas { packing: 0.008, seed: arguments.seed + seed };
        let container = Container::periodic(gas.side(), gas.side())?;
        let mut run = gas.settled(container, Smooth::from_restitution(r)?)?;
        for _ in 0..5 {
            collide(&mut run, 4)?;
            velocities.on_sample(&run.snapshot());
        }
    }
    let name = format!("second cumulant, cooling at r = {r}");
    rows.add_estimate(&name, velocities.second_cumulant(), second_cumulant(r));
    Ok(velocities)
}

/// Returns the second cumulant of a gas that cools at this restitution.
fn second_cumulant(r: f64) -> f64 {
    16.0 * (1.0 - r) * (1.0 - 2.0 * r * r) / (57.0 - 25.0 * r + 30.0 * r * r * (1.0 - r))
}
