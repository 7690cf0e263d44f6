//! The motion of the surfaces after the collision, from the velocities of the disks.

use granular_edmd::Disk;
use granular_edmd::collision::{Contact, Elastic, Encounter, Impulse, collide, collide_with_wall, from_fn};
use granular_edmd::strategies::touching_pair;
use proptest::prelude::*;

use crate::kinematics::{EPSILON, contact_velocity, normal, speed_magnitude};
use crate::rules::{config, law};

/// Speeds of the contact are differences of the disks' speeds: rounding counts with the latter.
fn tolerance(disks: [&Disk; 4]) -> f64 {
    16.0 * EPSILON * disks.into_iter().map(speed_magnitude).sum::<f64>()
}

proptest! {
    #![proptest_config(config())]

    /// The contact that the rule sees is the relative velocity of the two points that touch.
    #[test]
    fn the_contact_is_that_of_the_surfaces(law in law(), (first, second) in touching_pair()) {
        let contact = collide(&law.rule(), &first, &second).contact;
        let (closing, slip) = contact_velocity(normal(&first, &second), &first, &second);
        let tolerance = tolerance([&first, &second, &first, &second]);
        prop_assert!((contact.closing_speed() - closing).abs() <= tolerance);
        prop_assert!((contact.slip_speed() - slip).abs() <= tolerance);
        prop_assert_eq!(contact.time_since_last_collision(), f64::INFINITY);
    }

    /// The effective masses, from the paper's moments of inertia: $`1/\mu_t = \sum 1/m_i + R_i^2/I_i`$.
    #[test]
    fn the_masses_are_those_of_the_disks((first, second) in touching_pair()) {
        let contact = collide(&Elastic, &first, &second).contact;
        let reduced = first.mass() * second.mass() / (first.mass() + second.mass());
        let compliance = |disk: &Disk| 1.0 / disk.mass() + disk.radius().powi(2) / disk.moment_of_inertia();
        let tangential = 1.0 / (compliance(&first) + compliance(&second));
        prop_assert!((contact.normal_mass() / reduced - 1.0).abs() <= 8.0 * EPSILON);
        prop_assert!((contact.tangential_mass() / tangential - 1.0).abs() <= 16.0 * EPSILON);
    }

    /// $`v_n' = -(1-2q_n)v_n`$, and $`v_t' = -(1-2q_t)v_t`$ when the surfaces hold.
    #[test]
    fn the_surfaces_part_as_the_restitution_says(law in law(), (first, second) in touching_pair()) {
        let encounter = collide(&law.rule(), &first, &second);
        let Encounter { first: new_first, second: new_second, contact, impulse, .. } = encounter;
        let (closing, slip) = contact_velocity(normal(&first, &second), &new_first, &new_second);
        let tolerance = tolerance([&first, &second, &new_first, &new_second]);
        let expected_closing = -(1.0 - 2.0 * law.normal_inelasticity) * contact.closing_speed();
        let expected_slip = if law.sticks(&contact) {
            -(1.0 - 2.0 * law.tangential_inelasticity) * contact.slip_speed()
        } else {
            contact.slip_speed() - law.expected(&contact).tangential() / contact.tangential_mass()
        };
        prop_assert!((closing - expected_closing).abs() <= tolerance, "{closing} != {expected_closing}");
        prop_assert!((slip - expected_slip).abs() <= tolerance, "{slip} != {expected_slip}");
        prop_assert!(closing <= tolerance, "still closing");
        let apart = impulse.closing_speed_after(&contact) - expected_closing;
        prop_assert!(apart.abs() <= 4.0 * EPSILON * contact.closing_speed());
        let apart = impulse.slip_speed_after(&contact) - expected_slip;
        prop_assert!(apart.abs() <= 8.0 * EPSILON * contact.slip_speed().abs());
    }

    /// Disks that part close at a speed of zero, not below and not at minus zero: rules take roots of it.
    #[test]
    fn disks_that_part_do_not_close((first, second) in touching_pair()) {
        let back = |disk: &Disk| disk.with_velocity(-disk.velocity()).unwrap();
        let roots = from_fn(|contact: &Contact| Impulse::new(contact.closing_speed().sqrt(), 0.0));
        let after = collide(&roots, &back(&first), &back(&second));
        prop_assert_eq!(after.contact.closing_speed().to_bits(), 0.0_f64.to_bits());
        prop_assert_eq!((after.first, after.second), (back(&first), back(&second)));
        let normal = first.position().normalize();
        let leaving = collide_with_wall(&roots, &back(&first), normal, -second.velocity());
        prop_assert_eq!(leaving.contact.closing_speed().to_bits(), 0.0_f64.to_bits());
        prop_assert_eq!(leaving.disk, back(&first));
    }

    /// Rolling contact: exactly no slip gives exactly no tangential impulse.
    #[test]
    fn no_slip_no_grip(law in law(), contact in granular_edmd::strategies::contact()) {
        let rolling = Contact::new(
            contact.closing_speed(), 0.0, contact.normal_mass(), contact.tangential_mass());
        if law.sticks(&rolling) {
            prop_assert_eq!(law.rule().impulse(&rolling).tangential(), 0.0);
        }
    }
}
