//! Inelasticities, and the impulses that follow from them alone.

use super::Contact;
use crate::ParameterError;
use crate::quantity::{Checked, Quantity, Range, accept};

pub(super) enum Normal {}

pub(super) enum Tangential {}

/// Normal inelasticity q_n = (1 − r_n)/2 (paper, Eq. (1)), in `[0, 1/2]`.
pub(super) type NormalInelasticity = Checked<Normal>;

/// Tangential inelasticity q_t = (1 − r_t)/2 (paper, Eq. (1)), in `[0, 1]`.
pub(super) type TangentialInelasticity = Checked<Tangential>;

impl Quantity for Normal {
    const NAME: &'static str = "normal inelasticity";
    const RANGE: Range = Range::new("in [0, 0.5]", |value| (0.0..=0.5).contains(&value));
}

impl Quantity for Tangential {
    const NAME: &'static str = "tangential inelasticity";
    const RANGE: Range = Range::new("in [0, 1]", |value| (0.0..=1.0).contains(&value));
}

impl NormalInelasticity {
    /// Creates the inelasticity of a normal restitution in `[0, 1]`.
    pub(super) fn from_restitution(value: f64) -> Result<Self, ParameterError> {
        accept((0.0..=1.0).contains(&value), "normal restitution", "in [0, 1]", value)?;
        Self::new(0.5 * (1.0 - value))
    }

    /// Returns the impulse that reverses the closing speed with a loss (paper, Eq. (3)).
    #[inline]
    pub(super) const fn impulse(self, contact: &Contact) -> f64 {
        2.0 * (1.0 - self.get()) * contact.normal_mass() * contact.closing_speed()
    }
}

impl TangentialInelasticity {
    /// Creates the inelasticity of a tangential restitution in `[-1, 1]`.
    pub(super) fn from_restitution(value: f64) -> Result<Self, ParameterError> {
        accept((-1.0..=1.0).contains(&value), "tangential restitution", "in [-1, 1]", value)?;
        Self::new(0.5 * (1.0 - value))
    }

    /// Returns the impulse that reverses the slip with a loss, as if the surfaces held (paper, Eq. (4)).
    #[inline]
    pub(super) const fn impulse(self, contact: &Contact) -> f64 {
        2.0 * (1.0 - self.get()) * contact.tangential_mass() * contact.slip_speed()
    }
}
