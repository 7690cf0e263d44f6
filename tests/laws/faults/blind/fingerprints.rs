//! Fingerprints that do not tell parts apart, or that tell equal parts apart.

use granular_edmd::boundary::{Boundary, Container, Obstacles, Thermal, Wall};
use granular_edmd::collision::{
    CollisionRule, Contact, ElasticBelow, Frictional, Impulse, RulesByKind, Smooth,
};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::{AccelerationBounds, BiParabolic, Combined, Sinusoidal, WallMotion, WallState};
use granular_edmd::{Disk, Fingerprint, Kind};

use super::boundaries::marked as marked_boundary;
use super::motions::Motion;
use crate::faults::{List, Planted, tenth};

/// Two parts of one trait.
pub(crate) enum Parts {
    Rules([Box<dyn CollisionRule>; 2]),
    Motions([Motion; 2]),
    Boundaries([Box<dyn Boundary>; 2]),
}

/// Two parts whose fingerprints differ although the parts act alike, or the other way round.
pub(crate) struct Pair {
    pub(crate) parts: Parts,
    /// True if the parts give the same answers, so that their fingerprints must agree.
    pub(crate) act_alike: bool,
}

/// An honest part with a fingerprint of its own.
pub(crate) struct Marked<P>(pub(crate) P, pub(crate) Fingerprint);

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

/// The catalogue while it grows. A function with the fault makes both parts of a pair from their parameters.
type Pairs = List<Pair>;

impl Pairs {
    fn add(&mut self, family: &'static str, name: impl Into<String>, act_alike: bool, parts: Parts) {
        self.family = family;
        self.plant(name, Pair { parts, act_alike });
    }

    fn add_rules<T, R>(
        &mut self,
        name: impl Into<String>,
        act_alike: bool,
        of: [T; 2],
        make: fn(T) -> Marked<R>,
    ) where
        R: CollisionRule + 'static,
    {
        let parts = of.map(|parameters| Box::new(make(parameters)) as Box<dyn CollisionRule>);
        self.add("rules", name, act_alike, Parts::Rules(parts));
    }

    fn add_motions<T, M>(&mut self, name: &str, act_alike: bool, of: [T; 2], make: fn(T) -> Marked<M>)
    where
        M: WallMotion + Send + Sync + 'static,
    {
        let parts = of.map(|parameters| Box::new(make(parameters)) as Motion);
        self.add("motions", name, act_alike, Parts::Motions(parts));
    }

    fn add_boundaries<T>(
        &mut self,
        name: &str,
        act_alike: bool,
        of: [T; 2],
        make: fn(T) -> Box<dyn Boundary>,
    ) {
        self.add("boundaries", name, act_alike, Parts::Boundaries(of.map(make)));
    }
}

/// Returns pairs without a fault.
pub(crate) fn honest() -> Vec<Planted<Pair>> {
    let mut pairs = Pairs::default();
    let whole = |loss| Marked(smooth(loss), Fingerprint::of("smooth").number(loss));
    pairs.add_rules("different", false, [0.1, 0.2], whole);
    pairs.add_rules("equal", true, [0.1, 0.1], whole);
    pairs.faults
}

pub(crate) fn catalogue() -> Vec<Planted<Pair>> {
    List::grown(&[rules, tables, motions, boundaries, states])
}

fn smooth(loss: f64) -> Smooth {
    Smooth::from_inelasticity(loss).expect("an inelasticity")
}

fn frictional([normal, tangential, friction]: [f64; 3]) -> Frictional {
    Frictional::from_inelasticity(normal, tangential, friction).expect("an inelasticity")
}

fn container(width: f64) -> Container {
    Container::closed(width, 12.0).expect("a size")
}

