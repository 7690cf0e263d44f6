//! Slow collisions without loss, over every rule.

use granular_edmd::collision::{
    CollisionRule, ElasticBelow, Frictional, Regime, TangentialResponse, collide, laws,
};
use granular_edmd::strategies::{contact, decades, touching_pair};
use proptest::prelude::*;

use crate::kinematics::EPSILON;
use crate::rules::{Law, config, law};

fn model(law: &Law, speed: f64) -> ElasticBelow<Box<dyn CollisionRule>> {
    ElasticBelow::new(law.rule(), speed).unwrap()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn below_its_speed_nothing_is_lost(law in law(), contact in contact(), factor in decades(-3.0, 9.0)) {
        prop_assume!(contact.closing_speed() > 0.0);
        let model = model(&law, contact.closing_speed() * (1.0 + factor));
        let impulse = model.impulse(&contact);
        prop_assert_eq!(laws::check_impulse(&contact, impulse), Ok(()));
        prop_assert_eq!(impulse.tangential(), 0.0);
        let available = contact.available_energy();
        prop_assert!(impulse.energy_change(&contact).abs() <= 4.0 * EPSILON * available);
        prop_assert_eq!(impulse.regime(), Regime::ElasticBelow);
    }

    /// Only the normal loss goes: the rule's own tangential impulse stays, within the laws.
    #[test]
    fn the_tangential_response_can_stay(law in law(), contact in contact()) {
        prop_assume!(contact.closing_speed() > 0.0);
        let model = model(&law, 2.0 * contact.closing_speed())
            .with_tangential_response(TangentialResponse::Unchanged);
        let impulse = model.impulse(&contact);
        prop_assert_eq!(impulse.tangential(), law.rule().impulse(&contact).tangential());
        let cone = law.static_friction * impulse.normal() * (1.0 + 4.0 * EPSILON);
        prop_assert!(impulse.tangential().abs() <= cone);
        prop_assert_eq!(laws::check_impulse(&contact, impulse), Ok(()));
    }

    /// Perfectly rough surfaces lose nothing, either.
    #[test]
    fn a_slip_that_reverses_loses_nothing(law in law(), contact in contact()) {
        let model = model(&law, f64::MAX).with_tangential_response(TangentialResponse::Reversing);
        let impulse = model.impulse(&contact);
        let available = contact.available_energy();
        prop_assert!(impulse.energy_change(&contact).abs() <= 8.0 * EPSILON * available);
        let slip = impulse.slip_speed_after(&contact) + contact.slip_speed();
        prop_assert!(slip.abs() <= 4.0 * EPSILON * contact.slip_speed().abs());
    }

    /// Fast collisions are those of the rule, but for a parting speed that is never below that of the remedy.
    #[test]
    fn above_its_speed_the_rule_holds_unless_it_leaves_the_surfaces_too_slow(
        law in law(),
        contact in contact(),
        share in prop_oneof![Just(1.0), 1e-9..1.0],
    ) {
        prop_assume!(contact.closing_speed() * share > 0.0);
        let speed = share * contact.closing_speed();
        let (own, impulse) = (law.rule().impulse(&contact), model(&law, speed).impulse(&contact));
        let parting = -own.closing_speed_after(&contact);
        prop_assert_eq!(impulse.tangential(), own.tangential());
        let rounding = 4.0 * EPSILON * contact.closing_speed();
        let expected = parting.max(speed);
        prop_assert!((-impulse.closing_speed_after(&contact) - expected).abs() <= rounding);
        if parting > speed + rounding {
            prop_assert_eq!(impulse, own);
        }
        prop_assert_eq!(laws::check_impulse(&contact, impulse), Ok(()));
    }

    #[test]
    fn slow_pairs_keep_their_energy((first, second) in touching_pair(), law in law()) {
        let outcome = collide(&model(&law, f64::MAX), &first, &second);
        let available = outcome.contact.available_energy();
        prop_assert!(outcome.impulse.energy_change(&outcome.contact).abs() <= 4.0 * EPSILON * available);
    }
}

#[test]
fn the_default_is_frictionless() {
    let rule = Frictional::from_inelasticity(0.1, 0.1, 0.2).unwrap();
    let model = ElasticBelow::new(rule, 1e-2).unwrap();
    assert_eq!(model, model.with_tangential_response(TangentialResponse::Frictionless));
}
