//! Restitution that falls with the speed of the impact.

use super::inelasticity::NormalInelasticity;
use super::{CollisionRule, Contact, Friction, Impulse, KnownRule};
use crate::quantity::{Checked, Quantity, Range};
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
/// rest after infinitely many bounces in a finite time, only later: its speed falls by
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SpeedDependent {
    least_restitution: Checked<LeastRestitution>,
    speed: Checked<Speed>,
    friction: Friction,
}

enum LeastRestitution {}

impl Quantity for LeastRestitution {
    const NAME: &'static str = "least restitution";
    const RANGE: Range = Range::new("in [0, 1]", |value| (0.0..=1.0).contains(&value));
}

enum Speed {}

impl Quantity for Speed {
    const NAME: &'static str = "speed of the least restitution";
    const RANGE: Range = Range::POSITIVE;
}

impl SpeedDependent {
    /// Creates a rule without friction whose restitution falls to r_0, at the closing speed v_0.
    ///
    /// # Errors
    /// If the restitution is not in `[0, 1]`, or the speed is not finite and positive.
    pub fn from_restitution(least_restitution: f64, speed: f64) -> Result<Self, ParameterError> {
        let (least_restitution, speed) = (Checked::new(least_restitution)?, Checked::new(speed)?);
        Ok(Self { least_restitution, speed, friction: Friction::from_inelasticity(0.0, 0.0)? })
    }

    /// Creates a rule without friction whose inelasticity rises to q_0, at the closing speed v_0.
    ///
    /// # Errors
    /// If the inelasticity is not in `[0, 1/2]`, or the speed is not finite and positive.
    pub fn from_inelasticity(greatest_inelasticity: f64, speed: f64) -> Result<Self, ParameterError> {
        let inelasticity = NormalInelasticity::new(greatest_inelasticity)?;
        Self::from_restitution(1.0 - 2.0 * inelasticity.get(), speed)
    }

    /// Returns the same rule with this friction.
    pub const fn with_friction(self, friction: Friction) -> Self {
        Self { friction, ..self }
    }

    /// Returns the restitution r_n at a closing speed.
    #[inline]
    pub fn restitution(&self, closing_speed: f64) -> f64 {
        // Square roots give the power 3/4 with the same bits on every platform.
        let root = (closing_speed / self.speed.get()).min(1.0).sqrt();
        1.0 - (1.0 - self.least_restitution.get()) * (root * root.sqrt())
    }

    /// Returns the restitution r_0 of fast collisions.
    pub const fn least_restitution(&self) -> f64 {
        self.least_restitution.get()
    }

    /// Returns the closing speed v_0 above which the restitution is constant.
    pub const fn speed(&self) -> f64 {
        self.speed.get()
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
