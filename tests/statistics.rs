//! Errors of means, against the true scatter over seeds, for series of known correlation.

use granular_edmd::statistics::{BlockedMean, Estimate, Histogram, RunningMean, block_average};
use oracles::Autoregressive;
use support::cases::few;

/// Number of runs of each series. The scatter over them is known to 8 %.
const SEEDS: u64 = 80;

/// Returns the means of the same series under all seeds.
fn means(series: impl Fn(u64) -> BlockedMean) -> Vec<BlockedMean> {
    (0..SEEDS).map(series).collect()
}

/// Returns the ratio of the average error to the scatter of the means over seeds.
fn share(means: &[BlockedMean], error: impl Fn(&BlockedMean) -> f64) -> f64 {
    let scatter = means.iter().map(BlockedMean::mean).collect::<RunningMean>().standard_deviation();
    means.iter().map(error).collect::<RunningMean>().mean() / scatter
}

fn share_converged(means: &[BlockedMean]) -> f64 {
    means.iter().filter(|mean| mean.estimate().is_converged()).count() as f64 / means.len() as f64
}

fn printed(mean: &BlockedMean) -> f64 {
    mean.estimate().standard_error()
}

/// Returns the share of the series whose error is called converged, and the share of these whose true mean,
/// 0, lies within two errors.
fn called_converged(series: impl Fn(u64) -> BlockedMean) -> (f64, f64) {
    let all: Vec<Estimate> = few(0..1000, 4).map(|seed| series(seed).estimate()).collect();
    let estimates = all.iter().filter(|estimate| estimate.is_converged());
    let within = |estimate: &Estimate| estimate.mean().abs() <= 2.0 * estimate.standard_error();
    let called: Vec<bool> = estimates.map(within).collect();
    let share = called.iter().filter(|&&within| within).count() as f64 / called.len() as f64;
    (called.len() as f64 / all.len() as f64, share)
}

/// Checks the shares of [`called_converged`] for a series of this length in correlated samples.
///
/// The share within two errors is above 92 % for all lengths. Of fifty series or more, it is known to 4 %; of
/// fewer, it tells nothing.
fn check_called_converged(name: &str, length: f64, (called, within): (f64, f64)) {
    println!("{name}, {length}: {called:.3} converged, of these {within:.3} within two errors");
    assert!(called < 0.05 || within > 0.9, "{name}, {length}: {within} of {called}");
    assert!(called > 0.9 || length < 300.0, "{name}, {length}: {called}");
    assert!(called < 0.05 || length > 60.0, "{name}, {length}: {called}");
}

#[test]
fn errors_called_converged_hold_the_mean() {
    for tau in [1.0, 3.0, 19.0] {
        let correlation = (tau - 1.0) / (tau + 1.0);
        for length in [10.0, 30.0, 50.0, 75.0, 100.0, 150.0, 300.0, 1000.0] {
            let count = (length * tau) as usize;
            let found = called_converged(|seed| Autoregressive::new(seed, correlation).take(count).collect());
            check_called_converged("one time", length, found);
        }
    }
}

#[test]
fn errors_called_converged_hold_the_mean_of_two_time_scales() {
    let (fast, slow) = (0.5, 89.0 / 91.0);
    for length in [30.0, 50.0, 75.0, 100.0, 150.0, 300.0] {
        let both = |seed| {
            let parts = Autoregressive::new(seed, fast).zip(Autoregressive::new(!seed, slow));
            let sum = parts.map(|(fast, slow)| 0.7_f64.sqrt() * fast + 0.3_f64.sqrt() * slow);
            sum.take((90.0 * length) as usize).collect::<BlockedMean>()
        };
        let (called, within) = called_converged(both);
        println!("two times, {length}: {called:.3} converged, of these {within:.3} within two errors");
        assert!(within > 0.9, "{length}: {within} of {called}");
        assert!(called > 0.9 || length < 300.0, "{length}: {called}");
    }
}

