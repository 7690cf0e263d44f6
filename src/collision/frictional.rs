//! Rules with Coulomb friction: the paper's rule, and restitution that falls with the speed of the impact.

use super::without_friction::{normal_impulse, normal_inelasticity, of_tangential_restitution};
use super::without_friction::{tangential_impulse, tangential_inelasticity};
use super::{CollisionRule, Contact, Impulse, KnownRule, Regime, Smooth};
use crate::quantity::{accept, non_negative, positive};
use crate::{Fingerprint, ParameterError};

/// Coulomb friction that sticks or slides: the tangential part of a rule, for any normal impulse.
///
/// ```math
/// \Delta_t = \begin{cases}
/// 2(1-q_t)\,\mu_t\,v_t & \text{if } |2(1-q_t)\,\mu_t\,v_t| < \kappa_s\Delta_n \quad\text{(sticking)}\\
/// \mathrm{sgn}(v_t)\,\kappa_d\,\Delta_n & \text{else} \quad\text{(sliding)}
/// \end{cases}
/// ```
///
/// The equations are the paper's Eqs. (4), (5). A custom rule can compute the normal impulse and leave the
/// rest to this type:
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Friction, Impulse, Regime};
///
/// /// Restitution that falls with the speed of the impact.
/// struct Viscoelastic {
///     loss: f64,
///     friction: Friction,
/// }
///
/// impl CollisionRule for Viscoelastic {
///     fn impulse(&self, contact: &Contact) -> Impulse {
///         let restitution = 1.0 / (1.0 + self.loss * contact.closing_speed().sqrt());
///         self.friction.impulse(contact, contact.normal_impulse(restitution))
///     }
/// }
///
/// let rule = Viscoelastic { loss: 0.5, friction: Friction::from_inelasticity(0.1, 0.25)? };
/// let impulse = rule.impulse(&Contact::new(4.0, 9.0, 0.5, 0.5 / 3.0));
/// assert_eq!((impulse.normal(), impulse.tangential()), (3.0, 0.75));
/// assert_eq!(impulse.regime(), Regime::Sliding);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[expect(clippy::struct_field_names, reason = "a coefficient has one name in all rules and files")]
pub struct Friction {
    tangential_inelasticity: f64,
    static_friction: f64,
    dynamic_friction: f64,
}

impl Friction {
    /// Creates friction with the inelasticity q_t, in `[0, 1]`, and one coefficient, κ = κ_s = κ_d.
    ///
    /// # Errors
    /// If the inelasticity is out of its range, or the coefficient is negative or not finite.
    pub fn from_inelasticity(tangential: f64, friction: f64) -> Result<Self, ParameterError> {
        Self::with_equal(tangential_inelasticity(tangential)?, friction)
    }

    /// Creates friction with the restitution r_t, in `[-1, 1]`, and one coefficient, κ = κ_s = κ_d.
    ///
    /// # Errors
    /// If the restitution is out of its range, or the coefficient is negative or not finite.
    pub fn from_restitution(tangential: f64, friction: f64) -> Result<Self, ParameterError> {
        Self::with_equal(of_tangential_restitution(tangential)?, friction)
    }

    fn with_equal(tangential_inelasticity: f64, friction: f64) -> Result<Self, ParameterError> {
        let static_friction = non_negative("static friction", friction)?;
        Ok(Self { tangential_inelasticity, static_friction, dynamic_friction: static_friction })
    }

    /// Returns the same friction with a smaller dynamic coefficient κ_d.
    ///
    /// # Errors
    /// If the coefficient is negative or not finite, or exceeds the static one, because sliding could then
    /// gain energy.
    pub fn with_dynamic_friction(self, dynamic_friction: f64) -> Result<Self, ParameterError> {
        non_negative("dynamic friction", dynamic_friction)?;
        let ordered = dynamic_friction <= self.static_friction;
        accept(ordered, "dynamic friction", "at most the static friction", dynamic_friction)?;
        Ok(Self { dynamic_friction, ..self })
    }

    /// Returns the whole impulse of a contact: the given `normal` impulse, with the tangential impulse that
    /// friction then allows.
    #[inline]
    pub fn impulse(&self, contact: &Contact, normal: f64) -> Impulse {
        let sticking = tangential_impulse(self.tangential_inelasticity, contact);
        let sliding = (self.dynamic_friction * normal).copysign(sticking);
        // The code selects instead of branching, since no branch predictor can learn whether a contact sticks
        // or slides.
        let sticks = sticking.abs() < self.static_friction * normal;
        let tangential = if sticks { sticking } else { sliding };
        Impulse::new(normal, tangential).with_regime(if sticks { Regime::Sticking } else { Regime::Sliding })
    }

    /// Returns the fingerprint, which rules with friction include in theirs.
    pub(super) fn fingerprint(&self) -> Fingerprint {
        let inelastic = Fingerprint::of("Friction").number(self.tangential_inelasticity());
        inelastic.number(self.static_friction).number(self.dynamic_friction)
    }

    /// Returns the tangential inelasticity q_t.
    pub const fn tangential_inelasticity(&self) -> f64 {
        self.tangential_inelasticity
    }

    /// Returns the static friction coefficient κ_s.
    pub const fn static_friction(&self) -> f64 {
        self.static_friction
    }

    /// Returns the dynamic friction coefficient κ_d.
    pub const fn dynamic_friction(&self) -> f64 {
        self.dynamic_friction
    }
}

crate::gate::from_file! {
    Friction { tangential_inelasticity: f64, static_friction: f64, dynamic_friction: f64 } => Self::from_inelasticity(tangential_inelasticity, static_friction)?.with_dynamic_friction(dynamic_friction)
}

