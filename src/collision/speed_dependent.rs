//! Restitution that falls with the speed of the impact.

use super::{CollisionRule, Contact, Friction, Impulse, KnownRule, inelasticity};
use crate::quantity::{accept, positive};
use crate::{Fingerprint, ParameterError};

/// Restitution that falls with the speed of the impact, from 1 to a constant, with Coulomb friction (C. Bizon
/// et al., Phys. Rev. Lett. **80**, 57 (1998)):
///
/// ```math
/// r_n(v_n) = \max\left(r_0,\ 1 - (1 - r_0)\,(v_n/v_0)^{3/4}\right)
/// ```
///
/// Bizon et al. take $`v_0 = \sqrt{g\sigma}`$, with the diameter $`\sigma`$. Slow collisions lose next to
/// nothing, as with real grains, so disks without gravity do not collapse. A disk on a floor still comes to
/// rest after infinitely many bounces in a finite time, only later. Its speed falls by
/// $`(1 - r_0)\,v\,(v/v_0)^{3/4}`$ in each bounce, and the durations $`2v/g`$ of the bounces have a finite
/// sum. Matter at rest needs [`LeastRebound`](super::LeastRebound) or [`ElasticBelow`](super::ElasticBelow)
/// around this rule.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Friction, SpeedDependent};
///
/// let friction = Friction::from_inelasticity(0.25, 0.5)?;
/// let rule = SpeedDependent::from_restitution(0.7, 1.0)?.with_friction(friction);
/// assert_eq!(rule.restitution(1.0), 0.7);
/// assert_eq!(rule.restitution(5.0), 0.7);
/// assert!((rule.restitution(1.0 / 16.0) - (1.0 - 0.3 / 8.0)).abs() < 1e-15);
/// let slow = Contact::new(1e-8, 0.0, 0.5, 0.5 / 3.0);
/// assert!((rule.impulse(&slow).normal() / 1e-8 - 1.0).abs() < 1e-6);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SpeedDependent {
    least_restitution: f64,
    speed: f64,
    friction: Friction,
}

impl SpeedDependent {
    /// Creates a rule without friction whose restitution falls to r_0, at the closing speed v_0.
    ///
    /// # Errors
    /// If the restitution is not in `[0, 1]`, or the speed is not finite and positive.
    pub fn from_restitution(least_restitution: f64, speed: f64) -> Result<Self, ParameterError> {
        let valid = (0.0..=1.0).contains(&least_restitution);
        accept(valid, "least restitution", "in [0, 1]", least_restitution)?;
        positive("speed of the least restitution", speed)?;
        Ok(Self { least_restitution, speed, friction: Friction::from_inelasticity(0.0, 0.0)? })
    }

    /// Creates a rule without friction whose inelasticity rises to q_0, at the closing speed v_0.
    ///
    /// # Errors
    /// If the inelasticity is not in `[0, 1/2]`, or the speed is not finite and positive.
    pub fn from_inelasticity(greatest_inelasticity: f64, speed: f64) -> Result<Self, ParameterError> {
        Self::from_restitution(1.0 - 2.0 * inelasticity::normal(greatest_inelasticity)?, speed)
    }

    /// Returns the same rule with this friction.
    pub const fn with_friction(self, friction: Friction) -> Self {
        Self { friction, ..self }
    }

    /// Returns the restitution r_n at a closing speed.
    #[inline]
    pub fn restitution(&self, closing_speed: f64) -> f64 {
        // Square roots give the power 3/4 with the same bits on every platform.
        let root = (closing_speed / self.speed).min(1.0).sqrt();
        1.0 - (1.0 - self.least_restitution) * (root * root.sqrt())
    }

    /// Returns the restitution r_0 of fast collisions.
    pub const fn least_restitution(&self) -> f64 {
        self.least_restitution
    }

    /// Returns the closing speed v_0 above which the restitution is constant.
    pub const fn speed(&self) -> f64 {
        self.speed
    }

    /// Returns the friction.
    pub const fn friction(&self) -> &Friction {
        &self.friction
    }
}

impl CollisionRule for SpeedDependent {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let normal = contact.normal_impulse(self.restitution(contact.closing_speed()));
        self.friction.impulse(contact, normal)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let normal = Fingerprint::of("SpeedDependent").number(self.least_restitution()).number(self.speed());
        Some(normal.part(self.friction.fingerprint()))
    }

    fn known(&self) -> Option<KnownRule> {
        Some((*self).into())
    }
}

crate::gate::from_file! {
    SpeedDependent { least_restitution: f64, speed: f64, friction: Friction } =>
        Ok(Self::from_restitution(least_restitution, speed)?.with_friction(friction))
}
