//! Collision rules that break their contract.

use std::cell::Cell;

use granular_edmd::Kind;
use granular_edmd::collision::laws::Promises;
use granular_edmd::collision::{CollisionRule, Contact, Elastic, Frictional, Impulse, Rough, from_fn};

use crate::faults::{List, Planted, one_in, tenth};

/// A rule, with the promises that its author would give to the check.
pub(crate) struct Promised {
    pub(crate) rule: Box<dyn CollisionRule>,
    pub(crate) promises: Promises,
}

const FREE: Promises = Promises::new();
const RUBBING: Promises = FREE.with_friction(0.5);
const OPPOSED: Promises = RUBBING.with_opposed_slip();

/// The catalogue while it grows.
type Rules = List<Promised>;

impl Rules {
    fn add<F>(&mut self, promises: Promises, name: impl Into<String>, rule: F)
    where
        F: Fn(&Contact) -> Impulse + 'static,
    {
        let rule = Box::new(from_fn(rule));
        self.plant(name, Promised { rule, promises });
    }
}

/// The rule that turns both speeds around, and neither gains nor loses energy.
fn rough(contact: &Contact) -> Impulse {
    let rule = Rough::from_inelasticity(0.0, 0.0).expect("a restitution of 1");
    rule.impulse(contact)
}

fn frictional(contact: &Contact) -> Impulse {
    let rule = Frictional::from_inelasticity(0.05, 0.1, 0.5).expect("an inelasticity");
    rule.impulse(contact)
}

/// The rule without a loss, and rolling friction that takes this share of the relative spin.
fn rolling(contact: &Contact, share: f64) -> Impulse {
    let impulse = rough(contact);
    let spin = contact.relative_spin() - contact.spin_response() * impulse.tangential();
    impulse.with_couple(share * contact.spin_inertia() * spin)
}

fn smooth(contact: &Contact, restitution: f64) -> Impulse {
    Impulse::new(contact.normal_impulse(restitution), 0.0)
}

fn scaled(impulse: Impulse, normal: f64, tangential: f64) -> Impulse {
    Impulse::new(normal * impulse.normal(), tangential * impulse.tangential()).with_couple(impulse.couple())
}

/// Returns the rules on which faults are planted.
pub(crate) fn honest() -> Vec<Planted<Promised>> {
    let mut rules = Rules::default();
    rules.add(FREE, "elastic", |contact| Elastic.impulse(contact));
    rules.add(FREE, "rough", rough);
    rules.add(OPPOSED, "frictional", frictional);
    rules.add(FREE, "rolling", |contact| rolling(contact, 1.0));
    rules.add(FREE, "smooth", |contact| smooth(contact, 0.9));
    rules.faults
}

pub(crate) fn catalogue() -> Vec<Planted<Promised>> {
    List::grown(&[sizes, windows, partners, masses, histories, corners, friction, couples])
}

/// Errors of a relative size: sentences 3 and 4 of the contract.
fn sizes(rules: &mut Rules) {
    rules.family = "normal gain";
    for n in [1, 2, 3, 5, 7, 9] {
        let size = tenth(n);
        let name = format!("the normal impulse of an elastic rule is too large by 1e-{n}");
        rules.add(FREE, name, move |contact| scaled(Elastic.impulse(contact), 1.0 + size, 1.0));
    }
    rules.family = "still closing";
    for n in [1, 2, 3, 5, 7, 9] {
        let size = tenth(n);
        let name = format!("a rule without rebound leaves 1e-{n} of the closing speed");
        rules.add(FREE, name, move |contact| smooth(contact, -size));
    }
    rules.family = "tangential gain";
    for n in [1, 3, 5, 9] {
        let size = tenth(n);
        let name = format!("the tangential impulse turns the slip around with a gain of 1e-{n}");
        rules.add(FREE, name, move |contact| scaled(rough(contact), 1.0, 1.0 + size));
    }
    rules.family = "single precision";
    rules.add(FREE, "an elastic rule computes in single precision", |contact| {
        let product = 2.0 * (contact.normal_mass() as f32) * (contact.closing_speed() as f32);
        Impulse::new(f64::from(product), 0.0)
    });
}

