//! Planted faults that the checks do not find, each with the reason.

/// Names of faults, and reasons.
pub(crate) const SURVIVORS: [(&str, &str); 0] = [];