#[test]
fn equal_samples_tell_no_more_than_one() {
    let frozen: BlockedMean = [0.3; 100].into_iter().collect();
    let estimate = frozen.estimate();
    assert_eq!((estimate.mean(), estimate.standard_error()), (0.3, 0.0));
    assert!(!estimate.is_converged());
    assert_eq!((estimate.samples(), estimate.independent_samples()), (100, 1.0));
    assert_eq!(estimate.to_string(), "0.30000 ± 0.00000 (all samples are equal)");
    let independent = [0.3; 100].into_iter().collect::<RunningMean>().estimate();
    assert!(!independent.is_converged());
    assert_eq!(independent.to_string(), "0.30000 ± 0.00000 (all samples are equal)");
}

/// The only scatter is in the last samples, which fill no block of the sizes whose blocks are all equal.
#[test]
fn samples_that_fill_no_block_are_not_forgotten() {
    for (count, last) in [(1000_u32, 1), (1023, 15), (1001, 1)] {
        let series: Vec<f64> = (0..count).map(|k| f64::from(u8::from(k >= count - last))).collect();
        let average = block_average(&series).unwrap();
        assert!(!average.is_converged() && average.standard_error() > 0.0, "{count}, {last}: {average}");
    }
}

#[test]
fn the_printed_error_covers_the_scatter_over_seeds() {
    for correlation in [0.0, 0.5, 0.9, 0.97] {
        let means = means(|seed| Autoregressive::new(seed, correlation).take(1 << 14).collect());
        assert!(share_converged(&means) > 0.9, "{correlation}");
        let covered = share(&means, printed);
        assert!((0.75..1.3).contains(&covered), "{correlation}: {covered}");
        // An error that takes the samples as independent is too small by the root of the correlated samples.
        let naive = share(&means, |mean| mean.ungrouped().standard_error());
        let expected = ((1.0 - correlation) / (1.0 + correlation)).sqrt();
        assert!((naive / expected - 1.0).abs() < 0.3, "{correlation}: {naive}");
    }
}

/// The samples resemble collisions of a gas that slowly warms and cools: each has strong noise, and a small
/// part of the variance has a long correlation.
#[test]
fn a_slow_part_of_small_variance_is_seen() {
    let slow = |seed, correlation: f64| {
        let noise = Autoregressive::new(seed, 0.0).zip(Autoregressive::new(!seed, correlation));
        noise.map(|(noise, slow)| noise + 0.15 * slow).take(1 << 16).collect::<BlockedMean>()
    };
    let shorter = means(|seed| slow(seed, 0.99));
    assert!(share_converged(&shorter) > 0.9);
    assert!((0.75..1.3).contains(&share(&shorter, printed)));
    assert!(share(&shorter, |mean| mean.ungrouped().standard_error()) < 0.5);
    // The series has only a few of the long correlation times, so the error cannot be known. Most of the
    // estimates say so.
    let longer = means(|seed| slow(seed, 0.9999));
    assert!(share_converged(&longer) < 0.4, "{}", share_converged(&longer));
    let covered = share(&longer, printed);
    assert!((0.5..1.5).contains(&covered), "{covered}");
    assert!(share(&longer, |mean| mean.ungrouped().standard_error()) < 0.1);
}

#[test]
fn streamed_blocks_are_those_of_the_whole_series() {
    let series: Vec<f64> = Autoregressive::new(7, 0.8).take(700).collect();
    let mut streamed = BlockedMean::new();
    for (count, &number) in series.iter().enumerate() {
        if count >= 2 {
            assert_eq!(streamed.estimate(), block_average(&series[..count]).unwrap());
        }
        streamed.push(number);
    }
    let whole: RunningMean = series.iter().copied().collect();
    assert_eq!((streamed.ungrouped(), streamed.count()), (whole, 700));
    assert_eq!((streamed.mean(), streamed.sum()), (whole.mean(), whole.sum()));
}

