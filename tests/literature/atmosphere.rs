//! Elastic disks under gravity over a thermal base: an isothermal atmosphere.

use std::f64::consts::{FRAC_PI_4, PI};

use granular_edmd::boundary::{Container, Thermal, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    CenterOfMass, Collision, Partner, SampleTimes, Series, Temperature, Temperatures, on_collision,
};
use granular_edmd::statistics::block_average;
use granular_edmd::{Simulation, initial};

use crate::{Outcome, agrees, measured};

const DISKS: usize = 40;
const WIDTH: f64 = 40.0;
const GRAVITY: f64 = 0.2;

/// Z of hard disks (Henderson 1975), good to 1e-4 at the packing fractions here.
fn henderson(packing: f64) -> f64 {
    (1.0 + packing * packing / 8.0) / (1.0 - packing).powi(2)
}

/// The packing fraction at which n Z(n) is this much, by bisection.
fn packing_at(pressure: f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.9);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let below = middle / FRAC_PI_4 * henderson(middle) < pressure;
        (low, high) = if below { (middle, high) } else { (low, middle) };
    }
    low
}

/// Returns the height of the center of mass at temperature 1, if the pressure were that of the local density.
/// The pressure at a height is the weight above it, and is also nTZ. A layer of ds disks per width has the
/// height ds/n.
fn local_height() -> f64 {
    let (layers, column) = (1000, DISKS as f64 / WIDTH);
    let z = |k| henderson(packing_at(GRAVITY * column * (f64::from(k) + 0.5) / f64::from(layers)));
    0.5 + (0..layers).map(z).sum::<f64>() / f64::from(layers) / GRAVITY
}

/// Returns the correction of first order in density. The density changes within a diameter, and ends at the
/// base: the virial of pairs is $`(N/L)\tfrac12\int\cos^2\theta\,e^{-g\sigma\cos\theta/T}d\theta`$ over half
/// a turn, not $`\tfrac\pi4N/L`$.
fn layering() -> f64 {
    let cosines = (0..1000).map(|k| (PI * ((f64::from(k) + 0.5) / 1000.0 - 0.5)).cos());
    let integral: f64 = cosines.map(|c| c * c * (1.0 - (-GRAVITY * c).exp())).sum::<f64>() * PI / 1000.0;
    0.5 * DISKS as f64 / WIDTH * integral
}

#[test]
fn an_isothermal_atmosphere_has_its_height_temperature_and_virial() -> Outcome {
    let first_order = 0.5 + 1.0 / GRAVITY + FRAC_PI_4 * DISKS as f64 / WIDTH;
    assert!((local_height() / first_order - 1.0).abs() < 0.01, "{} {first_order}", local_height());
    let container =
        Container::open(WIDTH)?.with_periodic_sides()?.with_temperature(Wall::Floor, Thermal::new(1.0)?)?;
    let disks = initial::scattered(&container, DISKS, 0.5, 12.0, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
    let mut simulation =
        Simulation::builder(Elastic, container).disks(disks).gravity(GRAVITY).seed(2).build()?;
    let (start, end) = (200.0, 60_200.0);
    simulation.run_until(start, &mut ())?;
    let mut pairs = 0.0;
    let watch = |c: &Collision| {
        if let Partner::Disk(_) = c.partner {
            pairs += c.impulse.normal() * c.distance * c.normal.y * c.normal.y;
        }
    };
    let mut series = Series::new((Temperatures, CenterOfMass), SampleTimes::every(0.5)?.starting_at(start)?);
    simulation.run_until(end, &mut (&mut series, on_collision(watch)))?;
    let average = |value: fn(&(Temperature, DVec2)) -> f64| {
        block_average(&series.values().iter().map(value).collect::<Vec<_>>())
    };
    let center = average(|(_, center)| center.y)?;
    let vertical = average(|(temperature, _)| temperature.vertical)?;
    let translational = average(|(temperature, _)| temperature.translational())?;
    let rotational = average(|(temperature, _)| temperature.rotational)?;
    measured("error of Y", center.standard_error());
    // The standard errors are 0.25 % of Y and 0.3 % of T. Layers at the base are known to first order in
    // density; the next order is some 0.1 of 2 %.
    assert!(agrees("Y", center.mean(), local_height() - layering(), 0.013));
    assert!(agrees("T", translational.mean(), 1.0, 0.015));
    assert!(agrees("T_rot", rotational.mean(), 1.0, 0.03));
    // The virial theorem holds for each single run: N<m v_y^2> and the pairs balance N m g (<y> - radius).
    let virial = DISKS as f64 * vertical.mean() + pairs / (end - start);
    let weight = DISKS as f64 * GRAVITY * (center.mean() - 0.5);
    // Samples of v_y^2 and y between events: sqrt(2/(40 * 120 000)) = 0.1 % at most.
    assert!(agrees("virial", virial, weight, 0.005));
    Ok(())
}
