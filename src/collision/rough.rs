//! Rough disks: the surfaces never slide.

use super::{
    CollisionRule, Contact, Impulse, Regime, from_normal_restitution, from_tangential_restitution,
    normal_inelasticity, tangential_inelasticity,
};
use crate::ParameterError;

/// Rough inelastic collisions without a Coulomb limit: every collision sticks,
/// `$\Delta_n = 2(1-q_n)\mu v_n$` and `$\Delta_t = 2(1-q_t)\mu_t v_t$` (paper, Eqs. (3), (4) with `$\kappa\to\infty$`).
///
/// `$q_t = 0$` is perfectly rough and elastic in the tangential direction, `$q_t = 1$` perfectly smooth.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Rough};
/// let rule = Rough::new(0.0, 0.0)?;
/// let contact = Contact::new(2.0, 7.0, 0.5, 1.0 / 6.0);
/// assert!(rule.impulse(&contact).energy_change(&contact).abs() < 1e-14);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawRough"))]
pub struct Rough {
    normal_inelasticity: f64,
    tangential_inelasticity: f64,
}

impl Rough {
    /// A rule with `$q_n \in [0, 1/2]$` and `$q_t \in [0, 1]$`.
    ///
    /// # Errors
    /// If one is out of range.
    pub fn new(normal: f64, tangential: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            normal_inelasticity: normal_inelasticity(normal)?,
            tangential_inelasticity: tangential_inelasticity(tangential)?,
        })
    }

    /// A rule with the restitution coefficients `$r_n \in [0, 1]$` and `$r_t \in [-1, 1]$`.
    ///
    /// # Errors
    /// If one is out of range.
    pub fn from_restitution(normal: f64, tangential: f64) -> Result<Self, ParameterError> {
        Self::new(from_normal_restitution(normal)?, from_tangential_restitution(tangential)?)
    }

    /// `$q_n$`.
    pub const fn normal_inelasticity(&self) -> f64 {
        self.normal_inelasticity
    }

    /// `$q_t$`.
    pub const fn tangential_inelasticity(&self) -> f64 {
        self.tangential_inelasticity
    }
}

impl CollisionRule for Rough {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let normal = 2.0 * (1.0 - self.normal_inelasticity) * contact.normal_mass() * contact.closing_speed();
        let tangential =
            2.0 * (1.0 - self.tangential_inelasticity) * contact.tangential_mass() * contact.slip_speed();
        Impulse::new(normal, tangential).with_regime(Regime::Sticking)
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "Rough")]
struct RawRough {
    normal_inelasticity: f64,
    tangential_inelasticity: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<RawRough> for Rough {
    type Error = ParameterError;

    fn try_from(raw: RawRough) -> Result<Self, ParameterError> {
        Self::new(raw.normal_inelasticity, raw.tangential_inelasticity)
    }
}
