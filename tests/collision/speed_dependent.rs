//! Restitution that falls with the speed of the impact, against the formula of its authors.

use granular_edmd::collision::{CollisionRule, Friction, Frictional, SpeedDependent, laws};
use granular_edmd::strategies::{contact, decades};
use proptest::prelude::*;

use crate::kinematics::EPSILON;
use crate::rules::config;

proptest! {
    #![proptest_config(config())]

    /// Bizon et al. 1998: `1 - B v^{3/4}` with `B = (1 - r0) v0^{-3/4}`, and at least `r0`.
    #[test]
    fn the_restitution_is_that_of_the_paper(
        least in 0.0..=1.0f64,
        speed in decades(-6.0, 6.0),
        closing in decades(-12.0, 9.0),
    ) {
        let rule = SpeedDependent::from_restitution(least, speed).unwrap();
        let factor = (1.0 - least) * speed.powf(-0.75);
        let expected = (1.0 - factor * closing.powf(0.75)).max(least);
        prop_assert!((rule.restitution(closing) - expected).abs() < 8.0 * EPSILON);
        prop_assert!((least - EPSILON..=1.0).contains(&rule.restitution(closing)));
        prop_assert!(rule.restitution(closing) >= rule.restitution(2.0 * closing));
    }

    #[test]
    fn it_keeps_the_laws_and_its_friction_the_cone(
        least in 0.0..=1.0f64,
        speed in decades(-6.0, 6.0),
        contact in contact(),
        coefficient in 0.0..2.0f64,
    ) {
        let friction = Friction::from_inelasticity(0.3, coefficient).unwrap();
        let impulse = SpeedDependent::from_restitution(least, speed).unwrap().with_friction(friction).impulse(&contact);
        prop_assert_eq!(laws::check_impulse(&contact, impulse), Ok(()));
        prop_assert_eq!(laws::check_friction_cone(&contact, impulse, coefficient), Ok(()));
        prop_assert_eq!(laws::check_friction_opposes_slip(&contact, impulse), Ok(()));
    }

    /// Fast collisions have a constant restitution, and the friction of the paper's rule.
    #[test]
    fn fast_collisions_are_those_of_the_constant_rule(
        inelasticity in 0.0..=0.5f64,
        contact in contact(),
        coefficient in 0.0..2.0f64,
    ) {
        prop_assume!(contact.closing_speed() > 0.0);
        let rule = SpeedDependent::from_inelasticity(inelasticity, 0.5 * contact.closing_speed()).unwrap();
        let rule = rule.with_friction(Friction::from_inelasticity(0.2, coefficient).unwrap());
        let constant = Frictional::from_inelasticity(inelasticity, 0.2, coefficient).unwrap();
        let expected = constant.impulse(&contact);
        let scale = contact.normal_mass() * contact.closing_speed();
        prop_assert!((rule.impulse(&contact).normal() - expected.normal()).abs() <= 4.0 * EPSILON * scale);
    }
}
