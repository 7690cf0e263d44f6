//! Rules that break their contract where a check may not look.

use std::cell::Cell;

use granular_edmd::Kind;
use granular_edmd::collision::laws::Promises;
use granular_edmd::collision::{Contact, Frictional, Impulse, Regime, from_fn};

use crate::faults::blind::rules::Promised;
use crate::faults::{List, Planted, one_in, tenth};

const FREE: Promises = Promises::new();
const GAIN: f64 = 1.05;

type Rules = List<Promised>;

impl Rules {
    fn rule<F>(&mut self, family: &'static str, name: impl Into<String>, promises: Promises, rule: F)
    where
        F: Fn(&Contact) -> Impulse + 'static,
    {
        self.family = family;
        self.plant(name, Promised { rule: Box::new(from_fn(rule)), promises });
    }

    /// Adds a rule that gains energy in the contacts for which the condition holds.
    fn gain(&mut self, family: &'static str, name: &str, is_there: impl Fn(&Contact) -> bool + 'static) {
        self.rule(family, name, FREE, move |contact| {
            smooth(contact, if is_there(contact) { GAIN } else { 0.9 })
        });
    }
}

fn smooth(contact: &Contact, restitution: f64) -> Impulse {
    Impulse::new(contact.normal_impulse(restitution), 0.0)
}

fn frictional(contact: &Contact, tangential: f64) -> Impulse {
    let rule = Frictional::from_inelasticity(0.05, 0.1, 0.5).expect("an inelasticity");
    let impulse = granular_edmd::collision::CollisionRule::impulse(&rule, contact);
    Impulse::new(impulse.normal(), tangential * impulse.tangential())
}

/// An elastic rule whose couple takes a share of the spin, within the limit of a coefficient of 0.2.
fn rolling(contact: &Contact, share: f64, limit: f64) -> Impulse {
    let impulse = smooth(contact, 1.0);
    let most = limit * impulse.normal() * contact.effective_radius();
    let couple = share * contact.spin_inertia() * contact.relative_spin();
    impulse.with_couple(couple.clamp(-most, most))
}

pub(crate) fn catalogue() -> Vec<Planted<Promised>> {
    List::grown(&[windows, partners, couples, symmetries, states])
}

fn windows(rules: &mut Rules) {
    rules.gain("narrow window", "gain at closing speeds of 4.40 to 4.44", |contact| {
        (4.40..4.44).contains(&contact.closing_speed())
    });
    rules.gain("slow window", "gain at closing speeds of 1.7e-8 to 2.9e-8", |contact| {
        (1.7e-8..2.9e-8).contains(&contact.closing_speed())
    });
    rules.gain("oblique window", "gain where slip and closing speed agree to 2 %", |contact| {
        (0.98..1.02).contains(&(contact.slip_speed() / contact.closing_speed()).abs())
            && contact.slip_speed() > 0.1
    });
    rules.gain("time window", "gain from 0.002 to 0.004 after the last collision", |contact| {
        (0.002..0.004).contains(&contact.time_since_last_collision())
    });
    rules.gain("late window", "gain from 100 to 300 after the last collision", |contact| {
        (100.0..300.0).contains(&contact.time_since_last_collision())
    });
    rules.gain("mass window", "gain at reduced masses of 0.11 to 0.14", |contact| {
        (0.11..0.14).contains(&contact.normal_mass())
    });
    rules.gain("rings", "gain of rings", |contact| {
        (contact.tangential_mass() / contact.normal_mass() - 0.5).abs() < 1e-9
    });
    rules.gain(
        "two windows",
        "gain at closing speeds of 1 to 2 of partners with a radius above 3",
        |contact| (1.0..2.0).contains(&contact.closing_speed()) && contact.radii()[0] > 3.0,
    );
    rules.rule("rounded", "the normal impulse has ten digits", FREE, |contact| {
        let text = format!("{:.9e}", contact.normal_impulse(1.0));
        Impulse::new(text.parse().expect("a number"), 0.0)
    });
}

fn partners(rules: &mut Rules) {
    rules.gain("pair of kinds", "gain of the kinds 17 and 18", |contact| {
        contact.is_between(Kind::new(17), Kind::new(18))
    });
    rules.gain(
        "pair of kinds",
        "gain of a disk of kind 17 that meets one of kind 203, in this order",
        |contact| contact.kinds() == [Kind::new(17), Kind::new(203)],
    );
    let ordered = FREE.with_ordered_partners();
    rules.rule("pair of kinds", "gain of ordered partners of the kinds 17 and 203", ordered, |contact| {
        smooth(contact, if contact.kinds() == [Kind::new(17), Kind::new(203)] { GAIN } else { 0.9 })
    });
    rules.rule(
        "pair of kinds",
        "the kinds 17 and 203 lose less than the kinds 203 and 17",
        FREE,
        |contact| smooth(contact, if contact.kinds() == [Kind::new(17), Kind::new(203)] { 0.8 } else { 0.9 }),
    );
    rules.gain("walls with a kind", "gain at straight walls of kind 200", |contact| {
        contact.radii()[1] == f64::INFINITY && contact.kinds()[1] == Kind::new(200)
    });
    rules.gain("unnamed kind", "gain of two disks of the kind of walls", |contact| {
        contact.kinds() == [Kind::WALL; 2] && contact.radii()[1].is_finite()
    });
    rules.gain("unnamed kind", "gain of kind 1000, which nobody names", |contact| {
        contact.kinds().contains(&Kind::new(1000))
    });
    let promises = FREE.with_kinds(const { &[Kind::DEFAULT, Kind::new(1000)] });
    rules.rule("named kind", "gain of kind 1000, which the author names", promises, |contact| {
        smooth(contact, if contact.kinds().contains(&Kind::new(1000)) { GAIN } else { 0.9 })
    });
    rules.gain("close fit", "gain in hollow walls up to a fifth larger than the disk", |contact| {
        let [disk, wall] = contact.radii();
        wall < 0.0 && -wall < 1.2 * disk
    });
    rules.gain("close fit", "gain in hollow walls up to a fiftieth larger than the disk", |contact| {
        let [disk, wall] = contact.radii();
        wall < 0.0 && -wall < 1.02 * disk
    });
    rules.rule("pair of kinds", "gain of the kinds 200 and 201, less than friction takes", FREE, |contact| {
        let gains = contact.is_between(Kind::new(200), Kind::new(201));
        let normal = contact.normal_impulse(if gains { 1.02 } else { 0.9 });
        Impulse::new(normal, frictional(contact, 1.0).tangential())
    });
    rules.gain("small pegs", "gain at round walls smaller than a tenth of the disk", |contact| {
        let [disk, wall] = contact.radii();
        contact.kinds()[1] == Kind::WALL && wall > 0.0 && wall < 0.1 * disk
    });
    rules.gain("walls with a kind", "gain at straight walls of another kind than that of walls", |contact| {
        contact.radii()[1] == f64::INFINITY && contact.kinds()[1] != Kind::WALL
    });
}

fn couples(rules: &mut Rules) {
    let rough = FREE.with_rolling_friction(0.2);
    for n in [2, 6, 9] {
        let name = format!("the couple is beyond its limit by 1e-{n}");
        rules
            .rule("rolling limit", name, rough, move |contact| rolling(contact, 1.0, 0.2 * (1.0 + tenth(n))));
    }
    rules.rule("reversed spin", "rolling friction turns the spin around", rough, |contact| {
        rolling(contact, 1.9, 0.2)
    });
    rules.rule("fed spin", "the couple feeds slow spins", FREE, |contact| {
        let share = if contact.relative_spin().abs() < 0.1 { -0.1 } else { 0.5 };
        rolling(contact, share, 0.2)
    });
    rules.rule("spin window", "spins of 2 to 2.5 get a couple that is too large", FREE, |contact| {
        let is_there = (2.0..2.5).contains(&contact.relative_spin().abs());
        rolling(contact, if is_there { 2.2 } else { 0.5 }, f64::MAX)
    });
    rules.rule("couple of no spin", "the couple of no spin is not a number", FREE, |contact| {
        let spin = contact.relative_spin();
        smooth(contact, 0.9).with_couple(0.0 * spin / spin)
    });
}

fn symmetries(rules: &mut Rules) {
    rules.rule("order of spins", "partner 1 alone is slowed if it is the larger one", FREE, |contact| {
        let [first, second] = contact.radii();
        rolling(contact, if first > second { 0.5 } else { 0.4 }, f64::MAX)
    });
    for n in [2, 6, 10] {
        let name = format!("friction to the right is weaker by 1e-{n}");
        rules.rule("handed friction", name, FREE.with_friction(0.5), move |contact| {
            frictional(contact, if contact.slip_speed() > 0.0 { 1.0 - tenth(n) } else { 1.0 })
        });
    }
    rules.rule("handed couple", "spins to the right lose more", FREE, |contact| {
        rolling(contact, if contact.relative_spin() > 0.0 { 0.6 } else { 0.5 }, f64::MAX)
    });
    rules.rule("order of kinds", "of two kinds, the number of the first decides", FREE, |contact| {
        let [first, second] = contact.kinds();
        smooth(contact, if first.number() > second.number() { 0.8 } else { 0.9 })
    });
    rules.rule(
        "pushed slip",
        "the normal direction pays for a faster slip",
        FREE.with_opposed_slip(),
        |contact| {
            let push = -1e-3 * contact.tangential_mass() * contact.slip_speed();
            Impulse::new(contact.normal_impulse(0.1), push)
        },
    );
    rules.rule(
        "slow friction",
        "friction below a slip of 1e-5 has the wrong sign",
        FREE.with_friction(0.5),
        |contact| frictional(contact, if contact.slip_speed().abs() < 1e-5 { -1.0 } else { 1.0 }),
    );
}

fn states(rules: &mut Rules) {
    let largest = Cell::new(0.0);
    rules.rule("memory", "the loss depends on the largest speed ever", FREE, move |contact| {
        largest.set(contact.closing_speed().max(largest.get()));
        smooth(contact, 0.9 / (1.0 + 1e-3 * largest.get().min(1e9)))
    });
    let is_due = one_in(40_000);
    rules.rule("seldom", "one call in 40000 loses all", FREE, move |contact| {
        smooth(contact, if is_due() { 0.0 } else { 0.9 })
    });
    let is_due = one_in(5);
    rules.rule("label", "one call in five has another regime", FREE, move |contact| {
        let regime = if is_due() { Regime::Sliding } else { Regime::Sticking };
        smooth(contact, 0.9).with_regime(regime)
    });
    for (name, most) in [
        ("after a million calls, nothing is lost", 1_000_000_u32),
        ("after three million calls, nothing is lost", 3_000_000),
    ] {
        let calls = Cell::new(0);
        rules.rule("after many", name, FREE, move |contact| {
            calls.set(calls.get() + 1);
            smooth(contact, if calls.get() > most { 1.0 } else { 0.9 })
        });
    }
}
