//! Rules without sliding friction: elastic, smooth and perfectly rough disks. Their inelasticities, and the
//! impulses that follow from these alone.

use super::{CollisionRule, Contact, Impulse, KnownRule, Regime};
use crate::quantity::accept;
use crate::{Fingerprint, ParameterError};

/// Smooth elastic collisions: the closing speed is reversed, and the slip stays unchanged.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Elastic};
/// let contact = Contact::new(2.0, 7.0, 0.5, 1.0 / 6.0);
/// assert_eq!(Elastic.impulse(&contact).energy_change(&contact), 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "Empty", into = "Empty"))]
pub struct Elastic;

/// A value without fields, as files hold it: an empty table. Some formats, TOML among them, have no unit
/// value.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Empty {}

#[cfg(feature = "serde")]
impl From<Empty> for Elastic {
    fn from(_: Empty) -> Self {
        Self
    }
}

#[cfg(feature = "serde")]
impl From<Elastic> for Empty {
    fn from(_: Elastic) -> Self {
        Self {}
    }
}

impl CollisionRule for Elastic {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        Impulse::new(contact.normal_impulse(1.0), 0.0)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Elastic"))
    }

    fn known(&self) -> Option<KnownRule> {
        Some((*self).into())
    }
}

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
        Ok(Self { normal_inelasticity: normal_inelasticity(normal)? })
    }

    /// Creates a rule with the normal restitution r_n, in `[0, 1]`.
    ///
    /// # Errors
    /// If the restitution is out of range.
    pub fn from_restitution(normal: f64) -> Result<Self, ParameterError> {
        Ok(Self { normal_inelasticity: of_normal_restitution(normal)? })
    }

    /// Returns the normal inelasticity q_n.
    pub const fn normal_inelasticity(&self) -> f64 {
        self.normal_inelasticity
    }
}

impl CollisionRule for Smooth {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        Impulse::new(normal_impulse(self.normal_inelasticity, contact), 0.0)
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

/// Rough inelastic collisions without a Coulomb limit, in which every collision sticks.
///
/// The impulses are $`\Delta_n = 2(1-q_n)\mu v_n`$ and $`\Delta_t = 2(1-q_t)\mu_t v_t`$ (paper, Eqs. (3), (4)
/// with $`\kappa\to\infty`$).
///
/// Disks with $`q_t = 0`$ are perfectly rough and elastic in the tangential direction, disks with $`q_t = 1`$
/// perfectly smooth.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Rough};
/// let rule = Rough::from_inelasticity(0.0, 0.0)?;
/// let contact = Contact::new(2.0, 7.0, 0.5, 1.0 / 6.0);
/// assert!(rule.impulse(&contact).energy_change(&contact).abs() < 1e-14);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rough {
    normal_inelasticity: f64,
    tangential_inelasticity: f64,
}

impl Rough {
    /// Creates a rule with the inelasticities q_n, in `[0, 1/2]`, and q_t, in `[0, 1]`.
    ///
    /// # Errors
    /// If an inelasticity is out of range.
    pub fn from_inelasticity(normal: f64, tangential: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            normal_inelasticity: normal_inelasticity(normal)?,
            tangential_inelasticity: tangential_inelasticity(tangential)?,
        })
    }

    /// Creates a rule with the restitution coefficients r_n, in `[0, 1]`, and r_t, in `[-1, 1]`.
    ///
    /// # Errors
    /// If a restitution is out of range.
    pub fn from_restitution(normal: f64, tangential: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            normal_inelasticity: of_normal_restitution(normal)?,
            tangential_inelasticity: of_tangential_restitution(tangential)?,
        })
    }

    /// Returns the normal inelasticity q_n.
    pub const fn normal_inelasticity(&self) -> f64 {
        self.normal_inelasticity
    }

    /// Returns the tangential inelasticity q_t.
    pub const fn tangential_inelasticity(&self) -> f64 {
        self.tangential_inelasticity
    }
}

impl CollisionRule for Rough {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let normal = normal_impulse(self.normal_inelasticity, contact);
        let tangential = tangential_impulse(self.tangential_inelasticity, contact);
        Impulse::new(normal, tangential).with_regime(Regime::Sticking)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let name = Fingerprint::of("Rough");
        Some(name.number(self.normal_inelasticity()).number(self.tangential_inelasticity()))
    }

    fn known(&self) -> Option<KnownRule> {
        Some((*self).into())
    }
}

crate::gate::from_file! {
    Rough { normal_inelasticity: f64, tangential_inelasticity: f64 } =>
        Self::from_inelasticity(normal_inelasticity, tangential_inelasticity)
}

/// Returns a normal inelasticity q_n = (1 − r_n)/2 (paper, Eq. (1)) if it is in `[0, 1/2]`.
pub(super) fn normal_inelasticity(value: f64) -> Result<f64, ParameterError> {
    accept((0.0..=0.5).contains(&value), "normal inelasticity", "in [0, 0.5]", value)
}

/// Returns a tangential inelasticity q_t = (1 − r_t)/2 (paper, Eq. (1)) if it is in `[0, 1]`.
pub(super) fn tangential_inelasticity(value: f64) -> Result<f64, ParameterError> {
    accept((0.0..=1.0).contains(&value), "tangential inelasticity", "in [0, 1]", value)
}

/// Returns the inelasticity of a normal restitution, which must be in `[0, 1]`.
fn of_normal_restitution(value: f64) -> Result<f64, ParameterError> {
    Ok(0.5 * (1.0 - accept((0.0..=1.0).contains(&value), "normal restitution", "in [0, 1]", value)?))
}

/// Returns the inelasticity of a tangential restitution, which must be in `[-1, 1]`.
pub(super) fn of_tangential_restitution(value: f64) -> Result<f64, ParameterError> {
    Ok(0.5 * (1.0 - accept((-1.0..=1.0).contains(&value), "tangential restitution", "in [-1, 1]", value)?))
}

/// Returns the impulse that reverses the closing speed with a loss (paper, Eq. (3)).
#[inline]
pub(super) const fn normal_impulse(inelasticity: f64, contact: &Contact) -> f64 {
    2.0 * (1.0 - inelasticity) * contact.normal_mass() * contact.closing_speed()
}

/// Returns the impulse that reverses the slip with a loss, as if the surfaces held (paper, Eq. (4)).
#[inline]
pub(super) const fn tangential_impulse(inelasticity: f64, contact: &Contact) -> f64 {
    2.0 * (1.0 - inelasticity) * contact.tangential_mass() * contact.slip_speed()
}
