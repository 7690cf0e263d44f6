//! The simplest contact at which a rule still breaks a law.

use crate::collision::Contact;
use crate::{Kind, Violation};

/// Returns the violation at the simplest contact at which the rule still breaks the same law.
pub(super) fn simplest(
    contact: Contact,
    violation: Violation,
    broken: impl Fn(&Contact) -> Option<Violation>,
) -> Violation {
    let (mut contact, mut violation) = (contact, violation);
    let law = violation.law();
    let still = |contact: Contact| {
        broken(&contact).filter(|violation| violation.law() == law).map(|violation| (contact, violation))
    };
    while let Some(found) = simpler(&contact).into_iter().find_map(still) {
        (contact, violation) = found;
    }
    violation
}

/// Returns contacts that are simpler by one step each.
fn simpler(contact: &Contact) -> Vec<Contact> {
    let plain = Contact::new(contact.closing_speed(), contact.slip_speed(), 0.5, 0.5 / 3.0);
    let with = |closing, slip, time| {
        let moved = Contact::new(closing, slip, contact.normal_mass(), contact.tangential_mass());
        like(moved, contact).with_time_since_last_collision(time)
    };
    let (closing, slip, time) =
        (contact.closing_speed(), contact.slip_speed(), contact.time_since_last_collision());
    let mut all = vec![
        plain,
        contact.with_spin(0.0, 0.125 * contact.normal_mass(), 0.0),
        contact.with_kinds(plain.kinds()).with_radii(plain.radii()),
        if contact.kinds()[1] == Kind::WALL {
            contact.with_radii([0.5, f64::INFINITY])
        } else {
            contact.with_radii(plain.radii())
        },
        with(closing, slip, f64::INFINITY),
        with(closing, 0.0, time),
        with(1.0, slip, time),
        with(rounded(closing), slip, time),
        with(closing, rounded(slip), time),
        with(closing, slip, rounded(time)),
        contact.with_spin(rounded(contact.relative_spin()), contact.spin_inertia(), contact.spin_response()),
    ];
    if contact.spin_response() == 0.0 {
        all.push(like(plain, contact).with_spin(contact.relative_spin(), 0.0625, 0.0));
    }
    all.retain(|simpler| simpler != contact);
    all
}

/// Returns a contact of these speeds and masses with all other numbers from `other`.
fn like(contact: Contact, other: &Contact) -> Contact {
    contact
        .with_kinds(other.kinds())
        .with_radii(other.radii())
        .with_time_since_last_collision(other.time_since_last_collision())
        .with_spin(other.relative_spin(), other.spin_inertia(), other.spin_response())
}

/// Returns the number, rounded to one digit.
fn rounded(number: f64) -> f64 {
    format!("{number:.0e}").parse().unwrap_or(number)
}
