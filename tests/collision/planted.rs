//! The check of a whole rule: it passes every rule of the library, and catches every fault planted here.

use std::cell::Cell;

use granular_edmd::collision::laws::{Promises, check, hostile_contacts};
use granular_edmd::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Friction, Frictional, Impulse,
    LeastRebound, Rough, Smooth, SpeedDependent, TangentialResponse, from_fn,
};
use granular_edmd::{Kind, Violation};
use support::cases::few;

fn caught(rule: impl Fn(&Contact) -> Impulse, promises: Promises) -> Violation {
    check(&from_fn(rule), &promises).expect_err("the fault was not caught")
}

/// A rule with this normal impulse, in units of the one that stops, and no other.
fn pushing(push: impl Fn(&Contact) -> f64) -> impl Fn(&Contact) -> Impulse {
    move |contact| Impulse::new(push(contact) * contact.normal_mass() * contact.closing_speed(), 0.0)
}

/// A rule of restitution 1/2 with this tangential impulse for the contact and the normal impulse.
fn rubbing(friction: impl Fn(&Contact, f64) -> f64) -> impl Fn(&Contact) -> Impulse {
    move |contact| {
        let normal = contact.normal_impulse(0.5);
        Impulse::new(normal, friction(contact, normal))
    }
}

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
fn a_pull_or_a_weak_push() {
    for push in [-0.1, 0.0, 0.5, 1.0 - 1e-9] {
        assert_eq!(caught(pushing(move |_| push), Promises::new()).law(), "separation");
    }
    let fast_only = pushing(|contact| if contact.closing_speed() > 1e11 { 0.9 } else { 1.5 });
    let violation = caught(fast_only, Promises::new().with_energy_gain());
    assert_eq!(violation.law(), "separation");
    assert!(violation.found().contains("closing speed 1000000000000.0"), "{violation}");
}

#[test]
fn a_gain_of_energy() {
    assert_eq!(caught(pushing(|_| 2.0 + 1e-9), Promises::new()).law(), "energy");
    let after_a_collision =
        pushing(|contact| if contact.time_since_last_collision() < 1e-6 { 2.5 } else { 2.0 });
    let violation = caught(after_a_collision, Promises::new());
    assert_eq!(violation.law(), "energy");
    assert!(violation.found().contains("since the last collision 0.0"), "{violation}");
    let heavy = pushing(|contact| if contact.normal_mass() > 1e20 { 2.5 } else { 2.0 });
    let violation = caught(heavy, Promises::new());
    assert!(violation.found().contains("normal mass 1e30"), "{violation}");
}

/// A kick of a given size is a gain where there was nothing.
#[test]
fn a_kick_at_no_closing_speed() {
    let kick = |contact: &Contact| {
        let extra = if contact.closing_speed() == 0.0 { 1e-3 } else { 0.0 };
        Impulse::new(contact.normal_impulse(1.0) + extra, 0.0)
    };
    let violation = caught(kick, Promises::new());
    assert_eq!(violation.law(), "energy");
    assert!(violation.found().contains("closing speed 0.0"), "{violation}");
    assert_eq!(check(&from_fn(kick), &Promises::new().with_energy_gain()), Ok(()));
}

#[test]
fn more_friction_than_promised() {
    let cone = Promises::new().with_friction(0.5);
    let violation = check(&Rough::from_inelasticity(0.1, 0.0).unwrap(), &cone).unwrap_err();
    assert_eq!(violation.law(), "friction cone");
    let slightly = Friction::from_inelasticity(0.1, 0.5 + 1e-9).unwrap();
    let rule = rubbing(move |contact, normal| slightly.impulse(contact, normal).tangential());
    assert_eq!(caught(rule, cone).law(), "friction cone");
}

/// The sign is wrong by so little that the loss of the normal direction hides it from the balance of energy.
#[test]
fn friction_of_the_wrong_sign() {
    let rule = || {
        rubbing(|contact, normal| {
            let most = 1e-3 * contact.tangential_mass() * contact.slip_speed();
            let limit = 1e-3 * normal * (contact.closing_speed() / contact.slip_speed().abs()).min(1.0);
            if contact.slip_speed() == 0.0 { 0.0 } else { -most.clamp(-limit, limit) }
        })
    };
    let violation = caught(rule(), Promises::new().with_opposed_slip());
    assert_eq!(violation.law(), "opposed slip");
    assert_eq!(check(&from_fn(rule()), &Promises::new()), Ok(()), "no other law is broken");
}

