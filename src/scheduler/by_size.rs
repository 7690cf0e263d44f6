//! The default scheduler: whichever of the others is the fastest for so many disks.

use super::{BucketQueue, EventScheduler, TournamentTree};

/// Disks from which on the bucket queue is faster: at 10⁴ either is, at 10⁵ it takes a third of the time; `cargo bench --bench
/// scaling`.
const MANY: usize = 30_000;

/// A [`TournamentTree`] for fewer than 30 000 disks, a [`BucketQueue`] for more.
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
    /// Whether it is the queue that counts; the other is empty.
    many: bool,
}

impl BySize {
    /// A scheduler of no disks.
    pub const fn new() -> Self {
        Self { tree: TournamentTree::new(), queue: BucketQueue::new(), many: false }
    }
}

impl EventScheduler for BySize {
    fn reset(&mut self, due: &[f64]) {
        let many = due.len() >= MANY;
        if many != self.many {
            *self = Self { many, ..Self::new() };
        }
        if many { self.queue.reset(due) } else { self.tree.reset(due) }
    }

    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        if self.many { self.queue.set(disk, due) } else { self.tree.set(disk, due) }
    }

    #[inline]
    fn earliest(&self) -> (usize, f64) {
        if self.many { self.queue.earliest() } else { self.tree.earliest() }
    }

    #[inline]
    fn come_into_sight(&mut self, disks: &mut Vec<usize>) {
        if self.many {
            self.queue.come_into_sight(disks);
        }
    }
}
