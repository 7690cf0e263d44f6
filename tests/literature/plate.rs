//! The effect of a fast vibrating plate on a ball, and on a gas.

use std::f64::consts::{FRAC_1_PI, TAU};

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    CenterOfMass, Collision, EnergyChange, SampleTimes, Series, Temperatures, on_collision,
};
use granular_edmd::statistics::{RunningMean, block_average};
use granular_edmd::wall::{BiParabolic, WallMotion};
use granular_edmd::{Disk, Simulation, initial};

use crate::{Outcome, agrees, measured};

/// Returns the mean square velocity $`\langle U^2\rangle`$ of the bi-parabolic plate: a third of the square
/// of its largest velocity $`4A\omega/\pi`$.
const fn mean_square_velocity(amplitude: f64, angular_frequency: f64) -> f64 {
    let largest = 4.0 * FRAC_1_PI * amplitude * angular_frequency;
    largest * largest / 3.0
}

#[test]
fn the_plate_is_two_parabolas() -> Outcome {
    let (plate, samples) = (BiParabolic::new(0.1, 10.0)?, 100_000);
    let times = (0..samples).map(|k| (f64::from(k) + 0.5) / f64::from(samples) * TAU / 10.0);
    let square: RunningMean = times.clone().map(|time| plate.state(time).velocity.powi(2)).collect();
    // Midpoint sums: errors of 1e-9.
    assert!(agrees("U^2", square.mean(), mean_square_velocity(0.1, 10.0), 1e-6));
    let from_sine = times.map(|time| (plate.state(time).displacement - 0.1 * (10.0 * time).sin()).abs());
    assert!(agrees("largest distance from a sine", from_sine.fold(0.0, f64::max), 0.0056, 0.002));
    Ok(())
}

#[test]
fn a_ball_on_a_fast_plate_has_the_energy_of_the_flux() -> Outcome {
    // The theory is <v'^2> = (1 + 3r)/(1 - r) <U^2> over impacts: a plate that approaches is met more often
    // than one that retreats.
    let restitution = 0.98;
    let container = Container::open(2000.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
    let rule = ContactDuration::new(Smooth::from_restitution(restitution)?, 1e-6)?;
    // A large disk lives in one cell, so only impacts are events.
    let disk = Disk::new(DVec2::new(1000.0, 200.0), 100.0)?;
    let mut simulation = Simulation::builder(rule, container).disks([disk]).gravity(0.05).build()?;
    let mut square = RunningMean::default();
    let mut watch = on_collision(|c: &Collision| {
        // The impulse gives the sum of the speeds before and after, and the energy gives their difference.
        let departure = 0.5 * c.impulse.normal() + c.energy_change / c.impulse.normal();
        square.push(departure * departure);
    });
    while simulation.counters().wall_collisions < 200_000 {
        simulation.step_until(simulation.time() + 1e4, &mut watch)?;
    }
    // Speeds forget in 1/(1 - r^2) = 25 impacts, so that twice as many count as one: 1.6 %. Impacts in
    // chatter add 0.5 %.
    let expected = (1.0 + 3.0 * restitution) / (1.0 - restitution) * mean_square_velocity(0.1, 10.0);
    assert!(agrees("v'^2", square.mean(), expected, 0.06));
    Ok(())
}

/// A gas of smooth disks on a plate, in a steady state.
struct Shaken {
    temperature: f64,
    temperature_error: f64,
    height: f64,
    height_error: f64,
    /// Energy from the plate per unit of time.
    power: f64,
}

const DISKS: usize = 100;
const WIDTH: f64 = 50.0;
const GRAVITY: f64 = 0.05;

fn shaken(restitution: f64, amplitude: f64, duration: f64) -> Result<Shaken, Box<dyn std::error::Error>> {
    let container = Container::open(WIDTH)?
        .with_periodic_sides()?
        .with_motion(Wall::Floor, BiParabolic::new(amplitude, 1.0 / amplitude)?)?
        .with_rule(Wall::Floor, Elastic)?;
    let guess = kumaran(restitution);
    let disks = initial::scattered(&container, DISKS, 0.5, 2.0 * guess / GRAVITY, 1)?;
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
    let height = block_average(&values.iter().map(|(_, center)| center.y).collect::<Vec<_>>())?;
    Ok(Shaken {
        temperature: temperature.mean(),
        temperature_error: temperature.standard_error(),
        height: height.mean(),
        height_error: height.standard_error(),
        power: energy.wall("floor").sum() / (duration - start),
    })
}

/// Returns the temperature of a dilute, nearly elastic gas on a fast plate with A omega = 1 (Kumaran 1998).
fn kumaran(restitution: f64) -> f64 {
    let loss = 1.0 - restitution * restitution;
    4.0 * 2.0_f64.sqrt() * FRAC_1_PI * mean_square_velocity(0.1, 10.0) * WIDTH / (DISKS as f64 * loss)
}

/// Returns the power of a fast plate into a hot gas over it.
fn power(temperature: f64) -> f64 {
    (8.0 * FRAC_1_PI / temperature).sqrt() * DISKS as f64 * GRAVITY * mean_square_velocity(0.1, 10.0)
}

fn steady_state(restitution: f64, duration: f64, tolerance: f64) -> Outcome {
    let gas = shaken(restitution, 0.1, duration)?;
    measured("relative error of T", gas.temperature_error / gas.temperature);
    assert!(agrees("T", gas.temperature, kumaran(restitution), tolerance));
    assert!(agrees("power", gas.power, power(gas.temperature), tolerance));
    Ok(())
}

#[test]
fn a_shaken_gas_has_the_temperature_of_kumaran() -> Outcome {
    // The standard errors are 1 % of T and 2 % of the power. The theories are of first order in <U^2>/T,
    // which is 0.11 here.
    steady_state(0.95, 2e4, 0.13)
}

#[test]
#[ignore = "half a minute"]
fn a_hot_shaken_gas_has_the_temperature_of_kumaran() -> Outcome {
    // The values of <U^2>/T are 0.045 and 0.022; an independent study found T within 2 %. The first has 4 %
    // less power than the theory (300 seeds). The standard errors are 0.5 and 1.4 % of T, and 0.3 and 1 % of
    // the power.
    steady_state(0.98, 1e6, 0.06)?;
    steady_state(0.99, 1e6, 0.06)
}

/// Checks that half the amplitude and twice the frequency give the same temperature and height within four
/// standard errors, and also within this tolerance, so that large errors do not hide a difference.
fn only_the_velocity_matters(duration: f64, tolerance: f64) -> Outcome {
    let (one, half) = (shaken(0.95, 0.1, duration)?, shaken(0.95, 0.05, duration)?);
    let heat = (one.temperature - half.temperature) / one.temperature_error.hypot(half.temperature_error);
    let height = (one.height - half.height) / one.height_error.hypot(half.height_error);
    assert!(heat.abs() < 4.0 && height.abs() < 4.0);
    assert!(agrees("T", half.temperature, one.temperature, tolerance));
    assert!(agrees("Y", half.height, one.height, tolerance));
    Ok(())
}

#[test]
fn only_the_velocity_of_a_small_plate_matters() -> Outcome {
    // Standard errors 1.3 % each.
    only_the_velocity_matters(2e4, 0.08)
}

#[test]
#[ignore = "half a minute"]
fn only_the_velocity_of_a_small_plate_matters_for_long() -> Outcome {
    // Standard errors 0.5 % each.
    only_the_velocity_matters(2e5, 0.03)
}
