//! The runs that `.ci/portable` compares between platforms: two small runs and a packing, which use
//! everything that could differ. It compares the bits of their last states.
//!
//! The program prints for each run its name, its collisions, and a hash of the state and of the checkpoint.

use std::error::Error;
use std::process::ExitCode;

use granular_edmd::boundary::{Boundary, Container, Thermal, Wall};
use granular_edmd::collision::{ContactDuration, Frictional, Rough};
use granular_edmd::glam::DVec2;
use granular_edmd::initial::Radii;
use granular_edmd::scheduler::{BucketQueue, EventScheduler, TournamentTree};
use granular_edmd::simulation::Checkpoint;
use granular_edmd::wall::{BiParabolic, Sinusoidal, Triangular};
use granular_edmd::{Disk, Simulation, initial};

type Outcome<T> = Result<T, Box<dyn Error>>;
type Rule = ContactDuration<Frictional>;

fn main() -> ExitCode {
    let runs =
        [("box", shaken_box as fn() -> Outcome<String>), ("column", heated_column), ("packing", packing)];
    for (name, run) in runs {
        match run() {
            Ok(line) => println!("{name} {line}"),
            Err(error) => {
                eprintln!("error: {name}: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// Runs unequal disks in a box whose floor, left side and lid move each in its own way, and whose right side
/// is rough.
fn shaken_box() -> Outcome<String> {
    let container = || -> Outcome<Container> {
        Ok(Container::closed(20.0, 24.0)?
            .with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?
            .with_motion(Wall::Left, Sinusoidal::new(0.2, 7.0)?)?
            .with_motion(Wall::Lid, Triangular::new(0.3, 3.0)?)?
            .with_rule(Wall::Right, Rough::from_inelasticity(0.05, 0.4)?)?)
    };
    run(&container, 0.05, 0.0, 60.0)
}

/// Runs unequal disks between periodic sides over a thermal floor that moves up and down, at a late time.
fn heated_column() -> Outcome<String> {
    let container = || -> Outcome<Container> {
        Ok(Container::open(20.0)?
            .with_periodic_sides()?
            .with_motion(Wall::Floor, Sinusoidal::new(0.05, 20.0)?)?
            .with_temperature(Wall::Floor, Thermal::new(1.0)?)?)
    };
    run(&container, 0.2, 1e7, 100.0)
}

/// Packs disks with radii of all distributions, and sets them in motion. There is no run and no checkpoint,
/// so the result is the number of disks, and hashes of their state and of their radii.
fn packing() -> Outcome<String> {
    let radii = [
        Radii::uniform(0.3, 0.5)?,
        Radii::log_normal(0.4, 0.3, 0.2, 0.8)?,
        Radii::power_law(2.5, 0.2, 1.0)?,
        Radii::two_sizes(0.5, 0.7, 0.5)?,
    ];
    let radii = radii.iter().zip(1..).flat_map(|(radii, seed)| radii.draw(40, seed));
    let disks = initial::disks_from_radii(radii, 1.0)?;
    let area: f64 = disks.iter().map(|disk| std::f64::consts::PI * disk.radius() * disk.radius()).sum();
    let container = Container::open(12.0)?.with_periodic_sides()?;
    let disks = initial::packed_mix(&container, disks, area / (0.8 * 12.0), 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
    let rule = rule(0.02, 0.1)?;
    let run = Simulation::builder(rule, container).disks(disks.iter().copied()).build()?;
    let bytes: Vec<u8> = disks.iter().flat_map(|disk| disk.radius().to_bits().to_le_bytes()).collect();
    Ok(format!("{} {:016x} {:016x}", disks.len(), of_state(&run), of_bytes(&bytes)))
}

/// Runs for half of the time, goes through the bytes of a checkpoint to another scheduler, rule and gravity,
/// and runs on.
fn run(
    container: &dyn Fn() -> Outcome<Container>,
    gravity: f64,
    start: f64,
    duration: f64,
) -> Outcome<String> {
    let rule = rule(0.02, 0.1)?;
    let mut first = Simulation::builder(rule, container()?)
        .disks(disks(&container()?)?)
        .gravity(gravity)
        .seed(3)
        .starting_at(start)
        .scheduler(TournamentTree::new())
        .build()?;
    first.run_until(start + 0.5 * duration, &mut ())?;
    let bytes = first.checkpoint().to_bytes()?;
    let saved = Checkpoint::from_bytes(&bytes)?;
    let mut second = Simulation::resume(&saved, rule, container()?).scheduler(BucketQueue::new()).build()?;
    second.set_rule(self::rule(0.05, 0.5)?);
    second.set_gravity(1.5 * gravity)?;
    second.run_until(start + duration, &mut ())?;
    let collisions = second.counters().disk_collisions + second.counters().wall_collisions;
    Ok(format!("{collisions} {:016x} {:016x}", of_state(&second), of_bytes(&bytes)))
}

fn rule(inelasticity: f64, friction: f64) -> Outcome<Rule> {
    Ok(ContactDuration::new(Frictional::from_inelasticity(inelasticity, inelasticity, friction)?, 1e-3)?)
}

/// Returns disks of three sizes, with various masses and inertias, on a lattice.
fn disks(container: &Container) -> Outcome<Vec<Disk>> {
    let lattice = initial::with_maxwellian_velocities(initial::lattice(container, 180, 0.5)?, 1.0, 5)?;
    let unequal = lattice.iter().enumerate().map(|(index, disk)| {
        let size = [0.5, 0.4, 0.3][index % 3];
        Ok(Disk::new(disk.position(), size)?
            .with_velocity(disk.velocity())?
            .with_angular_velocity(disk.angular_velocity() - size)?
            .with_mass(4.0 * size * size)?
            .with_inertia_factor(if index % 2 == 0 { 0.5 } else { 1.0 })?)
    });
    unequal.collect()
}

/// Returns a hash of all bits of the time and the disks.
fn of_state<B: Boundary, S: EventScheduler>(run: &Simulation<Rule, B, S>) -> u64 {
    let mut bytes = run.time().to_bits().to_le_bytes().to_vec();
    for disk in run.disks() {
        let (DVec2 { x, y }, DVec2 { x: u, y: v }) = (disk.position(), disk.velocity());
        for number in [x, y, u, v, disk.angle(), disk.angular_velocity()] {
            bytes.extend(number.to_bits().to_le_bytes());
        }
    }
    of_bytes(&bytes)
}

/// Returns the FNV-1a hash, which needs only a few lines and is the same everywhere.
fn of_bytes(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
