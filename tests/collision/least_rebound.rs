//! Surfaces that never part too slowly, over every rule.

use granular_edmd::collision::{CollisionRule, LeastRebound, Regime};
use granular_edmd::strategies::{contact, decades};
use proptest::prelude::*;

use crate::kinematics::EPSILON;
use crate::rules::{config, law};

proptest! {
    #![proptest_config(config())]

    #[test]
    fn surfaces_part_as_the_rule_says_or_at_the_least_speed(
        law in law(),
        contact in contact(),
        speed in decades(-9.0, 3.0),
    ) {
        let rule = LeastRebound::new(law.rule(), speed).unwrap();
        let (own, impulse) = (law.rule().impulse(&contact), rule.impulse(&contact));
        let parting = -own.closing_speed_after(&contact);
        let rounding = 4.0 * EPSILON * (contact.closing_speed() + speed);
        let after = -impulse.closing_speed_after(&contact);
        prop_assert!((after - parting.max(speed)).abs() <= rounding, "{} {}", after, parting);
        if parting > speed + rounding {
            prop_assert_eq!(impulse, own);
        }
        prop_assert_eq!(impulse.tangential(), own.tangential());
        let is_raised = impulse.normal() > own.normal();
        prop_assert_eq!(impulse.regime(), if is_raised { Regime::LeastRebound } else { own.regime() });
    }

    /// The energy gained is at most that of the least parting speed.
    #[test]
    fn no_more_is_gained_than_said(law in law(), contact in contact(), speed in decades(-9.0, 3.0)) {
        let impulse = LeastRebound::new(law.rule(), speed).unwrap().impulse(&contact);
        let most = 0.5 * contact.normal_mass() * (speed * speed - contact.closing_speed().powi(2)).max(0.0);
        let scale = contact.available_energy() + most;
        prop_assert!(impulse.energy_change(&contact) <= most + 16.0 * EPSILON * scale);
        let cone = law.static_friction * impulse.normal() * (1.0 + 4.0 * EPSILON);
        prop_assert!(impulse.tangential().abs() <= cone);
    }
}
