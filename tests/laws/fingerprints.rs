//! Fingerprints that do not tell parts apart, or that tell equal parts apart.

use granular_edmd::boundary::{Boundary, Wall, laws as boundary_laws};
use granular_edmd::collision::{
    CollisionRule, Contact, Frictional, Impulse, RulesByKind, Smooth, laws as collision_laws,
};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::{
    AccelerationBounds, Combined, Sinusoidal, Tabulated, WallMotion, WallState, laws as wall_laws,
};
use granular_edmd::{Fingerprint, Kind, Violation};

use crate::boundaries::{Altered, pegs, resting};
use crate::{Fault, blind, honest, informed, judge};

const NAME: Fingerprint = Fingerprint::of("part");

/// The comparison of two parts.
type Pair = Box<dyn Fn() -> Result<(), Violation>>;

/// An honest part with a fingerprint of its own.
struct Marked<P>(P, Fingerprint);

impl<P: CollisionRule> CollisionRule for Marked<P> {
    fn impulse(&self, contact: &Contact) -> Impulse {
        self.0.impulse(contact)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(self.1)
    }
}

impl<P: WallMotion> WallMotion for Marked<P> {
    fn state(&self, phase: f64) -> WallState {
        self.0.state(phase)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        self.0.acceleration(phase)
    }

    fn reach(&self) -> (f64, f64) {
        self.0.reach()
    }

    fn period(&self) -> Option<f64> {
        self.0.period()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(self.1)
    }
}

fn rules<T: Copy + 'static, R: CollisionRule + 'static>(
    of: [T; 2],
    mark: fn(T) -> Fingerprint,
    make: fn(T) -> R,
) -> Pair {
    Box::new(move || {
        let [one, other] = of.map(|number| Marked(make(number), mark(number)));
        collision_laws::check_fingerprints(&one, &other)
    })
}

fn motions<T: Copy + 'static, M: WallMotion + 'static>(
    of: [T; 2],
    mark: fn(T) -> Fingerprint,
    make: fn(T) -> M,
) -> Pair {
    Box::new(move || {
        let [one, other] = of.map(|number| Marked(make(number), mark(number)));
        wall_laws::check_fingerprints(&one, &other)
    })
}

fn boundaries<T: Copy + 'static>(of: [T; 2], mark: fn(T) -> Fingerprint, make: fn(T) -> Altered) -> Pair {
    Box::new(move || {
        let [mut one, mut other] = of.map(|number| make(number).marked(mark(number)));
        boundary_laws::check_fingerprints(&mut one, &mut other, 0.5, 1.0)
    })
}

fn smooth(loss: f64) -> Smooth {
    Smooth::from_inelasticity(loss).expect("an inelasticity")
}

fn sine(frequency: f64) -> Sinusoidal {
    Sinusoidal::new(0.1, frequency).expect("an amplitude")
}

/// A rule that loses more between disks of kind 40 and of this kind.
fn table(kind: u16) -> RulesByKind<Smooth> {
    RulesByKind::new(smooth(0.1)).with(Kind::new(40), Kind::new(kind), smooth(0.2))
}

fn late_ramp(duration: f64) -> Combined {
    let ramp = Tabulated::from_to(0.0, 4.0, duration).expect("a duration");
    Combined::new(ramp).delayed_until(1000.0).expect("a start")
}

fn of_rules() -> Vec<Fault<Pair>> {
    vec![
        blind("the loss is forgotten", rules([0.1, 0.2], |_| NAME, smooth)),
        blind(
            "a loss counts in single precision",
            rules([0.1, 0.1 + 1e-10], |loss| NAME.number(f64::from(loss as f32)), smooth),
        ),
        informed(
            "the last bit of a friction is forgotten",
            rules(
                [0.3, 0.3_f64.next_up()],
                |_| NAME,
                |friction| Frictional::from_inelasticity(0.1, 0.1, friction).expect("an inelasticity"),
            ),
        ),
        informed("one of two larger kinds is forgotten", rules([41, 42], |_| NAME, table)),
        blind(
            "each rule of a program has a number of its own",
            rules([1.0, 2.0], |number| NAME.number(number), |_| smooth(0.1)),
        ),
        honest("different rules", rules([0.1, 0.2], |loss| NAME.number(loss), smooth)),
        honest("equal rules", rules([0.1, 0.1], |loss| NAME.number(loss), smooth)),
    ]
}

fn of_motions() -> Vec<Fault<Pair>> {
    vec![
        blind("the frequency is forgotten", motions([3.0, 7.0], |_| NAME, sine)),
        informed("the duration of a late ramp is forgotten", motions([20.0, 20.5], |_| NAME, late_ramp)),
        blind(
            "equal motions have numbers of their own",
            motions([0.0, 1.0], |number| NAME.number(number), |_| sine(3.0)),
        ),
        honest("different ramps", motions([20.0, 20.5], |duration| NAME.number(duration), late_ramp)),
    ]
}

fn of_boundaries() -> Vec<Fault<Pair>> {
    vec![
        blind(
            "the place of a peg is forgotten",
            boundaries([3.0, 7.0], |_| NAME, |x| Altered::new(pegs(DVec2::new(x, 6.0)))),
        ),
        informed(
            "the speed of a belt on the lid is forgotten",
            boundaries(
                [0.1, 0.2],
                |_| NAME,
                |speed| Altered::new(resting().with_surface_speed(Wall::Lid, speed).expect("a lid")),
            ),
        ),
        informed(
            "the time origin is in the fingerprint",
            boundaries([0, 1], |_| NAME, |_| Altered::new(resting()).marked_anew()),
        ),
        blind(
            "the present origin counts",
            boundaries(
                [0.0, 64.0],
                |origin| NAME.number(origin),
                |origin| {
                    let mut boundary = resting();
                    boundary.set_time_origin(origin);
                    Altered::new(boundary)
                },
            ),
        ),
        honest("equal boundaries", boundaries([0, 0], |_| NAME, |_| Altered::new(resting()))),
    ]
}

#[test]
fn the_checks_of_fingerprints_find_planted_faults() {
    let all = of_rules().into_iter().chain(of_motions()).chain(of_boundaries()).collect();
    judge("fingerprint", all, |check: Pair| check());
}