/// "Rules with equal fingerprints must give equal impulses."
fn rules(pairs: &mut Pairs) {
    pairs.add_rules("the name is all", false, [0.1, 0.2], |loss| {
        Marked(smooth(loss), Fingerprint::of("smooth"))
    });
    pairs.add_rules("the friction is forgotten", false, [[0.1, 0.1, 0.3], [0.1, 0.1, 0.5]], |numbers| {
        Marked(frictional(numbers), Fingerprint::of("frictional").number(numbers[0]).number(numbers[1]))
    });
    pairs.add_rules(
        "the sum of two parameters counts",
        false,
        [[0.1, 0.2, 0.5], [0.2, 0.1, 0.5]],
        |numbers| {
            let sum = Fingerprint::of("frictional").number(numbers[0] + numbers[1]);
            Marked(frictional(numbers), sum.number(numbers[2]))
        },
    );
    pairs.add_rules(
        "the sign of a restitution is forgotten",
        false,
        [[0.1, 0.25, 0.5], [0.1, 0.75, 0.5]],
        |numbers: [f64; 3]| {
            let restitution = (1.0 - 2.0 * numbers[1]).abs();
            Marked(frictional(numbers), Fingerprint::of("frictional").number(numbers[0]).number(restitution))
        },
    );
    for n in [3, 6, 10] {
        let name = format!("losses that differ by 1e-{n} are one, by their text");
        pairs.add_rules(name, false, [0.1, 0.1 + tenth(n)], |loss| {
            Marked(smooth(loss), Fingerprint::of("smooth").text(&format!("{loss:.2}")))
        });
    }
    pairs.add_rules("a loss counts in single precision", false, [0.1, 0.1 + 1e-10], |loss| {
        Marked(smooth(loss), Fingerprint::of("smooth").number(f64::from(loss as f32)))
    });
    pairs.add_rules("a remedy forgets the rule that it helps", false, [0.1, 0.2], |loss| {
        let rule = ElasticBelow::new(smooth(loss), 0.01).expect("a speed");
        Marked(rule, Fingerprint::of("remedy").number(0.01))
    });
    pairs.add_rules("a remedy has the fingerprint of its rule", false, [0.01, 0.5], |speed| {
        let rule = ElasticBelow::new(smooth(0.1), speed).expect("a speed");
        Marked(rule, Fingerprint::of("smooth").number(0.1))
    });
}

/// Tables of rules by kind.
fn tables(pairs: &mut Pairs) {
    let table = |first, second, loss| {
        RulesByKind::new(smooth(0.0)).with(Kind::new(first), Kind::new(second), smooth(loss))
    };
    let kinds = [(1, 12), (11, 2)];
    let parts = kinds.map(|(first, second)| {
        let mark = Fingerprint::of("table").text(&format!("{first}{second}"));
        Box::new(Marked(table(first, second, 0.3), mark)) as Box<dyn CollisionRule>
    });
    pairs.add("rules", "the kinds 1 and 12 read like 11 and 2", false, Parts::Rules(parts));
    let parts = kinds.map(|(first, second)| {
        let mark = Fingerprint::of("table").number(f64::from(first + second));
        Box::new(Marked(table(first, second, 0.3), mark)) as Box<dyn CollisionRule>
    });
    pairs.add("rules", "a table counts the sum of two kinds", false, Parts::Rules(parts));
    let parts = [(1, 2), (2, 1)].map(|(first, second)| {
        let mark = Fingerprint::of("table").number(f64::from(first)).number(f64::from(second));
        Box::new(Marked(table(first, second, 0.3), mark)) as Box<dyn CollisionRule>
    });
    pairs.add(
        "rules",
        "a table counts the order in which the kinds of a pair are given",
        true,
        Parts::Rules(parts),
    );
}

