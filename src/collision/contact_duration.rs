//! The remedy against inelastic collapse.

use super::{CollisionRule, Contact, Elastic, Impulse, Regime};
use crate::ParameterError;
use crate::quantity::positive;

/// What becomes of the tangential impulse in a contact that the contact-duration model makes elastic.
///
/// Published codes differ here, so it is said and not assumed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum TangentialResponse {
    /// There is none: the contact is elastic and frictionless.
    #[default]
    Frictionless,
    /// It stays that of the rule: only the normal direction is made elastic.
    Unchanged,
}

/// The contact-duration (TC) model over any rule: a collision of a body that collided less than `$t_c$` ago loses
/// no energy (Luding and McNamara 1998).
///
/// Without it, dense inelastic states collide infinitely often in finite time, and a run ends with an error. The
/// simulation counts the collisions changed this way, so that one sees when the model matters: with a collision rate
/// `$\omega_c$` per disk, a share of about `$2.25\,\omega_c t_c$` of the dissipation is lost to it.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, ContactDuration, Frictional, Regime};
///
/// let rule = ContactDuration::new(Frictional::new(0.1, 0.3)?, 1e-4)?;
/// let fresh = Contact::new(1.0, 0.5, 0.5, 1.0 / 6.0);
/// let again = fresh.with_time_since_last_collision(1e-5);
/// assert!(rule.impulse(&fresh).energy_change(&fresh) < 0.0);
/// assert_eq!(rule.impulse(&again).energy_change(&again), 0.0);
/// assert_eq!(rule.impulse(&again).regime(), Regime::ContactDuration);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawContactDuration<R>"))]
pub struct ContactDuration<R> {
    rule: R,
    duration: f64,
    #[cfg_attr(feature = "serde", serde(default))]
    tangential_response: TangentialResponse,
}

impl<R> ContactDuration<R> {
    /// `rule`, made elastic and frictionless for bodies that collided less than `duration` ago.
    ///
    /// # Errors
    /// If the duration is not finite and positive; use the rule alone for none.
    pub fn new(rule: R, duration: f64) -> Result<Self, ParameterError> {
        let duration = positive("contact duration", duration)?;
        Ok(Self { rule, duration, tangential_response: TangentialResponse::default() })
    }

    /// The same model with this tangential response.
    pub fn with_tangential_response(self, tangential_response: TangentialResponse) -> Self {
        Self { tangential_response, ..self }
    }

    /// The rule of all other collisions.
    pub const fn rule(&self) -> &R {
        &self.rule
    }

    /// `$t_c$`.
    pub const fn duration(&self) -> f64 {
        self.duration
    }
}

impl<R: CollisionRule> ContactDuration<R> {
    fn elastic(&self, contact: &Contact) -> Impulse {
        let tangential = match self.tangential_response {
            TangentialResponse::Frictionless => 0.0,
            TangentialResponse::Unchanged => self.rule.impulse(contact).tangential(),
        };
        Impulse::new(Elastic.impulse(contact).normal(), tangential).with_regime(Regime::ContactDuration)
    }
}

impl<R: CollisionRule> CollisionRule for ContactDuration<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        if contact.time_since_last_collision() < self.duration {
            self.elastic(contact)
        } else {
            self.rule.impulse(contact)
        }
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "ContactDuration")]
struct RawContactDuration<R> {
    rule: R,
    duration: f64,
    #[serde(default)]
    tangential_response: TangentialResponse,
}

#[cfg(feature = "serde")]
impl<R> TryFrom<RawContactDuration<R>> for ContactDuration<R> {
    type Error = ParameterError;

    fn try_from(raw: RawContactDuration<R>) -> Result<Self, ParameterError> {
        Ok(Self::new(raw.rule, raw.duration)?.with_tangential_response(raw.tangential_response))
    }
}
