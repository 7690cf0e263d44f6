//! Marks, by which observers recognize systems and their walls.

use std::sync::atomic::{AtomicUsize, Ordering};

/// A mark that is unique in this process; 0 until it is assigned.
///
/// It is not written to files, and measurements that differ only in marks compare equal.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Mark(usize);

impl Mark {
    /// No mark.
    pub(super) const NONE: Self = Self(0);

    /// Returns a new mark.
    pub(crate) fn new() -> Self {
        static NEXT: AtomicUsize = AtomicUsize::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }

    /// Returns whether both marks are assigned and equal.
    pub(super) const fn is_same(self, other: Self) -> bool {
        self.0 == other.0 && self.0 != 0
    }

    /// Returns whether both marks are assigned and different.
    pub(super) const fn is_other(self, other: Self) -> bool {
        self.0 != other.0 && self.0 != 0 && other.0 != 0
    }
}

impl PartialEq for Mark {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
