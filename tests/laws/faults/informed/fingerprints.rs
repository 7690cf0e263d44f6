//! Fingerprints that forget what shows in few answers only.

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::{
    CollisionRule, Contact, ElasticBelow, Frictional, Impulse, RulesByKind, Smooth,
};
use granular_edmd::wall::{Combined, Sinusoidal, Tabulated, WallMotion};
use granular_edmd::{Fingerprint, Kind};

use crate::faults::blind::boundaries::altered::Altered;
use crate::faults::blind::boundaries::marked;
use crate::faults::blind::fingerprints::{Marked, Pair, Parts};
use crate::faults::blind::motions::Motion;
use crate::faults::{List, Planted};

const NAME: Fingerprint = Fingerprint::of("part");

/// A rule that loses more between two disks of this kind.
struct Soft(Kind);

impl CollisionRule for Soft {
    fn impulse(&self, contact: &Contact) -> Impulse {
        let restitution = if contact.kinds() == [self.0; 2] { 0.5 } else { 0.9 };
        Impulse::new(contact.normal_impulse(restitution), 0.0)
    }
}

fn rules<R: CollisionRule + 'static>(parts: [R; 2], marks: [Fingerprint; 2]) -> Parts {
    let [one, other] = parts;
    Parts::Rules([Box::new(Marked(one, marks[0])), Box::new(Marked(other, marks[1]))])
}

fn motions<M: WallMotion + Send + Sync + 'static>([one, other]: [M; 2], marks: [Fingerprint; 2]) -> Parts {
    let [first, second]: [Motion; 2] = [Box::new(Marked(one, marks[0])), Box::new(Marked(other, marks[1]))];
    Parts::Motions([first, second])
}

/// Returns rules and motions that differ in few answers only, and say so.
pub(crate) fn honest() -> Vec<Planted<Pair>> {
    let mut all = List { family: "honest", faults: Vec::new() };
    let marks = [NAME, NAME.number(1.0)];
    let parts = rules([0.2, 0.3].map(|loss| table(41, loss)), marks);
    all.plant("losses of a pair of larger kinds", Pair { parts, act_alike: false });
    let parts = motions([20.0, 20.5].map(late_ramp), marks);
    all.plant("durations of a late ramp", Pair { parts, act_alike: false });
    let parts = motions([1e7, 1.1e7].map(late), marks);
    all.plant("late starts", Pair { parts, act_alike: false });
    all.faults
}

/// A rule that loses more between disks of kind 40 and of this kind.
fn table(kind: u16, loss: f64) -> RulesByKind<Smooth> {
    let smooth = |loss| Smooth::from_inelasticity(loss).expect("an inelasticity");
    RulesByKind::new(smooth(0.1)).with(Kind::new(40), Kind::new(kind), smooth(loss))
}

fn late(start: f64) -> Combined {
    Combined::new(Sinusoidal::new(0.1, 3.0).expect("an amplitude")).delayed_until(start).expect("a start")
}

fn late_ramp(duration: f64) -> Combined {
    Combined::new(Tabulated::from_to(0.0, 4.0, duration).expect("a duration"))
        .delayed_until(1000.0)
        .expect("a start")
}

pub(crate) fn catalogue() -> Vec<Planted<Pair>> {
    let mut all = List::default();
    let mut add = |family, name: &str, act_alike, parts: Parts| {
        all.family = family;
        all.plant(name, Pair { parts, act_alike });
    };
    let smooth = |loss| Smooth::from_inelasticity(loss).expect("an inelasticity");
    let frictional = |friction| Frictional::from_inelasticity(0.1, 0.1, friction).expect("an inelasticity");
    let below = |speed| ElasticBelow::new(smooth(0.1), speed).expect("a speed");
    add(
        "kind",
        "the kind of a soft pair is forgotten",
        false,
        rules([Soft(Kind::new(5)), Soft(Kind::new(6))], [NAME; 2]),
    );
    add(
        "kind",
        "the kind of a soft pair above 1000 is forgotten",
        false,
        rules([Soft(Kind::new(1001)), Soft(Kind::new(1002))], [NAME; 2]),
    );
    add("threshold", "speeds of 0.010 and 0.011 are one", false, rules([0.010, 0.011].map(below), [NAME; 2]));
    add(
        "last bit",
        "the last bit of a friction is forgotten",
        false,
        rules([0.3, 0.3_f64.next_up()].map(frictional), [NAME; 2]),
    );
    add("zero", "a rule counts its calls", true, rules([0.1, 0.1].map(smooth), [NAME, NAME.number(1.0)]));
    let kinds = rules([41, 42].map(|kind| table(kind, 0.2)), [NAME; 2]);
    add("kind", "one of two larger kinds is forgotten", false, kinds);
    add(
        "kind",
        "the loss between two larger kinds is forgotten",
        false,
        rules([0.2, 0.3].map(|loss| table(41, loss)), [NAME; 2]),
    );
    add(
        "late ramp",
        "the duration of a late ramp is forgotten",
        false,
        motions([20.0, 20.5].map(late_ramp), [NAME; 2]),
    );
    let starts = [1e7, 1.1e7].map(late);
    add("very late start", "starts at 1e7 and 1.1e7 are one", false, motions(starts, [NAME; 2]));
    add("late start", "starts at 300 and 310 are one", false, motions([300.0, 310.0].map(late), [NAME; 2]));
    add(
        "very late start",
        "starts at 3000 and 3100 are one",
        false,
        motions([3000.0, 3100.0].map(late), [NAME; 2]),
    );
    let sine = |_| Sinusoidal::new(0.1, 3.0).expect("an amplitude");
    add(
        "alike",
        "equal motions have numbers of their own",
        true,
        motions([0, 1].map(sine), [NAME, NAME.number(2.0)]),
    );
    let sliding = |speed| -> Box<dyn Boundary> {
        let belt = Container::closed(10.0, 12.0).expect("a size").with_surface_speed(Wall::Lid, speed);
        marked(belt.expect("a lid"), NAME)
    };
    add(
        "belt",
        "the speed of a belt on the lid is forgotten",
        false,
        Parts::Boundaries([0.1, 0.2].map(sliding)),
    );
    let anew = |_| -> Box<dyn Boundary> {
        let honest = Altered::new(Container::closed(10.0, 12.0).expect("a size"));
        Box::new(Altered { mark: Some(NAME), is_marked_anew: true, ..honest })
    };
    add("origin", "the time origin is in the fingerprint", true, Parts::Boundaries([0, 1].map(anew)));
    let kinds = |kind| -> Box<dyn Boundary> {
        let rule = Marked(Soft(Kind::new(kind)), NAME);
        marked(
            Container::closed(10.0, 12.0).expect("a size").with_rule(Wall::Floor, rule).expect("a floor"),
            NAME,
        )
    };
    add(
        "rule of a wall",
        "the kind in the rule of a wall is forgotten",
        false,
        Parts::Boundaries([0, 1].map(kinds)),
    );
    all.faults
}
