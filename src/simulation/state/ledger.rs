//! The energy at the start of a run, and whether anything may have added energy since.

/// The energy balance of a run. It reveals a rule or a wall that adds energy.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Ledger {
    /// Absolute time at which the number of disks last changed, or at which the run was built.
    since: f64,
    /// Sum of the times that all disks had spent in the run before that time.
    disk_time: f64,
    /// Kinetic and potential energy when the run was built, or when disks, walls or gravity last changed
    /// between two runs, less what the remedy `LeastRebound` had added by then.
    pub(in crate::simulation) energy: f64,
    /// True once a disk has hit a moving or thermal wall, has come in or has left since then.
    pub(in crate::simulation) has_source: bool,
    /// True while a run is under way. If it is true before a run, a panic interrupted the last run.
    pub(in crate::simulation) is_running: bool,
}

impl Ledger {
    pub(in crate::simulation) const fn new(start: f64, energy: f64) -> Self {
        Self { since: start, disk_time: 0.0, energy, has_source: false, is_running: false }
    }

    /// Begins a new balance of the energy.
    pub(in crate::simulation) const fn balance_anew(&mut self, energy: f64) {
        (self.energy, self.has_source) = (energy, false);
    }

    /// Returns the sum of the times that all disks have spent in the run, which now has `disks` disks.
    pub(in crate::simulation) fn disk_time_at(&self, now: f64, disks: usize) -> f64 {
        self.disk_time + disks as f64 * (now - self.since)
    }

    /// Notes that the number of disks changes. It was `before` until now.
    pub(in crate::simulation) fn count(&mut self, now: f64, before: usize) {
        (self.disk_time, self.since, self.has_source) = (self.disk_time_at(now, before), now, true);
    }
}
