//! The time of a run, as an offset from an epoch that moves on.

use super::guard::Guard;
use crate::simulation::errors::{Outcome, RunError};

/// Numbers that a run's latest times must tell apart in an epoch: a typical disk goes a diameter from one to the next.
///
/// So few are enough, since epochs are powers of two, as the distance of these numbers is: adding one to the origin is exact, and
/// walls that move do not jump.
const TIMES_IN_EPOCH: f64 = 64.0;

/// Cell crossings and collisions of two disks, as they were when the epoch last moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Tally {
    pub(in crate::simulation) cell_crossings: u64,
    pub(in crate::simulation) collisions: u64,
}

/// The present and the epoch that it is measured from.
#[derive(Debug, Clone, Copy)]
pub(in crate::simulation) struct Clock {
    /// The epoch: the absolute time of the offset 0.
    pub(in crate::simulation) origin: f64,
    /// The present, as an offset from the epoch.
    pub(in crate::simulation) now: f64,
    /// The offset from which on the epoch moves.
    pub(in crate::simulation) epoch_length: f64,
    pub(in crate::simulation) guard: Guard,
    pub(in crate::simulation) tally: Tally,
}

impl Clock {
    pub(in crate::simulation) fn new(origin: f64, epoch_length: f64) -> Self {
        Self { origin, now: 0.0, epoch_length, guard: Guard::default(), tally: Tally::default() }
    }

    /// The present in absolute time.
    #[inline]
    pub(in crate::simulation) fn time(&self) -> f64 {
        self.origin + self.now
    }

    /// The largest difference by which the present may miss a time that was run to.
    pub(in crate::simulation) fn rounding(&self) -> f64 {
        4.0 * f64::EPSILON * (self.origin.abs() + self.now.abs())
    }

    /// The distance of absolute times at the end of the epoch that begins at this offset, where that is too coarse: the epoch
    /// could not be added to the origin, and time would stand still.
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

    /// The whole epochs until an offset.
    pub(in crate::simulation) fn whole_epochs(&self, offset: f64) -> f64 {
        (offset / self.epoch_length).floor() * self.epoch_length
    }

    /// The largest offset, not after the present, by which the epoch can move with nothing lost in rounding.
    ///
    /// Late origins have fewer digits than offsets. If the epoch moved to the present itself, its origin would be rounded, and a
    /// wall that moves would jump by as much of its way: into a disk, at times. The difference of two numbers that are close
    /// is exact, so this moves the origin to a number that it can be, and leaves the rest to the offset.
    pub(in crate::simulation) fn exact_offset(&self) -> f64 {
        let nearest = self.time();
        // Beyond twice the origin their difference need not be exact. Then times are no coarser than offsets, and the epoch
        // may move to the present itself.
        if self.now > self.origin.abs() {
            return self.now;
        }
        let by = nearest - self.origin;
        if by <= self.now { by } else { nearest.next_down() - self.origin }
    }

    /// Takes note of an event of so many disks; returns how many there were without progress, if too many.
    #[inline]
    pub(in crate::simulation) fn watch(&mut self, disks: usize) -> Option<u64> {
        self.guard.watch(self.now, self.epoch_length, disks)
    }

    /// Moves the epoch on.
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
            let origin = sign * f64::powi(2.0, generator.random_range(-30..30)) * generator.random::<f64>();
            let now = f64::powi(2.0, generator.random_range(-30..30)) * generator.random::<f64>();
            let mut clock = Clock { now, ..Clock::new(origin, 1.0) };
            let (time, by) = (clock.time(), clock.exact_offset());
            clock.shift(by);
            assert!(clock.now >= 0.0, "{origin:e} {now:e}");
            assert_eq!(clock.time(), time, "{origin:e} {now:e}");
        }
    }
}
