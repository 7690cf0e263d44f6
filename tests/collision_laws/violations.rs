//! The check for rules of one's own: it names each broken law, and passes everything that breaks none.

use granular_edmd::collision::laws::{
    Violation, available_energy, check, closing_speed_after, slip_speed_after,
};
use granular_edmd::collision::{Contact, Impulse};
use proptest::prelude::*;

use crate::hostile::{config, contact};

/// Impulses in units of those that would stop the closing and the slip: 0 does nothing, 2 reverses elastically.
fn impulse(contact: &Contact, normal: f64, tangential: f64) -> Impulse {
    Impulse::new(
        normal * contact.normal_mass() * contact.closing_speed(),
        tangential * contact.tangential_mass() * contact.slip_speed(),
    )
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn what_breaks_no_law_passes(contact in contact(), normal in 1.0..=2.0, tangential in 0.0..=2.0) {
        let impulse = impulse(&contact, normal, tangential);
        prop_assert_eq!(check(&contact, impulse), Ok(()));
    }

    #[test]
    fn a_weak_push_leaves_the_surfaces_closing(contact in contact(), normal in -3.0..0.999, tangential in 0.0..2.0) {
        let impulse = impulse(&contact, normal, tangential);
        let closing_speed = closing_speed_after(&contact, impulse);
        prop_assert!(closing_speed > 0.0);
        prop_assert_eq!(check(&contact, impulse), Err(Violation::StillClosing { closing_speed }));
    }

    #[test]
    fn a_strong_push_gains_energy(contact in contact(), normal in 2.001..10.0) {
        let impulse = impulse(&contact, normal, 0.0);
        let energy_change = impulse.energy_change(&contact);
        let available = available_energy(&contact);
        prop_assume!(energy_change > 1e-9 * available, "a gain too small beside the slip to be told from rounding");
        prop_assert_eq!(check(&contact, impulse), Err(Violation::EnergyGained { energy_change }));
    }

    /// A tangential impulse that speeds the slip up, or reverses it faster than it was, gains energy.
    #[test]
    fn a_wrong_twist_gains_energy(contact in contact(), twist in prop_oneof![-3.0..-0.001, 2.001..5.0]) {
        let impulse = impulse(&contact, 2.0, twist);
        let energy_change = impulse.energy_change(&contact);
        let available = available_energy(&contact);
        prop_assume!(energy_change > 1e-9 * available, "a gain too small beside the approach to be told from rounding");
        prop_assert!(slip_speed_after(&contact, impulse).abs() > contact.slip_speed().abs());
        prop_assert_eq!(check(&contact, impulse), Err(Violation::EnergyGained { energy_change }));
    }
}

#[test]
fn what_is_not_finite_is_named() {
    let contact = Contact::new(1.0, 0.5, 0.5, 0.5 / 3.0);
    for (normal, tangential) in [(f64::INFINITY, 0.0), (1.0, f64::NEG_INFINITY), (1.0, f64::NAN)] {
        let violation = check(&contact, Impulse::new(normal, tangential)).unwrap_err();
        assert!(matches!(violation, Violation::NotFinite { .. }));
        assert_eq!(violation.to_string(), format!("the impulse ({normal}, {tangential}) is not finite"));
    }
}

#[test]
fn messages_carry_the_number() {
    let contact = Contact::new(1.0, 0.0, 0.5, 0.5 / 3.0);
    let text = |normal| check(&contact, Impulse::new(normal, 0.0)).unwrap_err().to_string();
    assert_eq!(text(0.25), "after the collision the surfaces still close, at speed 0.5");
    assert_eq!(text(1.5), "the collision gains the energy 0.75");
}

/// Equality breaks no law: nothing that happens to nothing.
#[test]
fn surfaces_at_rest_may_stay_so() {
    let contact = Contact::new(0.0, 0.0, 0.5, 0.5 / 3.0);
    assert_eq!(check(&contact, Impulse::new(0.0, 0.0)), Ok(()));
}

/// The most that can be lost is all of it: what `$\mu v_n$` and `$\mu_t v_t$` take away.
#[test]
fn the_available_energy_is_what_stopping_loses() {
    let contact = Contact::new(2.0, 3.0, 0.5, 0.25);
    assert_eq!(available_energy(&contact), 1.0 + 1.125);
    assert_eq!(Impulse::new(1.0, 0.75).energy_change(&contact), -(1.0 + 1.125));
}
