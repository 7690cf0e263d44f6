//! Rolling friction added to any rule.

use super::{CollisionRule, Contact, Impulse, KnownRule};
use crate::quantity::non_negative;
use crate::{Fingerprint, ParameterError};

/// Rolling friction added to any rule: a couple slows the relative spin of the partners, up to a limit that
/// grows with the normal impulse.
///
/// With the relative spin $`\omega'`$ that the inner rule leaves, and the effective radius
/// $`R = R_1R_2/(R_1 + R_2)`$,
///
/// ```math
/// C = \min\left(\mu_r\,\Delta_n R,\ I\,|\omega'|\right)\,\mathrm{sign}\,\omega'
/// ```
///
/// This is Coulomb's law of rolling resistance with impulses in place of forces: a lasting contact resists
/// rolling by a torque of at most $`\mu_r F_n R`$ (Iwashita and Oda 1998, without their spring). The couple
/// transfers no momentum, so it does not act on disks that only translate. A straight wall, or the corner or
/// end of a part, has $`R_2 = \infty`$.
///
/// The couple acts after the tangential impulse, on the spins that friction has left. Friction is thus the
/// same with and without rolling friction, and the couple never gains energy, whatever the inner rule does:
/// the couple removes the energy $`C(|\omega'| - C/2I)`$. In the other order, it could push surfaces that
/// have just stuck.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Elastic, RollingFriction};
///
/// let rule = RollingFriction::new(Elastic, 0.25)?;
/// // Two disks head on: normal impulse 2, effective radius 1/4.
/// let turning = Contact::new(2.0, 0.0, 0.5, 0.5 / 3.0).with_spin(4.0, 0.0625, 0.0);
/// assert_eq!(rule.impulse(&turning).couple(), 0.125);
/// assert_eq!(rule.impulse(&turning).relative_spin_after(&turning), 2.0);
/// // The same couple would reverse a slow spin, so a smaller couple stops it.
/// let slow = turning.with_spin(1.0, 0.0625, 0.0);
/// assert_eq!(rule.impulse(&slow).relative_spin_after(&slow), 0.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RollingFriction<R> {
    rule: R,
    coefficient: f64,
}

impl<R> RollingFriction<R> {
    /// Creates a rule that adds rolling friction with the coefficient μ_r to `rule`.
    ///
    /// # Errors
    /// If the coefficient is not finite, or negative.
    pub fn new(rule: R, coefficient: f64) -> Result<Self, ParameterError> {
        Ok(Self { rule, coefficient: non_negative("coefficient of rolling friction", coefficient)? })
    }

    /// Returns the inner rule, which decides everything else. A couple of its own is added.
    pub const fn rule(&self) -> &R {
        &self.rule
    }

    /// Returns the coefficient μ_r.
    pub const fn coefficient(&self) -> f64 {
        self.coefficient
    }
}

impl<R: CollisionRule> CollisionRule for RollingFriction<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let impulse = self.rule.impulse(contact);
        let stopping = contact.spin_inertia() * impulse.relative_spin_after(contact);
        let limit = self.coefficient * impulse.normal() * contact.effective_radius();
        // For a rule that pulls the surfaces together, the limit is negative; such a rule gets no couple.
        let couple = if stopping.abs() <= limit { stopping } else { limit.max(0.0).copysign(stopping) };
        impulse.with_couple(impulse.couple() + couple)
    }

    /// Returns `None` if the inner rule has no fingerprint: two such rules could not be distinguished.
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("RollingFriction").part(self.rule.fingerprint()?).number(self.coefficient))
    }

    fn known(&self) -> Option<KnownRule> {
        let rule = self.rule.known()?;
        Some(Box::new(RollingFriction { rule, coefficient: self.coefficient }).into())
    }
}

crate::gate::from_file! {
    RollingFriction<R> { rule: R, coefficient: f64 } => Self::new(rule, coefficient)
}
