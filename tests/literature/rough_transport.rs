//! Viscosity and thermal conductivity of rough disks, against direct simulation of the Boltzmann equation.

use std::f64::consts::PI;

use granular_edmd::Disk;
use granular_edmd::collision::{CollisionRule, Elastic, Rough};
use granular_edmd::glam::DVec2;
use granular_edmd::kinetic::DirectSimulation;
use granular_edmd::statistics::{BlockedMean, Estimate};

use crate::gas::{collision_rate, contact_value, periodic_gas};
use crate::transport::Measurement;
use crate::{Outcome, agrees};

/// Packing fraction so low that the momentum and the heat that go over the diameter at once are some 1 %.
const PACKING: f64 = 0.01;

/// Steps over which fluxes are integrated, in mean free times. The error of the trapezoids is 1e-3.
const STEP: f64 = 0.1;

/// Moments of shear and of heat, each with two components.
type Moments = [DVec2; 2];

/// Returns the fluxes of momentum and of energy of disks whose center of mass is at rest.
fn fluxes(disks: &[Disk]) -> Moments {
    disks.iter().fold([DVec2::ZERO; 2], |[shear, heat], disk| {
        let velocity = disk.velocity();
        let energy = disk.translational_energy() + disk.rotational_energy();
        let squares = 0.5 * (velocity.x * velocity.x - velocity.y * velocity.y);
        let part = disk.mass() * DVec2::new(velocity.x * velocity.y, squares);
        [shear + part, heat + energy * velocity]
    })
}

/// Returns the slopes of the mean squared moments of a gas without correlations: these disks at the density
/// and with the lags of a measurement.
fn slopes<R: CollisionRule>(
    measurement: Measurement,
    rule: R,
    disks: Vec<Disk>,
) -> Result<[Estimate; 2], Box<dyn std::error::Error>> {
    let mean_free_time = 1.0 / collision_rate(PACKING);
    let step = STEP * mean_free_time;
    let density = contact_value(PACKING) * 4.0 * PACKING / PI;
    let mut gas = DirectSimulation::new(rule, disks, density, 1)?;
    let (longest, half) = (Measurement::LAGS, Measurement::LAGS / 2);
    let time = (longest - half) as f64 * measurement.interval * mean_free_time;
    let mut slopes = [BlockedMean::new(), BlockedMean::new()];
    let (mut moments, mut flux, mut path) = ([DVec2::ZERO; 2], fluxes(gas.disks()), Vec::new());
    for _ in 0..(measurement.mean_free_times / measurement.interval) as usize {
        for _ in 0..(measurement.interval / STEP).round() as usize {
            gas.run_until(gas.time() + step)?;
            let now = fluxes(gas.disks());
            moments = [0, 1].map(|index| moments[index] + 0.5 * step * (flux[index] + now[index]));
            flux = now;
        }
        path.push(moments);
        let Some(first) = path.len().checked_sub(longest + 1) else { continue };
        for (index, slope) in slopes.iter_mut().enumerate() {
            let squared = |from: usize| 0.5 * moments[index].distance_squared(path[from][index]);
            slope.push((squared(first) - squared(first + longest - half)) / time);
        }
    }
    Ok(slopes.map(|slope| slope.estimate()))
}

/// Tells whether viscosity and conductivity are those of direct simulation, which begins with the same disks.
/// Both have the same number of disks, energy and lags, so what these do to a coefficient cancels.
fn agrees_with_direct_simulation<R: CollisionRule + Clone>(
    name: &str,
    rule: R,
    measurement: Measurement,
    tolerance: f64,
) -> Result<bool, Box<dyn std::error::Error>> {
    let mut gas = periodic_gas(measurement.count, PACKING, rule.clone(), 7)?;
    let expected = slopes(measurement, rule, gas.disks())?;
    let transport = measurement.of(&mut gas)?;
    let (area, temperature) = (0.25 * PI * measurement.count as f64 / PACKING, transport.temperature());
    let shear = ("eta / eta_B", transport.shear_viscosity(), expected[0], 2.0 * area * temperature);
    let unit = 2.0 * area * temperature * temperature;
    let heat = ("lambda / lambda_B", transport.thermal_conductivity(), expected[1], unit);
    let agree = [shear, heat].map(|(coefficient, measured, direct, unit)| {
        println!("{coefficient}, {name}: {measured} over {direct} / {unit}");
        agrees(&format!("{coefficient}, {name}"), measured.mean() * unit / direct.mean(), 1.0, tolerance)
    });
    Ok(agree[0] && agree[1])
}

#[test]
fn smooth_and_rough_disks_have_about_the_transport_of_boltzmann() -> Outcome {
    // The slope of a mean square over 800 stretches of 10 mean free times is known to 7 %, each of two. The
    // tolerance is three errors of their ratio.
    let short = Measurement { count: 200, packing: PACKING, interval: 1.0, mean_free_times: 8000.0 };
    assert!(agrees_with_direct_simulation("smooth", Elastic, short, 0.3)?);
    assert!(agrees_with_direct_simulation("rough", Rough::from_inelasticity(0.0, 0.0)?, short, 0.3)?);
    Ok(())
}

#[test]
#[ignore = "half an hour"]
fn long_rough_disks_have_the_transport_of_boltzmann() -> Outcome {
    // Each slope is known to 1 %. The tolerance is three errors of their ratio. Direct simulation lacks the
    // fluxes over the diameter: for smooth disks, Enskog's viscosity here is 0.5 % above that of Boltzmann,
    // and his conductivity 1.5 %.
    let long = Measurement { count: 1000, packing: PACKING, interval: 1.0, mean_free_times: 400_000.0 };
    assert!(agrees_with_direct_simulation("rough", Rough::from_inelasticity(0.0, 0.0)?, long, 0.045)?);
    Ok(())
}
