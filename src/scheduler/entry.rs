//! Entries of schedulers: a disk and its time.

use super::NOTHING_DUE;

/// A disk with the time at which it is due, ordered by time and then by disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Entry {
    /// The time as an integer, in the same order.
    pub(super) order: u64,
    pub(super) disk: usize,
}

const SIGN: u64 = 1 << 63;

impl Default for Entry {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Entry {
    /// The entry of no disk, which comes after all others.
    pub(super) const EMPTY: Self = Self { order: u64::MAX - 1, disk: usize::MAX };

    #[inline]
    pub(super) fn new(disk: usize, due: f64) -> Self {
        // Adding 0 turns -0 into 0, so that both zeros are the same time. The bits of a positive float grow
        // with the float, and the bits of a negative one with its magnitude. For a negative float, all bits
        // are flipped; for a positive one, only the sign.
        let bits = (due + 0.0).to_bits();
        Self { order: if bits & SIGN == 0 { bits | SIGN } else { !bits }, disk }
    }

    #[inline]
    pub(super) fn due(self) -> f64 {
        f64::from_bits(if self.order & SIGN == 0 { !self.order } else { self.order & !SIGN })
    }

    /// Returns the result of [`EventScheduler::earliest`](super::EventScheduler::earliest) if this entry is
    /// the first.
    #[inline]
    pub(super) fn answer(self) -> (usize, f64) {
        if self == Self::EMPTY { NOTHING_DUE } else { (self.disk, self.due()) }
    }
}
