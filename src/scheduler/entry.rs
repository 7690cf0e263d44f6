//! A disk and its time.

/// A disk and when it is due, ordered by time and then by disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Entry {
    /// The time as a number that is in the order of times.
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
    /// What stands where no disk is: later than any time.
    pub(super) const EMPTY: Self = Self { order: u64::MAX - 1, disk: usize::MAX };

    #[inline]
    pub(super) fn new(disk: usize, due: f64) -> Self {
        // Adding 0 makes the two zeros equal. Negative floats are in the reverse order of their bits.
        let bits = (due + 0.0).to_bits();
        Self { order: if bits & SIGN == 0 { bits | SIGN } else { !bits }, disk }
    }

    #[inline]
    pub(super) fn due(self) -> f64 {
        f64::from_bits(if self.order & SIGN == 0 { !self.order } else { self.order & !SIGN })
    }

    /// What [`EventScheduler::earliest`](super::EventScheduler::earliest) answers if this is the first.
    #[inline]
    pub(super) fn answer(self) -> (usize, f64) {
        if self == Self::EMPTY { (usize::MAX, f64::INFINITY) } else { (self.disk, self.due()) }
    }
}
