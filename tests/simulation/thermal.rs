//! Thermal walls: disks that leave them have the moments of the flux from a gas behind them.

use granular_edmd::Simulation;
use granular_edmd::boundary::{Boundary, Container, Part, Probe, Thermal, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, on_collision};
use granular_edmd::statistics::RunningMean;
use granular_edmd::wall::Piston;
use granular_edmd::{Disk, initial};

/// Returns the motion of disks that leave the floor of a box with a thermal floor of temperature 2: the
/// normal speed, the tangential velocity, and the change of energy of each touch. The box holds a single disk
/// of mass 3.
fn emitted(thermal: Thermal) -> (Vec<f64>, Vec<f64>) {
    let boundary = Container::closed(4.0, 4.0).unwrap().with_temperature(Wall::Floor, thermal).unwrap();
    let disk = Disk::new(DVec2::new(2.0, 2.0), 0.5).unwrap().with_mass(3.0).unwrap();
    let disk = disk.with_velocity(DVec2::new(0.1, 1.0)).unwrap();
    let mut simulation = Simulation::builder(Elastic, boundary).disks([disk]).seed(8).build().unwrap();
    let (mut normal, mut tangential) = (Vec::new(), Vec::new());
    let mut watch = on_collision(|c: &Collision| {
        if c.normal == DVec2::Y {
            normal.push(c.impulse.normal() / 3.0 - c.contact.closing_speed());
            tangential.push(c.impulse.tangential() / 3.0);
        }
    });
    while simulation.counters().wall_collisions < 60_000 {
        let end = simulation.time() + 100.0;
        simulation.run_until(end, &mut watch).unwrap();
    }
    (normal, tangential)
}

fn mean(values: &[f64], power: i32) -> RunningMean {
    values.iter().map(|value| value.powi(power)).collect()
}

/// Returns whether a mean is as expected, within five standard errors.
fn is(mean: RunningMean, expected: f64) -> bool {
    (mean.mean() - expected).abs() < 5.0 * mean.standard_error()
}

#[test]
fn emitted_speeds_have_the_moments_of_the_flux() {
    let speed = 2.0 / 3.0;
    let (normal, tangential) = emitted(Thermal::new(2.0).unwrap());
    assert!(normal.len() > 10_000 && normal.iter().all(|&v| v > 0.0));
    assert!(is(mean(&normal, 1), (std::f64::consts::FRAC_PI_2 * speed).sqrt()));
    assert!(is(mean(&normal, 2), 2.0 * speed));
    assert!(is(mean(&normal, 4), 8.0 * speed * speed));
    assert!(tangential.iter().any(|&v| v != 0.0));
    let (normal, tangential) = emitted(Thermal::new(2.0).unwrap().with_slip());
    assert!(is(mean(&normal, 2), 2.0 * speed));
    assert!(tangential.iter().all(|v| v.abs() < 1e-12));
}

#[test]
fn a_gas_takes_the_temperature_of_its_wall() {
    let boundary = Container::closed(12.0, 12.0)
        .unwrap()
        .with_periodic_sides()
        .unwrap()
        .with_temperature(Wall::Floor, Thermal::new(2.0).unwrap())
        .unwrap();
    let disks = initial::lattice(&boundary, 40, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 0.5, 3).unwrap();
    let mut simulation = Simulation::builder(Elastic, boundary).disks(disks).seed(5).build().unwrap();
    let mut energies = RunningMean::default();
    let mut spins = RunningMean::default();
    for sample in 0..400 {
        simulation.run_until(100.0 + 10.0 * f64::from(sample), &mut ()).unwrap();
        let disks = simulation.disks();
        energies.push(disks.iter().map(Disk::translational_energy).sum::<f64>() / 40.0);
        spins.push(disks.iter().map(|disk| 2.0 * disk.rotational_energy()).sum::<f64>() / 40.0);
    }
    // The fluctuations are those of a canonical gas: T/sqrt(40) for the energy and sqrt(2/40) T for the
    // rotation, over 400 samples of which one in ten counts as independent.
    assert!((energies.mean() - 2.0).abs() < 0.12, "{}", energies.mean());
    assert!((spins.mean() - 2.0).abs() < 0.3, "{}", spins.mean());
}

