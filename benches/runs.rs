//! Whole runs: collisions of two disks per second, in the paper's box with a thousand disks.

use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Simulation, initial};

type Run = Simulation<ContactDuration<Frictional>>;

/// A run that has forgotten its lattice.
fn settled(inelasticity: f64, friction: f64) -> Result<Run, Box<dyn std::error::Error>> {
    let boundary = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&boundary, 1000, 0.5)?, 1.0, 1)?;
    let rule = ContactDuration::new(Frictional::new(inelasticity, friction)?, 1e-5)?;
    let mut run = Simulation::builder(rule, boundary).disks(disks).gravity(0.015_625).build()?;
    while run.counters().collisions < 100_000 {
        run.run_until(run.time() + 1.0, &mut ())?;
    }
    Ok(run)
}

/// Time for this many collisions.
fn collide(run: &mut Run, collisions: u64) -> Duration {
    let (start, last) = (Instant::now(), run.counters().collisions + collisions);
    while run.counters().collisions < last {
        run.step(&mut ()).expect("the run goes on");
    }
    start.elapsed()
}

fn runs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("collisions");
    group.throughput(Throughput::Elements(1)).sample_size(20);
    for (name, inelasticity, friction) in [("dilute", 0.0, 0.03), ("dense", 0.05, 0.1)] {
        let mut run = settled(inelasticity, friction).expect("the state can be made");
        group.bench_function(name, |bencher| bencher.iter_custom(|collisions| collide(&mut run, collisions)));
    }
    group.finish();
}

criterion_group!(benches, runs);
criterion_main!(benches);
