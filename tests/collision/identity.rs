//! The identity of a rule, however the rule is held.

use std::collections::HashSet;
use std::sync::Arc;

use granular_edmd::Fingerprint;
use granular_edmd::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Friction, Frictional, Impulse,
    LeastRebound, RollingFriction, Rough, Smooth, SpeedDependent, TangentialResponse, from_fn,
};

/// A rule that answers everything that it can be asked.
struct Talkative;

impl CollisionRule for Talkative {
    fn impulse(&self, contact: &Contact) -> Impulse {
        Impulse::new(contact.closing_speed(), 0.0)
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Talkative"))
    }
}

fn says_the_same<R: CollisionRule>(rule: R) {
    let contact = Contact::new(2.0, 0.5, 0.5, 0.125);
    assert_eq!(rule.impulse(&contact), Impulse::new(2.0, 0.0));
    assert_eq!(rule.fingerprint(), Some(Fingerprint::of("Talkative")));
}

#[test]
fn every_way_to_hold_a_rule_passes_all_on() {
    says_the_same(Talkative);
    says_the_same(&Talkative);
    says_the_same(Box::new(Talkative));
    says_the_same(Arc::new(Talkative));
    says_the_same(Box::new(Arc::new(&Talkative)) as Box<dyn CollisionRule>);
}

fn frictional(normal: f64, tangential: f64, static_friction: f64, dynamic_friction: f64) -> Frictional {
    Frictional::from_inelasticity(normal, tangential, static_friction)
        .and_then(|rule| rule.with_dynamic_friction(dynamic_friction))
        .unwrap()
}

/// Every parameter counts, and equal numbers of other rules do not make an equal rule.
#[test]
fn different_rules_have_different_fingerprints() {
    let lasting = |rule, duration| ContactDuration::new(rule, duration).unwrap();
    let rules: Vec<Box<dyn CollisionRule>> = vec![
        Box::new(Elastic),
        Box::new(Smooth::from_inelasticity(0.1).unwrap()),
        Box::new(Smooth::from_inelasticity(0.2).unwrap()),
        Box::new(Rough::from_inelasticity(0.1, 0.2).unwrap()),
        Box::new(Rough::from_inelasticity(0.2, 0.1).unwrap()),
        Box::new(frictional(0.1, 0.2, 0.3, 0.3)),
        Box::new(frictional(0.2, 0.2, 0.3, 0.3)),
        Box::new(frictional(0.1, 0.1, 0.3, 0.3)),
        Box::new(frictional(0.1, 0.2, 0.4, 0.3)),
        Box::new(frictional(0.1, 0.2, 0.3, 0.2)),
        Box::new(lasting(frictional(0.1, 0.2, 0.3, 0.3), 1e-4)),
        Box::new(lasting(frictional(0.1, 0.2, 0.3, 0.3), 1e-5)),
        Box::new(lasting(frictional(0.1, 0.2, 0.3, 0.2), 1e-4)),
        Box::new(
            lasting(frictional(0.1, 0.2, 0.3, 0.3), 1e-4)
                .with_tangential_response(TangentialResponse::Unchanged),
        ),
        Box::new(ContactDuration::new(Elastic, 1e-4).unwrap()),
        Box::new(ElasticBelow::new(Elastic, 1e-4).unwrap()),
        Box::new(ElasticBelow::new(Elastic, 1e-5).unwrap()),
        Box::new(
            ElasticBelow::new(Elastic, 1e-4).unwrap().with_tangential_response(TangentialResponse::Unchanged),
        ),
        Box::new(LeastRebound::new(Elastic, 1e-4).unwrap()),
        Box::new(LeastRebound::new(Elastic, 1e-5).unwrap()),
        Box::new(RollingFriction::new(Elastic, 1e-4).unwrap()),
        Box::new(RollingFriction::new(Elastic, 1e-5).unwrap()),
        Box::new(SpeedDependent::from_restitution(0.1, 0.2).unwrap()),
        Box::new(SpeedDependent::from_restitution(0.2, 0.1).unwrap()),
        Box::new(
            SpeedDependent::from_restitution(0.1, 0.2)
                .unwrap()
                .with_friction(Friction::from_inelasticity(0.0, 0.2).unwrap()),
        ),
    ];
    let fingerprints: HashSet<_> = rules.iter().map(|rule| rule.fingerprint().unwrap()).collect();
    assert_eq!(fingerprints.len(), rules.len());
    assert_eq!(frictional(0.1, 0.2, 0.3, 0.3).fingerprint(), rules[5].fingerprint());
}

#[test]
fn a_closure_has_none_and_neither_has_a_model_of_it() {
    let closure = from_fn(|contact: &Contact| Impulse::new(contact.normal_impulse(0.5), 0.0));
    assert_eq!(closure.fingerprint(), None);
    assert_eq!(ContactDuration::new(closure, 1e-4).unwrap().fingerprint(), None);
    assert_eq!(ElasticBelow::new(closure, 1e-4).unwrap().fingerprint(), None);
    assert_eq!(LeastRebound::new(closure, 1e-4).unwrap().fingerprint(), None);
}

/// Rules are shared by threads, and sent to them.
#[test]
fn rules_go_to_other_threads() {
    const fn both<T: Send + Sync>() {}
    const {
        both::<(Contact, Impulse, Friction, Elastic, Smooth, Rough, Frictional)>();
        both::<ContactDuration<Arc<dyn CollisionRule + Send + Sync>>>();
        both::<(ElasticBelow<Arc<dyn CollisionRule + Send + Sync>>, SpeedDependent)>();
    }
}
