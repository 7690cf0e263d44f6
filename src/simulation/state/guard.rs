//! The guard against runs that cannot progress.

/// Number of events that are allowed while time advances by less than [`RESOLUTION`] epochs.
const PATIENCE: u64 = 200_000;

/// Number of events that are allowed in addition for each disk. On a lattice, all disks may have an event at
/// the same time.
const PATIENCE_PER_DISK: u64 = 20;

/// Time that counts as progress, in epochs.
///
/// A disk goes some tens of diameters in an epoch. If [`PATIENCE`] events advance time by less than this, an
/// epoch takes 10¹³ events, and days. The bound is not zero, since time does not quite stand still in such a
/// run: a disk at rest on a wall bounces as high as rounding lets it. The bound is not larger, either. Under
/// a contact duration of a ten-millionth of the time that a disk takes for a diameter, a run makes progress
/// even if all disks bounce at once.
const RESOLUTION: f64 = 1.0 / (1u64 << 25) as f64;

/// A counter of events since time last progressed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Guard {
    pub(in crate::simulation) since: f64,
    pub(in crate::simulation) events: u64,
}

impl Guard {
    /// Counts an event. If there were too many without progress, returns their number and starts again from
    /// 0, so that a caller who removes the cause can go on.
    #[inline]
    pub(in crate::simulation) fn watch(
        &mut self,
        time_offset: f64,
        epoch_length: f64,
        disks: usize,
    ) -> Option<u64> {
        if time_offset - self.since > RESOLUTION * epoch_length {
            *self = Self { since: time_offset, events: 0 };
        }
        self.events += 1;
        if self.events > PATIENCE + PATIENCE_PER_DISK * disks as u64 {
            return Some(std::mem::take(&mut self.events));
        }
        None
    }

    /// Measures time from an epoch that is later by this time.
    pub(in crate::simulation) fn shift(&mut self, by: f64) {
        self.since -= by;
    }
}
