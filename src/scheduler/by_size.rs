//! The simplest scheduler, and the default one: the faster scheduler for the number of disks.

use super::{BucketQueue, EventScheduler, NOTHING_DUE, TournamentTree};

/// The simplest scheduler, which searches all times for the earliest at each call.
///
/// It is slow and obviously right, so all other schedulers are tested against it.
#[derive(Debug, Clone, Default)]
pub struct LinearScan {
    due: Vec<f64>,
}

impl LinearScan {
    /// Creates a scheduler without disks.
    pub const fn new() -> Self {
        Self { due: Vec::new() }
    }
}

impl EventScheduler for LinearScan {
    fn reset(&mut self, due: &[f64]) {
        self.due.clear();
        self.due.extend_from_slice(due);
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.due[disk] = due;
    }

    fn earliest(&self) -> (usize, f64) {
        let mut first = NOTHING_DUE;
        for (disk, &due) in self.due.iter().enumerate() {
            // An infinite time is not before the time of `NOTHING_DUE`, but its disk exists.
            if due < first.1 || first.0 == usize::MAX {
                first = (disk, due);
            }
        }
        first
    }
}

/// Number of disks beyond which the system no longer fits into the caches.
///
/// Above this number, events wait for memory, and work that saves memory accesses pays off: a calendar that
/// is turned page by page ([`BucketQueue`]), and early requests for the data of the next events. Below this
/// number, the same work is a loss. The number comes from the program `scaling` in `tools`. The optimum is
/// flat, so one number serves both kinds of work.
pub(crate) const LARGE_SYSTEM: usize = 30_000;

/// A [`TournamentTree`] for fewer than 30 000 disks, and otherwise a [`BucketQueue`].
///
/// ```
/// use granular_edmd::scheduler::{BySize, EventScheduler};
///
/// let mut scheduler = BySize::default();
/// scheduler.reset(&vec![1.0; 100_000]);
/// scheduler.set(70_000, 0.5);
/// assert_eq!(scheduler.earliest(), (70_000, 0.5));
/// ```
#[derive(Debug, Clone, Default)]
pub struct BySize {
    tree: TournamentTree,
    queue: BucketQueue,
    /// True if the queue is in use and the tree is empty; false if the tree is in use and the queue is empty.
    is_large: bool,
}

impl BySize {
    /// Creates a scheduler without disks.
    pub const fn new() -> Self {
        Self { tree: TournamentTree::new(), queue: BucketQueue::new(), is_large: false }
    }
}

impl EventScheduler for BySize {
    fn reset(&mut self, due: &[f64]) {
        let is_large = due.len() >= LARGE_SYSTEM;
        if is_large != self.is_large {
            *self = Self { is_large, ..Self::new() };
        }
        if is_large { self.queue.reset(due) } else { self.tree.reset(due) }
    }

    // In builds with debug assertions, unoptimized tests call the optimized copy of this crate.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn set(&mut self, disk: usize, due: f64) {
        if self.is_large { self.queue.set(disk, due) } else { self.tree.set(disk, due) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn earliest(&self) -> (usize, f64) {
        if self.is_large { self.queue.earliest() } else { self.tree.earliest() }
    }

    #[cfg_attr(not(debug_assertions), inline)]
    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        if self.is_large {
            self.queue.upcoming(disks);
        }
    }
}
