//! Schedulers: the disk whose event is the earliest.
//!
//! The engine keeps one event for each disk, the earliest that it knows of. A scheduler puts the times of
//! these events in order and knows nothing else of them. Equal times go to the smaller index, so any two
//! schedulers give the same trajectory bit for bit.
//!
//! | scheduler | cost of an event | use |
//! |---|---|---|
//! | [`BySize`] | as the better of the next two | default |
//! | [`TournamentTree`] | `$O(\log N)$`, no branches | up to some ten thousand disks |
//! | [`BucketQueue`] | `$O(1)$` | more |
//! | [`LinearScan`] | `$O(N)$` | the oracle that tests the others |
//!
//! A scheduler of your own implements [`EventScheduler`] and is tested in one line by [`laws::check`].

mod bucket_queue;
mod by_size;
mod entry;
pub mod laws;
mod linear_scan;
mod tournament_tree;

pub use bucket_queue::BucketQueue;
pub use by_size::BySize;
pub(crate) use by_size::LARGE_SYSTEM;
pub use linear_scan::LinearScan;
pub use tournament_tree::TournamentTree;

/// The answer of a scheduler without disks: no disk, never.
///
/// Its index is that of no disk and its time is after the end of any run, so the comparison with the end,
/// which the engine makes at each event anyway, rejects it.
pub const NOTHING_DUE: (usize, f64) = (usize::MAX, f64::INFINITY);

/// Puts the events of the disks in the order of their times.
///
/// # What an implementer guarantees
/// 1. **The earliest comes first.** [`earliest`](Self::earliest) names the disk with the smallest of the times
///    last given for each disk, and that time.
/// 2. **Ties go to the smallest index.** `0.0` and `-0.0` are the same time. Where all times are infinite,
///    the disk with the smallest index is named, with its infinite time.
/// 3. **Time may go back.** [`set`](Self::set) takes any time: later than that of the disk before, or
///    earlier, because a faster partner has appeared, or earlier than the last answer. After most events the
///    disk just named gets a later time; a scheduler may be slow in the other cases, but not wrong.
/// 4. **Nothing outlives a reset.** [`reset`](Self::reset) may come with more disks, with fewer, or with
///    none.
/// 5. Without disks, as before the first `reset`, the answer is [`NOTHING_DUE`].
///
/// # What the engine guarantees
/// - Times are offsets from the epoch of the run, never NaN. They may be infinite: an event that never comes.
/// - `reset` comes first, and again whenever many times change at once, as when the epoch moves. After a
///   `reset` with `$n$` times only disks below `$n$` are `set`.
/// - For each event it asks `earliest`, then, in systems so large that memory is slow,
///   [`upcoming`](Self::upcoming), and then sets the disks whose next event has changed: mostly one or two.
///
/// # What happens otherwise
/// The engine compares each answer with the event that it keeps: a disk that does not exist, or a time other
/// than the last one set for it, ends the run with an error. A disk that is named although another one is due
/// before it cannot be noticed at this price; events then come out of order and the trajectory is wrong.
/// [`laws::check`] finds both kinds of fault.
///
/// # The answer is a pair, not an `Option`
/// It is asked for at every event. A pair comes back in two registers, and [`NOTHING_DUE`] fails the
/// comparison with the end of the run that is needed in any case; an `Option` would add a branch to each
/// event and say no more.
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
    note = "the default is `scheduler::BySize::new()`; `&mut S` and `Box<dyn EventScheduler>` will do, too",
    note = "one of your own implements `reset`, `set` and `earliest`; `scheduler::laws::check` tests it"
)]
pub trait EventScheduler {
    /// Forgets everything and takes these times, one for each disk.
    fn reset(&mut self, due: &[f64]);

    /// Takes a new time for the event of `disk`, in place of its last one; it may be earlier or later.
    fn set(&mut self, disk: usize, due: f64);

    /// Returns the disk whose event is due first, and its time; [`NOTHING_DUE`] without disks.
    ///
    /// It only looks: a lazy scheduler removes what is out of date in `set`.
    fn earliest(&self) -> (usize, f64);

    /// Appends the disks whose events are due soon and that have not been named yet, if the scheduler knows
    /// them.
    ///
    /// A hint, by which the engine asks the memory in time for what their events will need. It changes
    /// neither the order of events nor what `disks` holds already. Disks may be missing, or be named twice or
    /// in any order; those that do not exist are ignored by the engine. By default none is named.
    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        let _ = disks;
    }
}

impl<T: EventScheduler + ?Sized> EventScheduler for &mut T {
    #[inline]
    fn reset(&mut self, due: &[f64]) {
        (**self).reset(due);
    }
    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        (**self).set(disk, due);
    }
    #[inline]
    fn earliest(&self) -> (usize, f64) {
        (**self).earliest()
    }
    #[inline]
    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        (**self).upcoming(disks);
    }
}

impl<T: EventScheduler + ?Sized> EventScheduler for Box<T> {
    #[inline]
    fn reset(&mut self, due: &[f64]) {
        (**self).reset(due);
    }
    #[inline]
    fn set(&mut self, disk: usize, due: f64) {
        (**self).set(disk, due);
    }
    #[inline]
    fn earliest(&self) -> (usize, f64) {
        (**self).earliest()
    }
    #[inline]
    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        (**self).upcoming(disks);
    }
}
