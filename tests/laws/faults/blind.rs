//! Faults written from the documented contracts alone, without a look at the checks that shall find them.
//!
//! Each file has the faults of one trait as its `catalogue`, and the parts on which they are planted, without
//! a fault, as `honest`: a check that refuses one of these is wrong itself.

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