/// A gain of energy in a window of speeds.
fn windows(rules: &mut Rules) {
    rules.family = "closing window";
    for (low, high) in [(0.7, 0.95), (2.1, 2.2), (1.3e-3, 1.7e-3), (37.0, 41.0), (1e3, f64::MAX)] {
        let name = format!("contacts that close at {low:?} to {high:?} gain a tenth of the speed");
        rules.add(FREE, name, move |contact| {
            smooth(contact, if (low..high).contains(&contact.closing_speed()) { 1.1 } else { 0.9 })
        });
    }
    rules.family = "slip window";
    for (low, high) in [(0.3, 0.6), (6.5, 6.6), (1e-6, 1e-5)] {
        let name = format!("contacts that slip at {low:?} to {high:?} gain a fifth of the slip");
        rules.add(FREE, name, move |contact| {
            let is_inside = (low..high).contains(&contact.slip_speed().abs());
            scaled(rough(contact), 1.0, if is_inside { 1.1 } else { 0.9 })
        });
    }
    rules.add(FREE, "contacts that slip at 2.9 to 3.1 times the closing speed still close", |contact| {
        let ratio = contact.slip_speed() / contact.closing_speed();
        smooth(contact, if (2.9..3.1).contains(&ratio) { -0.1 } else { 0.9 })
    });
}

/// Faults for some partners only, or in one order of them: "a rule must give the same physics for the
/// partners in either order, and for the mirror image".
fn partners(rules: &mut Rules) {
    rules.family = "kinds";
    rules.add(FREE, "the kinds 3, 8, 13 and so on gain a tenth of the speed", |contact| {
        let is_one = contact.kinds().iter().any(|kind| kind.number() % 5 == 3);
        smooth(contact, if is_one { 1.1 } else { 0.9 })
    });
    rules.add(FREE, "contacts of kind 2 with kind 2 gain a tenth of the speed", |contact| {
        smooth(contact, if contact.is_between(Kind::new(2), Kind::new(2)) { 1.1 } else { 0.9 })
    });
    rules.add(FREE, "walls of the kind of walls return a hundredth too much", |contact| {
        smooth(contact, if contact.kinds()[1] == Kind::WALL { 1.01 } else { 0.9 })
    });
    rules.family = "order";
    rules.add(FREE, "the rule knows the kinds 1 and 2 in this order only", |contact| {
        smooth(contact, if contact.kinds() == [Kind::new(1), Kind::new(2)] { 0.5 } else { 0.9 })
    });
    for n in [1, 3, 6, 9] {
        let size = tenth(n);
        let name = format!("partner 1 decides the loss if it is the larger one, by 1e-{n}");
        rules.add(FREE, name, move |contact| {
            let [first, second] = contact.radii();
            smooth(contact, if first > second { 0.9 - size } else { 0.9 })
        });
    }
    rules.family = "mirror";
    for n in [1, 3, 6, 9] {
        let size = tenth(n);
        let name = format!("a slip to the right loses more than one to the left, by 1e-{n}");
        rules.add(FREE, name, move |contact| {
            smooth(contact, if contact.slip_speed() > 0.0 { 0.9 - size } else { 0.9 })
        });
    }
    rules.family = "order";
    rules.add(FREE, "the radius of partner 1 stands for the effective radius", |contact| {
        smooth(contact, 1.0 / (1.0 + 0.1 * contact.radii()[0].min(1e9)))
    });
    rules.family = "walls";
    rules.add(FREE, "hollow walls return a twentieth too much", |contact| {
        smooth(contact, if contact.radii()[1] < 0.0 { 1.05 } else { 0.9 })
    });
    rules.add(FREE, "round pegs return a twentieth too much", |contact| {
        let radius = contact.radii()[1];
        let is_peg = contact.kinds()[1] == Kind::WALL && radius > 0.0 && radius < f64::INFINITY;
        smooth(contact, if is_peg { 1.05 } else { 0.9 })
    });
    rules.add(FREE, "the effective radius is not a number at straight walls", |contact| {
        let [first, second] = contact.radii();
        smooth(contact, 1.0 / (1.0 + 0.1 * (first * second / (first + second))))
    });
    rules.add(FREE, "the root of a hollow radius is not a number", |contact| {
        smooth(contact, 0.9 / (1.0 + 1.0 / contact.radii()[1].sqrt()))
    });
}

