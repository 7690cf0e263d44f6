//! The time of a run as an offset from an epoch that moves on, and the energy at the start.

use super::guard::{EVENTS_PER_HORIZON, Guard};
use crate::simulation::errors::{Outcome, RunError};

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

/// Smallest number of floating-point times in an epoch. Between two such times, a typical disk then moves by
/// at most about a diameter.
///
/// These few times are enough, because the lengths of epochs are powers of two, and so are the distances
/// between these times. Adding an epoch to the origin is therefore exact, and moving walls do not jump.
const TIMES_IN_EPOCH: f64 = 64.0;

/// The present, and the epoch from which it is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Clock {
    /// The epoch: the absolute time of the offset 0.
    pub(in crate::simulation) origin: f64,
    /// The present, as an offset from the epoch.
    pub(in crate::simulation) now: f64,
    /// The offset after which the epoch moves.
    pub(in crate::simulation) epoch_length: f64,
    pub(in crate::simulation) guard: Guard,
    /// Number of events until the run checks its limits and its guard again: 1 if a check is due at the next
    /// event. No outcome depends on it.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(in crate::simulation) events_to_look: u64,
    /// The numbers of cell crossings and of collisions of two disks when the epoch last moved.
    pub(in crate::simulation) tally: [u64; 2],
}

impl Clock {
    pub(in crate::simulation) fn new(origin: f64, epoch_length: f64) -> Self {
        Self { origin, now: 0.0, epoch_length, guard: Guard::default(), events_to_look: 1, tally: [0; 2] }
    }

    /// Returns the present in absolute time.
    #[inline]
    pub(in crate::simulation) fn time(&self) -> f64 {
        self.origin + self.now
    }

    /// Advances to an absolute time. All events up to and including it have been carried out.
    pub(in crate::simulation) fn advance_to(&mut self, time: f64) {
        let offset = time - self.origin;
        // The difference is rounded. It must neither pass the time, nor set the run back to before its last
        // event.
        let is_after = self.origin + offset > time;
        self.now = self.now.max(if is_after { offset.next_down() } else { offset });
    }

    /// Returns the largest difference between the present and the time up to which a run was to advance.
    pub(in crate::simulation) fn rounding(&self) -> f64 {
        4.0 * f64::EPSILON * (self.origin.abs() + self.now.abs())
    }

    /// Returns the spacing of absolute times at the end of the epoch that begins at this offset, if it is too
    /// coarse. The epoch could then not be added to the origin, and time would stand still.
    pub(in crate::simulation) fn coarseness(&self, offset: f64) -> Option<f64> {
        let end = (self.origin + offset).abs() + self.epoch_length;
        let spacing = end.next_up() - end;
        let is_fine = spacing * TIMES_IN_EPOCH <= self.epoch_length;
        (!is_fine).then_some(spacing)
    }

    /// Checks that the epoch that begins at this offset can be added to the origin.
    pub(in crate::simulation) fn check_coarseness(&self, offset: f64) -> Outcome<()> {
        match self.coarseness(offset) {
            Some(spacing) => {
                let (time, epoch) = (self.time(), self.epoch_length);
                Err(Box::new(RunError::TimeTooLate { time, spacing, epoch }))
            }
            None => Ok(()),
        }
    }

    /// Returns the total length of the whole epochs before an offset.
    pub(in crate::simulation) fn whole_epochs(&self, offset: f64) -> f64 {
        (offset / self.epoch_length).floor() * self.epoch_length
    }

    /// Returns the largest offset, not after the present, by which the epoch can move without any rounding.
    ///
    /// Late origins have fewer digits than offsets. If the epoch moved to the present itself, its origin
    /// would be rounded. A moving wall would then jump by the distance that it moves in the rounded time,
    /// sometimes into a disk. The difference of two close numbers is exact, so this offset moves the origin
    /// exactly to a floating-point number, and the rest stays in the offset of the present.
    pub(in crate::simulation) fn exact_offset(&self) -> f64 {
        let nearest = self.time();
        // At times beyond twice the origin, the difference below need not be exact. Times are then no coarser
        // than offsets, and the epoch may move to the present itself.
        if self.now > self.origin.abs() {
            return self.now;
        }
        let by = nearest - self.origin;
        if by <= self.now { by } else { nearest.next_down() - self.origin }
    }

    /// Counts an event, and returns whether limits and guard are due to be checked.
    #[inline]
    pub(in crate::simulation) fn is_look_due(&mut self) -> bool {
        self.events_to_look -= 1;
        self.events_to_look == 0
    }

    /// Counts the steps of a search that has ended at its horizon, as if they were events.
    #[inline]
    pub(in crate::simulation) fn count_search(&mut self) {
        self.events_to_look = self.events_to_look.saturating_sub(EVENTS_PER_HORIZON).max(1);
    }

    /// Moves the epoch forward by this time.
    pub(in crate::simulation) fn shift(&mut self, by: f64) {
        self.origin += by;
        self.now -= by;
        self.guard.shift(by);
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::Clock;

    #[test]
    fn an_epoch_that_begins_for_a_kick_takes_time_neither_back_nor_on() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(1);
        for _ in 0..100_000 {
            let sign = if generator.random() { 1.0 } else { -1.0 };
            let mut size = || libm::scalbn(generator.random(), generator.random_range(-30..30));
            let (origin, now) = (sign * size(), size());
            let mut clock = Clock { now, ..Clock::new(origin, 1.0) };
            let (time, by) = (clock.time(), clock.exact_offset());
            clock.shift(by);
            assert!(clock.now >= 0.0, "{origin:e} {now:e}");
            assert_eq!(clock.time(), time, "{origin:e} {now:e}");
        }
    }
}
