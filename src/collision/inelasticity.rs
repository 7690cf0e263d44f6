//! Inelasticities, and the impulses that follow from them alone.

use super::Contact;
use crate::ParameterError;
use crate::quantity::accept;

/// Returns a normal inelasticity q_n = (1 − r_n)/2 (paper, Eq. (1)) if it is in `[0, 1/2]`.
pub(super) fn normal(value: f64) -> Result<f64, ParameterError> {
    accept((0.0..=0.5).contains(&value), "normal inelasticity", "in [0, 0.5]", value)
}

/// Returns a tangential inelasticity q_t = (1 − r_t)/2 (paper, Eq. (1)) if it is in `[0, 1]`.
pub(super) fn tangential(value: f64) -> Result<f64, ParameterError> {
    accept((0.0..=1.0).contains(&value), "tangential inelasticity", "in [0, 1]", value)
}

/// Returns the inelasticity of a normal restitution, which must be in `[0, 1]`.
pub(super) fn of_normal_restitution(value: f64) -> Result<f64, ParameterError> {
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
