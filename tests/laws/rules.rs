//! Collision rules that break their contract.

use granular_edmd::Kind;
use granular_edmd::collision::laws::{self, Promises};
use granular_edmd::collision::{
    CollisionRule, Contact, Elastic, Frictional, Impulse, Regime, Rough, from_fn,
};

use crate::{Fault, blind, honest, informed, judge, one_in, survivor};

type Rule = (Promises, Box<dyn CollisionRule>);

const FREE: Promises = Promises::new();
const RUBBING: Promises = FREE.with_friction(0.5);

fn rule(impulse: impl Fn(&Contact) -> Impulse + 'static) -> Rule {
    promised(FREE, impulse)
}

fn promised(promises: Promises, impulse: impl Fn(&Contact) -> Impulse + 'static) -> Rule {
    (promises, Box::new(from_fn(impulse)))
}

/// A rule that gains energy where the condition holds.
fn gain(is_there: impl Fn(&Contact) -> bool + 'static) -> Rule {
    rule(move |contact| smooth(contact, if is_there(contact) { 1.05 } else { 0.9 }))
}

fn smooth(contact: &Contact, restitution: f64) -> Impulse {
    Impulse::new(contact.normal_impulse(restitution), 0.0)
}

/// The rule that turns both speeds around, and neither gains nor loses energy.
fn rough(contact: &Contact, tangential: f64) -> Impulse {
    let impulse = Rough::from_inelasticity(0.0, 0.0).expect("a restitution of 1").impulse(contact);
    Impulse::new(impulse.normal(), tangential * impulse.tangential())
}

fn frictional(contact: &Contact, tangential: f64) -> Impulse {
    let rule = Frictional::from_inelasticity(0.05, 0.1, 0.5).expect("an inelasticity");
    let impulse = rule.impulse(contact);
    Impulse::new(impulse.normal(), tangential * impulse.tangential())
}

/// The rule without a loss, and rolling friction that takes this share of the relative spin.
fn rolling(contact: &Contact, share: f64) -> Impulse {
    let impulse = rough(contact, 1.0);
    let spin = contact.relative_spin() - contact.spin_response() * impulse.tangential();
    impulse.with_couple(share * contact.spin_inertia() * spin)
}

fn energies() -> Vec<Fault<Rule>> {
    vec![
        blind("an elastic rule gains 1e-7", rule(|contact| smooth(contact, 1.0 + 1e-7))),
        informed(
            "a gain at closing speeds of 4.40 to 4.44",
            gain(|contact| (4.40..4.44).contains(&contact.closing_speed())),
        ),
        blind(
            "a rule without rebound leaves 1e-5 of the closing speed",
            rule(|contact| smooth(contact, -1e-5)),
        ),
        informed(
            "a slip of three times the closing speed leaves a tenth",
            rule(|contact| {
                let ratio = contact.slip_speed() / contact.closing_speed();
                smooth(contact, if (2.9..3.1).contains(&ratio) { -0.1 } else { 0.9 })
            }),
        ),
        blind("the slip turns around with a gain of 1e-5", rule(|contact| rough(contact, 1.0 + 1e-5))),
        blind("the couple has the wrong sign", rule(|contact| rolling(contact, -0.5))),
    ]
}

fn partners() -> Vec<Fault<Rule>> {
    vec![
        blind(
            "contacts of kind 2 with kind 2 gain",
            gain(|contact| contact.is_between(Kind::new(2), Kind::new(2))),
        ),
        informed(
            "kind 17 gains at kind 203, in this order",
            gain(|contact| contact.kinds() == [Kind::new(17), Kind::new(203)]),
        ),
        blind(
            "the larger partner decides if it is the first",
            rule(|contact| {
                let [first, second] = contact.radii();
                smooth(contact, if first > second { 0.9 - 1e-6 } else { 0.9 })
            }),
        ),
        informed(
            "the kinds 1 and 2 are known in this order only",
            rule(|contact| {
                smooth(contact, if contact.kinds() == [Kind::new(1), Kind::new(2)] { 0.5 } else { 0.9 })
            }),
        ),
        blind(
            "a slip to the right loses more, by 1e-6",
            rule(|contact| smooth(contact, if contact.slip_speed() > 0.0 { 0.9 - 1e-6 } else { 0.9 })),
        ),
        informed(
            "the couple turns always counterclockwise",
            rule(|contact| {
                let impulse = rolling(contact, 0.5);
                impulse.with_couple(impulse.couple().max(0.0))
            }),
        ),
        blind("hollow walls gain", gain(|contact| contact.radii()[1] < 0.0)),
        informed(
            "rings gain",
            gain(|contact| (contact.tangential_mass() / contact.normal_mass() - 0.5).abs() < 1e-9),
        ),
    ]
}

fn promises() -> Vec<Fault<Rule>> {
    let opposed = RUBBING.with_opposed_slip();
    vec![
        blind(
            "friction is beyond its cone by 1e-5",
            promised(RUBBING, |contact| frictional(contact, 1.0 + 1e-5)),
        ),
        informed(
            "friction leaves its cone for a slip above 100",
            promised(RUBBING, |contact| {
                frictional(contact, if contact.slip_speed().abs() > 100.0 { 1.01 } else { 1.0 })
            }),
        ),
        blind("friction has the wrong sign", promised(opposed, |contact| frictional(contact, -1.0))),
        blind(
            "a closing speed of 0 is not a number",
            rule(|contact| smooth(contact, 0.9 * contact.closing_speed() / contact.closing_speed())),
        ),
        informed(
            "a gain from 0.002 to 0.004 after the last collision",
            gain(|contact| (0.002..0.004).contains(&contact.time_since_last_collision())),
        ),
    ]
}

fn states() -> Vec<Fault<Rule>> {
    let [often, seldom, other] = [one_in(7), one_in(40_000), one_in(5)];
    let (later, calls) = (one_in(3_000_000), std::cell::Cell::new(false));
    vec![
        blind(
            "one call in seven loses more, by 1e-3",
            rule(move |contact| smooth(contact, if often() { 0.899 } else { 0.9 })),
        ),
        informed(
            "one call in 40000 loses all",
            rule(move |contact| smooth(contact, if seldom() { 0.0 } else { 0.9 })),
        ),
        informed(
            "one call in five has another regime",
            rule(move |contact| {
                smooth(contact, 0.9).with_regime(if other() { Regime::Sliding } else { Regime::Sticking })
            }),
        ),
        survivor(
            "after three million calls, nothing is lost",
            rule(move |contact| {
                calls.set(calls.get() || later());
                smooth(contact, if calls.get() { 1.0 } else { 0.9 })
            }),
        ),
        honest("elastic", rule(|contact| Elastic.impulse(contact))),
        honest("rough", rule(|contact| rough(contact, 1.0))),
        honest("frictional", promised(RUBBING.with_opposed_slip(), |contact| frictional(contact, 1.0))),
        honest("rolling", rule(|contact| rolling(contact, 1.0))),
    ]
}

#[test]
fn the_check_of_rules_finds_planted_faults() {
    let all = energies().into_iter().chain(partners()).chain(promises()).chain(states());
    judge("rule", all.collect(), |(promises, rule)| laws::check(&*rule, &promises));
}
