//! Schedulers, which know the disk with the earliest event.
//!
//! The engine keeps one event for each disk, the earliest that is known. A scheduler orders the times of
//! these events, and knows nothing else about them. At equal times, the smaller index comes first, so any two
//! schedulers give the same trajectory bit for bit.
//!
//! | scheduler | cost of an event | use |
//! |---|---|---|
//! | [`BySize`] | the lower of the next two | default |
//! | [`TournamentTree`] | $`O(\log N)`$, no branches | up to tens of thousands of disks |
//! | [`BucketQueue`] | $`O(1)`$ | more |
//! | [`LinearScan`] | $`O(N)`$ | the oracle that tests the others |
//!
//! A custom scheduler implements [`EventScheduler`], and [`laws::check`] tests it in one line.

mod bucket_queue;
pub mod laws;
mod tournament_tree;

use crate::forward::forward;
pub use bucket_queue::BucketQueue;
pub use tournament_tree::TournamentTree;

/// The result of a scheduler without disks.
///
/// No disk has this index, and the time is later than any run lasts. The engine compares the time of each
/// event with the end of the run anyway, and this comparison rejects the result.
pub const NOTHING_DUE: (usize, f64) = (usize::MAX, f64::INFINITY);

/// A scheduler: it orders the events of the disks by their times.
///
/// # Guarantees of a scheduler
/// 1. **The earliest comes first.** [`earliest`](Self::earliest) names the disk whose last given time is the
///    smallest, and that time.
/// 2. **Ties go to the smallest index.** `0.0` and `-0.0` are the same time. If all times are infinite, the
///    disk with the smallest index is named, with its infinite time.
/// 3. **Time may go back.** [`set`](Self::set) takes any time. It may be later than the disk's last time,
///    earlier (because a faster partner has appeared), or even earlier than the last result of `earliest`.
///    After most events, the disk that was just named gets a later time. In the other cases, a scheduler may
///    be slow, but its results must be correct.
/// 4. **Nothing outlives a reset.** [`reset`](Self::reset) may come with more disks, with fewer, or with
///    none.
/// 5. **Without disks**, as before the first `reset`, the result is [`NOTHING_DUE`].
/// 6. **Queries change nothing.** [`earliest`](Self::earliest) returns the same result until the next `set`
///    or `reset`, and a hint of [`upcoming`](Self::upcoming) only appends.
///
/// # Guarantees of the engine
/// - Times are offsets from the epoch of the run, and never NaN. An infinite time stands for an event that
///   never comes.
/// - `reset` is called first, and again whenever many times change together, as when the epoch moves. After a
///   `reset` with $`n`$ times, `set` is called only for disks below $`n`$.
/// - For each event, the engine calls `earliest`, and then `set` for the disks whose next event has changed,
///   mostly one or two. In between, it calls [`upcoming`](Self::upcoming) in systems so large that memory is
///   slow.
///
/// # Schedulers that break the contract
/// The engine compares each result with the event that it keeps: a disk that does not exist, or a time that
/// differs from the last one set for the disk, ends the run with an error. A scheduler that loses a `set` may
/// never name an event that is due. The engine then ends the run with an error, but only when another disk
/// hits the one whose event was lost, when the epoch ends, or at the end of a run or a step once there were
/// as many events as disks since the last check. Checking all disks more often would cost time. Nor does the
/// engine notice that two events were swapped, once both have been named. [`laws::check`] finds such faults
/// if they show within its scripts of up to three million operations; `docs/validation.md` says which planted
/// faults the check finds.
///
/// # A pair instead of an `Option`
/// The engine calls [`earliest`](Self::earliest) at every event. A pair comes back in two registers, and
/// [`NOTHING_DUE`] fails the comparison with the end of the run, which is needed anyway. An `Option` would
/// add a branch to each event, and no information.
///
/// ```
/// use granular_edmd::scheduler::{EventScheduler, LinearScan, NOTHING_DUE, TournamentTree};
///
/// fn drill(scheduler: &mut impl EventScheduler) {
///     assert_eq!(scheduler.earliest(), NOTHING_DUE);
///     scheduler.reset(&[3.0, 1.0, f64::INFINITY]);
///     assert_eq!(scheduler.earliest(), (1, 1.0));
///     scheduler.set(1, 5.0);
///     scheduler.set(2, 3.0);
///     assert_eq!(scheduler.earliest(), (0, 3.0));
/// }
/// drill(&mut LinearScan::default());
/// drill(&mut TournamentTree::default());
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scheduler of events",
    label = "this type does not implement `EventScheduler`",
    note = "the default is `BySize::new()`; `&mut S` and `Box<dyn EventScheduler>` will do, too",
    note = "a custom scheduler implements `reset`, `set` and `earliest`; `laws::check` tests it"
)]
#[expect(unused_variables, reason = "what is shown need not be looked at")]
pub trait EventScheduler {
    /// Replaces all disks and times by these times, one for each disk.
    fn reset(&mut self, due: &[f64]);

    /// Sets a new time for the event of `disk`, in place of its last one.
    ///
    /// The new time may be earlier or later.
    fn set(&mut self, disk: usize, due: f64);

    /// Returns the disk whose event is due first, and its time, or [`NOTHING_DUE`] without disks.
    ///
    /// This method changes nothing: a lazy scheduler removes outdated entries in `set`.
    fn earliest(&self) -> (usize, f64);

    /// Appends the disks whose events are due soon and that have not been named yet, if the scheduler knows
    /// them.
    ///
    /// The list is a hint: the engine prefetches the data that these events will need. The call changes
    /// neither the order of events nor the disks that `disks` holds already. Disks may be missing, or be
    /// named twice or in any order. The engine ignores disks that do not exist. The default names no disk. A
    /// scheduler that wraps another should pass the call on: otherwise, a run of 10⁵ disks takes 50 % longer.
    fn upcoming(&mut self, disks: &mut Vec<usize>) {}
}

forward! { EventScheduler for [&mut T, Box<T>] {
    fn earliest(&self) -> (usize, f64);
    mut
    fn reset(&mut self, due: &[f64]);
    fn set(&mut self, disk: usize, due: f64);
    fn upcoming(&mut self, disks: &mut Vec<usize>);
}}

/// A disk with the time at which it is due, ordered by time and then by disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    /// The time as an integer, in the same order.
    order: u64,
    disk: usize,
}

const SIGN: u64 = 1 << 63;

impl Entry {
    /// The entry of no disk, which comes after all others.
    const EMPTY: Self = Self { order: u64::MAX - 1, disk: usize::MAX };

    #[inline]
    fn new(disk: usize, due: f64) -> Self {
        // Adding 0 turns -0 into 0, so that both zeros are the same time. The bits of a positive float grow
        // with the float, and the bits of a negative one with its magnitude. For a negative float, all bits
        // are flipped; for a positive one, only the sign.
        let bits = (due + 0.0).to_bits();
        Self { order: if bits & SIGN == 0 { bits | SIGN } else { !bits }, disk }
    }

    #[inline]
    fn due(self) -> f64 {
        f64::from_bits(if self.order & SIGN == 0 { !self.order } else { self.order & !SIGN })
    }

    /// Returns the result of [`EventScheduler::earliest`] if this entry is
    /// the first.
    #[inline]
    fn answer(self) -> (usize, f64) {
        if self == Self::EMPTY { NOTHING_DUE } else { (self.disk, self.due()) }
    }
}

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
