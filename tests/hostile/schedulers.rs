//! Every scheduler of the library: the one place to add a new one.

use granular_edmd::scheduler::{BucketQueue, BySize, EventScheduler, LinearScan, TournamentTree};

pub(crate) type Scheduler = Box<dyn EventScheduler>;

/// How to make each of them; the first is the default.
pub(crate) const SCHEDULERS: [fn() -> Scheduler; 4] = [
    || Box::new(BySize::default()),
    || Box::new(TournamentTree::default()),
    || Box::new(BucketQueue::default()),
    || Box::new(LinearScan::default()),
];
