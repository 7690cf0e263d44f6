//! Schedulers: which disk's event is the earliest.
//!
//! The engine keeps one event per disk, the earliest that it knows of; a scheduler orders these times and nothing
//! else. Equal times go to the smaller index, so any two schedulers give the same trajectory bit for bit.
//!
//! | scheduler | cost of an event | use |
//! |---|---|---|
//! | [`BySize`] | as the better of the next two | default |
//! | [`TournamentTree`] | `$O(\log N)$`, no branches | up to some ten thousand disks |
//! | [`BucketQueue`] | `$O(1)$` | more |
//! | [`LinearScan`] | `$O(N)$` | the oracle that tests the others |

mod bucket_queue;
mod by_size;
mod entry;
mod linear_scan;
mod tournament_tree;

pub use bucket_queue::BucketQueue;
pub use by_size::BySize;
pub use linear_scan::LinearScan;
pub use tournament_tree::TournamentTree;

/// Orders the events of the disks by time.
///
/// # Contract
/// Times are never NaN; they may be infinite. Of equal times, [`Self::earliest`] names the smallest index. After
/// `reset` with `$n$` times, indices below `$n$` may be `set`; `earliest` of no disks is `(usize::MAX, INFINITY)`.
///
/// ```
/// use granular_edmd::scheduler::{EventScheduler, LinearScan, TournamentTree};
///
/// fn drill(scheduler: &mut impl EventScheduler) {
///     scheduler.reset(&[3.0, 1.0, f64::INFINITY]);
///     assert_eq!(scheduler.earliest(), (1, 1.0));
///     scheduler.set(1, 5.0);
///     scheduler.set(2, 3.0);
///     assert_eq!(scheduler.earliest(), (0, 3.0));
/// }
/// drill(&mut LinearScan::default());
/// drill(&mut TournamentTree::default());
/// ```
pub trait EventScheduler {
    /// Forgets everything and takes these times, one a disk.
    fn reset(&mut self, due: &[f64]);

    /// The event of `disk` is now due at this time.
    fn set(&mut self, disk: usize, due: f64);

    /// The disk whose event is due first, and when. It does not change the scheduler: what is lazy tidies up in `set`.
    fn earliest(&self) -> (usize, f64);

    /// Adds the disks whose events come up soon and have come into sight since this was last called: a hint, so that their
    /// data can be fetched from memory in time. By default there are none; some may be missed, or be named twice.
    fn come_into_sight(&mut self, disks: &mut Vec<usize>) {
        let _ = disks;
    }
}

impl<T: EventScheduler + ?Sized> EventScheduler for Box<T> {
    fn reset(&mut self, due: &[f64]) {
        (**self).reset(due);
    }
    fn set(&mut self, disk: usize, due: f64) {
        (**self).set(disk, due);
    }
    fn earliest(&self) -> (usize, f64) {
        (**self).earliest()
    }
    fn come_into_sight(&mut self, disks: &mut Vec<usize>) {
        (**self).come_into_sight(disks);
    }
}
