//! A collision rule.

use granular_edmd::ParameterError;
use granular_edmd::collision::{CollisionRule, Contact, Impulse, Regime};

/// Restitution that falls with the speed of the impact, and Coulomb friction that stops at rolling.
#[derive(Debug, Clone, Copy)]
pub struct Viscoelastic {
    loss: f64,
    friction: f64,
}

impl Viscoelastic {
    pub fn new(loss: f64, friction: f64) -> Result<Self, ParameterError> {
        for (name, value) in [("loss", loss), ("friction", friction)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(ParameterError::new(name, "finite and not negative", value));
            }
        }
        Ok(Self { loss, friction })
    }
}

impl CollisionRule for Viscoelastic {
    fn impulse(&self, contact: &Contact) -> Impulse {
        let speed = contact.closing_speed();
        let restitution = 1.0 / (1.0 + self.loss * speed.max(0.0).powf(0.2));
        let normal = (1.0 + restitution) * contact.normal_mass() * speed;
        let rolling = contact.tangential_mass() * contact.slip_speed();
        let limit = self.friction * normal.abs();
        let regime = if rolling.abs() <= limit { Regime::Sticking } else { Regime::Sliding };
        Impulse::new(normal, rolling.clamp(-limit, limit)).with_regime(regime)
    }
}
