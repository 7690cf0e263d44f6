//! The energy at the start of a run, and whether anything may have added energy since.

/// The energy balance of a run, which shows a rule or a wall that gains energy.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Ledger {
    /// Absolute time at which the run was built.
    pub(in crate::simulation) start: f64,
    /// Kinetic and potential energy at that time.
    pub(in crate::simulation) energy: f64,
    /// True once a disk hit a moving or thermal wall, or disks were changed, added or removed.
    pub(in crate::simulation) has_source: bool,
    /// True while a run is under way. If it is true before a run, a panic interrupted the last run.
    pub(in crate::simulation) is_running: bool,
}

impl Ledger {
    pub(in crate::simulation) const fn new(start: f64, energy: f64, has_source: bool) -> Self {
        Self { start, energy, has_source, is_running: false }
    }
}