/// Inelastic collisions with Coulomb friction (paper, Eqs. (1)–(5); Jenkins & Zhang 2002), for any two
/// bodies:
///
/// ```math
/// \Delta_n = 2(1-q_n)\,\mu\,v_n,\qquad
/// \Delta_t = \begin{cases}
/// 2(1-q_t)\,\mu_t\,v_t & \text{if } |2(1-q_t)\,\mu_t\,v_t| < \kappa_s\Delta_n \quad\text{(sticking)}\\
/// \mathrm{sgn}(v_t)\,\kappa_d\,\Delta_n & \text{else} \quad\text{(sliding)}
/// \end{cases}
/// ```
///
/// For homogeneous disks $`\mu_t=\mu/3`$, which gives the paper's factors 2/3 and 3.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Frictional, Regime};
///
/// let rule = Frictional::from_inelasticity(0.1, 0.1, 0.08)?;
/// let contact = Contact::new(1.5, 4.25, 0.5, 0.5 / 3.0);
/// let impulse = rule.impulse(&contact);
/// assert_eq!(impulse.regime(), Regime::Sliding);
/// assert!((impulse.tangential() - 0.108).abs() < 1e-12);
///
/// let rule = Frictional::from_restitution(0.8, 0.6, 0.5)?.with_dynamic_friction(0.4)?;
/// assert!((rule.tangential_inelasticity() - 0.2).abs() < 1e-15);
/// assert!(rule.with_dynamic_friction(0.6).is_err(), "dynamic above static friction could gain energy");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
///
/// Three numbers in a row are easily swapped by mistake. Their order follows the equations: normal,
/// tangential, friction. [`Smooth::with_friction`](super::Smooth::with_friction) names them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Frictional {
    normal_inelasticity: f64,
    friction: Friction,
}

impl Smooth {
    /// Returns the rule with the same normal impulse and this friction.
    ///
    /// ```
    /// use granular_edmd::collision::{Friction, Frictional, Smooth};
    /// let friction = Friction::from_inelasticity(0.2, 0.3)?;
    /// let rule = Smooth::from_inelasticity(0.1)?.with_friction(friction);
    /// assert_eq!(rule, Frictional::from_inelasticity(0.1, 0.2, 0.3)?);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    pub const fn with_friction(self, friction: Friction) -> Frictional {
        Frictional { normal_inelasticity: self.normal_inelasticity(), friction }
    }
}

impl Frictional {
    /// Creates a rule from the inelasticities q_n, in `[0, 1/2]`, and q_t, in `[0, 1]`, and one coefficient
    /// of friction, κ = κ_s = κ_d.
    ///
    /// The paper takes q_n = q_t.
    ///
    /// # Errors
    /// If an inelasticity is out of its range, or the friction is negative or not finite.
    pub fn from_inelasticity(normal: f64, tangential: f64, friction: f64) -> Result<Self, ParameterError> {
        Ok(Smooth::from_inelasticity(normal)?
            .with_friction(Friction::from_inelasticity(tangential, friction)?))
    }

    /// Creates a rule from the restitution coefficients r_n, in `[0, 1]`, and r_t, in `[-1, 1]` (paper,
    /// Eq. (1)), and one coefficient of friction, κ = κ_s = κ_d.
    ///
    /// # Errors
    /// If a restitution is out of its range, or the friction is negative or not finite.
    pub fn from_restitution(normal: f64, tangential: f64, friction: f64) -> Result<Self, ParameterError> {
        Ok(Smooth::from_restitution(normal)?.with_friction(Friction::from_restitution(tangential, friction)?))
    }

    /// Returns the same rule with a smaller coefficient of dynamic friction κ_d.
    ///
    /// # Errors
    /// If the coefficient is negative or not finite, or exceeds the static one, because sliding could then
    /// gain energy.
    pub fn with_dynamic_friction(self, dynamic_friction: f64) -> Result<Self, ParameterError> {
        Ok(Self { friction: self.friction.with_dynamic_friction(dynamic_friction)?, ..self })
    }

    /// Returns the normal inelasticity q_n.
    pub const fn normal_inelasticity(&self) -> f64 {
        self.normal_inelasticity
    }

    /// Returns the tangential inelasticity q_t.
    pub const fn tangential_inelasticity(&self) -> f64 {
        self.friction.tangential_inelasticity()
    }

    /// Returns the static friction coefficient κ_s.
    pub const fn static_friction(&self) -> f64 {
        self.friction.static_friction()
    }

    /// Returns the dynamic friction coefficient κ_d.
    pub const fn dynamic_friction(&self) -> f64 {
        self.friction.dynamic_friction()
    }
}

impl CollisionRule for Frictional {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let normal = normal_impulse(self.normal_inelasticity, contact);
        self.friction.impulse(contact, normal)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let name = Fingerprint::of("Frictional");
        let inelastic = name.number(self.normal_inelasticity()).number(self.tangential_inelasticity());
        Some(inelastic.number(self.static_friction()).number(self.dynamic_friction()))
    }

    fn known(&self) -> Option<KnownRule> {
        Some((*self).into())
    }
}

crate::gate::from_file! {
    Frictional { normal_inelasticity: f64, friction: Friction } =>
        Ok(Smooth::from_inelasticity(normal_inelasticity)?.with_friction(friction))
}

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
        Self::from_restitution(1.0 - 2.0 * normal_inelasticity(greatest_inelasticity)?, speed)
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
}

impl CollisionRule for SpeedDependent {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let normal = contact.normal_impulse(self.restitution(contact.closing_speed()));
        self.friction.impulse(contact, normal)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let normal = Fingerprint::of("SpeedDependent").number(self.least_restitution).number(self.speed);
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
