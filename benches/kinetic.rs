//! The time to compute the mean energy loss: per point by the closed form, per collision by the Monte Carlo
//! average.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use granular_edmd::collision::Frictional;
use granular_edmd::kinetic::{IsoLine, Maxwellian, MonteCarlo, friction_of_largest_loss, mean_energy_change};

/// Returns points spread over the plane of Fig. 1.
fn points() -> Vec<Frictional> {
    let point = |i: u32| {
        let inelasticity = f64::from(i % 100) * 2e-3;
        Frictional::from_inelasticity(inelasticity, inelasticity, f64::from(i / 100) * 0.01).unwrap()
    };
    (0..10_000).map(point).collect()
}

fn closed_form(criterion: &mut Criterion) {
    let (points, gas) = (points(), Maxwellian::new(1.0).unwrap());
    let mut group = criterion.benchmark_group("closed form");
    group.throughput(Throughput::Elements(points.len() as u64));
    group.bench_function("mean energy change", |bencher| {
        bencher.iter(|| points.iter().map(|rule| mean_energy_change(rule, &gas)).sum::<f64>());
    });
    group.bench_function("friction of largest loss", |bencher| {
        bencher.iter(|| points.iter().filter_map(|rule| friction_of_largest_loss(rule, &gas)).sum::<f64>());
    });
    let line = IsoLine::new(-0.3, &gas).unwrap();
    group.bench_function("inelasticities of an iso-line", |bencher| {
        bencher.iter(|| {
            points.iter().map(|rule| line.inelasticities(rule.static_friction())).collect::<Vec<_>>()
        });
    });
    group.finish();
}

fn monte_carlo(criterion: &mut Criterion) {
    let (rule, gas) = (Frictional::from_inelasticity(0.1, 0.1, 0.3).unwrap(), Maxwellian::new(1.0).unwrap());
    let samples = 1 << 16;
    let mut group = criterion.benchmark_group("Monte Carlo");
    group.throughput(Throughput::Elements(samples));
    group.bench_function("mean energy change", |bencher| {
        let average = |seed| MonteCarlo::new(seed).with_samples(samples);
        bencher.iter_batched(
            || average(1),
            |average| average.mean_energy_change(&rule, &gas),
            BatchSize::SmallInput,
        );
    });
    group.finish();
}

criterion_group!(benches, closed_form, monte_carlo);
criterion_main!(benches);