/// Records of studies keep the bits of means.
#[test]
fn a_running_mean_is_that_of_welford_to_the_bit() {
    let (mut count, mut mean, mut squares) = (0.0, 0.0, 0.0);
    let mut running = RunningMean::default();
    for number in Autoregressive::new(5, 0.3).take(1000) {
        running.push(number);
        count += 1.0;
        let before = number - mean;
        mean += before / count;
        squares += before * (number - mean);
        assert_eq!(running.mean(), mean);
        if count >= 2.0 {
            assert_eq!(running.variance(), squares / (count - 1.0));
        }
    }
}

/// The error is that of blocks of one size, computed as in the textbook.
#[test]
fn the_error_is_that_of_blocks_of_one_size() {
    let series: Vec<f64> = Autoregressive::new(3, 0.5).take(4000).collect();
    let estimate = block_average(&series).unwrap();
    let error = |size: usize| {
        let means = series.chunks_exact(size).map(|block| block.iter().sum::<f64>() / size as f64);
        means.collect::<RunningMean>().standard_error()
    };
    let growth = estimate.correlated_samples();
    let sizes = (0..9).map(|level| 1 << level);
    let found: Vec<usize> =
        sizes.filter(|&size| (error(size) / (error(1) * growth.sqrt()) - 1.0).abs() < 1e-12).collect();
    // 4000 samples, three of which are worth one: 60/1300 more, or a little more than that.
    let raised = estimate.standard_error() / (error(1) * growth.sqrt());
    assert!((1.035..1.07).contains(&raised), "{raised}");
    assert!(matches!(found[..], [size] if (size as f64).powi(3) > 8000.0 * growth * growth), "{found:?}");
    assert!((growth / 3.0 - 1.0).abs() < 0.4, "{growth}");
}

#[test]
fn no_and_few_numbers_have_no_error() {
    let none = BlockedMean::new();
    assert!(none.mean().is_nan());
    assert_eq!((none.count(), none.sum()), (0, 0.0));
    let nothing = none.estimate();
    assert!(nothing.mean().is_nan() && nothing.standard_error().is_nan() && !nothing.is_converged());
    let one = BlockedMean::from_iter([5.0]).estimate();
    assert!(one.mean() == 5.0 && one.standard_error().is_nan() && !one.is_converged());
    assert_eq!(one.to_string(), "5.00000 ± NaN (too few samples for an error)");
    let two = BlockedMean::from_iter([5.0, 7.0]).estimate();
    assert_eq!((two.standard_error(), two.is_converged()), (1.0, false));
    let equal = BlockedMean::from_iter([0.1; 9]).estimate();
    assert_eq!((equal.standard_error(), equal.is_converged(), equal.correlated_samples()), (0.0, false, 9.0));
    let broken = BlockedMean::from_iter([1.0, f64::NAN, f64::INFINITY, 2.0]).estimate();
    assert!(broken.mean().is_nan() && !broken.is_converged());
    let huge = BlockedMean::from_iter([1e200, -1e200, 3e200, 1e300]).estimate();
    assert!(!huge.is_converged());
}

#[test]
fn two_digits_of_the_error_are_printed() {
    let printed = |spread: f64| {
        let numbers = (0..1000).map(|k| -0.125 + if k % 3 == 0 { spread } else { -0.5 * spread });
        let mean: RunningMean = numbers.collect();
        let estimate: Estimate = mean.estimate();
        assert_eq!(estimate.is_converged(), spread != 0.0);
        estimate.to_string()
    };
    assert_eq!(printed(0.0), "-0.12500 ± 0.00000 (all samples are equal)");
    assert_eq!(printed(1.0), "-0.124 ± 0.022 (independent samples)");
    assert_eq!(printed(1e4), "10 ± 224 (independent samples)");
}

