//! Every collision rule, alone, within the contact-duration model, and elastic below a speed.

use std::sync::Arc;

use granular_edmd::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Friction, Frictional, Impulse, Rough,
    Smooth, SpeedDependent, TangentialResponse, from_fn,
};
use proptest::prelude::*;

use support::cases::decades;

pub(crate) type Rule = Arc<dyn CollisionRule + Send + Sync>;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Elastic,
    Smooth,
    Rough,
    Frictional,
    SpeedDependent,
    Closure,
}

/// A remedy for disks at rest: whether it is the contact-duration model, its time or speed, and whether the
/// tangential response stays.
type Remedy = (bool, f64, bool);

/// A rule that never gains energy.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Law {
    pub(crate) kind: Kind,
    normal: f64,
    tangential: f64,
    friction: f64,
    dynamic_share: f64,
    /// A remedy around the rule.
    remedy: Option<Remedy>,
}

impl Law {
    pub(crate) fn rule(&self) -> Rule {
        let rule = self.bare();
        let Some((lasting, limit, unchanged)) = self.remedy else { return rule };
        let response =
            if unchanged { TangentialResponse::Unchanged } else { TangentialResponse::Frictionless };
        if lasting {
            Arc::new(ContactDuration::new(rule, limit).unwrap().with_tangential_response(response))
        } else {
            Arc::new(ElasticBelow::new(rule, limit).unwrap().with_tangential_response(response))
        }
    }

    fn bare(&self) -> Rule {
        let Self { normal, tangential, friction, dynamic_share, .. } = *self;
        match self.kind {
            Kind::Elastic => Arc::new(Elastic),
            Kind::Smooth => Arc::new(Smooth::from_inelasticity(normal).unwrap()),
            Kind::Rough => Arc::new(Rough::from_inelasticity(normal, tangential).unwrap()),
            Kind::Frictional => {
                let rule = Frictional::from_inelasticity(normal, tangential, friction).unwrap();
                Arc::new(rule.with_dynamic_friction(dynamic_share * friction).unwrap())
            }
            Kind::SpeedDependent => {
                let rule = SpeedDependent::from_inelasticity(normal, 0.3).unwrap();
                Arc::new(rule.with_friction(Friction::from_inelasticity(tangential, friction).unwrap()))
            }
            Kind::Closure => Arc::new(from_fn(move |contact: &Contact| viscous(normal, tangential, contact))),
        }
    }
}

/// Restitution that falls with the speed of the impact, and a tangential impulse in proportion to the slip.
fn viscous(loss: f64, drag: f64, contact: &Contact) -> Impulse {
    let restitution = 1.0 / (1.0 + loss * contact.closing_speed());
    let normal = (1.0 + restitution) * contact.normal_mass() * contact.closing_speed();
    Impulse::new(normal, 2.0 * drag * contact.tangential_mass() * contact.slip_speed())
}

pub(crate) fn law() -> impl Strategy<Value = Law> {
    let kind = prop_oneof![
        1 => Just(Kind::Elastic),
        1 => Just(Kind::Smooth),
        1 => Just(Kind::Rough),
        2 => Just(Kind::Frictional),
        1 => Just(Kind::SpeedDependent),
        1 => Just(Kind::Closure),
    ];
    let normal = prop_oneof![4 => 0.0..0.1f64, 1 => Just(0.0), 1 => 0.0..=0.5f64, 1 => Just(0.5)];
    let tangential = prop_oneof![3 => 0.0..=1.0f64, 1 => Just(0.0), 1 => Just(1.0)];
    let friction = prop_oneof![3 => 0.0..1.0f64, 1 => Just(0.0), 1 => Just(1e3)];
    let remedy = prop::option::of((any::<bool>(), decades(-3.0, -1.0), any::<bool>()));
    (kind, normal, tangential, friction, 0.0..=1.0f64, remedy).prop_map(
        |(kind, normal, tangential, friction, dynamic_share, remedy)| Law {
            kind,
            normal,
            tangential,
            friction,
            dynamic_share,
            remedy,
        },
    )
}
