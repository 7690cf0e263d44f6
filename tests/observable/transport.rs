//! Transport coefficients refuse runs whose numbers would not be those of an elastic gas.

use std::error::Error;

use granular_edmd::boundary::{Boundary, Container, Part, Vessel};
use granular_edmd::collision::{CollisionRule, Contact, Elastic, Impulse, Rough, Smooth, from_fn};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{SampleTimes, TransportCoefficients};
use granular_edmd::simulation::{Inlet, Limits, RunError, WhiteNoise};
use granular_edmd::{Disk, ParameterError, Simulation, initial};

type Result<T = ()> = std::result::Result<T, Box<dyn std::error::Error>>;

fn gas<R: CollisionRule, B: Boundary>(rule: R, walls: B) -> Result<Simulation<R, B>> {
    let disks = initial::lattice(&walls, 20, 0.4)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
    Ok(Simulation::builder(rule, walls).disks(disks).build()?)
}

fn empty() -> Result<Container> {
    Ok(Container::periodic(12.0, 12.0)?)
}

fn coefficients() -> Result<TransportCoefficients> {
    Ok(TransportCoefficients::new(4, SampleTimes::every(1.0)?)?)
}

fn refusal<R: CollisionRule, B: Boundary>(mut gas: Simulation<R, B>) -> Result<String> {
    reason(gas.run_until(200.0, &mut coefficients()?))
}

/// Returns the observer's own error.
fn reason(refused: std::result::Result<impl std::fmt::Debug, RunError>) -> Result<String> {
    let error = refused.expect_err("such a run is refused");
    Ok(error.source().ok_or("no source")?.to_string())
}

#[test]
fn a_gas_that_is_not_elastic_or_has_walls_is_refused() -> Result {
    let error = refusal(gas(Smooth::from_restitution(0.9)?, empty()?)?)?;
    assert!(error.contains("energy lost in a collision must be 0"), "{error}");
    let peg = Vessel::new(empty()?).with("peg", Part::peg(DVec2::splat(11.0), 0.3)?)?;
    let error = refusal(gas(Elastic, peg)?)?;
    assert!(error.contains("time of a collision with a wall must be never"), "{error}");
    gas(Rough::from_inelasticity(0.0, 0.0)?, empty()?)?.run_until(200.0, &mut coefficients()?)?;
    Ok(())
}

/// A couple that turns the relative spin around keeps the energy. The motions that the observer follows by
/// the impulses and couples of the collisions must be those of the disks at each sample, or the run is
/// refused.
#[test]
fn elastic_couples_are_followed() -> Result {
    let turning = from_fn(|contact: &Contact| {
        let couple = 2.0 * contact.relative_spin() * contact.spin_inertia();
        Impulse::new(contact.normal_impulse(1.0), 0.0).with_couple(couple)
    });
    let mut gas = gas(turning, empty()?)?;
    gas.map_disks(|index, disk| disk.with_angular_velocity(if index % 2 == 0 { 5.0 } else { -3.0 }))?;
    let mut transport = coefficients()?;
    gas.run_until(400.0, &mut transport)?;
    assert!(transport.shear_viscosity().mean() > 0.0 && transport.thermal_conductivity().mean() > 0.0);
    Ok(())
}

/// The changes are of a velocity, a spin, a radius, and the number of disks.
#[test]
fn disks_that_change_otherwise_than_by_collisions_are_refused() -> Result {
    let changed = "changed otherwise than in collisions must be never";
    let changes: [fn(Disk) -> std::result::Result<Disk, ParameterError>; 3] = [
        |disk| disk.with_velocity(-2.0 * disk.velocity()),
        |disk| disk.with_angular_velocity(7.0),
        |disk| Disk::new(disk.position(), 0.3)?.with_velocity(disk.velocity()),
    ];
    for change in changes {
        let (mut transport, mut run) = (coefficients()?, gas(Elastic, empty()?)?);
        run.run_until(50.0, &mut transport)?;
        run.map_disks(|_, disk| change(disk))?;
        for end in [100.0, 150.0] {
            let error = reason(run.run_until(end, &mut transport))?;
            assert!(error.contains(changed), "{error}");
        }
    }
    let mut run = gas(Elastic, empty()?)?;
    let newcomer = Disk::new(DVec2::ZERO, 0.2)?;
    let places = [DVec2::ZERO, DVec2::splat(12.0)];
    run.add_inlet(Inlet::new(places, [newcomer], SampleTimes::every(7.0)?, 1)?)?;
    let error = reason(run.run_until(200.0, &mut coefficients()?))?;
    assert!(error.contains(changed), "{error}");
    Ok(())
}

/// The pressure and the area belong to one gas. So an observer of several would mix them.
#[test]
fn one_observer_measures_one_gas() -> Result {
    let (mut transport, mut run) = (coefficients()?, gas(Elastic, empty()?)?);
    run.run_until(50.0, &mut transport)?;
    run.run_until(99.5, &mut transport)?;
    run.clone().run_until(120.0, &mut transport)?;

    let error = reason(gas(Elastic, empty()?)?.run_until(50.0, &mut transport.clone()))?;
    assert!(error.contains("start of the run must be the end of the previous one"), "{error}");
    let mut wider = gas(Elastic, Container::periodic(14.0, 12.0)?)?;
    wider.run_until(120.0, &mut ())?;
    let error = reason(wider.run_until(200.0, &mut transport))?;
    assert!(error.contains("area of the domain must be that of the previous run"), "{error}");
    Ok(())
}

#[test]
fn driven_runs_are_refused_however_rare_the_kicks() -> Result {
    for interval in [0.3, 1.0, 7.0, 150.0] {
        let mut run = gas(Elastic, empty()?)?;
        let mut noise = WhiteNoise::new(0.5, SampleTimes::every(interval)?, 1)?;
        let error = reason(run.run_driven(&Limits::until(200.0), &mut noise, &mut coefficients()?))?;
        assert!(error.contains("changed otherwise than in collisions"), "{interval}: {error}");
    }
    Ok(())
}
