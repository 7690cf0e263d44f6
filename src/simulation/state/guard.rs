//! The guard against runs that cannot progress.

/// Events allowed while time advances by less than [`RESOLUTION`] epochs: so many, and as many more for each disk, since
/// disks on a lattice may all have something to do at the same time.
const PATIENCE: u64 = 200_000;
const PATIENCE_PER_DISK: u64 = 20;

/// Time that counts as progress, in epochs: at less for so many events an epoch, in which a disk goes some tens of
/// diameters, would take days.
///
/// Time need not stand still for that: a disk at rest on a wall bounces as high as rounding lets it. On the other side, a
/// contact duration of a ten-millionth of the time that a disk takes for a diameter is progress even if all bounce at once.
const RESOLUTION: f64 = 1.0 / (1u64 << 25) as f64;

/// Counts events since time last progressed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Guard {
    pub(in crate::simulation) since: f64,
    pub(in crate::simulation) events: u64,
}

impl Guard {
    /// Takes note of an event; returns how many there were without progress, if too many, and starts afresh: whoever
    /// mends the cause may go on.
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

    /// The epoch has moved.
    pub(in crate::simulation) fn shift(&mut self, by: f64) {
        self.since -= by;
    }
}
