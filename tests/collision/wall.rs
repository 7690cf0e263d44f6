//! A wall is a partner of infinite mass.

use granular_edmd::Disk;
use granular_edmd::collision::{WallEncounter, collide, collide_with_wall};
use granular_edmd::glam::DVec2;
use granular_edmd::strategies::disk_closing_on_wall;
use proptest::prelude::*;

use crate::kinematics::{
    EPSILON, angular_magnitude, angular_momentum, kinetic_energy, momentum, speed_magnitude, surface_velocity,
};
use crate::rules::{config, law};

/// Mass and size of the body that stands for a wall, in units of the disk's.
const HEAVY: f64 = 1e13;

fn giant(disk: &Disk, velocity: DVec2) -> Disk {
    Disk::new(DVec2::ZERO, HEAVY * disk.radius())
        .and_then(|giant| giant.with_mass(HEAVY * disk.mass()))
        .and_then(|giant| giant.with_velocity(velocity))
        .unwrap()
}

proptest! {
    #![proptest_config(config())]

    /// A partner `HEAVY` times heavier changes the effective masses, hence the impulse, by a few parts in
    /// `HEAVY`; the impulse changes speeds by at most twice the speeds of the contact.
    #[test]
    fn a_heavy_partner_is_a_wall(law in law(), (disk, normal, velocity) in disk_closing_on_wall()) {
        let giant = giant(&disk, velocity);
        let near = disk.with_position(normal * (disk.radius() + giant.radius())).unwrap();
        let limit = collide(&law.rule(), &near, &giant);
        let wall = collide_with_wall(&law.rule(), &disk, near.position().normalize(), velocity);
        let (contact, bounced) = (wall.contact, wall.disk);
        prop_assert_eq!(limit.contact.closing_speed(), contact.closing_speed());
        prop_assert_eq!(limit.contact.slip_speed(), contact.slip_speed());
        let speeds = contact.closing_speed() + contact.slip_speed().abs();
        let tolerance = 16.0 * speeds / HEAVY + 8.0 * EPSILON * (speed_magnitude(&disk) + velocity.length());
        let spin = disk.radius() * (limit.first.angular_velocity() - bounced.angular_velocity());
        prop_assert!((limit.first.velocity() - bounced.velocity()).length() <= tolerance);
        prop_assert!(spin.abs() <= tolerance);
        prop_assert!((limit.second.velocity() - velocity).length() <= tolerance);
        prop_assert!(limit.second.angular_velocity().abs() * giant.radius() <= tolerance);
    }

    #[test]
    fn the_masses_are_those_of_the_disk(law in law(), (disk, normal, velocity) in disk_closing_on_wall()) {
        let contact = collide_with_wall(&law.rule(), &disk, normal, velocity).contact;
        let tangential = disk.mass() / (1.0 + 1.0 / disk.inertia_factor());
        prop_assert!((contact.normal_mass() / disk.mass() - 1.0).abs() <= 2.0 * EPSILON);
        prop_assert!((contact.tangential_mass() / tangential - 1.0).abs() <= 4.0 * EPSILON);
    }

    /// The surface leaves the wall, in the wall's frame, as from any other partner.
    #[test]
    fn the_surface_parts_from_the_wall(law in law(), (disk, normal, velocity) in disk_closing_on_wall()) {
        let encounter = collide_with_wall(&law.rule(), &disk, normal, velocity);
        let WallEncounter { disk: bounced, contact, .. } = encounter;
        let relative = velocity - surface_velocity(&bounced, -normal * disk.radius());
        let speeds = speed_magnitude(&disk) + speed_magnitude(&bounced) + velocity.length();
        let tolerance = 16.0 * EPSILON * speeds;
        let closing = -(1.0 - 2.0 * law.normal_inelasticity) * contact.closing_speed();
        prop_assert!((relative.dot(normal) - closing).abs() <= tolerance);
        if law.sticks(&contact) {
            let slip = -(1.0 - 2.0 * law.tangential_inelasticity) * contact.slip_speed();
            prop_assert!((relative.dot(normal.perp()) - slip).abs() <= tolerance);
        }
    }

    /// The disk's momentum changes by the impulse; its angular momentum about the contact point does not.
    #[test]
    fn the_wall_gives_the_impulse(law in law(), (disk, normal, velocity) in disk_closing_on_wall()) {
        let encounter = collide_with_wall(&law.rule(), &disk, normal, velocity);
        let WallEncounter { disk: bounced, impulse, .. } = encounter;
        let kick = normal * impulse.normal() + normal.perp() * impulse.tangential();
        let size = momentum(&disk).length() + momentum(&bounced).length();
        prop_assert!((momentum(&bounced) - momentum(&disk) - kick).length() <= 8.0 * EPSILON * size);
        // The arm is taken from the center: the position of the disk is another matter.
        let centered = |disk: &Disk| disk.with_position(DVec2::ZERO).unwrap();
        let (disk, bounced) = (centered(&disk), centered(&bounced));
        let touch = -normal * disk.radius();
        let change = angular_momentum(&bounced, touch) - angular_momentum(&disk, touch);
        let size = angular_magnitude(&bounced, touch) + angular_magnitude(&disk, touch);
        prop_assert!(change.abs() <= 16.0 * EPSILON * size);
    }

    /// The wall's motion does the work $`\vec\Delta\cdot\vec V`$ in the laboratory, on top of the loss.
    #[test]
    fn a_moving_wall_does_work(law in law(), (disk, normal, velocity) in disk_closing_on_wall()) {
        let encounter = collide_with_wall(&law.rule(), &disk, normal, velocity);
        let WallEncounter { disk: bounced, contact, impulse, .. } = encounter;
        let work = (normal * impulse.normal() + normal.perp() * impulse.tangential()).dot(velocity);
        let (before, after) = (kinetic_energy(&disk), kinetic_energy(&bounced));
        let wall = 0.5 * disk.mass() * velocity.length_squared();
        let change = impulse.energy_change(&contact) + work;
        prop_assert!((after - before - change).abs() <= 64.0 * EPSILON * (before + after + wall));
    }
}
