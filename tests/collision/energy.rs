//! Energy: never gained, and lost by exactly the amount that the formulas say.

use granular_edmd::collision::{Contact, Encounter, Regime, collide, laws};
use granular_edmd::strategies::{contact, touching_pair};
use proptest::prelude::*;

use crate::kinematics::{EPSILON, kinetic_energy};
use crate::rules::{Law, config, law};

/// The change of energy from the coefficients alone: Eq. (6) with the factor 1/3, and Eq. (7), for any two
/// bodies.
fn expected_change(law: &Law, contact: &Contact) -> f64 {
    let (mu, mu_t) = (contact.normal_mass(), contact.tangential_mass());
    let (v_n, v_t) = (contact.closing_speed(), contact.slip_speed().abs());
    let (q_n, q_t, kappa) = (law.normal_inelasticity, law.tangential_inelasticity, law.dynamic_friction);
    if law.sticks(contact) {
        -2.0 * mu * q_n * (1.0 - q_n) * v_n * v_n - 2.0 * mu_t * q_t * (1.0 - q_t) * v_t * v_t
    } else {
        // Products are ordered so that a huge coefficient never meets a huge mass.
        let grip = (1.0 - q_n) * kappa * (mu / mu_t) * v_n;
        -2.0 * mu * (1.0 - q_n) * (q_n * v_n * v_n + kappa * v_n * v_t) + 2.0 * mu_t * grip * grip
    }
}

proptest! {
    #![proptest_config(config())]

    /// The loss consists of some ten products and differences of terms, none above the energy of the relative
    /// motion.
    #[test]
    fn the_loss_is_that_of_the_formulas(law in law(), contact in contact()) {
        // A contact-duration model replaces the formula soon after a collision.
        let contact = contact.with_time_since_last_collision(f64::INFINITY);
        let change = law.rule().impulse(&contact).energy_change(&contact);
        let expected = expected_change(&law, &contact);
        let available = contact.available_energy();
        let apart = (change - expected).abs();
        prop_assert!(apart <= 16.0 * EPSILON * available, "{change} != {expected}, of {available}");
    }

    #[test]
    fn energy_is_never_gained(law in law(), contact in contact()) {
        let impulse = law.rule().impulse(&contact);
        let (change, available) = (impulse.energy_change(&contact), contact.available_energy());
        prop_assert!(change <= 4.0 * EPSILON * available, "{change} of {available}");
        prop_assert!(change >= -(1.0 + 4.0 * EPSILON) * available, "more than there is: {change} of {available}");
        prop_assert_eq!(laws::check_impulse(&contact, impulse), Ok(()));
    }

    /// The disks lose as much as the impulse says; rounding of their velocities counts with their whole
    /// energy.
    #[test]
    fn the_disks_lose_what_the_impulse_says(law in law(), (first, second) in touching_pair()) {
        let encounter = collide(&law.rule(), &first, &second);
        let Encounter { first: new_first, second: new_second, contact, impulse, .. } = encounter;
        let before = kinetic_energy(&first) + kinetic_energy(&second);
        let after = kinetic_energy(&new_first) + kinetic_energy(&new_second);
        let change = impulse.energy_change(&contact);
        let lost = after - before;
        prop_assert!((lost - change).abs() <= 32.0 * EPSILON * (before + after), "{lost} != {change}");
    }

    /// Without inelasticity, and with no friction or full grip, no energy is lost.
    #[test]
    fn an_elastic_rule_loses_nothing(mut law in law(), contact in contact(), rough in any::<bool>()) {
        (law.normal_inelasticity, law.tangential_inelasticity) = (0.0, 0.0);
        let friction = if rough { f64::MAX } else { 0.0 };
        if law.static_friction.is_finite() && law.static_friction > 0.0 {
            (law.static_friction, law.dynamic_friction) = (friction, friction);
        }
        let change = law.rule().impulse(&contact).energy_change(&contact);
        prop_assert!(change.abs() <= 4.0 * EPSILON * contact.available_energy(), "{change}");
    }

    /// The impulse lies in the cone of friction, and on its edge when the surfaces slide.
    #[test]
    fn the_impulse_stays_in_the_friction_cone(law in law(), contact in contact()) {
        let impulse = law.rule().impulse(&contact);
        let (normal, tangential) = (impulse.normal(), impulse.tangential().abs());
        prop_assert!(normal > 0.0);
        prop_assert!(tangential <= law.static_friction * normal * (1.0 + 4.0 * EPSILON));
        prop_assert!(impulse.tangential() * contact.slip_speed() >= 0.0, "friction opposes the slip");
        match impulse.regime() {
            Regime::Sticking => prop_assert!(law.sticks(&contact)),
            Regime::Sliding => prop_assert_eq!(tangential, law.dynamic_friction * normal),
            _ => (),
        }
    }
}
