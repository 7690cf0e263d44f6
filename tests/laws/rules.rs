//! Collision rules that break their contract.

use granular_edmd::Kind;
use granular_edmd::collision::laws::{self, Promises};
use granular_edmd::collision::{CollisionRule, Contact, Elastic, Frictional, Impulse, Rough, from_fn};

use crate::{Fault, blind, honest, informed, judge, one_in, survivor};

/// The law that finds a fault, the promises of a rule, and the rule.
type Rule = (&'static str, Promises, Box<dyn CollisionRule>);

const FREE: Promises = Promises::new();
const RUBBING: Promises = FREE.with_friction(0.5);

fn rule(law: &'static str, impulse: impl Fn(&Contact) -> Impulse + 'static) -> Rule {
    promised(law, FREE, impulse)
}

fn promised(law: &'static str, promises: Promises, impulse: impl Fn(&Contact) -> Impulse + 'static) -> Rule {
    (law, promises, Box::new(from_fn(impulse)))
}

/// A rule that gains energy where the condition holds.
fn gain(is_there: impl Fn(&Contact) -> bool + 'static) -> Rule {
    rule("energy", move |contact| smooth(contact, if is_there(contact) { 1.05 } else { 0.9 }))
}

fn smooth(contact: &Contact, restitution: f64) -> Impulse {
    Impulse::new(contact.normal_impulse(restitution), 0.0)
}

/// The rule that turns both speeds around, and neither gains nor loses energy.
fn rough(contact: &Contact) -> Impulse {
    Rough::from_inelasticity(0.0, 0.0).expect("a restitution of 1").impulse(contact)
}

fn frictional(contact: &Contact, tangential: f64) -> Impulse {
    let rule = Frictional::from_inelasticity(0.05, 0.1, 0.5).expect("an inelasticity");
    let impulse = rule.impulse(contact);
    Impulse::new(impulse.normal(), tangential * impulse.tangential())
}

/// The rule without a loss, and rolling friction that takes this share of the relative spin.
fn rolling(contact: &Contact, share: f64) -> Impulse {
    let impulse = rough(contact);
    let spin = contact.relative_spin() - contact.spin_response() * impulse.tangential();
    impulse.with_couple(share * contact.spin_inertia() * spin)
}

fn energies() -> Vec<Fault<Rule>> {
    vec![
        blind("an elastic rule gains 1e-7", rule("energy", |contact| smooth(contact, 1.0 + 1e-7))),
        informed(
            "a gain at closing speeds of 4.40 to 4.44",
            gain(|contact| (4.40..4.44).contains(&contact.closing_speed())),
        ),
        blind("the couple has the wrong sign", rule("energy", |contact| rolling(contact, -0.5))),
        blind("hollow walls gain", gain(|contact| contact.radii()[1] < 0.0)),
        blind(
            "contacts of kind 2 with kind 2 gain",
            gain(|contact| contact.is_between(Kind::new(2), Kind::new(2))),
        ),
        informed(
            "a gain from 0.002 to 0.004 after the last collision",
            gain(|contact| (0.002..0.004).contains(&contact.time_since_last_collision())),
        ),
        blind(
            "a rule without rebound leaves 1e-5 of the closing speed",
            rule("separation", |contact| smooth(contact, -1e-5)),
        ),
        informed(
            "a slip of three times the closing speed leaves a tenth",
            rule("separation", |contact| {
                let ratio = contact.slip_speed() / contact.closing_speed();
                smooth(contact, if (2.9..3.1).contains(&ratio) { -0.1 } else { 0.9 })
            }),
        ),
        blind(
            "a closing speed of 0 is not a number",
            rule("finite", |contact| {
                smooth(contact, 0.9 * contact.closing_speed() / contact.closing_speed())
            }),
        ),
    ]
}

fn symmetries() -> Vec<Fault<Rule>> {
    let exchange = "exchange of partners";
    vec![
        blind(
            "the larger partner decides if it is the first",
            rule(exchange, |contact| {
                let [first, second] = contact.radii();
                smooth(contact, if first > second { 0.9 - 1e-6 } else { 0.9 })
            }),
        ),
        informed(
            "kind 17 gains at kind 203, in this order",
            rule(exchange, |contact| {
                smooth(contact, if contact.kinds() == [Kind::new(17), Kind::new(203)] { 1.05 } else { 0.9 })
            }),
        ),
        blind(
            "a slip to the right loses more, by 1e-6",
            rule("mirror image", |contact| {
                smooth(contact, if contact.slip_speed() > 0.0 { 0.9 - 1e-6 } else { 0.9 })
            }),
        ),
        informed(
            "the couple turns always counterclockwise",
            rule("mirror image", |contact| {
                let impulse = rolling(contact, 0.5);
                impulse.with_couple(impulse.couple().max(0.0))
            }),
        ),
    ]
}

fn promises() -> Vec<Fault<Rule>> {
    let (opposed, cone) = ("opposed slip", "friction cone");
    vec![
        blind(
            "friction is beyond its cone by 1e-5",
            promised(cone, RUBBING, |contact| frictional(contact, 1.0 + 1e-5)),
        ),
        informed(
            "friction leaves its cone for a slip above 100",
            promised(cone, RUBBING, |contact| {
                frictional(contact, if contact.slip_speed().abs() > 100.0 { 1.01 } else { 1.0 })
            }),
        ),
        blind("friction has the wrong sign", promised(opposed, RUBBING, |contact| frictional(contact, -1.0))),
        // The sign of a zero is one, not zero.
        informed(
            "a slip of 0 has a sign",
            promised(opposed, RUBBING, |contact| {
                let normal = contact.normal_impulse(0.5);
                Impulse::new(normal, 0.1 * normal * contact.slip_speed().signum())
            }),
        ),
        blind(
            "rolling friction is beyond its limit",
            promised("rolling friction", FREE.with_rolling_friction(1e-3), |contact| rolling(contact, 0.5)),
        ),
    ]
}

fn states() -> Vec<Fault<Rule>> {
    let [often, seldom] = [one_in(7), one_in(40_000)];
    let (later, calls) = (one_in(3_000_000), std::cell::Cell::new(false));
    vec![
        blind(
            "one call in seven loses more, by 1e-3",
            rule("repeatable", move |contact| smooth(contact, if often() { 0.899 } else { 0.9 })),
        ),
        informed(
            "one call in 40000 loses all",
            rule("repeatable", move |contact| smooth(contact, if seldom() { 0.0 } else { 0.9 })),
        ),
        survivor(
            "after three million calls, nothing is lost",
            rule("repeatable", move |contact| {
                calls.set(calls.get() || later());
                smooth(contact, if calls.get() { 1.0 } else { 0.9 })
            }),
        ),
        honest("elastic", rule("", |contact| Elastic.impulse(contact))),
        honest("rough", rule("", rough)),
        honest("frictional", promised("", RUBBING, |contact| frictional(contact, 1.0))),
        honest("rolling", rule("", |contact| rolling(contact, 1.0))),
    ]
}

#[test]
fn the_check_of_rules_finds_planted_faults() {
    let all = [energies(), symmetries(), promises(), states()];
    judge("rule", all.into_iter().flatten().collect(), |(law, promises, rule)| {
        laws::check(&*rule, &promises)
            .inspect_err(|violation| assert_eq!(violation.law(), law, "{violation}"))
    });
}
