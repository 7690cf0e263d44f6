//! Planted faults, by which the conformance checks are judged: parts that break the contracts of their
//! traits.

mod alarms;
mod boundaries;
mod fingerprints;
mod motions;
mod observers;
mod rules;
mod schedulers;

use std::sync::atomic::{AtomicU64, Ordering};

use granular_edmd::Violation;
use support::measured::measured;

/// Whose fault it is: written from the contract alone, or by someone who knows what the check looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Half {
    Blind,
    Informed,
    /// No fault: the check must accept the part.
    Honest,
    /// A fault that the check does not find.
    Survivor,
}

/// A part, and a sentence that says what is wrong with it.
struct Fault<T>(Half, &'static str, T);

fn blind<T>(name: &'static str, part: T) -> Fault<T> {
    Fault(Half::Blind, name, part)
}

fn informed<T>(name: &'static str, part: T) -> Fault<T> {
    Fault(Half::Informed, name, part)
}

fn survivor<T>(name: &'static str, part: T) -> Fault<T> {
    Fault(Half::Survivor, name, part)
}

fn honest<T>(name: &'static str, part: T) -> Fault<T> {
    Fault(Half::Honest, name, part)
}

/// Checks that each fault is found and each honest part passes, and writes down the shares.
fn judge<T>(part: &str, faults: Vec<Fault<T>>, check: impl Fn(T) -> Result<(), Violation>) {
    let (mut wrong, mut counts) = (Vec::new(), [[0; 2]; 2]);
    for Fault(half, name, part) in faults {
        let verdict = check(part);
        if let Half::Blind | Half::Informed = half {
            let [found, planted] = &mut counts[usize::from(half == Half::Informed)];
            (*found, *planted) = (*found + u32::from(verdict.is_err()), *planted + 1);
        }
        if verdict.is_err() != matches!(half, Half::Blind | Half::Informed) {
            wrong.push(format!("{half:?}: {name}: {verdict:?}"));
        }
    }
    for (half, [found, planted]) in ["blind", "informed"].into_iter().zip(counts) {
        measured(&format!("{part}, {half}, found"), found);
        measured(&format!("{part}, {half}, planted"), planted);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Returns a function that is true in one call in `n`: a state that hides from the caller.
fn one_in(n: u64) -> impl Fn() -> bool + Send + Sync {
    let calls = AtomicU64::new(0);
    move || (calls.fetch_add(1, Ordering::Relaxed) + 1).is_multiple_of(n)
}
