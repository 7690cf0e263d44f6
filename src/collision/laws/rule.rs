//! The check of a rule against all laws at once.

use super::violation::same;
use super::{
    Fault, Violation, check_friction_cone, check_friction_opposes_slip, check_impulse, check_separation,
    hostile_contacts,
};
use crate::collision::{CollisionRule, Contact, Impulse};

/// The promises of a rule. Every rule also promises finite impulses that separate the surfaces and repeat to
/// the bit.
///
/// ```
/// use granular_edmd::collision::laws::{Promises, check};
/// use granular_edmd::collision::{Rough, Smooth};
///
/// check(&Smooth::from_inelasticity(0.2)?, &Promises::new().with_friction(0.0))?;
/// check(&Rough::from_inelasticity(0.2, 0.1)?, &Promises::new().with_opposed_slip())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Promises {
    energy_gain: bool,
    opposed_slip: bool,
    static_friction: Option<f64>,
}

impl Promises {
    /// Creates the promise that a collision gains no energy. It says nothing about the tangential direction.
    pub const fn new() -> Self {
        Self { energy_gain: false, opposed_slip: false, static_friction: None }
    }

    /// Returns the same promises, with Coulomb friction: the impulse stays in the cone of this coefficient
    /// κ_s, and opposes the slip.
    pub const fn with_friction(self, static_friction: f64) -> Self {
        Self { opposed_slip: true, static_friction: Some(static_friction), ..self }
    }

    /// Returns the same promises, with a tangential impulse that opposes the slip, within a cone or not.
    pub const fn with_opposed_slip(self) -> Self {
        Self { opposed_slip: true, ..self }
    }

    /// Returns the same promises for a rule that drives: energy may be gained.
    pub const fn with_energy_gain(self) -> Self {
        Self { energy_gain: true, ..self }
    }

    /// Checks that `impulse` keeps these promises.
    ///
    /// # Errors
    /// The first promise that is broken.
    pub fn check(&self, contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
        if self.energy_gain { check_separation(contact, impulse) } else { check_impulse(contact, impulse) }?;
        if let Some(static_friction) = self.static_friction {
            check_friction_cone(contact, impulse, static_friction)?;
        }
        if self.opposed_slip { check_friction_opposes_slip(contact, impulse) } else { Ok(()) }
    }
}

/// Checks that `rule` keeps its promises for all [`hostile_contacts`], and gives the same answers when asked
/// again in another order.
///
/// # Errors
/// The first promise that is broken, with the contact and the impulse that break it.
pub fn check<R: CollisionRule + ?Sized>(rule: &R, promises: &Promises) -> Result<(), Violation> {
    let mut answers = Vec::new();
    for contact in hostile_contacts() {
        let impulse = rule.impulse(&contact);
        promises.check(&contact, impulse)?;
        answers.push((contact, impulse));
    }
    // The second pass runs backward, so that a rule with a memory remembers other contacts.
    for (contact, impulse) in answers.into_iter().rev() {
        let later = rule.impulse(&contact);
        if !same(impulse, later) {
            let contact = Box::new(contact);
            return Err(Violation { fault: Fault::NotRepeatable { later }, contact, impulse });
        }
    }
    Ok(())
}
