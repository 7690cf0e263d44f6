//! What a fast vibrating plate does to a ball, and to a gas.

use std::f64::consts::{FRAC_1_PI, PI};

use granular_edmd::analysis::block_average;
use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    CenterOfMass, Collision, EnergyChange, RunningMean, SampleTimes, Series, Temperatures, on_collision,
};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Simulation, initial};

use crate::{Outcome, agrees};

/// Mean square velocity of the bi-parabolic plate: a third of the square of the largest, `$4A\omega/\pi$`... over two.
const fn mean_square_velocity(amplitude: f64, angular_frequency: f64) -> f64 {
    let largest = 4.0 * FRAC_1_PI * amplitude * angular_frequency;
    largest * largest / 3.0
}

#[test]
fn a_ball_on_a_fast_plate_has_the_energy_of_the_flux() -> Outcome {
    // <v'^2> = (1 + 3r)/(1 - r) <U^2> over impacts: a plate that comes is met more often than one that goes.
    let restitution = 0.98;
    let container = Container::open(2000.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
    let rule = ContactDuration::new(Smooth::from_restitution(restitution)?, 1e-6)?;
    // A large disk lives in one cell: only impacts are events.
    let disk = Disk::new(DVec2::new(1000.0, 200.0), 100.0)?;
    let mut simulation = Simulation::builder(rule, container).disks([disk]).gravity(0.05).build()?;
    let mut square = RunningMean::default();
    let mut watch = on_collision(|c: &Collision| {
        let arrival = c.contact.closing_speed();
        square.push(arrival * arrival);
    });
    while simulation.counters().wall_collisions < 1_000_000 {
        simulation.step(&mut watch)?;
    }
    // Speeds forget in 1/(1 - r^2) = 25 impacts: 2 * 25 impacts count as one, 0.7 %; impacts in chatter, 0.5 %. The
    // closing speed c obeys v' = r c + U, so r^2 <c^2> = <v'^2> - 2 <U v'> + <U^2>, and 2 <U v'> = 2 (2 + r) <U^2>.
    let plate = mean_square_velocity(0.1, 10.0);
    let expected = ((1.0 + 3.0 * restitution) / (1.0 - restitution)) * plate;
    println!("{} {} {}", square.mean(), expected, PI);
    assert!(agrees("<v^2>", square.mean(), expected, 0.05));
    Ok(())
}

/// A gas of smooth disks on a plate, in a steady state.
struct Shaken {
    temperature: f64,
    temperature_error: f64,
    height: f64,
    height_error: f64,
    /// Energy from the plate per time.
    power: f64,
}

const DISKS: usize = 100;
const WIDTH: f64 = 50.0;
const GRAVITY: f64 = 0.05;

fn shaken(restitution: f64, amplitude: f64, duration: f64) -> Result<Shaken, Box<dyn std::error::Error>> {
    let container = Container::open(WIDTH)?
        .with_periodic_sides()
        .with_motion(Wall::Floor, BiParabolic::new(amplitude, 1.0 / amplitude)?)?
        .with_rule(Wall::Floor, Elastic)?;
    let guess = kumaran(restitution);
    let disks = initial::random(&container, DISKS, 0.5, 2.0 * guess / GRAVITY, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, guess, 1)?;
    let rule = Smooth::from_restitution(restitution)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(GRAVITY).build()?;
    let start = 0.2 * duration;
    simulation.run_until(start, &mut ())?;
    let times = SampleTimes::every(5.0)?.starting_at(start)?;
    let mut series = Series::new((Temperatures, CenterOfMass), times);
    let mut energy = EnergyChange::default();
    simulation.run_until(duration, &mut (&mut series, &mut energy))?;
    let values = series.values();
    let temperature = block_average(&values.iter().map(|(t, _)| t.translational()).collect::<Vec<_>>())?;
    let height = block_average(&values.iter().map(|(_, centre)| centre.y).collect::<Vec<_>>())?;
    Ok(Shaken {
        temperature: temperature.mean(),
        temperature_error: temperature.standard_error(),
        height: height.mean(),
        height_error: height.standard_error(),
        power: energy.wall(0).sum() / (duration - start),
    })
}

/// Temperature of a dilute, nearly elastic gas on a fast plate with A omega = 1 (Kumaran 1998).
fn kumaran(restitution: f64) -> f64 {
    let loss = 1.0 - restitution * restitution;
    4.0 * 2.0_f64.sqrt() * FRAC_1_PI * mean_square_velocity(0.1, 10.0) * WIDTH / (DISKS as f64 * loss)
}

/// The power of a fast plate into a hot gas over it.
fn power(temperature: f64) -> f64 {
    (8.0 * FRAC_1_PI / temperature).sqrt() * DISKS as f64 * GRAVITY * mean_square_velocity(0.1, 10.0)
}

fn steady_state(restitution: f64, duration: f64, tolerance: f64) -> Outcome {
    let gas = shaken(restitution, 0.1, duration)?;
    println!("r {restitution}: standard error of T {:.4}", gas.temperature_error / gas.temperature);
    assert!(agrees("T", gas.temperature, kumaran(restitution), tolerance));
    assert!(agrees("power", gas.power, power(gas.temperature), tolerance));
    Ok(())
}

#[test]
fn a_shaken_gas_has_the_temperature_of_kumaran() -> Outcome {
    // Standard error 1.5 %; the theory, to first order in 1 - r and U/v, is 3 % off at r = 0.95.
    steady_state(0.95, 2e4, 0.09)
}

#[test]
#[ignore = "half a minute in release"]
fn a_hot_shaken_gas_has_the_temperature_of_kumaran() -> Outcome {
    steady_state(0.98, 2e5, 0.04)?;
    steady_state(0.99, 2e5, 0.05)
}

#[test]
fn only_the_velocity_of_a_small_plate_matters() -> Outcome {
    let (one, half) = (shaken(0.95, 0.1, 2e4)?, shaken(0.95, 0.05, 2e4)?);
    let error = |a: f64, b: f64| a.hypot(b);
    let heat = (one.temperature - half.temperature) / error(one.temperature_error, half.temperature_error);
    let height = (one.height - half.height) / error(one.height_error, half.height_error);
    println!("T {:.3} and {:.3}: {heat:.2} errors", one.temperature, half.temperature);
    println!("Y {:.2} and {:.2}: {height:.2} errors", one.height, half.height);
    // Four standard errors; and 8 %, so that large errors do not hide a difference.
    assert!(heat.abs() < 4.0 && height.abs() < 4.0);
    assert!(agrees("T", half.temperature, one.temperature, 0.08));
    assert!(agrees("Y", half.height, one.height, 0.08));
    Ok(())
}
