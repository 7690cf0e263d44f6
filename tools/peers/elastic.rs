//! Elastic disks in a periodic square: the same states in this crate and in another event-driven code.

use std::f64::consts::PI;
use std::path::Path;

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::observable::{SampleTimes, Stress, Temperatures};
use granular_edmd::simulation::Limits;
use granular_edmd::speed::{Meter, Quartiles};
use granular_edmd::{Simulation, initial};

use super::measured::{Measured, Speed, Start};
use super::smallenburg::{Smallenburg, compiler};
use benches::{Outcome, ask};

/// Number of disks and area fractions.
const STATES: [(usize, &[f64]); 3] =
    [(1000, &[0.1, 0.3, 0.5, 0.65]), (10_000, &[0.1, 0.3, 0.5, 0.65]), (100_000, &[0.1, 0.3, 0.5])];

/// Collisions of each disk until the gas has forgotten its lattice.
const SETTLE: u64 = 50;

/// Smallest number of collisions in an interval.
const COLLISIONS: u64 = 300_000;

/// Largest difference between the collision rates and pressures of two programs in the same state.
const ALIKE: f64 = 0.02;

/// A gas of this crate, which continues from interval to interval.
struct Gas {
    run: Simulation<Elastic>,
    side: f64,
    collisions: u64,
}

/// Prints the table for the code in this folder.
pub(crate) fn compare(folder: &Path) -> Outcome<()> {
    let rounds = ask::number("ROUNDS", 9)?;
    println!(
        "Elastic disks, periodic square; time on the processor, medians (and quartiles) of {rounds} pairs."
    );
    println!("{}\nSmallenburg’s code: {}\n", benches::machine(), compiler());
    println!(
        "| N, φ | this crate, ns a collision | its time | ratio | rate, pressure: its over ours | its settings |"
    );
    println!("|---|---|---|---|---|---|");
    for (count, fractions) in STATES {
        for &fraction in fractions {
            row(&mut Gas::settled(count, fraction)?, fraction, folder, rounds)?;
        }
    }
    Ok(())
}

fn row(gas: &mut Gas, fraction: f64, folder: &Path, rounds: u32) -> Outcome<()> {
    let start = gas.start()?;
    let peer = Smallenburg::tuned(folder, &start)?;
    let mut pairs = Vec::new();
    for round in 0..rounds {
        // The order changes from pair to pair.
        let early = if round % 2 == 0 { Some(peer.measure()?) } else { None };
        let ours = gas.stretch()?;
        pairs.push((ours, early.map_or_else(|| peer.measure(), Ok)?));
    }
    let of = |number: fn(&(Speed, Measured)) -> f64| Quartiles::of(pairs.iter().map(number));
    let rate = of(|(ours, (its, _))| its.rate / ours.rate).median;
    let pressure = of(|(_, (_, compressibility))| *compressibility).median / gas.compressibility()?;
    println!(
        "| {}, {fraction} | {:.0} | {:.0} | {} | {:.4}, {pressure:.4} | {} |",
        gas.run.len(),
        of(|(ours, _)| ours.nanoseconds).median,
        of(|(_, (its, _))| its.nanoseconds).median,
        of(|(ours, (its, _))| its.nanoseconds / ours.nanoseconds),
        rate,
        peer.settings(),
    );
    if (rate - 1.0).abs() > ALIKE || (pressure - 1.0).abs() > ALIKE {
        return Err("the programs are not in the same state".into());
    }
    Ok(())
}

impl Gas {
    fn settled(count: usize, fraction: f64) -> Outcome<Self> {
        let side = (0.25 * PI * count as f64 / fraction).sqrt();
        let container = Container::periodic(side, side)?;
        let disks = initial::even_lattice(&container, count, 0.5)?;
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
        let run = Simulation::builder(Elastic, container).disks(disks).build()?;
        let mut gas = Self { run, side, collisions: SETTLE * count as u64 / 2 };
        gas.stretch()?;
        gas.collisions = COLLISIONS.max(10 * count as u64);
        Ok(gas)
    }

    fn stretch(&mut self) -> Outcome<Speed> {
        let meter = Meter::start(&self.run);
        self.run.run(&Limits::collisions(self.collisions), &mut ())?;
        let report = meter.report(&self.run);
        let collisions = report.counters.disk_collisions as f64;
        let rate = 2.0 * collisions / (self.run.len() as f64 * report.simulated_time * self.thermal_speed());
        Ok(Speed { nanoseconds: report.nanoseconds_per_collision, rate })
    }

    fn thermal_speed(&self) -> f64 {
        self.run.measure(&Temperatures).translational().sqrt()
    }

    /// Continues for an interval to measure PA/(NT).
    fn compressibility(&mut self) -> Outcome<f64> {
        let start = self.start()?;
        let end = self.run.time() + start.time / self.thermal_speed();
        let mut stress = Stress::new(SampleTimes::every((end - self.run.time()) / 100.0)?);
        self.run.run_until(end, &mut stress)?;
        let energy = self.run.len() as f64 * self.thermal_speed().powi(2);
        Ok(stress.tensor().pressure.mean() * self.side.powi(2) / energy)
    }

    /// Returns the present disks, and the length of an interval for them.
    fn start(&mut self) -> Outcome<Start> {
        let disks = self.run.disks();
        let rate = self.stretch()?.rate;
        let time = 2.0 * self.collisions as f64 / (disks.len() as f64 * rate);
        Ok(Start { side: self.side, disks, time })
    }
}
