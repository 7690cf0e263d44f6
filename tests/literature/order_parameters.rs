//! The order parameters of flows whose integrals are known.

use std::f64::consts::{PI, TAU};

use granular_edmd::boundary::{Boundary, Domain};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{ConvectionOrder, Observable, OrderParameters, Snapshot};
use granular_edmd::statistics::RunningMean;
use granular_edmd::{Disk, ParameterError, initial};

use crate::Outcome;
use crate::gas::Gas;

const WIDTH: f64 = 60.0;

/// The order of evenly spread disks with this vertical velocity.
fn order(flow: impl Fn(f64) -> f64) -> Result<ConvectionOrder, ParameterError> {
    let disk = |k: i32| {
        let x = WIDTH * (f64::from(k) + 0.5) / 10_000.0;
        Disk::new(DVec2::new(x, 5.0), 0.5)?.with_velocity(DVec2::new(0.0, flow(x)))
    };
    let disks = (0..10_000).map(disk).collect::<Result<Vec<_>, _>>()?;
    let domain = Domain::new(0.0, WIDTH, 0.0, 150.0);
    Ok(OrderParameters.measure(&Snapshot::new(0.0, &disks, domain, 0.0)))
}

#[test]
fn one_roll_and_two_have_the_order_of_their_integrals() -> Outcome {
    // Midpoint sums of 10 000 points: errors of 1e-8.
    let one = order(|x| (PI * x / WIDTH).cos())?;
    assert!((one.one_roll - 4.0 / (3.0 * PI)).abs() < 1e-6 && one.two_rolls.abs() < 1e-6, "{one:?}");
    let two = order(|x| -(TAU * x / WIDTH).cos())?;
    assert!(two.one_roll.abs() < 1e-6 && (two.two_rolls - 0.5).abs() < 1e-6, "{two:?}");
    Ok(())
}

#[test]
fn a_gas_at_rest_has_the_noise_of_its_temperature() -> Outcome {
    let gas = Gas::of(50, 0.02, 1.0, 1);
    let container = gas.container()?;
    let domain = container.domain();
    let [mut one, mut two] = [RunningMean::default(); 2];
    for seed in 0..400 {
        let disks = initial::scattered(&container, 50, 0.5, gas.height, seed)?;
        let disks = initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, seed)?)?;
        let order = OrderParameters.measure(&Snapshot::new(0.0, &disks, domain, 0.0));
        one.push(order.one_roll);
        two.push(order.two_rolls);
    }
    // With 400 samples, a variance is known to sqrt(2/400) = 7 %, and a deviation to 3.5 %. Momentum at rest
    // takes 1/N of it.
    let noise = (1.0_f64 / 100.0).sqrt();
    assert!((one.standard_deviation() / noise - 1.0).abs() < 0.15, "{}", one.standard_deviation());
    assert!((two.standard_deviation() / noise - 1.0).abs() < 0.15, "{}", two.standard_deviation());
    assert!(one.mean().abs() < 5.0 * one.standard_error() && two.mean().abs() < 5.0 * two.standard_error());
    Ok(())
}
