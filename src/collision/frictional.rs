//! The paper's rule: inelastic, rotating disks with static and dynamic friction.

use super::{CollisionRule, Contact, Friction, Impulse, KnownRule, Smooth, inelasticity};
use crate::{Fingerprint, ParameterError};

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
        let normal = inelasticity::normal_impulse(self.normal_inelasticity, contact);
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
