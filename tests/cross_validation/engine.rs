//! Runs of this crate.

use std::error::Error;

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{CenterOfMass, Energies, EnergyChange, OrderParameters};
use granular_edmd::wall::{BiParabolic, WallMotion};
use granular_edmd::{Disk, ParameterError, Simulation, initial};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::means::{Interval, Means};
use crate::{CONTACT_DURATION, DISKS, HEIGHT, INTERVAL, Point, SAMPLES, SETTLE, WIDTH};

type Run = Simulation<ContactDuration<Frictional>>;

/// Means over the sampled part of a run.
pub(crate) fn run(point: Point, seed: u64) -> Result<Means, Box<dyn Error>> {
    let base = BiParabolic::new(0.1, 10.0)?;
    let period = base.period().ok_or("the base has a period")?;
    let length = f64::from(INTERVAL) * period;
    let mut simulation = start(point, base, seed)?;
    simulation.run_until(f64::from(SETTLE) * period, &mut ())?;
    let settled = simulation.time();
    let intervals: Result<Vec<Interval>, Box<dyn Error>> =
        (1..=SAMPLES).map(|count| interval(&mut simulation, settled + f64::from(count) * length)).collect();
    Ok(Means::over(&intervals?, length))
}

fn start(point: Point, base: BiParabolic, seed: u64) -> Result<Run, Box<dyn Error>> {
    let container = Container::closed(WIDTH, HEIGHT)?.with_motion(Wall::Floor, base)?;
    let disks = initial::with_maxwellian_velocities(disks(seed)?, 1.0, seed)?;
    let rule = Frictional::from_inelasticity(point.inelasticity, point.inelasticity, point.friction)?;
    let rule = ContactDuration::new(rule, CONTACT_DURATION)?;
    Ok(Simulation::builder(rule, container).disks(disks).gravity(point.gravity).build()?)
}

/// Returns disks where the other program has them at its start: in rows of 42 on the base, each disk a little
/// off its site.
///
/// Dense states remember for a long time how they were piled up. Two programs that start alike can be
/// compared at any time.
fn disks(seed: u64) -> Result<Vec<Disk>, ParameterError> {
    const COLUMNS: usize = 42;
    const ROW: f64 = 1.4;
    let pitch = (WIDTH - 1.0) / COLUMNS as f64;
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut off = || generator.random_range(-0.05..0.05);
    let site = |index: usize| {
        let (row, column) = ((index / COLUMNS) as f64, (index % COLUMNS) as f64);
        DVec2::new(0.5 + pitch * (column + 0.5), 0.8 + ROW * row)
    };
    (0..DISKS).map(|index| Disk::new(site(index) + DVec2::new(off(), off()), 0.5)).collect()
}

fn interval(simulation: &mut Run, end: f64) -> Result<Interval, Box<dyn Error>> {
    let mut change = EnergyChange::default();
    simulation.run_until(end, &mut change)?;
    let (order, center, energies) = simulation.measure(&(OrderParameters, CenterOfMass, Energies));
    Ok(Interval {
        height: center.y,
        translational: energies.translational,
        rotational: energies.rotational,
        one_roll: order.one_roll,
        two_rolls: order.two_rolls,
        collisions: change.disks().count() as f64,
        energy_change: change.disks().sum(),
    })
}
