//! The collision rule of the box.

use granular_edmd::Fingerprint;
use granular_edmd::collision::{CollisionRule, Contact, ContactDuration, Frictional, Impulse};

/// The paper's rule, with or without the contact-duration model.
#[derive(Debug, Clone, Copy)]
pub struct BoxRule(pub(super) Kind);

#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    Plain(Frictional),
    Lasting(ContactDuration<Frictional>),
}

impl CollisionRule for BoxRule {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        match &self.0 {
            Kind::Plain(rule) => rule.impulse(contact),
            Kind::Lasting(rule) => rule.impulse(contact),
        }
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        match &self.0 {
            Kind::Plain(rule) => rule.fingerprint(),
            Kind::Lasting(rule) => rule.fingerprint(),
        }
    }
}
