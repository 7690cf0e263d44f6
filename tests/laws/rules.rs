//! Collision rules that break their contract.

use granular_edmd::Kind;
use granular_edmd::collision::laws::{self, Promises};
use granular_edmd::collision::{
    CollisionRule, Contact, Elastic, Frictional, Impulse, Regime, Rough, from_fn,
};

use crate::Half::{Blind, Honest, Informed, Survivor};
use crate::{Fault, judge, one_in};

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
        Fault(Blind, "an elastic rule gains 1e-7", rule(|contact| smooth(contact, 1.0 + 1e-7))),
        Fault(
            Informed,
            "a gain at closing speeds of 4.40 to 4.44",
            gain(|contact| (4.40..4.44).contains(&contact.closing_speed())),
        ),
        Fault(
            Informed,
            "a gain at closing speeds near 2e-8",
            gain(|contact| (1.7e-8..2.9e-8).contains(&contact.closing_speed())),
        ),
        Fault(
            Blind,
            "a rule without rebound leaves 1e-5 of the closing speed",
            rule(|contact| smooth(contact, -1e-5)),
        ),
        Fault(
            Informed,
            "a slip of three times the closing speed leaves a tenth",
            rule(|contact| {
                let ratio = contact.slip_speed() / contact.closing_speed();
                smooth(contact, if (2.9..3.1).contains(&ratio) { -0.1 } else { 0.9 })
            }),
        ),
        Fault(Blind, "the slip turns around with a gain of 1e-5", rule(|contact| rough(contact, 1.0 + 1e-5))),
        Fault(
            Informed,
            "a slip of 6.5 to 6.6 turns around with a gain",
            rule(|contact| {
                rough(contact, if (6.5..6.6).contains(&contact.slip_speed().abs()) { 1.1 } else { 0.9 })
            }),
        ),
        Fault(Blind, "the couple has the wrong sign", rule(|contact| rolling(contact, -0.5))),
        Fault(
            Informed,
            "spins above 50 get a couple that is too large",
            rule(|contact| rolling(contact, if contact.relative_spin().abs() > 50.0 { 2.1 } else { 0.5 })),
        ),
    ]
}

fn partners() -> Vec<Fault<Rule>> {
    vec![
        Fault(
            Blind,
            "contacts of kind 2 with kind 2 gain",
            gain(|contact| contact.is_between(Kind::new(2), Kind::new(2))),
        ),
        Fault(
            Informed,
            "kind 17 gains at kind 203, in this order",
            gain(|contact| contact.kinds() == [Kind::new(17), Kind::new(203)]),
        ),
        Fault(
            Blind,
            "the larger partner decides if it is the first",
            rule(|contact| {
                let [first, second] = contact.radii();
                smooth(contact, if first > second { 0.9 - 1e-6 } else { 0.9 })
            }),
        ),
        Fault(
            Informed,
            "the kinds 1 and 2 are known in this order only",
            rule(|contact| {
                smooth(contact, if contact.kinds() == [Kind::new(1), Kind::new(2)] { 0.5 } else { 0.9 })
            }),
        ),
        Fault(
            Blind,
            "a slip to the right loses more, by 1e-6",
            rule(|contact| smooth(contact, if contact.slip_speed() > 0.0 { 0.9 - 1e-6 } else { 0.9 })),
        ),
        Fault(
            Informed,
            "the couple turns always counterclockwise",
            rule(|contact| {
                let impulse = rolling(contact, 0.5);
                impulse.with_couple(impulse.couple().max(0.0))
            }),
        ),
        Fault(Blind, "hollow walls gain", gain(|contact| contact.radii()[1] < 0.0)),
        Fault(
            Informed,
            "straight walls of kind 200 gain",
            gain(|contact| contact.radii()[1] == f64::INFINITY && contact.kinds()[1] == Kind::new(200)),
        ),
        Fault(
            Blind,
            "a reduced mass below 1e-3 is taken as 1e-3",
            rule(|contact| {
                Impulse::new(2.0 * contact.normal_mass().max(1e-3) * contact.closing_speed(), 0.0)
            }),
        ),
        Fault(
            Informed,
            "rings gain",
            gain(|contact| (contact.tangential_mass() / contact.normal_mass() - 0.5).abs() < 1e-9),
        ),
    ]
}

