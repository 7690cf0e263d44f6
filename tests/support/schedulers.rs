//! Every scheduler of the library: the one place to add a new one.

use granular_edmd::scheduler::{BucketQueue, BySize, EventScheduler, LinearScan, TournamentTree};

pub type Scheduler = Box<dyn EventScheduler>;

/// Functions that make each of them; the first is the default.
pub const SCHEDULERS: [fn() -> Scheduler; 4] = [
    || Box::new(BySize::new()),
    || Box::new(TournamentTree::new()),
    || Box::new(BucketQueue::new()),
    || Box::new(LinearScan::new()),
];
