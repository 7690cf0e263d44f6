//! The check of a whole rule passes every rule of the library. The target `laws` plants the faults that it
//! must find.

use granular_edmd::collision::laws::{Promises, check, hostile_contacts};
use granular_edmd::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Friction, Frictional, Impulse,
    LeastRebound, Rough, Smooth, SpeedDependent, TangentialResponse, from_fn,
};
use support::cases::few;

/// Numbers of a rule: inelasticities along the normal and the tangent, static and dynamic friction, a speed.
type Numbers = [f64; 5];

/// Returns numbers of each size in their combinations, by default a few of these.
fn numbers() -> impl Iterator<Item = Numbers> {
    let frictions = [(0.0, 0.0), (0.3, 0.3), (0.5, 0.1), (1e9, 0.0), (f64::MAX, f64::MAX)];
    let mut all = Vec::new();
    for inelasticity in [0.0, 1e-15, 0.1, 0.5] {
        for tangential in [0.0, 0.3, 1.0] {
            for (held, slid) in frictions {
                all.extend([1e-60, 0.5, 1e60].map(|speed| [inelasticity, tangential, held, slid, speed]));
            }
        }
    }
    few(all, 26)
}

fn frictional([inelasticity, tangential, held, slid, _]: Numbers) -> Frictional {
    let rule = Frictional::from_inelasticity(inelasticity, tangential, held).unwrap();
    rule.with_dynamic_friction(slid).unwrap()
}

/// Checks a rule with the numbers, which promises their friction.
fn passes<R: CollisionRule>(make: impl Fn(Numbers) -> R) {
    for numbers in numbers() {
        let promises = Promises::new().with_friction(numbers[2]);
        assert_eq!(check(&make(numbers), &promises), Ok(()), "{numbers:?}");
    }
}

#[test]
fn rules_without_a_limit_of_friction_pass() {
    let frictionless = Promises::new().with_friction(0.0);
    check(&Elastic, &frictionless).unwrap();
    for [inelasticity, tangential, ..] in numbers() {
        check(&Smooth::from_inelasticity(inelasticity).unwrap(), &frictionless).unwrap();
        let rough = Rough::from_inelasticity(inelasticity, tangential).unwrap();
        check(&rough, &Promises::new().with_opposed_slip()).unwrap();
    }
}

#[test]
fn frictional_passes() {
    passes(frictional);
}

#[test]
fn contact_duration_passes() {
    let model = |numbers| ContactDuration::new(frictional(numbers), 1e-6).unwrap();
    passes(model);
    passes(|numbers| model(numbers).with_tangential_response(TangentialResponse::Unchanged));
}

#[test]
fn elastic_below_passes() {
    let remedy = |numbers: Numbers| ElasticBelow::new(frictional(numbers), numbers[4]).unwrap();
    passes(remedy);
    passes(|numbers| remedy(numbers).with_tangential_response(TangentialResponse::Unchanged));
}

#[test]
fn least_rebound_passes() {
    for numbers in numbers() {
        let rule = LeastRebound::new(frictional(numbers), numbers[4]).unwrap();
        let promises = Promises::new().with_friction(numbers[2]).with_energy_gain();
        assert_eq!(check(&rule, &promises), Ok(()), "{numbers:?}");
    }
}

#[test]
fn speed_dependent_passes() {
    passes(|[inelasticity, tangential, held, slid, speed]| {
        let friction = Friction::from_inelasticity(tangential, held).unwrap();
        let friction = friction.with_dynamic_friction(slid).unwrap();
        SpeedDependent::from_inelasticity(inelasticity, speed).unwrap().with_friction(friction)
    });
}

#[test]
fn a_rule_that_drives_may_say_so() {
    let driven = from_fn(|contact: &Contact| Impulse::new(contact.normal_impulse(1.5), 0.0));
    assert_eq!(check(&driven, &Promises::new().with_energy_gain()), Ok(()));
    assert_eq!(Promises::default(), Promises::new());
}

/// The contacts are what the engine guarantees, and no two are the same.
#[test]
fn hostile_contacts_are_possible() {
    let contacts: Vec<_> = hostile_contacts().collect();
    assert!(contacts.len() > 10_000, "{}", contacts.len());
    for contact in &contacts {
        assert!(contact.closing_speed() >= 0.0 && contact.closing_speed().is_finite());
        assert!(contact.slip_speed().is_finite() && contact.time_since_last_collision() >= 0.0);
        assert!(contact.tangential_mass() > 0.0 && contact.tangential_mass() <= contact.normal_mass());
    }
    let boxed: Box<dyn CollisionRule> = Box::new(Elastic);
    assert_eq!(check(&*boxed, &Promises::new()), Ok(()), "also a rule of unknown type");
}