fn promises() -> Vec<Fault<Rule>> {
    let opposed = RUBBING.with_opposed_slip();
    vec![
        Fault(
            Blind,
            "friction is beyond its cone by 1e-5",
            promised(RUBBING, |contact| frictional(contact, 1.0 + 1e-5)),
        ),
        Fault(
            Informed,
            "friction leaves its cone for a slip above 100",
            promised(RUBBING, |contact| {
                frictional(contact, if contact.slip_speed().abs() > 100.0 { 1.01 } else { 1.0 })
            }),
        ),
        Fault(Blind, "friction has the wrong sign", promised(opposed, |contact| frictional(contact, -1.0))),
        Fault(
            Informed,
            "friction has the wrong sign below a slip of 1e-5",
            promised(opposed, |contact| {
                frictional(contact, if contact.slip_speed().abs() < 1e-5 { -1.0 } else { 1.0 })
            }),
        ),
        Fault(
            Blind,
            "a closing speed of 0 is not a number",
            rule(|contact| smooth(contact, 0.9 * contact.closing_speed() / contact.closing_speed())),
        ),
        Fault(
            Informed,
            "the root of a hollow radius is not a number",
            rule(|contact| smooth(contact, 0.9 / (1.0 + 1.0 / contact.radii()[1].sqrt()))),
        ),
        Fault(
            Blind,
            "an infinite time since the last collision is not a number",
            rule(|contact| {
                let time = contact.time_since_last_collision();
                smooth(contact, 0.9 - time * (-time).exp())
            }),
        ),
        Fault(
            Informed,
            "a gain from 0.002 to 0.004 after the last collision",
            gain(|contact| (0.002..0.004).contains(&contact.time_since_last_collision())),
        ),
    ]
}

fn states() -> Vec<Fault<Rule>> {
    let [often, seldom, other] = [one_in(7), one_in(40_000), one_in(5)];
    let (later, calls) = (one_in(3_000_000), std::cell::Cell::new(false));
    vec![
        Fault(
            Blind,
            "one call in seven loses more, by 1e-3",
            rule(move |contact| smooth(contact, if often() { 0.899 } else { 0.9 })),
        ),
        Fault(
            Informed,
            "one call in 40000 loses all",
            rule(move |contact| smooth(contact, if seldom() { 0.0 } else { 0.9 })),
        ),
        Fault(
            Informed,
            "one call in five has another regime",
            rule(move |contact| {
                smooth(contact, 0.9).with_regime(if other() { Regime::Sliding } else { Regime::Sticking })
            }),
        ),
        Fault(
            Survivor,
            "after three million calls, nothing is lost",
            rule(move |contact| {
                calls.set(calls.get() || later());
                smooth(contact, if calls.get() { 1.0 } else { 0.9 })
            }),
        ),
        Fault(Honest, "elastic", rule(|contact| Elastic.impulse(contact))),
        Fault(Honest, "rough", rule(|contact| rough(contact, 1.0))),
        Fault(
            Honest,
            "frictional",
            promised(RUBBING.with_opposed_slip(), |contact| frictional(contact, 1.0)),
        ),
        Fault(Honest, "rolling", rule(|contact| rolling(contact, 1.0))),
    ]
}

#[test]
fn the_check_of_rules_finds_planted_faults() {
    let all = energies().into_iter().chain(partners()).chain(promises()).chain(states());
    judge("rule", all.collect(), |(promises, rule)| laws::check(&*rule, &promises));
}
