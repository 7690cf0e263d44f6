//! Every scheduler against the obvious one: by the public check, and over scripts that are shrunk when they
//! fail.

mod ghosts;

use granular_edmd::scheduler::{
    BucketQueue, BySize, EventScheduler, LinearScan, NOTHING_DUE, TournamentTree, laws,
};
use proptest::prelude::*;

use support::cases::config;
use support::schedulers::SCHEDULERS;

#[test]
fn every_scheduler_keeps_the_laws() {
    for scheduler in SCHEDULERS {
        assert_eq!(laws::check(scheduler), Ok(()));
    }
}

/// Asserts that it is told of times for disks that are there.
#[derive(Default)]
struct Wary(LinearScan, usize);

impl EventScheduler for Wary {
    fn reset(&mut self, due: &[f64]) {
        assert!(!due.iter().any(|due| due.is_nan()));
        self.0.reset(due);
        self.1 = due.len();
    }
    fn set(&mut self, disk: usize, due: f64) {
        assert!(disk < self.1 && !due.is_nan(), "{disk} of {}: {due}", self.1);
        self.0.set(disk, due);
    }
    fn earliest(&self) -> (usize, f64) {
        self.0.earliest()
    }
}

#[test]
fn no_law_sets_nan_or_a_disk_that_is_not_there() {
    assert_eq!(laws::check(Wary::default), Ok(()));
}

/// References and boxes forward all four methods, including the optional one.
#[test]
fn a_borrowed_or_boxed_scheduler_is_the_same() {
    fn upcoming(mut scheduler: impl EventScheduler) -> Vec<usize> {
        let mut disks = Vec::new();
        scheduler.reset(&[3.0, 1.0, 2.0]);
        scheduler.upcoming(&mut disks);
        disks
    }
    let (mut lent, mut boxed) = (BucketQueue::new(), BucketQueue::new());
    assert_eq!(upcoming(&mut lent), [1, 2, 0]);
    assert_eq!(upcoming(&mut lent as &mut dyn EventScheduler), [1, 2, 0]);
    assert_eq!(upcoming(Box::new(&mut boxed)), [1, 2, 0]);
    assert_eq!(lent.earliest(), (1, 1.0));
    assert_eq!(laws::check(|| Box::new(Box::new(TournamentTree::new()))), Ok(()));
}

#[derive(Debug, Clone)]
enum Operation {
    Reset(Vec<f64>),
    /// Sets a disk (reduced to how many there are) to a time.
    Set(usize, f64),
    /// Gives the earliest disk a later time, as the engine mostly does.
    Postpone(f64),
}

/// Times with many ties, both zeros, both infinities, negative, tiny and huge ones.
fn time() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -100.0..100.0f64,
        4 => (-3..4i32).prop_map(f64::from),
        1 => Just(-0.0),
        2 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => prop_oneof![Just(f64::MAX), Just(f64::MIN), Just(f64::MIN_POSITIVE), Just(-5e-324), Just(5e-324)],
    ]
}

/// Returns times of no disks, of few, of powers of two and their neighbors, and of many.
fn times() -> impl Strategy<Value = Vec<f64>> {
    let count =
        prop_oneof![Just(0usize), Just(1), Just(2), 3..10usize, 15..18usize, 31..34usize, 60..200usize];
    count.prop_flat_map(|count| prop::collection::vec(time(), count))
}

fn operation() -> impl Strategy<Value = Operation> {
    prop_oneof![
        1 => times().prop_map(Operation::Reset),
        10 => (any::<usize>(), time()).prop_map(|(disk, due)| Operation::Set(disk, due)),
        10 => (0.0..5.0f64).prop_map(Operation::Postpone),
    ]
}

/// Performs an operation on both; `count` is how many disks there are.
fn perform(operation: &Operation, count: &mut usize, pair: [&mut dyn EventScheduler; 2]) {
    let (disk, due) = match operation {
        Operation::Reset(due) => {
            *count = due.len();
            for scheduler in pair {
                scheduler.reset(due);
            }
            return;
        }
        Operation::Set(disk, due) => (disk % (*count).max(1), *due),
        Operation::Postpone(by) => {
            let (disk, due) = pair[0].earliest();
            (disk, due + by)
        }
    };
    if disk < *count {
        for scheduler in pair {
            scheduler.set(disk, due);
        }
    }
}

fn agrees_with_the_oracle(
    mut scheduler: impl EventScheduler,
    script: &[Operation],
) -> Result<(), TestCaseError> {
    let (mut oracle, mut count) = (LinearScan::default(), 0);
    prop_assert_eq!(scheduler.earliest(), NOTHING_DUE, "before any reset");
    for operation in script {
        perform(operation, &mut count, [&mut oracle, &mut scheduler]);
        prop_assert_eq!(scheduler.earliest(), oracle.earliest());
    }
    Ok(())
}

