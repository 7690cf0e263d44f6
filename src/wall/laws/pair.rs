//! The comparison of two motions with their fingerprints.

use std::iter::successors;

use crate::Violation;
use crate::fingerprint::check_pair;
use crate::wall::WallMotion;
use crate::wall::finite::PART;

/// Number of phases at which two motions are compared, and the length of the interval in which they lie.
const PHASES: u32 = 4000;
const INTERVAL: f64 = 400.0;

/// Number of later phases, each a fifth later than the previous one.
const LATE: i32 = 40;

/// Number of pieces of each motion in which the motions are compared.
const PIECES: usize = 1000;

/// Checks that two motions that move differently have different fingerprints, and that two motions of one
/// type that move alike at every phase of the check have the same fingerprint. Motions without a fingerprint
/// are not compared.
///
/// The motions are compared at four thousand phases from −1 to 399, at forty later phases up to 490 000, and
/// in the first thousand pieces of both after phase −1. The check cannot see other differences. If two such
/// motions are of one type, the check refuses different fingerprints. Motions of two types may move alike and
/// have different fingerprints.
///
/// # Errors
/// If the fingerprints contradict the values.
///
/// ```
/// use granular_edmd::wall::{Sinusoidal, laws};
/// laws::check_fingerprints(&Sinusoidal::new(0.1, 10.0)?, &Sinusoidal::new(0.1, 11.0)?)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_fingerprints<M, N>(first: &M, second: &N) -> Result<(), Violation>
where
    M: WallMotion + ?Sized,
    N: WallMotion + ?Sized,
{
    let differ = |&phase: &f64| first.state(phase) != second.state(phase);
    let phases = (0..PHASES).map(|k| INTERVAL * f64::from(k) / f64::from(PHASES) - 1.0);
    let late = (0..LATE).map(|k| INTERVAL * libm::pow(1.2, f64::from(k)));
    let mut phases = phases.chain(late).chain(phases_of(first)).chain(phases_of(second));
    let mut difference = phases.find(differ).map(|phase| format!("at phase {phase:?}"));
    if (first.reach(), first.period()) != (second.reach(), second.period()) {
        difference = Some("in reach or period".to_owned());
    }
    check_pair::<M, N>(PART, [first.fingerprint(), second.fingerprint()], difference)
}

/// Returns phases at the start of each piece of a motion and within it.
fn phases_of<M: WallMotion + ?Sized>(motion: &M) -> impl Iterator<Item = f64> + '_ {
    let end = |&phase: &f64| Some(motion.acceleration(phase).until).filter(|until| *until > phase);
    let starts = successors(Some(-1.0), end).take(PIECES).filter(|start| start.is_finite());
    starts.flat_map(move |start| {
        let length = motion.acceleration(start).until - start;
        [start, start + 0.37 * length.min(INTERVAL)]
    })
}
