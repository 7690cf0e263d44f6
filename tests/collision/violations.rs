//! The check for rules of users, which names each broken law, and passes everything that breaks none.

use granular_edmd::Violation;
use granular_edmd::collision::laws::{
    Promises, check, check_friction_cone, check_friction_opposes_slip, check_impulse,
};
use granular_edmd::collision::{Contact, Impulse, from_fn};
use granular_edmd::strategies::{contact, decades};
use proptest::prelude::*;

use crate::rules::config;

/// Impulses in units of those that would stop the closing and the slip: 0 does nothing, 2 reverses
/// elastically.
fn impulse(contact: &Contact, normal: f64, tangential: f64) -> Impulse {
    Impulse::new(
        normal * contact.normal_mass() * contact.closing_speed(),
        tangential * contact.tangential_mass() * contact.slip_speed(),
    )
}

/// Returns whether the answer is a violation of this law that names the number.
fn says(answer: Result<(), Violation>, law: &str, number: f64) -> bool {
    answer.is_err_and(|fault| fault.law() == law && fault.found().contains(&format!(" {number:?} (")))
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn what_breaks_no_law_passes(contact in contact(), normal in 1.0..=2.0, tangential in 0.0..=2.0) {
        let impulse = impulse(&contact, normal, tangential);
        prop_assert_eq!(check_impulse(&contact, impulse), Ok(()));
    }

    #[test]
    fn a_weak_push_leaves_the_surfaces_closing(contact in contact(), normal in -3.0..0.999, tangential in 0.0..2.0) {
        let impulse = impulse(&contact, normal, tangential);
        let closing_speed = impulse.closing_speed_after(&contact);
        prop_assert!(closing_speed > 0.0);
        prop_assert!(says(check_impulse(&contact, impulse), "separation", closing_speed));
    }

    /// The impulse goes from nothing to the full reversal, in the cone that just holds it.
    #[test]
    fn friction_passes(contact in contact(), normal in 1.0..=2.0, tangential in 0.0..=2.0) {
        let impulse = impulse(&contact, normal, tangential);
        let needed = impulse.tangential().abs() / impulse.normal();
        prop_assert_eq!(check_friction_opposes_slip(&contact, impulse), Ok(()));
        prop_assert_eq!(check_friction_cone(&contact, impulse, needed), Ok(()));
        if contact.slip_speed() != 0.0 && tangential > 0.0 {
            prop_assert!(check_friction_cone(&contact, impulse, needed * (1.0 - 1e-11)).is_err());
        }
    }

    /// The push breaks the law, however small it is.
    #[test]
    fn a_push_along_the_slip_is_not_friction(contact in contact(), share in decades(-30.0, 0.0)) {
        let with = impulse(&contact, 1.0, -share);
        prop_assume!(with.tangential() != 0.0);
        let slip_speed = with.slip_speed_after(&contact);
        prop_assert!(says(check_friction_opposes_slip(&contact, with), "opposed slip", slip_speed));
    }
}

/// The end of each message: a contact of closing speed 1 and this slip speed.
fn of_contact(slip: &str) -> String {
    let masses = "normal mass 0.5, tangential mass 0.125";
    let partners = "radii 0.5 and 0.5, kinds 0 and 0";
    format!("(closing speed 1.0, slip speed {slip}, {masses}, time since the last collision inf, {partners})")
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let contact = Contact::new(1.0, 0.5, 0.5, 0.125);
    for (normal, tangential) in [(f64::INFINITY, 0.0), (1.0, f64::NEG_INFINITY), (1.0, f64::NAN)] {
        let violation = check_impulse(&contact, Impulse::new(normal, tangential)).unwrap_err();
        assert_eq!(violation.law(), "finite");
        let impulse = format!("({normal:?}, {tangential:?})");
        assert_eq!(violation.found(), format!("the impulse {impulse} is not finite {}", of_contact("0.5")));
    }
}

#[test]
fn messages_carry_the_numbers() {
    let contact = Contact::new(1.0, 0.0, 0.5, 0.125);
    let text = |normal| check_impulse(&contact, Impulse::new(normal, 0.0)).unwrap_err().found().to_owned();
    let weak = "the impulse (0.25, 0.0) leaves the surfaces closing, at speed 0.5";
    assert_eq!(text(0.25), format!("{weak} {}", of_contact("0.0")));
    assert_eq!(text(1.5), format!("the impulse (1.5, 0.0) gains the energy 0.75 {}", of_contact("0.0")));
    let slipping = Contact::new(1.0, 2.0, 0.5, 0.125);
    let violation = check_friction_cone(&slipping, Impulse::new(0.5, 0.25), 0.25).unwrap_err();
    let cone = "the impulse (0.5, 0.25) leaves the friction cone: 0.125 is the most along the tangent";
    assert_eq!(violation.found(), format!("{cone} {}", of_contact("2.0")));
    let violation = check_friction_opposes_slip(&slipping, Impulse::new(0.5, -0.25)).unwrap_err();
    assert_eq!(
        violation.found(),
        format!("the impulse (0.5, -0.25) makes the slip faster: 4.0 {}", of_contact("2.0"))
    );
}

/// The message has the impulse that the law expects and the one that the rule gives, and they differ.
#[test]
fn images_that_differ_are_shown() {
    let chiral = from_fn(|contact: &Contact| Impulse::new(contact.normal_impulse(0.5), -0.0625));
    let violation = check(&chiral, &Promises::new().with_energy_gain()).unwrap_err();
    assert_eq!(violation.law(), "mirror image");
    assert_eq!(check(&chiral, &Promises::new().with_energy_gain().with_handedness()), Ok(()));
    let expected = "should be (0.75, 0.0625) in the mirror image, where tangential impulse and couple change \
                    sign, but is (0.75, -0.0625) there";
    let found = violation.found();
    assert!(
        found.starts_with(&format!("the impulse (0.75, -0.0625) {expected} (closing speed 1.0")),
        "{found}"
    );

    let first = from_fn(|contact: &Contact| {
        let turn = contact.spin_inertia() * contact.relative_spin() * contact.radii()[0];
        Impulse::new(contact.normal_impulse(0.5), 0.0).with_couple(turn)
    });
    let found = check(&first, &Promises::new().with_energy_gain()).unwrap_err().found().to_owned();
    assert!(found.contains("in the exchange of partners, where the couple changes sign, but is "), "{found}");
}

/// Equality breaks no law: nothing happens to surfaces at rest.
#[test]
fn surfaces_at_rest_may_stay_so() {
    let contact = Contact::new(0.0, 0.0, 0.5, 0.5 / 3.0);
    assert_eq!(check_impulse(&contact, Impulse::new(0.0, 0.0)), Ok(()));
}

/// The available energy is what stopping the surfaces loses: what $`\mu v_n`$ and $`\mu_t v_t`$ take away.
#[test]
fn the_available_energy_is_what_stopping_loses() {
    let contact = Contact::new(2.0, 3.0, 0.5, 0.25);
    assert_eq!(contact.available_energy(), 1.0 + 1.125);
    assert_eq!(Impulse::new(1.0, 0.75).energy_change(&contact), -(1.0 + 1.125));
}
