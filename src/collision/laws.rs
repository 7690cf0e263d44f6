//! Checks of the laws that a collision rule can break, for rules of your own.
//!
//! Momentum, angular momentum and Galilean invariance hold by construction, because the engine applies any
//! impulse and its opposite at the contact point. The rule is responsible for separation, energy and
//! friction.
//!
//! [`check`] asks a rule about tens of thousands of contacts, always the same ones, and fits into a
//! plain test:
//!
//! ```
//! use granular_edmd::collision::laws::{self, Fault, Promises};
//! use granular_edmd::collision::{Contact, Frictional, Impulse, from_fn};
//!
//! laws::check(&Frictional::from_inelasticity(0.1, 0.1, 0.3)?, &Promises::new().with_friction(0.3))?;
//!
//! let glue = from_fn(|_: &Contact| Impulse::new(0.0, 0.0));
//! let violation = laws::check(&glue, &Promises::new()).unwrap_err();
//! assert!(matches!(violation.fault, Fault::StillClosing { .. }));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! To check contacts of your own, use [`check_impulse`], [`check_friction_opposes_slip`] and
//! [`check_friction_cone`].
//! With the feature `proptest`, the module `strategies` makes random contacts.

mod hostile;
mod rule;
mod violation;

pub use hostile::hostile_contacts;
pub use rule::{Promises, check};
pub use violation::{Fault, Violation};

use super::{Contact, Impulse};

/// Allowed rounding in each law, relative to the speeds and energies of the contact.
const ROUNDING: f64 = 1e-12;

/// Smallest product whose rounding has a relative bound. Below it, numbers lose digits as they become
/// smaller.
const LEAST: f64 = f64::MIN_POSITIVE;

/// Checks that `impulse` is possible in `contact`: it is finite, it separates the surfaces, and it gains no
/// energy.
///
/// # Errors
/// The first law that is broken.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, laws};
/// let contact = Contact::new(1.0, 0.0, 0.5, 0.5 / 3.0);
/// assert!(laws::check_impulse(&contact, Impulse::new(0.8, 0.0)).is_ok());
/// let violation = laws::check_impulse(&contact, Impulse::new(0.2, 0.0)).unwrap_err();
/// assert_eq!(violation.fault, laws::Fault::StillClosing { closing_speed: 0.6 });
/// ```
pub fn check_impulse(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    check_separation(contact, impulse)?;
    let energy_change = impulse.energy_change(contact);
    if energy_change > ROUNDING * contact.available_energy() + LEAST {
        return Err(Violation {
            fault: Fault::EnergyGained { energy_change },
            contact: Box::new(*contact),
            impulse,
        });
    }
    Ok(())
}

/// Checks all laws except that of energy.
fn check_separation(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    let numbers = [impulse.normal(), impulse.tangential(), impulse.couple()];
    if !numbers.iter().all(|number| number.is_finite()) {
        return Err(Violation { fault: Fault::NotFinite, contact: Box::new(*contact), impulse });
    }
    let closing_speed = impulse.closing_speed_after(contact);
    if closing_speed > rounding_of(contact.closing_speed(), contact.normal_mass()) {
        return Err(Violation {
            fault: Fault::StillClosing { closing_speed },
            contact: Box::new(*contact),
            impulse,
        });
    }
    Ok(())
}

/// Checks that the tangential impulse can be friction: it slows the slip, and at most reverses it.
///
/// A rule may add to the slip and still lose energy, if it takes that energy from the normal direction.
/// [`check_impulse`] allows this, but friction never does it.
///
/// # Errors
/// If the impulse pushes along the slip, or the slip is faster after the collision.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, laws};
/// let contact = Contact::new(1.0, 0.5, 0.5, 0.5 / 3.0);
/// assert!(laws::check_friction_opposes_slip(&contact, Impulse::new(0.8, 0.1)).is_ok());
/// assert!(laws::check_friction_opposes_slip(&contact, Impulse::new(0.8, -0.1)).is_err());
/// ```
pub fn check_friction_opposes_slip(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    let slip_speed = impulse.slip_speed_after(contact);
    // The sign is exact, however small the impulse is compared with the slip.
    let opposes = impulse.tangential() == 0.0 || impulse.tangential().signum() * contact.slip_speed() > 0.0;
    let bound = contact.slip_speed().abs() + rounding_of(contact.slip_speed(), contact.tangential_mass());
    if opposes && slip_speed.abs() <= bound {
        Ok(())
    } else {
        Err(Violation { fault: Fault::SlipSpedUp { slip_speed }, contact: Box::new(*contact), impulse })
    }
}

/// Checks that the impulse lies in the cone of friction, |Δ_t| ≤ κ_s Δ_n.
///
/// # Errors
/// If it does not.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, laws};
/// let contact = Contact::new(1.0, 0.5, 0.5, 0.5 / 3.0);
/// assert!(laws::check_friction_cone(&contact, Impulse::new(0.8, 0.2), 0.25).is_ok());
/// assert!(laws::check_friction_cone(&contact, Impulse::new(0.8, 0.3), 0.25).is_err());
/// ```
pub fn check_friction_cone(
    contact: &Contact,
    impulse: Impulse,
    static_friction: f64,
) -> Result<(), Violation> {
    let limit = static_friction * impulse.normal();
    if impulse.tangential().abs() <= limit * (1.0 + ROUNDING) + LEAST {
        Ok(())
    } else {
        Err(Violation { fault: Fault::OutsideFrictionCone { limit }, contact: Box::new(*contact), impulse })
    }
}

/// Returns the rounding error of a speed after an impulse on this mass. The impulse itself is uncertain by
/// [`LEAST`].
fn rounding_of(speed: f64, mass: f64) -> f64 {
    ROUNDING * speed.abs() + LEAST / mass
}
