//! Offsets and speeds at which the disks of an elastic gas meet, against kinetic theory.

use granular_edmd::collision::Elastic;
use granular_edmd::observable::{CollisionHistograms, Temperatures};
use granular_edmd::statistics::Histogram;

use crate::gas::{periodic_gas, run_for};
use crate::{Outcome, measured};

/// Returns chi squared of a histogram against a cumulative distribution, over bins with 10 expected numbers
/// or more, and the number of these bins.
fn chi_squared(histogram: &Histogram, cumulative: impl Fn(f64) -> f64) -> (f64, usize) {
    let all = histogram.count() as f64;
    let expected =
        histogram.bins().map(|bin| (bin.count, all * (cumulative(bin.high) - cumulative(bin.low))));
    let terms: Vec<f64> = expected
        .filter(|(_, expected)| *expected >= 10.0)
        .map(|(count, expected)| (count as f64 - expected).powi(2) / expected)
        .collect();
    (terms.iter().sum(), terms.len())
}

#[test]
fn disks_meet_at_any_offset_and_with_the_speeds_of_the_flux() -> Outcome {
    let mut gas = periodic_gas(1000, 0.1, Elastic, 1)?;
    let mut histograms = CollisionHistograms::new(8.0, 8.0, 40)?;
    run_for(&mut gas, 200.0, &mut histograms)?;
    let temperature = gas.measure(&Temperatures).translational() * 1000.0 / 999.0;
    let speeds = |speed: f64| -f64::exp_m1(-speed * speed / (4.0 * temperature));
    let tests = [
        ("obliqueness", chi_squared(histograms.obliqueness(), |b| 0.5 * (1.0 + b))),
        ("closing speed", chi_squared(histograms.closing_speed(), speeds)),
        // Elastic disks of mass 1 exchange their closing velocity.
        ("impulse", chi_squared(histograms.impulse(), speeds)),
    ];
    assert_eq!(histograms.obliqueness().count(), 100_000);
    for (what, (chi, bins)) in tests {
        measured(what, chi);
        // The 1e5 collisions are nearly independent. Chi squared exceeds its mean by five standard deviations
        // once in 1e5 cases.
        let free = bins as f64;
        assert!(chi < free + 5.0 * (2.0 * free).sqrt(), "{what}: {chi} of {bins}");
        assert!(chi > free - 4.0 * (2.0 * free).sqrt(), "{what}: {chi} of {bins}");
    }
    Ok(())
}
