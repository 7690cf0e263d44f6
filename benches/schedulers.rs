//! The cost of an event for each scheduler, which finds the earliest disk and gives it a later time.

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use granular_edmd::scheduler::{BucketQueue, EventScheduler, LinearScan, TournamentTree};

type New = fn() -> Box<dyn EventScheduler>;

const EVENTS: usize = 1024;

/// Returns times without order between 0 and 1.
fn scattered(k: usize) -> f64 {
    (k.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64 / (1u64 << 53) as f64
}

fn drive(scheduler: &mut dyn EventScheduler) {
    for event in 0..EVENTS {
        let (disk, due) = scheduler.earliest();
        scheduler.set(disk, due + scattered(event));
    }
}

fn events(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("scheduler");
    group.throughput(Throughput::Elements(EVENTS as u64));
    for count in [1_000, 100_000] {
        let due: Vec<f64> = (0..count).map(scattered).collect();
        let schedulers: [(&str, New); 3] = [
            ("tournament_tree", || Box::new(TournamentTree::new())),
            ("bucket_queue", || Box::new(BucketQueue::new())),
            ("linear_scan", || Box::new(LinearScan::default())),
        ];
        for (name, new) in schedulers {
            let full = || {
                let mut scheduler = new();
                scheduler.reset(&due);
                scheduler
            };
            if name == "linear_scan" && count > 1_000 {
                continue;
            }
            group.bench_function(BenchmarkId::new(name, count), |bencher| {
                bencher.iter_batched_ref(full, |scheduler| drive(scheduler), BatchSize::LargeInput);
            });
        }
    }
    group.finish();
}

criterion_group!(benches, events);
criterion_main!(benches);
