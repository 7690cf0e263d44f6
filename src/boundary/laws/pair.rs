//! The comparison of two boundaries with their fingerprints.

use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::surface::in_words;
use super::trial::{PART, Trial};
use super::{KINDS, Random};
use crate::boundary::{Boundary, FirstTouch, Region};
use crate::error::require;
use crate::fingerprint::check_pair;
use crate::{Flight, Kind, Violation};

/// Number of flights on which two boundaries are compared.
const FLIGHTS: usize = 1000;

/// Number of contacts in which the rules of two walls are compared.
const CONTACTS: usize = 300;

/// Checks that two boundaries with different results have different fingerprints, and that two boundaries of
/// one type with equal results on a thousand flights have the same fingerprint. Boundaries without a
/// fingerprint are not compared.
///
/// The flights are as in [`check`](super::check), with the same ranges of times and kinds. The check cannot
/// see other differences, for example walls that begin to move later. If two such boundaries are of one type,
/// the check refuses different fingerprints. Boundaries of two types may act alike and have different
/// fingerprints.
///
/// The check sets the time origins of both boundaries, which must not change their fingerprints, and gives
/// the second the state of the first.
///
/// # Errors
/// If the fingerprints contradict the results.
///
/// ```
/// use granular_edmd::boundary::{Container, laws};
/// let (mut narrow, mut wide) = (Container::closed(8.0, 6.0)?, Container::closed(9.0, 6.0)?);
/// laws::check_fingerprints(&mut narrow, &mut wide, 0.5, 1.0)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_fingerprints<A, B>(
    first: &mut A,
    second: &mut B,
    radius: f64,
    speed: f64,
) -> Result<(), Violation>
where
    A: Boundary + ?Sized,
    B: Boundary + ?Sized,
{
    let (domain, other) = (first.domain(), second.domain());
    let fingerprints = [first.fingerprint(), second.fingerprint()];
    let judge = |difference| check_pair::<A, B>(PART, fingerprints, difference);
    if (domain, first.interior()) != (other, second.interior()) {
        return judge(Some(format!("in their domains {domain} and {other}")));
    }
    let mut random = Random(Xoshiro256PlusPlus::seed_from_u64(7));
    let (mut first, mut second) = (first, second);
    let mut one = Trial::new(&mut first, domain, radius, speed);
    let mut other = Trial::new(&mut second, domain, radius, speed);
    let are_alike = one.state == other.state;
    for number in 0..FLIGHTS {
        one.kind = Kind::new(KINDS[number % KINDS.len()]);
        other.kind = one.kind;
        // `check` refuses a boundary without room. Here, nothing is left to compare.
        let Ok(Some((origin, flight))) = random.flight(&mut one) else { break };
        // Fingerprints do not depend on the present state of the walls, so the results are compared in the
        // same one.
        one.begin(origin)?;
        other.set_origin(origin);
        let kept = [one.boundary.fingerprint(), other.boundary.fingerprint()];
        require!(PART, "fingerprint", kept == fingerprints;
            "with the time origin {origin:?}, the walls are alike, but the fingerprints are {kept:?}, and were \
             {fingerprints:?}");
        if other.take_state(&one.state).is_err() {
            return judge(Some("in their states".to_owned()));
        }
        let until = flight.time() + one.crossing();
        let answers = [answer(&one, &flight, until), answer(&other, &flight, until)];
        if answers[0] != answers[1] {
            return judge(Some(format!("on {flight:?}: {answers:?}")));
        }
    }
    // Walls that differ at first and agree later may or may not have the same fingerprint.
    if are_alike { judge(None) } else { Ok(()) }
}

/// Returns the results of a boundary for a flight, as text.
fn answer(trial: &Trial<'_>, flight: &Flight, until: f64) -> String {
    let (start, boundary) = (flight.time(), &*trial.boundary);
    let place = flight.position(start);
    let gap = trial.gap().at(place, trial.length(), start);
    let around = DVec2::splat(flight.radius());
    let area = boundary.area(&Region::new(place - around, place + around), flight.radius(), start);
    let touch = boundary.first_touch(flight, until);
    let surface = match touch {
        FirstTouch::At(touch) => {
            in_words(&boundary.surface(touch.wall, flight.position(touch.time), touch.time), CONTACTS)
        }
        FirstTouch::NotBefore(_) => String::new(),
    };
    format!("{gap:?}, {area:?}, {touch:?}, {surface}")
}
