//! Six collisions worked by hand, with numbers to compare any implementation with.
//!
//! Radius 1/2 and mass 1 unless said; $`\hat n`$ from the second body to the first.

use granular_edmd::Disk;
use granular_edmd::collision::{Encounter, Frictional, Regime, WallEncounter, collide, collide_with_wall};
use granular_edmd::glam::DVec2;

/// The figures carry ten decimals.
const TOLERANCE: f64 = 1e-10;

fn close(actual: f64, expected: f64, what: &str) {
    assert!((actual - expected).abs() < TOLERANCE, "{what}: {actual} is not {expected}");
}

fn disk(position: DVec2, radius: f64, mass: f64, velocity: (f64, f64), angular_velocity: f64) -> Disk {
    Disk::new(position, radius)
        .and_then(|disk| disk.with_mass(mass))
        .and_then(|disk| disk.with_velocity(velocity.into()))
        .and_then(|disk| disk.with_angular_velocity(angular_velocity))
        .unwrap()
}

fn rule(normal: f64, tangential: f64, static_friction: f64, dynamic_friction: f64) -> Frictional {
    Frictional::from_inelasticity(normal, tangential, static_friction)
        .and_then(|rule| rule.with_dynamic_friction(dynamic_friction))
        .unwrap()
}

fn moves(disk: &Disk, velocity: (f64, f64), angular_velocity: f64) {
    close(disk.velocity().x, velocity.0, "velocity along x");
    close(disk.velocity().y, velocity.1, "velocity along y");
    close(disk.angular_velocity(), angular_velocity, "angular velocity");
}

fn energy(disk: &Disk) -> f64 {
    disk.translational_energy() + disk.rotational_energy()
}

/// Regime, closing and slip speed, impulse, and change of energy in the laboratory.
type Expected = (Regime, (f64, f64), (f64, f64), f64);
type Motion = ((f64, f64), f64);

fn pair(rule: &Frictional, first: &Disk, second: &Disk, expected: Expected, after: [Motion; 2]) {
    let Encounter { first: new_first, second: new_second, contact, impulse, .. } =
        collide(rule, first, second);
    let (regime, speeds, impulses, change) = expected;
    assert_eq!(impulse.regime(), regime);
    close(contact.closing_speed(), speeds.0, "closing speed");
    close(contact.slip_speed(), speeds.1, "slip speed");
    close(impulse.normal(), impulses.0, "normal impulse");
    close(impulse.tangential(), impulses.1, "tangential impulse");
    moves(&new_first, after[0].0, after[0].1);
    moves(&new_second, after[1].0, after[1].1);
    close(impulse.energy_change(&contact), change, "energy");
    close(
        energy(&new_first) + energy(&new_second) - energy(first) - energy(second),
        change,
        "energy of the disks",
    );
}

fn floor(rule: &Frictional, disk: &Disk, floor_speed: f64, expected: Expected, after: Motion) {
    let WallEncounter { disk: bounced, contact, impulse, .. } =
        collide_with_wall(rule, disk, DVec2::Y, DVec2::Y * floor_speed);
    let (regime, speeds, impulses, change) = expected;
    assert_eq!(impulse.regime(), regime);
    close(contact.closing_speed(), speeds.0, "closing speed");
    close(contact.slip_speed(), speeds.1, "slip speed");
    close(impulse.normal(), impulses.0, "normal impulse");
    close(impulse.tangential(), impulses.1, "tangential impulse");
    moves(&bounced, after.0, after.1);
    close(energy(&bounced) - energy(disk), change, "energy of the disk");
    close(impulse.energy_change(&contact) + impulse.normal() * floor_speed, change, "energy and work");
}

#[test]
fn equal_disks_stick() {
    let first = disk(DVec2::new(0.6, 0.8), 0.5, 1.0, (-1.0, -0.5), 2.0);
    let second = disk(DVec2::ZERO, 0.5, 1.0, (0.5, 0.25), -1.0);
    let expected = (Regime::Sticking, (1.5, -0.25), (1.35, -1.0 / 15.0), -0.205_833_333_333);
    let after =
        [((-0.136_666_666_667, 0.54), 2.266_666_666_667), ((-0.363_333_333_333, -0.79), -0.733_333_333_333)];
    pair(&rule(0.1, 0.2, 0.5, 0.4), &first, &second, expected, after);
}

#[test]
fn equal_disks_slide() {
    let first = disk(DVec2::new(0.6, 0.8), 0.5, 1.0, (-1.0, -0.5), 6.0);
    let second = disk(DVec2::ZERO, 0.5, 1.0, (0.5, 0.25), 4.0);
    let expected = (Regime::Sliding, (1.5, 4.25), (1.35, 0.108), -0.626_508);
    let after = [((-0.2764, 0.6448), 5.568), ((-0.2236, -0.8948), 3.568)];
    pair(&rule(0.1, 0.2, 0.1, 0.08), &first, &second, expected, after);
}

#[test]
fn unequal_disks_slide() {
    let first = disk(DVec2::new(1.25, 0.0), 0.75, 2.0, (-2.0, 1.0), 6.0);
    let second = disk(DVec2::ZERO, 0.5, 0.5, (1.0, -1.0), 3.0);
    let expected = (Regime::Sliding, (3.0, 4.0), (2.28, 0.1824), -0.946_838_4);
    let after = [((-0.86, 1.0912), 5.7568), ((-3.56, -1.3648), 1.5408)];
    pair(&rule(0.05, 0.3, 0.1, 0.08), &first, &second, expected, after);
}

#[test]
fn a_rising_floor_sticks_and_does_work() {
    let disk = disk(DVec2::ZERO, 0.5, 1.0, (0.3, -1.0), 1.2);
    let expected = (Regime::Sticking, (1.4, 0.9), (2.52, 0.48), 0.5688);
    floor(&rule(0.1, 0.2, 0.5, 0.5), &disk, 0.4, expected, ((-0.18, 1.52), -0.72));
}

#[test]
fn a_floor_slides() {
    let disk = disk(DVec2::ZERO, 0.5, 1.0, (3.0, -1.0), -2.0);
    let expected = (Regime::Sliding, (1.0, 2.0), (1.8, 0.18), -0.4914);
    floor(&rule(0.1, 0.2, 0.1, 0.1), &disk, 0.0, expected, ((2.82, 0.8), -2.72));
}

/// A disk that rolls on the floor has no slip: a wrong sign of the lever arm shows here.
#[test]
fn a_rolling_disk_feels_no_friction() {
    let disk = disk(DVec2::ZERO, 0.5, 1.0, (1.0, -1.0), -2.0);
    let expected = (Regime::Sticking, (1.0, 0.0), (1.8, 0.0), -0.18);
    floor(&rule(0.1, 0.2, 0.5, 0.5), &disk, 0.0, expected, ((1.0, 0.8), -2.0));
}
