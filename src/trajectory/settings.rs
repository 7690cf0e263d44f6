//! Settings of a reader for data that a file lacks.

/// The settings of a [`Reader`](super::Reader) for data that a file lacks, or gives in few digits.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Settings {
    pub(super) tolerance: Option<f64>,
    pub(super) shrinks: bool,
    pub(super) density: Option<f64>,
    pub(super) radius: Option<f64>,
}
