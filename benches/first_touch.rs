//! The search for the first touch of each wall motion.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use granular_edmd::wall::{
    Approach, BiParabolic, Fixed, Sawtooth, Sinusoidal, Triangular, WallMotion, first_touch,
};

const FLIGHTS: usize = 1024;

/// Returns flights of disks that fall onto the wall from up to two amplitudes above its reach, at all phases.
fn flights() -> Vec<Approach> {
    let flight = |k: usize| {
        let (phase, height, speed) = ((k % 97) as f64, (k * 37 % 101) as f64, (k * 53 % 89) as f64);
        Approach::new(0.0065 * phase, 0.1 + 0.002 * height, 1.0 - 0.03 * speed, -0.0156)
    };
    (0..FLIGHTS).map(flight).collect()
}

fn searches(criterion: &mut Criterion) {
    let motions: [(&str, Box<dyn WallMotion>); 5] = [
        ("fixed", Box::new(Fixed)),
        ("bi_parabolic", Box::new(BiParabolic::new(0.1, 10.0).expect("valid"))),
        ("sinusoidal", Box::new(Sinusoidal::new(0.1, 10.0).expect("valid"))),
        ("triangular", Box::new(Triangular::new(0.1, 10.0).expect("valid"))),
        ("sawtooth", Box::new(Sawtooth::new(0.1, 10.0).expect("valid"))),
    ];
    let flights = flights();
    let mut group = criterion.benchmark_group("first_touch");
    group.throughput(Throughput::Elements(FLIGHTS as u64));
    for (name, motion) in &motions {
        let search = || {
            flights
                .iter()
                .filter_map(|flight| first_touch(motion, black_box(flight), 1e3).touch())
                .sum::<f64>()
        };
        group.bench_function(*name, |bencher| bencher.iter(search));
    }
    group.finish();
}

criterion_group!(benches, searches);
criterion_main!(benches);
