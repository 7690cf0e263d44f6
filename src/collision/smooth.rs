//! Inelastic disks without any tangential force.

use super::{CollisionRule, Contact, Impulse, KnownRule, inelasticity};
use crate::{Fingerprint, ParameterError};

/// Smooth inelastic collisions: a normal impulse (paper, Eq. (3)) and no tangential impulse.
///
/// The normal impulse is $`\Delta_n = 2(1-q_n)\mu v_n`$.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Smooth};
/// let rule = Smooth::from_restitution(0.8)?;
/// let contact = Contact::new(2.0, 7.0, 0.5, 1.0 / 6.0);
/// // -2 q (1 - q) mu v_n^2 with q = 0.1
/// assert!((rule.impulse(&contact).energy_change(&contact) + 0.36).abs() < 1e-12);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Smooth {
    normal_inelasticity: f64,
}

impl Smooth {
    /// Creates a rule with the normal inelasticity q_n, in `[0, 1/2]`.
    ///
    /// # Errors
    /// If the inelasticity is out of range.
    pub fn from_inelasticity(normal: f64) -> Result<Self, ParameterError> {
        Ok(Self { normal_inelasticity: inelasticity::normal(normal)? })
    }

    /// Creates a rule with the normal restitution r_n, in `[0, 1]`.
    ///
    /// # Errors
    /// If the restitution is out of range.
    pub fn from_restitution(normal: f64) -> Result<Self, ParameterError> {
        Ok(Self { normal_inelasticity: inelasticity::of_normal_restitution(normal)? })
    }

    /// Returns the normal inelasticity q_n.
    pub const fn normal_inelasticity(&self) -> f64 {
        self.normal_inelasticity
    }
}

impl CollisionRule for Smooth {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        Impulse::new(inelasticity::normal_impulse(self.normal_inelasticity, contact), 0.0)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Smooth").number(self.normal_inelasticity()))
    }

    fn known(&self) -> Option<KnownRule> {
        Some((*self).into())
    }
}

crate::gate::from_file! {
    Smooth { normal_inelasticity: f64 } => Self::from_inelasticity(normal_inelasticity)
}
