//! Friction by itself, under any normal impulse.

use granular_edmd::collision::laws::hostile_contacts;
use granular_edmd::collision::{CollisionRule, Contact, Friction, Frictional, Impulse, Regime, laws};
use granular_edmd::strategies::{contact, decades};
use proptest::prelude::*;

use crate::rules::config;

fn rule() -> Frictional {
    Frictional::from_inelasticity(0.1, 0.3, 0.5).and_then(|rule| rule.with_dynamic_friction(0.4)).unwrap()
}

/// The rule as one formula, in the order of operations that recorded runs have.
fn in_one_piece(rule: &Frictional, contact: &Contact) -> Impulse {
    let normal = 2.0 * (1.0 - rule.normal_inelasticity()) * contact.normal_mass() * contact.closing_speed();
    let sticking =
        2.0 * (1.0 - rule.tangential_inelasticity()) * contact.tangential_mass() * contact.slip_speed();
    if sticking.abs() < rule.static_friction() * normal {
        return Impulse::new(normal, sticking).with_regime(Regime::Sticking);
    }
    let sliding = (rule.dynamic_friction() * normal).copysign(sticking);
    Impulse::new(normal, sliding).with_regime(Regime::Sliding)
}

#[test]
fn the_rule_made_of_parts_has_the_bits_of_the_formula() {
    for contact in hostile_contacts() {
        let (impulse, expected) = (rule().impulse(&contact), in_one_piece(&rule(), &contact));
        assert_eq!(impulse.normal().to_bits(), expected.normal().to_bits(), "{contact}");
        assert_eq!(impulse.tangential().to_bits(), expected.tangential().to_bits(), "{contact}");
        assert_eq!(impulse.regime(), expected.regime(), "{contact}");
    }
}

#[test]
fn the_parts_are_those_of_the_rule() {
    let friction = Friction::from_inelasticity(0.3, 0.5)
        .and_then(|friction| friction.with_dynamic_friction(0.4))
        .unwrap();
    let contact = Contact::new(1.0, 0.5, 0.5, 0.125);
    let impulse = rule().impulse(&contact);
    assert_eq!(friction.impulse(&contact, impulse.normal()), impulse);
    assert_eq!(friction.tangential_inelasticity(), rule().tangential_inelasticity());
    assert_eq!(friction.static_friction(), rule().static_friction());
    assert_eq!(friction.dynamic_friction(), rule().dynamic_friction());
}

/// A restitution of 0 stops the surfaces, and a restitution of 1 reverses them.
#[test]
fn the_normal_impulse_of_a_restitution() {
    let contact = Contact::new(2.0, 0.5, 0.25, 0.125);
    for (restitution, after) in [(0.0, 0.0), (0.5, -1.0), (1.0, -2.0)] {
        let impulse = Impulse::new(contact.normal_impulse(restitution), 0.0);
        assert_eq!(impulse.closing_speed_after(&contact), after);
    }
}

proptest! {
    #![proptest_config(config())]

    /// The normal impulse is passed on as it is, and the tangential one is lawful beside any of either size.
    #[test]
    fn any_push_allows_lawful_friction(
        contact in contact(),
        push in decades(-12.0, 12.0),
        inelasticity in 0.0..=1.0,
        coefficient in prop_oneof![Just(0.0), decades(-9.0, 9.0)],
        ratio in 0.0..=1.0,
    ) {
        let friction = Friction::from_inelasticity(inelasticity, coefficient)
            .and_then(|friction| friction.with_dynamic_friction(ratio * coefficient))
            .unwrap();
        let normal = push * contact.normal_mass() * contact.closing_speed();
        let impulse = friction.impulse(&contact, normal);
        prop_assert_eq!(impulse.normal(), normal);
        prop_assert_eq!(laws::check_friction_cone(&contact, impulse, coefficient), Ok(()));
        prop_assert_eq!(laws::check_friction_opposes_slip(&contact, impulse), Ok(()));
    }
}
