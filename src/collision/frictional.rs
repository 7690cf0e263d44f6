//! The paper's rule: inelastic, rotating disks with static and dynamic friction.

use super::inelasticity::NormalInelasticity;
use super::{CollisionRule, Contact, Friction, Impulse};
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
/// let rule = Frictional::new(0.1, 0.08)?;
/// let contact = Contact::new(1.5, 4.25, 0.5, 0.5 / 3.0);
/// let impulse = rule.impulse(&contact);
/// assert_eq!(impulse.regime(), Regime::Sliding);
/// assert!((impulse.tangential() - 0.108).abs() < 1e-12);
///
/// let rule = Frictional::from_restitution(0.8, 0.6)?.with_friction(0.5, 0.4)?;
/// assert!((rule.tangential_inelasticity() - 0.2).abs() < 1e-15);
/// assert!(rule.with_friction(0.4, 0.5).is_err(), "dynamic above static friction could gain energy");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Fields", into = "Fields"))]
pub struct Frictional {
    normal_inelasticity: NormalInelasticity,
    friction: Friction,
}

impl Frictional {
    /// Creates a rule with the paper's choice: q = q_n = q_t and κ = κ_s = κ_d.
    ///
    /// # Errors
    /// If `inelasticity` is not in `[0, 0.5]`, or `friction` is negative or not finite.
    pub fn new(inelasticity: f64, friction: f64) -> Result<Self, ParameterError> {
        Self::from_inelasticity(inelasticity, inelasticity)?.with_friction(friction, friction)
    }

    /// Creates a rule without friction from the inelasticities q_n, in `[0, 1/2]`, and q_t, in `[0, 1]`;
    /// [`Self::with_friction`] adds friction.
    ///
    /// # Errors
    /// If an inelasticity is out of its range.
    pub fn from_inelasticity(normal: f64, tangential: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            normal_inelasticity: NormalInelasticity::new(normal)?,
            friction: Friction::from_inelasticity(tangential)?,
        })
    }

    /// Creates a rule without friction from the restitution coefficients r_n, in `[0, 1]`, and r_t, in
    /// `[-1, 1]` (paper, Eq. (1)); [`Self::with_friction`] adds friction.
    ///
    /// # Errors
    /// If a restitution is out of its range.
    pub fn from_restitution(normal: f64, tangential: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            normal_inelasticity: NormalInelasticity::from_restitution(normal)?,
            friction: Friction::from_restitution(tangential)?,
        })
    }

    /// Returns the same rule with the friction coefficients κ_s ≥ κ_d ≥ 0.
    ///
    /// # Errors
    /// If a coefficient is negative or not finite, or the dynamic one exceeds the static one, because sliding
    /// could then gain energy.
    pub fn with_friction(self, static_friction: f64, dynamic_friction: f64) -> Result<Self, ParameterError> {
        Ok(Self { friction: self.friction.with_coefficients(static_friction, dynamic_friction)?, ..self })
    }

    /// Returns the normal inelasticity q_n.
    pub const fn normal_inelasticity(&self) -> f64 {
        self.normal_inelasticity.get()
    }

    /// Returns the tangential inelasticity q_t.
    pub const fn tangential_inelasticity(&self) -> f64 {
        self.friction.tangential_inelasticity()
    }

    /// Returns the static friction coefficient κ_s.
    pub const fn static_friction(&self) -> f64 {
        self.friction.static_coefficient()
    }

    /// Returns the dynamic friction coefficient κ_d.
    pub const fn dynamic_friction(&self) -> f64 {
        self.friction.dynamic_coefficient()
    }
}

impl CollisionRule for Frictional {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        self.friction.impulse(contact, self.normal_inelasticity.impulse(contact))
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let name = Fingerprint::of("Frictional");
        let inelastic = name.number(self.normal_inelasticity()).number(self.tangential_inelasticity());
        Some(inelastic.number(self.static_friction()).number(self.dynamic_friction()))
    }
}

/// Fields of the rule in a file: all numbers side by side.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "Frictional")]
struct Fields {
    normal_inelasticity: f64,
    tangential_inelasticity: f64,
    static_friction: f64,
    dynamic_friction: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<Fields> for Frictional {
    type Error = ParameterError;

    fn try_from(fields: Fields) -> Result<Self, ParameterError> {
        Self::from_inelasticity(fields.normal_inelasticity, fields.tangential_inelasticity)?
            .with_friction(fields.static_friction, fields.dynamic_friction)
    }
}

#[cfg(feature = "serde")]
impl From<Frictional> for Fields {
    fn from(rule: Frictional) -> Self {
        Self {
            normal_inelasticity: rule.normal_inelasticity(),
            tangential_inelasticity: rule.tangential_inelasticity(),
            static_friction: rule.static_friction(),
            dynamic_friction: rule.dynamic_friction(),
        }
    }
}
