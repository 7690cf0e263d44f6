//! A least speed at which surfaces part: a remedy for matter at rest that keeps friction.

use super::{CollisionRule, Contact, Impulse, KnownRule, Regime};
use crate::quantity::positive;
use crate::{Fingerprint, ParameterError};

/// A rule with a least parting speed: after each collision, the surfaces part at v_c or faster.
///
/// ```math
/// v_n' = \max\left(r_n v_n,\ v_c\right)
/// ```
///
/// A grain at rest then bounces at $`v_c`$, as if the ground trembled. Each collision transfers at least the
/// momentum $`\mu v_c`$, so a contact that carries the mean force $`F`$ has at most $`F/\mu v_c`$ collisions
/// per unit of time, however much the rule loses. The cost of matter at rest is therefore known beforehand,
/// and friction stays unchanged.
///
/// **The rule gains energy** where surfaces close more slowly than they part, at most
/// $`\tfrac12\mu(v_c^2 - v_n^2)`$. Friction and faster collisions take this energy away. Matter at rest keeps
/// a granular temperature of the order of $`m v_c^2`$ and creeps because of it. Without gravity, a gas that
/// should cool forever stops cooling. The page `docs/rest.md` of the repository compares this remedy with
/// others.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Frictional, LeastRebound, laws};
///
/// let rule = LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, 0.01)?;
/// let fast = Contact::new(1.0, 0.5, 0.5, 1.0 / 6.0);
/// let slow = Contact::new(0.001, 0.0, 0.5, 1.0 / 6.0);
/// assert_eq!(rule.impulse(&fast), rule.rule().impulse(&fast));
/// assert!((rule.impulse(&slow).closing_speed_after(&slow) + 0.01).abs() < 1e-15);
/// laws::check(&rule, &laws::Promises::new().with_friction(0.3).with_energy_gain())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LeastRebound<R> {
    rule: R,
    speed: f64,
}

impl<R> LeastRebound<R> {
    /// Creates the remedy over `rule`, with this least parting speed.
    ///
    /// # Errors
    /// If the speed is not finite and positive. To have no least speed, use the rule alone.
    pub fn new(rule: R, speed: f64) -> Result<Self, ParameterError> {
        Ok(Self { rule, speed: positive("least speed of rebound", speed)? })
    }

    /// Returns the inner rule, which decides all faster rebounds.
    pub const fn rule(&self) -> &R {
        &self.rule
    }

    /// Returns the least parting speed v_c.
    pub const fn speed(&self) -> f64 {
        self.speed
    }
}

impl<R: CollisionRule> CollisionRule for LeastRebound<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let impulse = self.rule.impulse(contact);
        let raised = impulse.parting_at_least(self.speed, contact);
        if raised.normal() > impulse.normal() { raised.with_regime(Regime::LeastRebound) } else { raised }
    }

    /// Returns `None` if the inner rule has no fingerprint: two such remedies could not be distinguished.
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("LeastRebound").part(self.rule.fingerprint()?).number(self.speed))
    }

    fn known(&self) -> Option<KnownRule> {
        Some(Box::new(LeastRebound { rule: self.rule.known()?, speed: self.speed }).into())
    }
}

crate::gate::from_file! {
    LeastRebound<R> { rule: R, speed: f64 } => Self::new(rule, speed)
}
