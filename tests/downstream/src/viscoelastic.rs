//! A collision rule.

use granular_edmd::collision::{CollisionRule, Contact, Friction, Impulse};
use granular_edmd::{Fingerprint, ParameterError, quantity};

/// Restitution that falls with the speed of the impact, and Coulomb friction that stops at rolling.
#[derive(Debug, Clone, Copy)]
pub struct Viscoelastic {
    loss: f64,
    friction: Friction,
}

impl Viscoelastic {
    pub fn new(loss: f64, friction: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            loss: quantity::non_negative("loss", loss)?,
            friction: Friction::from_inelasticity(0.5, friction)?,
        })
    }
}

impl CollisionRule for Viscoelastic {
    fn impulse(&self, contact: &Contact) -> Impulse {
        let restitution = 1.0 / (1.0 + self.loss * contact.closing_speed().sqrt().sqrt());
        self.friction.impulse(contact, contact.normal_impulse(restitution))
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Viscoelastic").number(self.loss).number(self.friction.static_friction()))
    }
}