/// Faults for unusual masses.
fn masses(rules: &mut Rules) {
    rules.family = "masses";
    rules.add(FREE, "partners whose radii differ by a factor above 10 gain a tenth", |contact| {
        let [first, second] = contact.radii().map(f64::abs);
        let ratio = first.max(second) / first.min(second);
        smooth(contact, if ratio > 10.0 && ratio < f64::INFINITY { 1.1 } else { 0.9 })
    });
    rules.add(FREE, "a reduced mass below 1e-3 is taken as 1e-3", |contact| {
        Impulse::new(2.0 * contact.normal_mass().max(1e-3) * contact.closing_speed(), 0.0)
    });
    rules.add(FREE, "a reduced mass above 1e3 is taken as 1e3", |contact| {
        Impulse::new(1.9 * contact.normal_mass().min(1e3) * contact.closing_speed(), 0.0)
    });
    rules.add(FREE, "all disks count as homogeneous, with a third of the mass", |contact| {
        let rigid = rough(contact);
        Impulse::new(rigid.normal(), 2.0 * contact.normal_mass() / 3.0 * contact.slip_speed())
    });
    rules.add(FREE, "the reduced mass is that of equal partners of mass 1", |contact| {
        Impulse::new(2.0 * 0.5 * contact.closing_speed(), 0.0)
    });
}

/// Faults soon after the last collision, and states that hide from the contact: sentence 1.
fn histories(rules: &mut Rules) {
    rules.family = "last collision";
    for n in [3, 9] {
        let (soon, name) =
            (tenth(n), format!("contacts sooner than 1e-{n} after the last one gain a twentieth"));
        rules.add(FREE, name, move |contact| {
            smooth(contact, if contact.time_since_last_collision() < soon { 1.05 } else { 0.9 })
        });
    }
    rules.add(FREE, "an infinite time since the last collision is not a number", |contact| {
        let time = contact.time_since_last_collision();
        smooth(contact, 0.9 - time * (-time).exp())
    });
    rules.add(FREE, "the restitution falls below 0 soon after the last collision", |contact| {
        smooth(contact, 0.9 - 1e-3 / contact.time_since_last_collision().max(1e-4))
    });
    rules.family = "hidden state";
    for (calls, n) in [(2, 1), (7, 3), (100, 6), (1_000, 1), (10_000, 1)] {
        let (is_due, size) = (one_in(calls), tenth(n));
        let name = format!("one call in {calls} loses more, by 1e-{n}");
        rules.add(FREE, name, move |contact| smooth(contact, if is_due() { 0.9 - size } else { 0.9 }));
    }
    let last = Cell::new(0.0);
    rules.add(FREE, "the loss depends on the speed of the contact before", move |contact| {
        smooth(contact, 1.0 / (1.0 + 0.1 * last.replace(contact.closing_speed()).min(10.0)))
    });
}