/// All disks in the order in which they come up, each postponed for ever when it did.
fn order(scheduler: &mut dyn EventScheduler, due: &[f64]) -> Vec<usize> {
    scheduler.reset(due);
    let next = |_| {
        let (disk, _) = scheduler.earliest();
        scheduler.set(disk, f64::INFINITY);
        disk
    };
    due.iter().map(next).collect()
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn each_scheduler_is_the_linear_scan(script in prop::collection::vec(operation(), 0..300)) {
        for scheduler in SCHEDULERS {
            agrees_with_the_oracle(scheduler(), &script)?;
        }
    }

    #[test]
    fn disks_come_up_in_the_order_of_time_then_index(due in prop::collection::vec(-3..4i32, 0..100)) {
        let due: Vec<f64> = due.into_iter().map(f64::from).collect();
        let mut sorted: Vec<usize> = (0..due.len()).collect();
        sorted.sort_by(|&a, &b| due[a].total_cmp(&due[b]));
        for scheduler in SCHEDULERS {
            prop_assert_eq!(&order(&mut scheduler(), &due), &sorted);
        }
    }
}

/// A change of a disk, the first one or any. It is due a while after the first, or again when it was before.
#[derive(Debug, Clone, Copy)]
enum Change {
    First(f64),
    Any(usize, f64),
    Back(usize),
}

fn change(disks: usize) -> impl Strategy<Value = Change> {
    let wait = || prop_oneof![6 => 0.0..3.0f64, 2 => 0.0..1e-3f64, 1 => Just(0.0), 1 => Just(f64::INFINITY)];
    prop_oneof![
        6 => wait().prop_map(Change::First),
        2 => (0..disks, wait()).prop_map(|(disk, by)| Change::Any(disk, by)),
        1 => (0..disks).prop_map(Change::Back),
    ]
}

proptest! {
    #![proptest_config(config(12))]

    /// The disks are so many that they fill many buckets. Old entries are left out, those that come back are
    /// found again, those set within the time of an open bucket are not missed, and looking ahead changes
    /// nothing.
    #[test]
    fn the_bucket_queue_of_many_disks_is_the_linear_scan(
        changes in prop::collection::vec(change(4000), 0..12_000),
    ) {
        let due: Vec<f64> = (0..4000).map(|disk| f64::from(disk * 7919 % 4001) / 4001.0).collect();
        let (mut oracle, mut queue, mut named) = (LinearScan::default(), BucketQueue::new(), Vec::new());
        let (mut times, mut before) = (due.clone(), due.clone());
        oracle.reset(&due);
        queue.reset(&due);
        for change in changes {
            let (first, now) = oracle.earliest();
            let (disk, time) = match change {
                Change::First(by) => (first, now + by),
                Change::Any(disk, by) => (disk, now + by),
                Change::Back(disk) => (disk, before[disk]),
            };
            before[disk] = std::mem::replace(&mut times[disk], time);
            oracle.set(disk, time);
            queue.set(disk, time);
            queue.upcoming(&mut named);
            prop_assert_eq!(queue.earliest(), oracle.earliest());
        }
        prop_assert!(named.iter().all(|&disk| disk < due.len()));
    }
}

/// A single disk of many moves. The calendar is not dealt out anew for each of its events, or this test would
/// take minutes.
#[test]
fn a_bucket_queue_with_one_busy_disk_is_not_slow() {
    let mut queue = BucketQueue::new();
    let mut due = vec![f64::INFINITY; 100_000];
    due[7] = 0.0;
    queue.reset(&due);
    for event in 0..100_000 {
        let (disk, now) = queue.earliest();
        assert_eq!((disk, now), (7, f64::from(event) * 1e6));
        queue.set(7, now + 1e6);
    }
}

#[test]
fn no_disks_no_event() {
    for scheduler in SCHEDULERS {
        let mut scheduler = scheduler();
        assert_eq!(scheduler.earliest(), NOTHING_DUE);
        scheduler.reset(&[1.0]);
        assert_eq!(scheduler.earliest(), (0, 1.0));
        scheduler.reset(&[]);
        assert_eq!(scheduler.earliest(), NOTHING_DUE);
    }
}

#[test]
fn infinite_times_still_name_a_disk_and_ties_the_first() {
    for scheduler in SCHEDULERS {
        let mut scheduler = scheduler();
        scheduler.reset(&[f64::INFINITY; 3]);
        assert_eq!(scheduler.earliest(), (0, f64::INFINITY));
        scheduler.reset(&[0.0, -0.0]);
        assert_eq!(scheduler.earliest().0, 0, "one zero is as early as the other");
    }
}

/// The disks are more than a scheduler that chooses by size keeps in a tree. They run in lockstep with the
/// tree.
#[test]
fn many_disks_come_up_in_the_same_order() {
    let mut random = 1u64;
    let mut wait = move || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 40) as f64 / 1e4
    };
    let due: Vec<f64> = (0..60_000).map(|_| wait()).collect();
    let (mut chosen, mut tree) = (BySize::new(), TournamentTree::new());
    chosen.reset(&due);
    tree.reset(&due);
    for _ in 0..300_000 {
        let (disk, time) = tree.earliest();
        assert_eq!(chosen.earliest(), (disk, time));
        let next = time + wait();
        chosen.set(disk, next);
        tree.set(disk, next);
    }
}
