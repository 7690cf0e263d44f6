//! Slow collisions without loss: a remedy for matter at rest.

use super::{CollisionRule, Contact, Impulse, KnownRule, Regime, TangentialResponse};
use crate::quantity::positive;
use crate::{Fingerprint, ParameterError};

/// A rule whose slow collisions are elastic: surfaces part at least at the speed v_c or, if they closed more
/// slowly, as fast as they closed.
///
/// ```math
/// v_n' = \max\left(r_n v_n,\ \min(v_n, v_c)\right)
/// ```
///
/// A disk that comes to rest on a floor then bounces at the speed $`v_c`$, once every $`2v_c/g`$. Many disks
/// share the energy that the last fast collisions left them. If the tangential response loses nothing, their
/// granular temperature stays constant. This temperature may be far below $`m v_c^2`$, and the lower it is,
/// the more often disks collide. [`LeastRebound`](super::LeastRebound) bounds the number of collisions. The
/// page `docs/rest.md` of the repository compares the remedies.
///
/// Collisions with $`v_c \le v_n < v_c/r_n`$ lose less, too, but keep the regime of the inner rule. In a gas
/// of temperature $`T`$, with a constant $`r_n`$ and $`x = m v_c^2/4T`$, the remedy removes this share of the
/// normal dissipation:
///
/// ```math
/// 1 - \frac{e^{-x} - r_n^2\,e^{-x/r_n^2}}{1 - r_n^2} \approx \frac{x^2}{2\,r_n^2}
/// ```
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, ElasticBelow, Frictional, Regime};
///
/// let rule = ElasticBelow::new(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, 0.05)?;
/// let fast = Contact::new(1.0, 0.5, 0.5, 1.0 / 6.0);
/// let slow = Contact::new(0.01, 0.5, 0.5, 1.0 / 6.0);
/// assert!(rule.impulse(&fast).energy_change(&fast) < 0.0);
/// assert_eq!(rule.impulse(&slow).energy_change(&slow), 0.0);
/// assert_eq!(rule.impulse(&slow).regime(), Regime::ElasticBelow);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ElasticBelow<R> {
    rule: R,
    speed: f64,
    tangential_response: TangentialResponse,
}

impl<R> ElasticBelow<R> {
    /// Creates the remedy over `rule`: collisions below this closing speed are elastic and frictionless.
    ///
    /// # Errors
    /// If the speed is not finite and positive. For no limit, use the rule without this remedy.
    pub fn new(rule: R, speed: f64) -> Result<Self, ParameterError> {
        positive("speed of elastic collisions", speed)?;
        Ok(Self { rule, speed, tangential_response: TangentialResponse::default() })
    }

    /// Returns the same remedy with this tangential response.
    pub fn with_tangential_response(self, tangential_response: TangentialResponse) -> Self {
        Self { tangential_response, ..self }
    }

    /// Returns the inner rule, which decides all other collisions.
    pub const fn rule(&self) -> &R {
        &self.rule
    }

    /// Returns the closing speed v_c below which collisions are elastic.
    pub const fn speed(&self) -> f64 {
        self.speed
    }
}

impl<R: CollisionRule> CollisionRule for ElasticBelow<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        if contact.closing_speed() < self.speed {
            return self.tangential_response.elastic(&self.rule, contact, Regime::ElasticBelow);
        }
        self.rule.impulse(contact).parting_at_least(self.speed, contact)
    }

    /// Returns `None` if the inner rule has no fingerprint: two such remedies could not be distinguished.
    fn fingerprint(&self) -> Option<Fingerprint> {
        let (rule, response) = (self.rule.fingerprint()?, self.tangential_response.name());
        Some(Fingerprint::of("ElasticBelow").part(rule).number(self.speed).text(response))
    }

    fn known(&self) -> Option<KnownRule> {
        let Self { speed, tangential_response, .. } = *self;
        Some(Box::new(ElasticBelow { rule: self.rule.known()?, speed, tangential_response }).into())
    }
}

crate::gate::from_file! {
    ElasticBelow<R> { rule: R, speed: f64, #[serde(default)] tangential_response: TangentialResponse } =>
        Ok(Self::new(rule, speed)?.with_tangential_response(tangential_response))
}