/// Estimates of the halves, quarters, … of one series together are that of the whole; their scatter over
/// seeds is their error.
#[test]
fn the_error_of_repeats_together_is_that_of_one_long_run() {
    for repeats in [1, 2, 4, 16] {
        let together: Vec<Estimate> = (0..SEEDS)
            .map(|seed| {
                let run = |repeat| -> BlockedMean {
                    Autoregressive::new(1000 * seed + repeat, 0.8).take(4096).collect()
                };
                Estimate::over_repeats((0..repeats).map(|repeat| run(repeat).estimate()))
            })
            .collect();
        let means: RunningMean = together.iter().map(Estimate::mean).collect();
        let errors: RunningMean = together.iter().map(Estimate::standard_error).collect();
        let ratio = errors.mean() / means.standard_deviation();
        // The larger of two errors is too large by a few percent.
        assert!((0.8..1.45).contains(&ratio), "{repeats}: {ratio}");
        // An autoregressive series of correlation 0.8: nine samples are worth one.
        let worth: RunningMean = together.iter().map(Estimate::independent_samples).collect();
        let expected = repeats as f64 * 4096.0 / 9.0;
        assert!((0.55..1.35).contains(&(worth.mean() / expected)), "{repeats}: {}", worth.mean() / expected);
        assert!(together.iter().all(|estimate| estimate.samples() == repeats * 4096));
    }
}

/// Runs that are each in a state of its own: a run that is twenty times longer counts as one state.
#[test]
fn a_long_run_in_one_of_many_states_is_one_state() {
    for long in [1, 20] {
        let together: Vec<Estimate> = (0..SEEDS)
            .map(|seed| {
                let mut states = Autoregressive::new(seed, 0.0);
                let runs = (0..16).map(|repeat| {
                    let (state, length) =
                        (states.next().unwrap(), if repeat == 0 { long * 100 } else { 100 });
                    let noise = Autoregressive::new(1000 * (seed + 1) + repeat, 0.0);
                    noise.take(length).map(|x| state + 0.01 * x).collect::<BlockedMean>().estimate()
                });
                Estimate::over_repeats(runs)
            })
            .collect();
        let means: RunningMean = together.iter().map(Estimate::mean).collect();
        let squares: RunningMean = together.iter().map(|one| one.standard_error().powi(2)).collect();
        let ratio = squares.mean().sqrt() / means.standard_deviation();
        assert!((0.75..1.3).contains(&ratio), "{long}: {ratio}");
    }
}

#[test]
fn equal_samples_of_repeats_do_not_converge() {
    let run = || [2.5; 60].into_iter().collect::<BlockedMean>().estimate();
    let together = Estimate::over_repeats((0..9).map(|_| run()));
    assert!(!together.is_converged() && together.standard_error() == 0.0, "{together}");
}

/// Two long runs with levels of their own: their mean has an error, but two numbers do not tell how large.
#[test]
fn a_few_runs_in_different_states_have_not_converged() {
    let run = |level: f64| {
        let noise = Autoregressive::new(level as u64, 0.0).take(4096);
        noise.map(|x| level + 0.01 * x).collect::<BlockedMean>().estimate()
    };
    assert!(Estimate::over_repeats([run(1.0), run(1.0 + 1e-4)]).is_converged());
    let apart = Estimate::over_repeats([run(1.0), run(2.0), run(3.0)]);
    assert!(!apart.is_converged() && apart.independent_samples() < 3.1, "{apart}");
}

/// Repeats whose states do not depend on the seed.
#[test]
fn the_same_run_again_counts_once() {
    let run = || Autoregressive::new(3, 0.8).take(512).collect::<BlockedMean>().estimate();
    assert_eq!(Estimate::over_repeats((0..8).map(|_| run())), run());
}

