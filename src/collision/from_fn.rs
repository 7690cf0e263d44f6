//! Closures as rules.

use super::{CollisionRule, Contact, Impulse};

/// A closure as a [`CollisionRule`]; returned by [`from_fn`].
#[derive(Debug, Clone, Copy)]
pub struct FromFn<F>(F);

/// Makes a rule from a closure.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Impulse, from_fn};
/// let sticky = from_fn(|contact: &Contact| Impulse::new(contact.normal_impulse(0.0), 0.0));
/// let contact = Contact::new(1.0, 0.0, 0.5, 0.2);
/// assert_eq!(sticky.impulse(&contact).normal(), 0.5);
/// ```
pub const fn from_fn<F: Fn(&Contact) -> Impulse>(rule: F) -> FromFn<F> {
    FromFn(rule)
}

impl<F: Fn(&Contact) -> Impulse> CollisionRule for FromFn<F> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        (self.0)(contact)
    }
}
