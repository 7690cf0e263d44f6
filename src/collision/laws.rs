//! The laws that a collision rule can break, as a check for rules of your own.
//!
//! Momentum, angular momentum and Galilean invariance hold by construction: the engine applies any impulse and its
//! opposite at the contact point. Left to the rule are energy and separation.

use thiserror::Error;

use super::{Contact, Impulse};

/// A law that an impulse breaks.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum Violation {
    /// The impulse has a component that is not a number, or infinite.
    #[error("the impulse ({normal}, {tangential}) is not finite")]
    NotFinite {
        /// Its normal component.
        normal: f64,
        /// Its tangential component.
        tangential: f64,
    },
    /// The partners still approach after the collision.
    #[error("after the collision the surfaces still close, at speed {closing_speed}")]
    StillClosing {
        /// Closing speed after the collision.
        closing_speed: f64,
    },
    /// The collision adds kinetic energy.
    #[error("the collision gains the energy {energy_change}")]
    EnergyGained {
        /// Change of kinetic energy.
        energy_change: f64,
    },
}

/// Rounding allowed in each law, relative to the speeds and energies of the contact.
const ROUNDING: f64 = 1e-12;

/// Speeds and impulses of light disks below this have fewer digits the lower they are.
const LEAST_SPEED: f64 = 1e-280;

/// Whether `impulse` is one that `contact` can suffer: finite, separating, not gaining energy.
///
/// # Errors
/// The first law that is broken.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, laws};
/// let contact = Contact::new(1.0, 0.0, 0.5, 0.5 / 3.0);
/// assert!(laws::check(&contact, Impulse::new(0.8, 0.0)).is_ok());
/// assert!(matches!(
///     laws::check(&contact, Impulse::new(0.2, 0.0)),
///     Err(laws::Violation::StillClosing { .. })
/// ));
/// ```
pub fn check(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    let (normal, tangential) = (impulse.normal(), impulse.tangential());
    if !(normal.is_finite() && tangential.is_finite()) {
        return Err(Violation::NotFinite { normal, tangential });
    }
    let closing_speed = closing_speed_after(contact, impulse);
    if closing_speed > ROUNDING * contact.closing_speed().abs().max(LEAST_SPEED) {
        return Err(Violation::StillClosing { closing_speed });
    }
    let energy_change = impulse.energy_change(contact);
    if energy_change > ROUNDING * available_energy(contact) {
        return Err(Violation::EnergyGained { energy_change });
    }
    Ok(())
}

/// Closing speed after the collision, `$v_n' = v_n - \Delta_n/\mu$`; negative when the surfaces separate.
pub fn closing_speed_after(contact: &Contact, impulse: Impulse) -> f64 {
    contact.closing_speed() - impulse.normal() / contact.normal_mass()
}

/// Slip speed after the collision, `$v_t' = v_t - \Delta_t/\mu_t$`.
pub fn slip_speed_after(contact: &Contact, impulse: Impulse) -> f64 {
    contact.slip_speed() - impulse.tangential() / contact.tangential_mass()
}

/// Kinetic energy of the relative motion, `$\tfrac12\mu v_n^2 + \tfrac12\mu_t v_t^2$`: the most that a collision
/// can lose.
pub fn available_energy(contact: &Contact) -> f64 {
    0.5 * contact.normal_mass() * contact.closing_speed().powi(2)
        + 0.5 * contact.tangential_mass() * contact.slip_speed().powi(2)
}