/// "The name and all numbers that decide how it moves."
fn motions(pairs: &mut Pairs) {
    let shake = |frequency| Sinusoidal::new(0.1, frequency).expect("an amplitude");
    pairs.add_motions("the frequency is forgotten", false, [3.0, 7.0], |frequency| {
        Marked(Sinusoidal::new(0.1, frequency).expect("an amplitude"), Fingerprint::of("sine").number(0.1))
    });
    pairs.add_motions("the start is forgotten", false, [1.0, 2.0], |start| {
        let motion = Sinusoidal::new(0.1, 3.0).expect("an amplitude");
        Marked(
            Combined::new(motion).delayed_until(start).expect("a start"),
            Fingerprint::of("late").number(0.1).number(3.0),
        )
    });
    pairs.add_motions("the sign of a factor is forgotten", false, [1.0, -1.0], |factor: f64| {
        let motion = Sinusoidal::new(0.1, 3.0).expect("an amplitude");
        Marked(
            Combined::new(motion).scaled(factor).expect("a factor"),
            Fingerprint::of("scaled").number(factor.abs()),
        )
    });
    pairs.add_motions(
        "only the peak speed counts",
        false,
        [[0.25, 4.0], [0.5, 2.0]],
        |[amplitude, frequency]| {
            let motion = Sinusoidal::new(amplitude, frequency).expect("an amplitude");
            Marked(motion, Fingerprint::of("sine").number(amplitude * frequency))
        },
    );
    let mark = Fingerprint::of("motion").number(0.1).number(3.0);
    let arcs = BiParabolic::new(0.1, 3.0).expect("an amplitude");
    let parts: [Motion; 2] = [Box::new(Marked(shake(3.0), mark)), Box::new(Marked(arcs, mark))];
    pairs.add("motions", "two motions have one name", false, Parts::Motions(parts));
}

/// "Its name and everything on which its answers depend."
fn boundaries(pairs: &mut Pairs) {
    pairs.add_boundaries("the width is forgotten", false, [10.0, 14.0], |width| {
        marked_boundary(container(width), Fingerprint::of("box").number(12.0))
    });
    pairs.add_boundaries("the place of an obstacle is forgotten", false, [3.0, 7.0], |x| {
        let peg = Disk::new(DVec2::new(x, 6.0), 1.0).expect("a radius");
        marked_boundary(Obstacles::new(container(10.0), [peg]), Fingerprint::of("board").number(1.0))
    });
    pairs.add_boundaries("the kind of an obstacle is forgotten", false, [1, 2], |kind| {
        let peg = Disk::new(DVec2::new(5.0, 6.0), 1.0).expect("a radius").with_kind(Kind::new(kind));
        marked_boundary(
            Obstacles::new(container(10.0), [peg]),
            Fingerprint::of("board").number(5.0).number(6.0),
        )
    });
    pairs.add_boundaries("the temperature of the floor is forgotten", false, [1.0, 2.0], |temperature| {
        let hot = Thermal::new(temperature).expect("a temperature");
        let hot = container(10.0).with_temperature(Wall::Floor, hot).expect("a floor");
        marked_boundary(hot, Fingerprint::of("hot box").number(10.0))
    });
    pairs.add_boundaries("the rule of a wall is forgotten", false, [0.1, 0.2], |loss| {
        let soft = container(10.0).with_rule(Wall::Left, smooth(loss)).expect("a side");
        marked_boundary(soft, Fingerprint::of("soft box").number(10.0))
    });
    pairs.add_boundaries("the motion of the floor counts by its amplitude", false, [3.0, 7.0], |frequency| {
        let motion = BiParabolic::new(0.1, frequency).expect("an amplitude");
        let shaken = container(10.0).with_motion(Wall::Floor, motion).expect("a floor");
        marked_boundary(shaken, Fingerprint::of("shaken box").number(0.1))
    });
}

/// Fingerprints that change although the part stays: "equal for parts made alike", and "not its state".
fn states(pairs: &mut Pairs) {
    pairs.add_rules("each rule of a program has a number of its own", true, [1.0, 2.0], |number| {
        Marked(smooth(0.1), Fingerprint::of("smooth").number(0.1).number(number))
    });
    pairs.add_motions("the place of the wall at present counts", true, [0.0, 0.3], |time| {
        let motion = Sinusoidal::new(0.1, 3.0).expect("an amplitude");
        Marked(motion, Fingerprint::of("sine").number(motion.state(time).displacement))
    });
    pairs.add_boundaries("the origin of time counts", true, [0.0, 64.0], |origin| {
        let mut boundary = container(10.0);
        boundary.set_time_origin(origin);
        marked_boundary(boundary, Fingerprint::of("box").number(10.0).number(origin))
    });
    pairs.add_boundaries("the spin that blows have given counts", true, [0.0, 0.1], |spin| {
        marked_boundary(container(10.0), Fingerprint::of("drum").number(10.0).number(spin))
    });
}