/// The sign of a zero is one, not zero.
#[test]
fn friction_of_surfaces_that_do_not_slip() {
    let signum = rubbing(|contact, normal| 0.1 * normal * contact.slip_speed().signum());
    let violation = caught(signum, Promises::new().with_friction(0.1).with_energy_gain());
    assert_eq!(violation.law(), "opposed slip");
    assert!(violation.found().contains("slip speed 0.0"), "{violation}");
}

#[test]
fn friction_that_reverses_too_much() {
    let rule = rubbing(|contact, _| 2.001 * contact.tangential_mass() * contact.slip_speed());
    let violation = caught(rule, Promises::new().with_opposed_slip().with_energy_gain());
    assert_eq!(violation.law(), "opposed slip");
}

#[test]
fn numbers_that_are_not_finite() {
    let root = pushing(|contact| 1.5 + (contact.closing_speed() - 1e-20).sqrt());
    assert_eq!(caught(root, Promises::new().with_energy_gain()).law(), "finite");
    let angle =
        rubbing(|contact, normal| 0.1 * normal * (contact.slip_speed() / contact.closing_speed()).sin());
    let violation = caught(angle, Promises::new().with_energy_gain());
    assert_eq!(violation.law(), "finite");
    assert!(violation.found().contains("closing speed 0.0"), "{violation}");
    let inverse =
        |contact: &Contact| Impulse::new(contact.normal_impulse(1.0) + 1.0 / contact.closing_speed(), 0.0);
    let violation = caught(inverse, Promises::new().with_energy_gain());
    assert!(violation.law() == "finite" && violation.found().contains("(inf, "), "{violation}");
}

#[test]
fn an_answer_that_depends_on_the_past() {
    let calls = Cell::new(0_u64);
    let alternating = pushing(|_| {
        calls.set(calls.get() + 1);
        if calls.get().is_multiple_of(2) { 1.5 } else { 1.6 }
    });
    assert_eq!(caught(alternating, Promises::new()).law(), "repeatable");

    let fastest = Cell::new(0.0_f64);
    let remembering = pushing(|contact| {
        fastest.set(fastest.get().max(contact.closing_speed()));
        if contact.closing_speed() < 0.5 * fastest.get() { 1.5 } else { 1.6 }
    });
    let violation = caught(remembering, Promises::new());
    let text = violation.to_string();
    assert!(
        text.contains("changes when the rule is called again") && text.contains("closing speed"),
        "{text}"
    );
}

#[test]
fn a_rule_that_drives_may_say_so() {
    let driven = pushing(|_| 2.5);
    assert_eq!(check(&from_fn(driven), &Promises::new().with_energy_gain()), Ok(()));
    assert_eq!(Promises::default(), Promises::new());
}

/// A fault is shown at the simplest contact that still has it.
#[test]
fn the_contact_that_is_shown_is_simple() {
    let shown = |rule: &dyn Fn(&Contact) -> Impulse, promises| {
        let found = check(&from_fn(rule), &promises).expect_err("the fault was not caught").to_string();
        found[found.rfind("(closing").unwrap()..].to_owned()
    };
    let [masses, never] = ["normal mass 0.5, tangential mass 0.16666666666666666", "last collision inf"];
    let simple = |speeds: &str| {
        format!("({speeds}, {masses}, time since the {never}, radii 0.5 and 0.5, kinds 0 and 0)")
    };
    assert_eq!(shown(&pushing(|_| 2.5), Promises::new()), simple("closing speed 1.0, slip speed 0.0"));
    let along = rubbing(|contact, _| -0.1 * contact.slip_speed());
    let slipping = simple("closing speed 1.0, slip speed 0.5");
    assert_eq!(shown(&along, Promises::new().with_opposed_slip()), slipping);
    let window = pushing(|contact| if (4.40..4.44).contains(&contact.closing_speed()) { 2.5 } else { 2.0 });
    let found = shown(&window, Promises::new());
    assert!(found.starts_with("(closing speed 4.4") && found.ends_with(&simple("")[3..]), "{found}");
    let kinds = pushing(|contact| if contact.is_between(Kind::new(3), Kind::new(3)) { 2.5 } else { 2.0 });
    let found = shown(&kinds, Promises::new());
    assert!(
        found.starts_with("(closing speed 1.0, slip speed 0.0") && found.contains("kinds 3 and 3"),
        "{found}"
    );
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