/// Corners at which a formula breaks down: sentence 2.
fn corners(rules: &mut Rules) {
    rules.family = "corners";
    rules.add(FREE, "a closing speed of 0 is not a number", |contact| {
        let speed = contact.closing_speed();
        smooth(contact, 0.9 * speed / speed)
    });
    rules.add(RUBBING, "the direction of no slip is not a number", |contact| {
        let (impulse, slip) = (frictional(contact), contact.slip_speed());
        Impulse::new(impulse.normal(), impulse.tangential().abs() * slip / slip.abs())
    });
    rules.add(FREE, "the sixth power of a speed overflows", |contact| {
        let power = contact.closing_speed().powi(6);
        smooth(contact, 0.9 - 0.1 * power / (1.0 + power))
    });
    rules.add(FREE, "a reduced mass squared vanishes and divides", |contact| {
        let (mass, speed) = (contact.normal_mass(), contact.closing_speed());
        Impulse::new(1.9 * speed * (mass * mass) * mass / (mass * mass), 0.0)
    });
}

/// Friction of the wrong sign or size, against the promises.
fn friction(rules: &mut Rules) {
    rules.family = "friction cone";
    for n in [1, 2, 3, 5, 7] {
        let (size, name) = (tenth(n), format!("friction is beyond its cone by 1e-{n}"));
        rules.add(RUBBING, name, move |contact| scaled(frictional(contact), 1.0, 1.0 + size));
    }
    rules.add(RUBBING, "friction leaves its cone only for a slip above 100", |contact| {
        scaled(frictional(contact), 1.0, if contact.slip_speed().abs() > 100.0 { 1.01 } else { 1.0 })
    });
    rules.family = "friction sign";
    rules.add(OPPOSED, "friction has the wrong sign", |contact| scaled(frictional(contact), 1.0, -1.0));
    rules.add(OPPOSED, "friction has the wrong sign at walls", |contact| {
        scaled(frictional(contact), 1.0, if contact.kinds()[1] == Kind::WALL { -1.0 } else { 1.0 })
    });
    rules.add(OPPOSED, "friction pushes always to the right", |contact| {
        let impulse = frictional(contact);
        Impulse::new(impulse.normal(), impulse.tangential().abs())
    });
    rules.add(OPPOSED, "friction slides even where it would turn the slip around", |contact| {
        let normal = contact.normal_impulse(1.0);
        Impulse::new(normal, (0.5 * normal).copysign(contact.slip_speed()))
    });
}

/// Couples that feed the spin: sentence 4, and the symmetry of the partners.
fn couples(rules: &mut Rules) {
    rules.family = "couple";
    rules.add(FREE, "the couple has the wrong sign", |contact| rolling(contact, -0.5));
    for n in [0, 2, 6] {
        let (size, name) = (tenth(n), format!("the couple turns the spin around with a gain of 1e-{n}"));
        rules.add(FREE, name, move |contact| rolling(contact, 2.0 + size));
    }
    rules.add(FREE, "the couple ignores the inertia", |contact| {
        rough(contact).with_couple(0.1 * contact.relative_spin())
    });
    rules.add(FREE, "the couple forgets the spin that the friction gives", |contact| {
        rough(contact).with_couple(1.5 * contact.spin_inertia() * contact.relative_spin())
    });
    rules.add(FREE, "the couple follows the slip and not the spin", |contact| {
        rough(contact).with_couple(contact.spin_inertia() * contact.slip_speed())
    });
    rules.add(FREE, "a couple of constant size is not limited by the spin", |contact| {
        let impulse = rough(contact);
        let spin = contact.relative_spin() - contact.spin_response() * impulse.tangential();
        impulse.with_couple((0.05 * impulse.normal()).copysign(spin))
    });
    rules.add(FREE, "the couple turns always counterclockwise, and loses what it can", |contact| {
        let impulse = rolling(contact, 0.5);
        impulse.with_couple(impulse.couple().max(0.0))
    });
    rules.add(FREE, "only spins above 50 get a couple that is too large", |contact| {
        rolling(contact, if contact.relative_spin().abs() > 50.0 { 2.1 } else { 0.5 })
    });
}
