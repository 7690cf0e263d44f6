//! Coulomb friction in a contact, for any behavior in the normal direction.

use super::{Contact, Impulse, Regime, inelasticity};
use crate::quantity::{accept, non_negative};
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
        Self::with_equal(inelasticity::tangential(tangential)?, friction)
    }

    /// Creates friction with the restitution r_t, in `[-1, 1]`, and one coefficient, κ = κ_s = κ_d.
    ///
    /// # Errors
    /// If the restitution is out of its range, or the coefficient is negative or not finite.
    pub fn from_restitution(tangential: f64, friction: f64) -> Result<Self, ParameterError> {
        Self::with_equal(inelasticity::of_tangential_restitution(tangential)?, friction)
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
        let sticking = inelasticity::tangential_impulse(self.tangential_inelasticity, contact);
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
