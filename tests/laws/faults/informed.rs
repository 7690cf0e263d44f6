//! Faults written by those who know the checks, and aimed at what they may overlook: between their samples,
//! beyond their ranges, and in the parts of an answer that they compare last.

pub(crate) mod boundaries;
pub(crate) mod fingerprints;
pub(crate) mod motions;
pub(crate) mod observers;
pub(crate) mod rules;
pub(crate) mod schedulers;

use super::named;

/// Returns the names of all faults, each after the name of its trait.
pub(crate) fn names() -> Vec<String> {
    [
        named("rule", &rules::catalogue()),
        named("motion", &motions::catalogue()),
        named("boundary", &boundaries::catalogue()),
        named("scheduler", &schedulers::catalogue()),
        named("observer", &observers::catalogue()),
        named("fingerprint", &fingerprints::catalogue()),
    ]
    .concat()
}
