//! The rule without any loss of energy.

use super::{CollisionRule, Contact, Impulse, KnownRule};
use crate::Fingerprint;

/// Smooth elastic collisions: the closing speed is reversed, and the slip stays unchanged.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Elastic};
/// let contact = Contact::new(2.0, 7.0, 0.5, 1.0 / 6.0);
/// assert_eq!(Elastic.impulse(&contact).energy_change(&contact), 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "crate::gate::Empty", into = "crate::gate::Empty"))]
pub struct Elastic;

crate::gate::without_fields!(Elastic);

impl CollisionRule for Elastic {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        Impulse::new(contact.normal_impulse(1.0), 0.0)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Elastic"))
    }

    fn known(&self) -> Option<KnownRule> {
        Some((*self).into())
    }
}
