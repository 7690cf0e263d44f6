//! Parts of the analysis that are not public.
#![allow(
    dead_code,
    unreachable_pub,
    unfulfilled_lint_expectations,
    reason = "the tests need some of them, and the library shows some"
)]

#[path = "../../src/analysis/clusters.rs"]
pub(crate) mod clusters;
