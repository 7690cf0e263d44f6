//! The rules under test, with coefficients over the whole range that the constructors accept.

use granular_edmd::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, Frictional, Impulse, Rough, Smooth, from_fn,
};
use granular_edmd::strategies::decades;
use proptest::prelude::*;

use support::cases;

/// The same cases on every run and machine.
pub(crate) fn config() -> ProptestConfig {
    ProptestConfig { max_global_rejects: 1_000_000, ..cases::config(500) }
}

fn inelasticity(top: f64) -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.0..=top, 1 => Just(0.0), 1 => Just(top), 1 => decades(-15.0, -3.0)]
}

fn friction() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.0..2.0, 1 => Just(0.0), 2 => decades(-9.0, 9.0), 1 => Just(f64::MAX)]
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    Elastic,
    Smooth,
    Rough,
    Frictional,
    Closure,
}

/// A rule with the coefficients that it should obey; without friction `static_friction` is zero, without a
/// Coulomb limit infinite.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Law {
    pub(crate) kind: Kind,
    pub(crate) normal_inelasticity: f64,
    pub(crate) tangential_inelasticity: f64,
    pub(crate) static_friction: f64,
    pub(crate) dynamic_friction: f64,
    adapted: bool,
}

impl Law {
    /// The rule itself, alone or within a contact-duration model that has nothing to do.
    pub(crate) fn rule(&self) -> Box<dyn CollisionRule> {
        let (normal, tangential) = (self.normal_inelasticity, self.tangential_inelasticity);
        match self.kind {
            Kind::Elastic => self.boxed(Elastic),
            Kind::Smooth => self.boxed(Smooth::from_inelasticity(normal).unwrap()),
            Kind::Rough => self.boxed(Rough::from_inelasticity(normal, tangential).unwrap()),
            Kind::Frictional => self.boxed(
                Frictional::from_inelasticity(normal, tangential, self.static_friction)
                    .and_then(|rule| rule.with_dynamic_friction(self.dynamic_friction))
                    .unwrap(),
            ),
            Kind::Closure => {
                let law = *self;
                self.boxed(from_fn(move |contact: &Contact| law.expected(contact)))
            }
        }
    }

    fn boxed<R: CollisionRule + 'static>(&self, rule: R) -> Box<dyn CollisionRule> {
        if self.adapted { Box::new(ContactDuration::new(rule, 1e-4).unwrap()) } else { Box::new(rule) }
    }

    /// Returns whether the surfaces hold: the paper's inequality, with $`\mu/\mu_t`$ for its 3.
    pub(crate) fn sticks(&self, contact: &Contact) -> bool {
        let holding = (1.0 - self.tangential_inelasticity) * contact.tangential_mass() * contact.slip_speed();
        let limit = (1.0 - self.normal_inelasticity) * contact.normal_mass() * contact.closing_speed();
        holding.abs() < limit * self.static_friction || self.static_friction.is_infinite()
    }

    /// Eqs. (3)–(5) of the paper, written down a second time.
    pub(crate) fn expected(&self, contact: &Contact) -> Impulse {
        let normal = contact.closing_speed() * contact.normal_mass() * (2.0 - 2.0 * self.normal_inelasticity);
        let tangential = if self.sticks(contact) {
            contact.slip_speed() * contact.tangential_mass() * (2.0 - 2.0 * self.tangential_inelasticity)
        } else if contact.slip_speed() < 0.0 {
            -self.dynamic_friction * normal
        } else {
            self.dynamic_friction * normal
        };
        Impulse::new(normal, tangential)
    }
}

/// Every rule, with coefficients anywhere in their ranges.
pub(crate) fn law() -> impl Strategy<Value = Law> {
    let kind = prop_oneof![
        1 => Just(Kind::Elastic),
        1 => Just(Kind::Smooth),
        2 => Just(Kind::Rough),
        4 => Just(Kind::Frictional),
        1 => Just(Kind::Closure),
    ];
    let ratio = prop_oneof![Just(1.0), Just(0.0), 0.0..=1.0];
    (kind, inelasticity(0.5), inelasticity(1.0), friction(), ratio, any::<bool>()).prop_map(
        |(kind, normal, tangential, friction, ratio, adapted)| {
            let (static_friction, dynamic_friction) = match kind {
                Kind::Elastic | Kind::Smooth => (0.0, 0.0),
                Kind::Rough => (f64::INFINITY, f64::INFINITY),
                Kind::Frictional | Kind::Closure => (friction, ratio * friction),
            };
            let normal_inelasticity = if matches!(kind, Kind::Elastic) { 0.0 } else { normal };
            Law {
                kind,
                normal_inelasticity,
                tangential_inelasticity: tangential,
                static_friction,
                dynamic_friction,
                adapted,
            }
        },
    )
}
