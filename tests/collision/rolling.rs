//! Rolling friction: closed forms of single collisions and of a disk that hops between floor and lid.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{
    CollisionRule, Contact, Elastic, Frictional, RollingFriction, Smooth, collide,
};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{CollisionCounts, EnergyChange};
use granular_edmd::{Disk, Simulation, initial};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// Mass of the disks; with radius 1/2, their moment of inertia is 1/4.
const MASS: f64 = 2.0;

fn spinning(y: f64, spin: f64) -> Outcome<Disk> {
    Ok(Disk::new(DVec2::new(5.0, y), 0.5)?.with_mass(MASS)?.with_angular_velocity(spin)?)
}

/// A disk that hops between floor and lid with speed v loses the spin μ_r 2mv R/I at each of both, and stops.
#[test]
fn a_hopping_disk_loses_a_known_spin_at_each_hit() -> Outcome {
    let rule = RollingFriction::new(Elastic, 0.05)?;
    let disk = spinning(3.5, 3.0)?.with_velocity(DVec2::new(0.0, -1.5))?;
    let mut run = Simulation::builder(rule, Container::closed(10.0, 7.0)?).disks([disk]).build()?;
    let loss = 0.05 * 2.0 * MASS * 1.5 * 0.5 / 0.25;
    for hit in 1..=8 {
        // The way between floor and lid takes 4.
        run.run_until(2.0 + 4.0 * f64::from(hit - 1) + 1.0, &mut ())?;
        let expected = (3.0 - loss * f64::from(hit)).max(0.0);
        let spin = run.disks()[0].angular_velocity();
        assert!((spin - expected).abs() < 1e-14, "{hit}: {spin} {expected}");
        assert_eq!(run.disks()[0].velocity().y.abs(), 1.5);
    }
    assert_eq!(run.disks()[0].angular_velocity(), 0.0);
    Ok(())
}

/// With friction that never sticks, each hit takes the spin of dynamic friction, too, and pushes the disk.
#[test]
fn friction_acts_first_and_is_the_same() -> Outcome {
    let slipping = Frictional::from_restitution(1.0, 0.0, 0.01)?;
    let rule = RollingFriction::new(slipping, 0.05)?;
    let disk = spinning(3.5, 3.0)?.with_velocity(DVec2::new(0.0, -1.5))?;
    let mut run = Simulation::builder(rule, Container::closed(10.0, 7.0)?).disks([disk]).build()?;
    run.run_until(3.0, &mut ())?;
    let normal = 2.0 * MASS * 1.5;
    let (dynamic, rolling) = (0.01 * normal * 0.5 / 0.25, 0.05 * normal * 0.5 / 0.25);
    let after = run.disks()[0];
    assert!((after.angular_velocity() - (3.0 - dynamic - rolling)).abs() < 1e-14, "{after:?}");
    assert!((after.velocity().x.abs() - 0.01 * normal / MASS).abs() < 1e-15, "{after:?}");
    Ok(())
}

/// Two disks head on, in both orders and mirrored: opposite spins slow each other, equal spins do not.
#[test]
fn two_disks_head_on() -> Outcome {
    let rule = RollingFriction::new(Elastic, 0.1)?;
    let left = spinning(0.0, 2.0)?.with_position(DVec2::ZERO)?.with_velocity(DVec2::X)?;
    let right = spinning(0.0, -2.0)?.with_position(DVec2::X)?.with_velocity(DVec2::NEG_X)?;
    let met = collide(&rule, &left, &right);
    // Normal impulse m v = 4, effective radius 1/4, couple 0.1: each spin changes by 0.1/I = 0.4.
    assert!((met.first.angular_velocity() - 1.6).abs() < 1e-15, "{:?}", met.first);
    assert!((met.second.angular_velocity() + 1.6).abs() < 1e-15);
    let turned = collide(&rule, &right, &left);
    assert_eq!((turned.first, turned.second), (met.second, met.first));
    let alike = collide(&rule, &left, &right.with_angular_velocity(2.0)?);
    assert_eq!(alike.first.angular_velocity(), 2.0);
    Ok(())
}

/// The balance of energy in a run counts the couple, and angular momentum is kept between disks.
#[test]
fn energy_and_angular_momentum_balance_in_a_run() -> Outcome {
    let container = Container::periodic(12.0, 12.0)?;
    let mix = |k: i32| {
        let radius = if k % 3 == 0 { 0.7 } else { 0.35 };
        Disk::new(DVec2::ZERO, radius)?
            .with_mass(radius * radius)?
            .with_angular_velocity(f64::from(k % 5) - 2.0)
    };
    let mix = (0..60).map(mix).collect::<Result<Vec<_>, _>>()?;
    let disks = initial::scattered_mix(&container, mix, 12.0, 2)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3)?;
    let rule = RollingFriction::new(Frictional::from_inelasticity(0.05, 0.1, 0.3)?, 0.2)?;
    let mut run = Simulation::builder(rule, container).disks(disks).build()?;
    let energy = |disks: &[Disk]| -> f64 {
        disks.iter().map(|disk| disk.translational_energy() + disk.rotational_energy()).sum()
    };
    let before = energy(&run.disks());
    let (mut change, mut counts) = (EnergyChange::default(), CollisionCounts::default());
    run.run_until(50.0, &mut (&mut change, &mut counts))?;
    let lost = change.disks().mean() * change.disks().count() as f64;
    let after = energy(&run.disks());
    assert!(after < before && (after - before - lost).abs() < 1e-9 * before, "{before} {after} {lost}");
    Ok(())
}

/// Without a couple, nothing changes: rough disks keep their bits.
#[test]
fn a_coefficient_of_zero_keeps_the_bits() -> Outcome {
    let rule = Frictional::from_inelasticity(0.05, 0.1, 0.3)?;
    let end = |rule: &dyn CollisionRule| -> Outcome<Vec<Disk>> {
        let container = Container::closed(12.0, 12.0)?;
        let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 3)?;
        let mut run = Simulation::builder(rule, container).disks(disks).gravity(0.1).build()?;
        run.run_until(15.0, &mut ())?;
        Ok(run.disks())
    };
    assert_eq!(end(&rule)?, end(&RollingFriction::new(rule, 0.0)?)?);
    Ok(())
}

#[test]
fn a_contact_that_pulls_has_no_rolling_friction() {
    let glue =
        granular_edmd::collision::from_fn(|_: &Contact| granular_edmd::collision::Impulse::new(-1.0, 0.0));
    let contact = Contact::new(1.0, 0.0, 0.5, 0.5 / 3.0).with_spin(1.0, 0.1, 0.0);
    assert_eq!(RollingFriction::new(glue, 0.5).unwrap().impulse(&contact).couple(), 0.0);
    assert!(RollingFriction::new(Smooth::from_restitution(1.0).unwrap(), -0.5).is_err());
}
