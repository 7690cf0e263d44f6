//! Rule, gravity and walls can change between runs.

use granular_edmd::Simulation;
use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Energies, SampleTimes, Series};
use granular_edmd::simulation::{BuildError, RunError};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, initial};
use proptest::prelude::*;

use crate::setups::{config, elastic_gas, setup};

proptest! {
    #![proptest_config(config(30))]

    #[test]
    fn a_change_to_the_same_changes_nothing_but_rounding(setup in setup()) {
        let mut plain = setup.simulation();
        plain.run_until(setup.start + 1.0, &mut ()).unwrap();
        let mut changed = plain.clone();
        changed.set_rule(setup.rule());
        changed.set_gravity(setup.gravity).unwrap();
        changed.set_boundary(setup.boundary()).unwrap();
        for (a, b) in plain.disks().iter().zip(changed.disks()) {
            prop_assert!((a.position() - b.position()).length() < 1e-11);
            prop_assert!((a.velocity() - b.velocity()).length() < 1e-11);
        }
        plain.run_until(setup.start + 1.2, &mut ()).unwrap();
        changed.run_until(setup.start + 1.2, &mut ()).unwrap();
        for (a, b) in plain.disks().iter().zip(changed.disks()) {
            // A base that vibrates is where its phase says, and the phase at late times has an error of 2e-9.
            prop_assert!((a.position() - b.position()).length() < 1e-5, "{:?} {:?}", a, b);
        }
    }

    #[test]
    fn samples_come_when_asked_for_at_any_time(
        start in -200.0..200.0f64,
        change in 0.0..5.0f64,
        interval in 0.01..0.3f64,
    ) {
        let mut simulation = Simulation::builder(Elastic, Container::open(8.0).unwrap())
            .disks([Disk::new(DVec2::new(2.0, 3.0), 0.5).unwrap()])
            .gravity(0.3)
            .starting_at(start)
            .build()
            .unwrap();
        let times = SampleTimes::every(interval).unwrap().starting_at(start).unwrap();
        let (mut one, mut two) = (Series::new(Energies, times), Series::new(Energies, times));
        simulation.run_until(start + change, &mut (&mut one, &mut two)).unwrap();
        simulation.set_gravity(0.4).unwrap();
        simulation.run_until(start + change, &mut (&mut one, &mut two)).unwrap();
        simulation.run_until(start + 6.0, &mut (&mut one, &mut two)).unwrap();
        prop_assert_eq!(one.times(), two.times());
        for (k, &time) in one.times().iter().enumerate() {
            prop_assert_eq!(time, start + k as f64 * interval);
        }
    }
}

#[test]
fn gravity_switched_off_lets_disks_fly_straight() {
    let mut simulation = elastic_gas(50, 20.0, 30.0, 1.0);
    simulation.run_until(10.0, &mut ()).unwrap();
    simulation.set_gravity(0.0).unwrap();
    assert_eq!(simulation.gravity(), 0.0.into());
    let energy = |simulation: &mut Simulation<Elastic>| simulation.measure(&Energies);
    let before = energy(&mut simulation);
    simulation.run_until(30.0, &mut ()).unwrap();
    let after = energy(&mut simulation);
    assert!((after.translational / before.translational - 1.0).abs() < 1e-11);
    assert_eq!(after.potential, 0.0);
    assert!(simulation.set_gravity(f64::NAN).is_err());
    assert_eq!(simulation.gravity(), 0.0.into());
}

#[test]
fn a_rule_counts_from_when_it_is_set() {
    let rule =
        |q, kappa| ContactDuration::new(Frictional::from_inelasticity(q, q, kappa).unwrap(), 1e-4).unwrap();
    let boundary = Container::closed(20.0, 20.0).unwrap();
    let disks = initial::lattice(&boundary, 100, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 4).unwrap();
    let mut simulation = Simulation::builder(rule(0.0, 0.0), boundary).disks(disks).build().unwrap();
    let before = simulation.measure(&Energies).total();
    simulation.run_until(20.0, &mut ()).unwrap();
    assert!((simulation.measure(&Energies).total() / before - 1.0).abs() < 1e-12);
    simulation.set_rule(rule(0.1, 0.2));
    simulation.run_until(30.0, &mut ()).unwrap();
    let after = simulation.measure(&Energies);
    assert!(after.total() < 0.8 * before && after.rotational > 0.01 * before, "{after:?}");
}

#[test]
fn walls_can_move_in_and_out() {
    let mut simulation = elastic_gas(20, 20.0, 20.0, 0.0);
    simulation.run_until(20.0, &mut ()).unwrap();
    let error = simulation.set_boundary(Container::closed(5.0, 20.0).unwrap()).unwrap_err();
    assert!(matches!(error, BuildError::Outside { .. } | BuildError::OverlapsWall { .. }), "{error}");
    let before = simulation.disks();
    simulation.set_boundary(Container::closed(40.0, 60.0).unwrap()).unwrap();
    assert_eq!(simulation.counters().max_overlap, simulation.counters().max_overlap.min(1e-9));
    for (a, b) in before.iter().zip(simulation.disks()) {
        assert!((a.position() - b.position()).length() < 1e-12);
    }
    simulation.run_until(200.0, &mut ()).unwrap();
    assert!(simulation.disks().iter().any(|disk| disk.position().y > 30.0));
    assert_eq!(simulation.boundary().width(), 40.0);
    let moving = Container::closed(40.0, 60.0)
        .unwrap()
        .with_motion(Wall::Floor, BiParabolic::new(0.1, 3.0).unwrap())
        .unwrap();
    if simulation.set_boundary(moving).is_ok() {
        simulation.run_until(300.0, &mut ()).unwrap();
    }
}

#[test]
fn sides_that_become_periodic_must_not_join_disks() {
    // Free between walls; across the joined sides they overlap.
    let at = |x: f64| Disk::new(DVec2::new(x, 1.0), 0.5).unwrap();
    let mut simulation =
        Simulation::builder(Elastic, Container::closed(8.0, 2.0).unwrap().with_periodic_sides().unwrap())
            .disks([at(0.1), at(5.5)])
            .build()
            .unwrap();
    let narrow = Container::closed(6.0, 2.0).unwrap().with_periodic_sides().unwrap();
    let error = simulation.set_boundary(narrow).unwrap_err();
    assert!(matches!(error, BuildError::Overlap { first: 0, second: 1, .. }), "{error}");
    simulation.run_until(1.0, &mut ()).unwrap();
}

#[test]
fn a_run_cannot_end_before_it_begins() {
    let mut simulation = elastic_gas(5, 20.0, 20.0, 0.0);
    simulation.run_until(3.0, &mut ()).unwrap();
    for end in [2.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = simulation.run_until(end, &mut ()).unwrap_err();
        assert!(matches!(error, RunError::End { time, .. } if time == 3.0), "{error}");
    }
    simulation.run_until(3.0, &mut ()).unwrap();
}
