//! Whole runs: collisions of two disks per second, in the paper's box with a thousand disks.

use std::time::{Duration, Instant};

use benches::state::{DENSE, DILUTE, Run};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

/// Returns the time for `collisions` collisions.
fn collide(run: &mut Run, collisions: u64) -> Duration {
    let (start, last) = (Instant::now(), run.counters().disk_collisions + collisions);
    while run.counters().disk_collisions < last {
        run.step_until(run.time() + 1.0, &mut ()).expect("the run goes on");
    }
    start.elapsed()
}

fn runs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("collisions");
    group.throughput(Throughput::Elements(1)).sample_size(20);
    for (name, state) in [("dilute", DILUTE), ("dense", DENSE)] {
        let mut run = state.settled(1, 500).expect("the state can be made");
        group.bench_function(name, |bencher| bencher.iter_custom(|collisions| collide(&mut run, collisions)));
    }
    group.finish();
}

criterion_group!(benches, runs);
criterion_main!(benches);
