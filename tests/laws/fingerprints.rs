//! Fingerprints that do not tell rules apart, or that tell equal rules apart.

use granular_edmd::collision::laws::check_fingerprints;
use granular_edmd::collision::{CollisionRule, Contact, Frictional, Impulse, RulesByKind, Smooth};
use granular_edmd::{Fingerprint, Kind, Violation};

use crate::{Fault, blind, honest, informed, judge};

const NAME: Fingerprint = Fingerprint::of("rule");

/// The comparison of two rules.
type Pair = Box<dyn Fn() -> Result<(), Violation>>;

/// An honest rule with a fingerprint of its own.
struct Marked<R>(R, Fingerprint);

impl<R: CollisionRule> CollisionRule for Marked<R> {
    fn impulse(&self, contact: &Contact) -> Impulse {
        self.0.impulse(contact)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(self.1)
    }
}

fn pair<T: Copy + 'static, R: CollisionRule + 'static>(
    of: [T; 2],
    mark: fn(T) -> Fingerprint,
    make: fn(T) -> R,
) -> Pair {
    Box::new(move || {
        let [one, other] = of.map(|number| Marked(make(number), mark(number)));
        check_fingerprints(&one, &other)
    })
}

fn smooth(loss: f64) -> Smooth {
    Smooth::from_inelasticity(loss).expect("an inelasticity")
}

fn frictional(friction: f64) -> Frictional {
    Frictional::from_inelasticity(0.1, 0.1, friction).expect("an inelasticity")
}

/// A rule that loses more between disks of kind 40 and of this kind.
fn table(kind: u16) -> RulesByKind<Smooth> {
    RulesByKind::new(smooth(0.1)).with(Kind::new(40), Kind::new(kind), smooth(0.2))
}

fn faults() -> Vec<Fault<Pair>> {
    let in_single = |loss| NAME.number(f64::from(loss as f32));
    vec![
        blind("a loss counts in single precision", pair([0.1, 0.1 + 1e-10], in_single, smooth)),
        informed(
            "the last bit of a friction is forgotten",
            pair([0.3, 0.3_f64.next_up()], |_| NAME, frictional),
        ),
        informed("one of two larger kinds is forgotten", pair([41, 42], |_| NAME, table)),
        blind(
            "each rule of a program has a number of its own",
            pair([1.0, 2.0], |number| NAME.number(number), |_| smooth(0.1)),
        ),
        honest("different rules", pair([0.1, 0.2], |loss| NAME.number(loss), smooth)),
        honest("equal rules", pair([0.1, 0.1], |loss| NAME.number(loss), smooth)),
    ]
}

#[test]
fn the_check_of_fingerprints_finds_planted_faults() {
    judge("fingerprint", faults(), |check: Pair| check());
}
