//! Checks of the laws that a collision rule can break, for custom rules.
//!
//! Momentum, angular momentum and Galilean invariance hold by construction, because the engine applies any
//! impulse and its opposite at the contact point. The rule is responsible for separation, energy and
//! friction, and for symmetry.
//!
//! [`check`] calls a rule for tens of thousands of contacts, the same contacts for the same seed, and takes
//! one line in a unit test:
//!
//! ```
//! use granular_edmd::collision::laws::{self, Promises};
//! use granular_edmd::collision::{Contact, Frictional, Impulse, from_fn};
//!
//! laws::check(&Frictional::from_inelasticity(0.1, 0.1, 0.3)?, &Promises::new().with_friction(0.3))?;
//!
//! let glue = from_fn(|_: &Contact| Impulse::new(0.0, 0.0));
//! let violation = laws::check(&glue, &Promises::new()).unwrap_err();
//! assert_eq!(violation.law(), "separation");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! To check single contacts, use [`check_impulse`], [`check_friction_opposes_slip`] and
//! [`check_friction_cone`]; to compare the fingerprints of two rules, [`check_fingerprints`].
//! With the feature `proptest`, the module `strategies` makes random contacts.

mod contacts;
mod rule;

pub use contacts::hostile_contacts;
#[cfg(feature = "proptest")]
pub(crate) use contacts::{Partner, meeting};
pub use rule::{Promises, check, check_fingerprints};

use super::{Contact, Impulse};
use crate::Violation;

/// Allowed rounding in each law, relative to the speeds and energies of the contact.
const ROUNDING: f64 = 1e-12;

/// Smallest product whose relative rounding error is bounded. Smaller numbers have fewer digits.
const LEAST: f64 = f64::MIN_POSITIVE;

/// Returns the violation of a law by an impulse if the condition does not hold.
fn unless(
    holds: bool,
    law: &'static str,
    contact: &Contact,
    impulse: Impulse,
    found: impl FnOnce() -> String,
) -> Result<(), Violation> {
    if holds {
        return Ok(());
    }
    let sentence = format!("the impulse {impulse} {} ({contact})", found());
    Err(Violation::new("collision rule", law, sentence))
}

/// Checks that `impulse` is possible in `contact`: it is finite, it separates the surfaces, and it adds no
/// energy, even through its couple.
///
/// # Errors
/// The first broken law: "finite", "separation" or "energy".
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, laws};
/// let contact = Contact::new(1.0, 0.0, 0.5, 0.5 / 3.0);
/// assert!(laws::check_impulse(&contact, Impulse::new(0.8, 0.0)).is_ok());
/// let violation = laws::check_impulse(&contact, Impulse::new(0.2, 0.0)).unwrap_err();
/// assert!(violation.found().contains("leaves the surfaces closing, at speed 0.6"));
/// ```
pub fn check_impulse(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    check_separation(contact, impulse)?;
    let change = impulse.energy_change(contact);
    let mut available = contact.available_energy();
    if impulse.couple() != 0.0 {
        let spin = contact.relative_spin();
        available += 0.5 * contact.spin_inertia() * spin * spin;
    }
    unless(change <= ROUNDING * available + LEAST, "energy", contact, impulse, || {
        format!("gains the energy {change:?}")
    })
}

/// Checks all laws except the law of energy.
fn check_separation(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    let numbers = [impulse.normal(), impulse.tangential(), impulse.couple()];
    let are_finite = numbers.iter().all(|number| number.is_finite());
    unless(are_finite, "finite", contact, impulse, || "is not finite".to_owned())?;
    let speed = impulse.closing_speed_after(contact);
    let rounding = rounding_of(contact.closing_speed(), contact.normal_mass());
    unless(speed <= rounding, "separation", contact, impulse, || {
        format!("leaves the surfaces closing, at speed {speed:?}")
    })
}

/// Checks that the tangential impulse can be friction: it slows the slip, and at most reverses it.
///
/// A rule may add to the slip and still lose energy, if it takes that energy from the normal direction.
/// [`check_impulse`] allows this, but friction never does it. The check ignores a couple, which acts after
/// friction.
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
    let slip = impulse.with_couple(0.0).slip_speed_after(contact);
    // The sign is exact, however small the impulse is compared with the slip.
    let opposes = opposes(impulse.tangential(), contact.slip_speed());
    let bound = contact.slip_speed().abs() + rounding_of(contact.slip_speed(), contact.tangential_mass());
    unless(opposes && slip.abs() <= bound, "opposed slip", contact, impulse, || {
        format!("makes the slip faster: {slip:?}")
    })
}

/// Checks that the impulse lies in the cone of friction, |Δ_t| ≤ κ_s Δ_n.
///
/// # Errors
/// If the impulse lies outside the cone.
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
    let is_inside = impulse.tangential().abs() <= limit * (1.0 + ROUNDING) + LEAST;
    unless(is_inside, "friction cone", contact, impulse, || {
        format!("leaves the friction cone: {limit:?} is the most along the tangent")
    })
}

/// Checks that the couple can be rolling friction: it is at most μ_r Δ_n R, it slows the relative spin that
/// friction leaves, and it does not reverse it.
fn check_rolling(contact: &Contact, impulse: Impulse, coefficient: f64) -> Result<(), Violation> {
    let limit = coefficient * impulse.normal() * contact.effective_radius();
    let couple = impulse.couple();
    let is_inside = couple.abs() <= limit * (1.0 + ROUNDING) + LEAST;
    unless(is_inside, "rolling friction", contact, impulse, || format!("is beyond its limit {limit:?}"))?;
    let spin = impulse.with_couple(0.0).relative_spin_after(contact);
    let least = rounding_of(contact.relative_spin(), contact.spin_inertia())
        + ROUNDING * (contact.spin_response() * impulse.tangential()).abs();
    let stops = (contact.spin_inertia() * spin).abs() * (1.0 + ROUNDING);
    let slows = opposes(couple, spin) && couple.abs() <= stops;
    unless(
        slows || couple.abs() <= contact.spin_inertia() * least,
        "rolling friction",
        contact,
        impulse,
        || format!("does not slow the spin {spin:?} that friction leaves"),
    )
}

/// Returns whether an impulse is zero, or acts against this speed.
fn opposes(impulse: f64, speed: f64) -> bool {
    impulse == 0.0 || impulse.signum() * speed > 0.0
}

/// Returns the rounding error of a speed after an impulse on this mass. The impulse itself is uncertain by
/// [`LEAST`].
fn rounding_of(speed: f64, mass: f64) -> f64 {
    ROUNDING * speed.abs() + LEAST / mass
}
