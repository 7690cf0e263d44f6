//! The collision rule of a study's system.

use crate::Fingerprint;
use crate::collision::{CollisionRule, Contact, ContactDuration, Frictional, Impulse};

/// The paper's rule, with or without the contact-duration model.
#[derive(Debug, Clone, Copy)]
pub(super) enum Rule {
    Plain(Frictional),
    Lasting(ContactDuration<Frictional>),
}

impl CollisionRule for Rule {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        match self {
            Self::Plain(rule) => rule.impulse(contact),
            Self::Lasting(rule) => rule.impulse(contact),
        }
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        match self {
            Self::Plain(rule) => rule.fingerprint(),
            Self::Lasting(rule) => rule.fingerprint(),
        }
    }
}
