//! Stress from collisions: the equation of state, walls and bulk, shear.

use granular_edmd::Simulation;
use granular_edmd::boundary::{Boundary, Container, Region, Thermal, Wall};
use granular_edmd::collision::{Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::initial;
use granular_edmd::observable::{Energies, SampleTimes, Stress, WallStress};
use granular_edmd::statistics::Estimate;

use crate::gas::{Gas, collision_rate, contact_value, periodic_gas, run_for};
use crate::{Outcome, agrees, measured};

/// Returns whether two estimates agree within four standard errors of their difference.
fn agree(what: &str, one: Estimate, other: Estimate) -> bool {
    let error = one.standard_error().hypot(other.standard_error());
    measured(&format!("{what}, one"), one);
    measured(&format!("{what}, other"), other);
    (one.mean() - other.mean()).abs() < 4.0 * error
}

#[test]
fn the_virial_of_a_periodic_gas_is_its_equation_of_state() -> Outcome {
    for packing in [0.1, 0.3] {
        let mut gas = periodic_gas(1000, packing, Elastic, 1)?;
        let times = SampleTimes::every(1.0 / collision_rate(packing))?;
        let mut stress = Stress::new(times);
        gas.run_until(gas.time() + 400.0 * times.interval(), &mut stress)?;
        let temperature = gas.measure(&Energies).translational * 1000.0 / 999.0;
        let domain = gas.boundary().domain();
        let ideal = 1000.0 / (domain.width() * domain.height()) * temperature;
        let tensor = stress.tensor();
        let measured = tensor.pressure.mean() / ideal;
        // There are 2e5 collisions, whose impulses scatter by half of their mean: 0.1 %. Henderson's contact
        // value is good to 0.2 %, and the gas of 1000 disks to 0.1 %.
        assert!(agrees(
            &format!("Z, {packing}"),
            measured,
            1.0 + 2.0 * packing * contact_value(packing),
            0.006
        ));
        assert!(agree("P_xx and P_yy", tensor.xx, tensor.yy));
        // Smooth disks push along the line of their centers: the tensor of collisions is symmetric.
        let collisional = stress.collisional();
        assert!((collisional.xy.mean() - collisional.yx.mean()).abs() < 1e-12 * tensor.pressure.mean());
        for shear in [tensor.xy, tensor.yx] {
            assert!(shear.mean().abs() < 4.0 * shear.standard_error(), "{shear}");
        }
    }
    Ok(())
}

#[test]
fn the_stress_in_the_bulk_is_the_pressure_on_the_walls() -> Outcome {
    let gas = Gas::of(600, 0.25, 1.0, 1);
    let mut run = gas.simulation(Elastic, 0.0)?;
    run_for(&mut run, 50.0, &mut ())?;
    let times = SampleTimes::every(1.0)?;
    let bulk = Region::new(DVec2::new(3.0, 4.0), DVec2::new(gas.width - 5.0, gas.height - 4.0));
    let walls = WallStress::new(times).with_wall("floor", gas.width)?.with_wall("lid", gas.width)?;
    let mut watched = (Stress::new(times), Stress::new(times).within(bulk)?, walls);
    run.run_until(1000.0, &mut watched)?;
    let (whole, bulk, walls) = watched;
    let wall = |name| walls.pressure(name).ok_or("a wall that is not watched");
    // The vertical momentum that enters at the floor leaves at the lid.
    assert!(agree("floor and lid", wall("floor")?, wall("lid")?));
    assert!(agree("floor and whole box", wall("floor")?, whole.tensor().yy));
    assert!(agree("floor and bulk", wall("floor")?, bulk.tensor().yy));
    assert!(agree("bulk, both directions", bulk.tensor().xx, bulk.tensor().yy));
    assert!(bulk.tensor().yy.standard_error() < 0.01 * bulk.tensor().yy.mean());
    Ok(())
}

#[test]
fn a_sheared_gas_drags_its_walls_as_it_is_sheared() -> Outcome {
    // Thermal walls that run opposite ways drag a gas of frictional grains.
    let container = Container::closed(30.0, 15.0)?.with_periodic_sides()?;
    let container = container.with_surface_speed(Wall::Floor, -1.0)?.with_surface_speed(Wall::Lid, 1.0)?;
    let container = container
        .with_temperature(Wall::Floor, Thermal::new(1.0)?)?
        .with_temperature(Wall::Lid, Thermal::new(1.0)?)?;
    let disks = initial::scattered(&container, 120, 0.5, 15.0, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
    let mut run = Simulation::builder(Frictional::from_inelasticity(0.01, 0.01, 0.3)?, container)
        .disks(disks)
        .build()?;
    run.run_until(200.0, &mut ())?;
    let times = SampleTimes::every(5.0)?;
    let walls = WallStress::new(times).with_wall("floor", 30.0)?.with_wall("lid", 30.0)?;
    let bulk = Region::new(DVec2::new(0.0, 3.0), DVec2::new(30.0, 12.0));
    let mut watched = (Stress::new(times).within(bulk)?, walls);
    run.run_until(2500.0, &mut watched)?;
    let (bulk, walls) = watched;
    let shear = |name| walls.shear(name).ok_or("a wall that is not watched");
    assert!(agree("shear of floor and lid", shear("floor")?, shear("lid")?));
    assert!(agree("shear of floor and bulk", shear("floor")?, bulk.tensor().xy));
    // The tensor is not symmetric at each collision, but is on average where spins are steady.
    assert!(agree("P_xy and P_yx", bulk.tensor().xy, bulk.tensor().yx));
    let xy = bulk.tensor().xy;
    assert!(xy.mean().abs() > 20.0 * xy.standard_error(), "{xy}");
    Ok(())
}
