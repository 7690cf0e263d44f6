//! The contact-duration model: elastic below its time, the rule at it and above.

use granular_edmd::collision::{
    CollisionRule, ContactDuration, Elastic, ElasticBelow, Regime, RollingFriction, TangentialResponse,
    collide, collide_with_wall, laws,
};
use granular_edmd::strategies::{contact, decades, disk_closing_on_wall, touching_pair};
use proptest::prelude::*;

use crate::kinematics::EPSILON;
use crate::rules::{Law, config, law};

fn model(law: &Law, duration: f64) -> ContactDuration<Box<dyn CollisionRule>> {
    ContactDuration::new(law.rule(), duration).unwrap()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn below_its_time_nothing_is_lost(
        law in law(),
        contact in contact(),
        duration in decades(-9.0, 3.0),
        share in prop_oneof![Just(0.0), 0.0..1.0, Just(1.0 - EPSILON)],
    ) {
        let contact = contact.with_time_since_last_collision(share * duration);
        let impulse = model(&law, duration).impulse(&contact);
        prop_assert_eq!(impulse.normal(), Elastic.impulse(&contact).normal());
        prop_assert_eq!(impulse.tangential(), 0.0);
        let available = contact.available_energy();
        prop_assert!(impulse.energy_change(&contact).abs() <= 4.0 * EPSILON * available);
        prop_assert_eq!(impulse.regime(), Regime::ContactDuration);
    }

    /// Only the normal loss goes: the rule's own tangential impulse and its loss stay, and stay within the
    /// laws.
    #[test]
    fn the_tangential_response_can_stay(law in law(), contact in contact(), duration in decades(-9.0, 3.0)) {
        let contact = contact.with_time_since_last_collision(0.5 * duration);
        let model = model(&law, duration).with_tangential_response(TangentialResponse::Unchanged);
        let (impulse, own) = (model.impulse(&contact), law.rule().impulse(&contact));
        prop_assert_eq!(impulse.normal(), Elastic.impulse(&contact).normal());
        prop_assert_eq!(impulse.tangential(), own.tangential());
        prop_assert_eq!(impulse.regime(), Regime::ContactDuration);
        let cone = law.static_friction * impulse.normal() * (1.0 + 4.0 * EPSILON);
        prop_assert!(impulse.tangential().abs() <= cone);
        prop_assert!(impulse.energy_change(&contact) <= 4.0 * EPSILON * contact.available_energy());
        prop_assert_eq!(laws::check_impulse(&contact, impulse), Ok(()));
    }

    /// The couple of rolling friction stays with the tangential impulse.
    #[test]
    fn the_couple_can_stay(law in law(), contact in contact(), share in 0.0..0.9) {
        let contact = contact.with_time_since_last_collision(share);
        let rolling = RollingFriction::new(law.rule(), 0.3).unwrap();
        let own = rolling.impulse(&contact).couple();
        let response = TangentialResponse::Unchanged;
        let model = ContactDuration::new(&rolling, 1.0).unwrap().with_tangential_response(response);
        prop_assert_eq!(model.impulse(&contact).couple(), own);
        let model = ElasticBelow::new(&rolling, 1e99).unwrap().with_tangential_response(response);
        prop_assert_eq!(model.impulse(&contact).couple(), own);
    }

    #[test]
    fn at_its_time_and_above_the_rule_holds(
        law in law(),
        contact in contact(),
        duration in decades(-9.0, 3.0),
        factor in prop_oneof![Just(1.0), 1.0..10.0, Just(f64::INFINITY)],
        response in prop_oneof![Just(TangentialResponse::Frictionless), Just(TangentialResponse::Unchanged)],
    ) {
        let contact = contact.with_time_since_last_collision(factor * duration);
        let model = model(&law, duration).with_tangential_response(response);
        prop_assert_eq!(model.impulse(&contact), law.rule().impulse(&contact));
    }

    /// Two disks, or a disk and a wall, outside a simulation have never collided before.
    #[test]
    fn a_first_collision_is_the_rules(
        law in law(),
        (first, second) in touching_pair(),
        (disk, normal, wall) in disk_closing_on_wall(),
    ) {
        let model = model(&law, f64::MAX);
        prop_assert_eq!(collide(&model, &first, &second), collide(&law.rule(), &first, &second));
        prop_assert_eq!(
            collide_with_wall(&model, &disk, normal, wall),
            collide_with_wall(&law.rule(), &disk, normal, wall)
        );
    }
}

#[test]
fn the_default_is_frictionless() {
    assert_eq!(TangentialResponse::default(), TangentialResponse::Frictionless);
    let model = ContactDuration::new(Elastic, 1e-4).unwrap();
    assert_eq!(model, model.with_tangential_response(TangentialResponse::Frictionless));
    assert_eq!((model.rule(), model.duration()), (&Elastic, 1e-4));
}
