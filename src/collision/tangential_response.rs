//! The tangential impulse in contacts that a remedy makes elastic.

use super::{CollisionRule, Contact, Elastic, Impulse, Regime};

/// The choice of the tangential impulse in a contact that [`ContactDuration`](super::ContactDuration) or
/// [`ElasticBelow`](super::ElasticBelow) makes elastic.
///
/// Published codes differ in this choice, so it is explicit here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum TangentialResponse {
    /// No tangential impulse: the contact is elastic and frictionless.
    #[default]
    Frictionless,
    /// The tangential impulse and the couple of the rule: only the normal direction becomes elastic. Friction
    /// then keeps cooling matter at rest, so runs still stall.
    Unchanged,
    /// The slip reverses without loss, as between perfectly rough surfaces. The slip is then zero on average,
    /// so surfaces at rest hold each other, however weak the friction of the rule is.
    Reversing,
}

impl TangentialResponse {
    /// Returns the impulse of an elastic contact, in place of the impulse of `rule`.
    pub(super) fn elastic<R: CollisionRule>(self, rule: &R, contact: &Contact, regime: Regime) -> Impulse {
        let normal = Elastic.impulse(contact).normal();
        let impulse = match self {
            Self::Frictionless => Impulse::new(normal, 0.0),
            Self::Unchanged => rule.impulse(contact).with_normal(normal),
            Self::Reversing => Impulse::new(normal, 2.0 * contact.tangential_mass() * contact.slip_speed()),
        };
        impulse.with_regime(regime)
    }

    /// Returns the word that stands for the response in fingerprints.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Frictionless => "frictionless",
            Self::Unchanged => "unchanged",
            Self::Reversing => "reversing",
        }
    }
}
