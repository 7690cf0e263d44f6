//! Settings of a reader for what a file leaves open.

/// The answers of a [`Reader`](super::Reader) to what a file does not say, or says in few digits.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Settings {
    pub(super) tolerance: Option<f64>,
    pub(super) shrinks: bool,
    pub(super) density: Option<f64>,
    pub(super) radius: Option<f64>,
}
