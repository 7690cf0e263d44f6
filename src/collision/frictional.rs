//! The paper's rule: inelastic, rotating disks with static and dynamic friction.

use super::{
    CollisionRule, Contact, Impulse, Regime, from_normal_restitution, from_tangential_restitution,
    normal_inelasticity, tangential_inelasticity,
};
use crate::ParameterError;
use crate::quantity::{accept, non_negative};

/// Inelastic collisions with Coulomb friction (paper, Eqs. (1)–(5); Jenkins & Zhang 2002), for any two bodies:
///
/// ```math
/// \Delta_n = 2(1-q_n)\,\mu\,v_n,\qquad
/// \Delta_t = \begin{cases}
/// 2(1-q_t)\,\mu_t\,v_t & \text{if } |2(1-q_t)\,\mu_t\,v_t| < \kappa_s\Delta_n \quad\text{(sticking)}\\
/// \operatorname{sgn}(v_t)\,\kappa_d\,\Delta_n & \text{else} \quad\text{(sliding)}
/// \end{cases}
/// ```
///
/// For homogeneous disks `$\mu_t=\mu/3$`, and these are the paper's factors 2/3 and 3.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Frictional, Regime};
///
/// let rule = Frictional::new(0.1, 0.08)?;
/// let contact = Contact::new(1.5, 4.25, 0.5, 0.5 / 3.0);
/// let impulse = rule.impulse(&contact);
/// assert_eq!(impulse.regime(), Regime::Sliding);
/// assert!((impulse.tangential() - 0.108).abs() < 1e-12);
///
/// let rule = Frictional::from_restitution(0.8, 0.6)?.with_friction(0.5, 0.4)?;
/// assert!((rule.tangential_inelasticity() - 0.2).abs() < 1e-15);
/// assert!(rule.with_friction(0.4, 0.5).is_err(), "dynamic friction above static friction could gain energy");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawFrictional"))]
pub struct Frictional {
    normal_inelasticity: f64,
    tangential_inelasticity: f64,
    static_friction: f64,
    dynamic_friction: f64,
}

impl Frictional {
    /// The paper's choice: `$q = q_n = q_t$` and `$\kappa = \kappa_s = \kappa_d$`.
    ///
    /// # Errors
    /// If `inelasticity` is not in `[0, 0.5]`, or `friction` is negative or not finite.
    pub fn new(inelasticity: f64, friction: f64) -> Result<Self, ParameterError> {
        Self::from_inelasticity(inelasticity, inelasticity)?.with_friction(friction, friction)
    }

    /// A rule without friction from `$q_n \in [0, 1/2]$` and `$q_t \in [0, 1]$`; see [`Self::with_friction`].
    ///
    /// # Errors
    /// If an inelasticity is out of its range.
    pub fn from_inelasticity(normal: f64, tangential: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            normal_inelasticity: normal_inelasticity(normal)?,
            tangential_inelasticity: tangential_inelasticity(tangential)?,
            static_friction: 0.0,
            dynamic_friction: 0.0,
        })
    }

    /// A rule without friction from the restitution coefficients `$r_n \in [0, 1]$` and `$r_t \in [-1, 1]$`
    /// (paper, Eq. (1)); see [`Self::with_friction`].
    ///
    /// # Errors
    /// If a restitution is out of its range.
    pub fn from_restitution(normal: f64, tangential: f64) -> Result<Self, ParameterError> {
        Self::from_inelasticity(from_normal_restitution(normal)?, from_tangential_restitution(tangential)?)
    }

    /// The same rule with the friction coefficients `$\kappa_s \ge \kappa_d \ge 0$`.
    ///
    /// # Errors
    /// If one is negative or not finite, or the dynamic coefficient exceeds the static one: sliding could then
    /// gain energy.
    pub fn with_friction(self, static_friction: f64, dynamic_friction: f64) -> Result<Self, ParameterError> {
        non_negative("static friction", static_friction)?;
        non_negative("dynamic friction", dynamic_friction)?;
        let ordered = dynamic_friction <= static_friction;
        accept(ordered, "dynamic friction", "at most the static friction", dynamic_friction)?;
        Ok(Self { static_friction, dynamic_friction, ..self })
    }

    /// `$q_n$`.
    pub const fn normal_inelasticity(&self) -> f64 {
        self.normal_inelasticity
    }

    /// `$q_t$`.
    pub const fn tangential_inelasticity(&self) -> f64 {
        self.tangential_inelasticity
    }

    /// `$\kappa_s$`.
    pub const fn static_friction(&self) -> f64 {
        self.static_friction
    }

    /// `$\kappa_d$`.
    pub const fn dynamic_friction(&self) -> f64 {
        self.dynamic_friction
    }
}

impl CollisionRule for Frictional {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let normal = 2.0 * (1.0 - self.normal_inelasticity) * contact.normal_mass() * contact.closing_speed();
        let sticking =
            2.0 * (1.0 - self.tangential_inelasticity) * contact.tangential_mass() * contact.slip_speed();
        let sliding = (self.dynamic_friction * normal).copysign(sticking);
        // Selections, not a branch: which of the two it is, is a coin toss.
        let sticks = sticking.abs() < self.static_friction * normal;
        let tangential = if sticks { sticking } else { sliding };
        Impulse::new(normal, tangential).with_regime(if sticks { Regime::Sticking } else { Regime::Sliding })
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "Frictional")]
struct RawFrictional {
    normal_inelasticity: f64,
    tangential_inelasticity: f64,
    static_friction: f64,
    dynamic_friction: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<RawFrictional> for Frictional {
    type Error = ParameterError;

    fn try_from(raw: RawFrictional) -> Result<Self, ParameterError> {
        Self::from_inelasticity(raw.normal_inelasticity, raw.tangential_inelasticity)?
            .with_friction(raw.static_friction, raw.dynamic_friction)
    }
}