#[test]
fn the_seed_decides() {
    let run = |seed| {
        let boundary =
            Container::open(6.0).unwrap().with_temperature(Wall::Floor, Thermal::new(1.0).unwrap()).unwrap();
        let disks = initial::lattice(&boundary, 5, 0.5).unwrap();
        let mut simulation =
            Simulation::builder(Elastic, boundary).disks(disks).gravity(0.1).seed(seed).build().unwrap();
        simulation.run_until(20.0, &mut ()).unwrap();
        simulation.disks()
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

#[test]
fn a_disk_that_a_wall_makes_fast_keeps_its_digits() {
    // The disk creeps for five million units of time, and then flies a hundred million times as fast. Counted
    // from its place at the beginning of the run, its place would have an error of 1e-7.
    let walls = Container::closed(10.0, 10.0).unwrap();
    let walls = walls.with_temperature(Wall::Right, Thermal::new(1e4).unwrap()).unwrap();
    let disk = Disk::new(DVec2::new(5.0, 5.0), 0.5).unwrap().with_velocity(DVec2::new(1e-6, 0.0)).unwrap();
    let mut simulation = Simulation::builder(Elastic, walls.clone()).disks([disk]).build().unwrap();
    while simulation.counters().wall_collisions < 1000 {
        simulation.step_until(simulation.time() + 1.0, &mut ()).unwrap();
        let overlap = walls.overlap(&Probe::new(simulation.disks()[0].position(), 0.5, simulation.time()));
        assert!(overlap.is_none_or(|overlap| overlap.depth < 1e-12), "{overlap:?} at {}", simulation.time());
    }
}

/// A hot piston of mass M under a force over a gas: both take the temperature of the piston. About its mean,
/// the gas has an error of 2 %, and a piston of little mass would be far too hot if it did not recoil.
#[test]
fn a_hot_piston_and_its_gas_take_its_temperature() {
    for mass in [1.0, 5.0] {
        let piston = Piston::new(mass, [-30.0, 11.0]).unwrap().with_force(1.5).unwrap();
        let container = Container::closed(8.0, 12.0).unwrap().with_piston(Wall::Lid, piston).unwrap();
        let container = container.with_temperature(Wall::Lid, Thermal::new(1.0).unwrap()).unwrap();
        let disks = initial::lattice(&container, 15, 0.5).unwrap();
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap();
        let mut run = Simulation::builder(Elastic, container).disks(disks).seed(4).build().unwrap();
        let (mut gas, mut lid) = (RunningMean::default(), RunningMean::default());
        for sample in 1..=6000 {
            run.run_until(f64::from(sample), &mut ()).unwrap();
            gas.push(run.disks().iter().map(Disk::translational_energy).sum::<f64>() / 15.0);
            lid.push(mass * run.snapshot().wall_velocity(3).unwrap().y.powi(2));
        }
        assert!(
            (gas.mean() - 1.0).abs() < 0.1 && (lid.mean() - 1.0).abs() < 0.15,
            "{mass}: {gas:?}, {lid:?}"
        );
    }
}

/// Smooth disks in a hot drum that turns: in equilibrium, they turn with it like a body. Their angular
/// momentum has an error of 2 %, and their spin one of 0.02.
#[test]
fn a_gas_turns_with_a_hot_drum() {
    let turning = 0.3;
    let drum = Part::drum(DVec2::ZERO, 3.0).unwrap().with_temperature(Thermal::new(1.0).unwrap());
    let drum = drum.with_rotation(DVec2::ZERO, turning).unwrap();
    let vessel = Container::around([("drum", drum)]).unwrap();
    let disks = initial::scattered(&vessel, 8, 0.5, 10.0, 1).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 2).unwrap();
    let mut run = Simulation::builder(Elastic, vessel).disks(disks).seed(5).build().unwrap();
    let (mut momentum, mut inertia, mut spin) = (0.0, 0.0, RunningMean::default());
    for sample in 1..=10_000 {
        run.run_until(f64::from(sample), &mut ()).unwrap();
        for disk in run.disks() {
            momentum += disk.position().perp_dot(disk.velocity());
            inertia += disk.position().length_squared();
            spin.push(disk.angular_velocity());
        }
    }
    assert!((momentum / (turning * inertia) - 1.0).abs() < 0.1, "{}", momentum / inertia);
    assert!((spin.mean() - turning).abs() < 0.1, "{spin:?}");
}