#[test]
fn repeats_without_samples_are_left_out() {
    let none = BlockedMean::new().estimate();
    let one: BlockedMean = [2.0].into_iter().collect();
    let some: BlockedMean = [1.0, 2.0, 3.0, 4.0].into_iter().collect();
    assert!(Estimate::over_repeats([]).mean().is_nan());
    assert!(Estimate::over_repeats([none, none]).mean().is_nan());
    assert_eq!(Estimate::over_repeats([none, some.estimate()]), some.estimate());
    let both = Estimate::over_repeats([one.estimate(), some.estimate()]);
    assert!((both.mean() - 2.4).abs() < 1e-15 && both.standard_error().is_finite() && both.samples() == 5);
    assert!(!both.is_converged());
    let many = Estimate::over_repeats(
        [1.0, 2.0]
            .repeat(4)
            .into_iter()
            .map(|level| [level; 2].into_iter().collect::<BlockedMean>().estimate()),
    );
    assert!(many.is_converged() && many.standard_error() > 0.1, "{many}");
    assert!((many.independent_samples() - 7.0).abs() < 1.1, "{}", many.independent_samples());
}

/// The quotient by the width and the edges round differently.
#[test]
fn a_number_on_an_edge_is_in_the_bin_that_begins_there() {
    for (low, high, bins) in
        [(-1.0, 1.0, 20), (0.0, 1.0, 49), (0.1, 0.7, 6), (-0.3, 1e3, 999), (1e9, 1e9 + 7.0, 1000)]
    {
        let mut histogram = Histogram::new(low, high, bins).unwrap();
        let edges: Vec<f64> = histogram.bins().map(|bin| bin.low).collect();
        let ends = (edges[0], histogram.bins().last().unwrap().high);
        assert_eq!(ends, (low, high), "{bins}");
        histogram.extend(edges.iter().copied());
        assert!(histogram.bins().all(|bin| bin.count == 1), "{low} {high} {bins}");
        histogram.extend(edges.iter().map(|edge| edge.next_down()));
        let counts: Vec<u64> = histogram.bins().map(|bin| bin.count).collect();
        assert!(counts[..bins - 1].iter().all(|&count| count == 2), "{low} {high} {bins}: {counts:?}");
        assert_eq!((counts[bins - 1], histogram.below()), (1, 1), "{low} {high} {bins}");
    }
}

#[test]
fn bins_below_rounding_are_refused() {
    for (low, high, bins) in [(1e16, 1e16 + 2.0, 7), (0.0, 1e-320, 1000), (-1.0, -1.0 + 1e-15, 100)] {
        let error = Histogram::new(low, high, bins).unwrap_err().to_string();
        assert!(error.starts_with("width of a bin must be above the rounding of its edges"), "{error}");
    }
    assert!(Histogram::new(1e16, 1e16 + 16.0, 4).is_ok());
}

/// A few repeats, each too short to be trusted alone, are trusted together once they have as many independent
/// samples as one run needs; two errors then hold the mean. Repeats of less than a correlation time are not.
#[test]
fn a_few_repeats_are_trusted_together() {
    const SERIES: u64 = 400;
    let correlation = 9.0 / 11.0;
    for (repeats, length) in [(2, 300.0), (3, 30.0), (3, 80.0), (4, 60.0), (5, 100.0), (4, 2.0), (7, 1.0)] {
        let run = |seed| Autoregressive::new(seed, correlation).take((10.0 * length) as usize);
        let together = |series: u64| {
            let seeds = (0..repeats).map(|repeat| 1000 * series + repeat);
            Estimate::over_repeats(seeds.map(|seed| run(seed).collect::<BlockedMean>().estimate()))
        };
        let called: Vec<_> = (0..SERIES).map(together).filter(Estimate::is_converged).collect();
        let within =
            called.iter().filter(|estimate| estimate.mean().abs() <= 2.0 * estimate.standard_error());
        let (share, within) =
            (called.len() as f64 / SERIES as f64, within.count() as f64 / called.len() as f64);
        println!(
            "{repeats} repeats of {length}: {share:.3} converged, of these {within:.3} within two errors"
        );
        let independent = repeats as f64 * length;
        assert!(share > 0.5 || independent < 240.0, "{repeats} of {length}: {share}");
        assert!(share > 0.9 || independent < 480.0, "{repeats} of {length}: {share}");
        assert!(share < 0.05 || independent > 60.0, "{repeats} of {length}: {share}");
        assert!(share < 0.05 || within > 0.88, "{repeats} of {length}: {within}");
    }
}
