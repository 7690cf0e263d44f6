//! Clusters, states, transitions and block averages, on data with known answers.

mod clusters;
mod convective_states;
mod parts;
mod states;

use granular_edmd::ParameterError;
use granular_edmd::glam::DVec2;
use granular_edmd::statistics::{RunningMean, block_average};
use granular_edmd_study::analysis::ConvectiveRegime::{Coexistence, Collapsed, NoRoll, OneRoll, TwoRolls};
use granular_edmd_study::analysis::{TransitionLine, transitions};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

type Outcome = Result<(), ParameterError>;

/// Clusters of Fig. 4 of the paper: both senses of one roll, and two rolls.
const FIGURE_4: [(f64, f64); 3] = [(0.118, 0.045), (-0.118, 0.045), (0.0, 0.122)];

const NOISE: f64 = 0.012;

struct Random(Xoshiro256PlusPlus);

impl Random {
    fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a normal variable, by Box and Muller.
    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }

    fn cloud(&mut self, (x, y): (f64, f64), spread: f64, count: usize) -> Vec<DVec2> {
        (0..count).map(|_| DVec2::new(x + spread * self.normal(), y + spread * self.normal())).collect()
    }
}

fn figure_4(seed: u64, counts: [usize; 3]) -> Vec<DVec2> {
    let mut random = Random::new(seed);
    FIGURE_4.into_iter().zip(counts).flat_map(|(at, count)| random.cloud(at, 1.4 * NOISE, count)).collect()
}

#[test]
fn block_error_is_that_of_an_autoregressive_series() -> Outcome {
    // The error of the mean is exactly sqrt((1 + rho)/(1 - rho)/n).
    for rho in [0.0_f64, 0.5, 0.9] {
        let (runs, samples) = (40, 1 << 14);
        let exact = ((1.0 + rho) / (1.0 - rho) / f64::from(samples)).sqrt();
        let mut squares = 0.0;
        for seed in 0..runs {
            let mut random = Random::new(seed);
            let mut state = random.normal();
            let step = |_| {
                state = rho * state + (1.0 - rho * rho).sqrt() * random.normal();
                state
            };
            let average = block_average(&(0..samples).map(step).collect::<Vec<_>>())?;
            assert!(average.is_converged());
            // For 0.9, with some 860 independent samples, the error is raised by 7 %.
            let ratio = average.standard_error() / exact;
            assert!((0.65..1.45).contains(&ratio), "{rho}: {average:?}");
            // The naive error is known far better, so the uncertainty of their ratio is that of the blocked
            // error.
            let growth = average.correlated_samples() * (1.0 - rho) / (1.0 + rho);
            assert!((growth.sqrt() - 1.0).abs() < 0.35, "{rho}: {average:?}");
            squares += (average.mean() / average.standard_error()).powi(2);
        }
        // Mean of 40 squared normals: standard error 0.22, and 1/error^2 is biased up by a few percent.
        let chi = squares / runs as f64;
        assert!((0.35..1.9).contains(&chi), "{rho}: {chi}");
    }
    Ok(())
}

#[test]
fn the_block_taken_is_the_smallest_that_is_long_enough() -> Outcome {
    // With 300 independent samples, blocks of 8 are too short, since 512 < 600, and blocks of 16 are not.
    let mut random = Random::new(3);
    let samples: Vec<f64> = (0..300).map(|_| random.normal()).collect();
    let error = |block| {
        let means = samples.chunks_exact(block).map(|chunk| chunk.iter().sum::<f64>() / block as f64);
        means.collect::<RunningMean>().standard_error()
    };
    assert!((0.97..1.13).contains(&(error(8) / error(1))) && error(8) != error(16));
    let found = error(1) * block_average(&samples)?.correlated_samples().sqrt();
    assert!((found / error(16) - 1.0).abs() < 1e-12);
    Ok(())
}

#[test]
fn short_constant_and_bad_series() -> Outcome {
    let constant = block_average(&[2.5; 100])?;
    assert_eq!((constant.mean(), constant.standard_error(), constant.independent_samples()), (2.5, 0.0, 1.0));
    assert!(!constant.is_converged());
    // A single jump does not show how often jumps occur.
    let jump: Vec<f64> = (0..64).map(|k| f64::from(k / 32)).collect();
    let average = block_average(&jump)?;
    assert!(!average.is_converged() && (average.mean() - 0.5).abs() < 1e-15);
    assert!((average.standard_error() - 0.5).abs() < 1e-15, "of two blocks, 0 and 1");
    assert!(block_average(&[1.0]).is_err() && block_average(&[1.0, f64::NAN]).is_err());
    assert!(block_average(&[0.0, 1e200]).is_err());
    Ok(())
}

#[test]
fn re_entrance_is_found_both_ways() -> Outcome {
    use TransitionLine::{OneTwoBeginning, OneTwoEnd, TwoCollapse, ZeroOne};
    // The states at q = 0, g = 1/64.
    let ramp = [
        (0.01, NoRoll),
        (0.02, OneRoll),
        (0.0575, OneRoll),
        (0.059, Coexistence),
        (0.0605, Coexistence),
        (0.065, TwoRolls),
        (0.16, TwoRolls),
        (0.2, Collapsed),
        (0.5, Collapsed),
        (0.6, TwoRolls),
        (1.0, TwoRolls),
        (1.2, OneRoll),
    ];
    let found = transitions(ramp)?;
    let lines: Vec<_> = found.iter().map(|point| (point.line, point.rising)).collect();
    let expected = [
        (ZeroOne, true),
        (OneTwoBeginning, true),
        (OneTwoEnd, true),
        (TwoCollapse, true),
        (TwoCollapse, false),
        (OneTwoBeginning, false),
        (OneTwoEnd, false),
    ];
    assert_eq!(lines, expected);
    assert!((found[3].value - 0.18).abs() < 1e-12 && (found[3].error - 0.02).abs() < 1e-12);
    let mut reversed = ramp;
    reversed.reverse();
    assert_eq!(transitions(reversed)?, found, "the order does not matter");
    Ok(())
}

#[test]
fn hysteresis_is_the_difference_of_ramps() -> Outcome {
    let ramp = |jump: f64| {
        (0..20).map(move |k| (f64::from(k), if f64::from(k) < jump { OneRoll } else { TwoRolls }))
    };
    let (up, down) = (transitions(ramp(12.5))?, transitions(ramp(7.5))?);
    assert!(up.iter().all(|point| point.value == 12.5) && down.iter().all(|point| point.value == 7.5));
    let both = transitions(ramp(12.5).chain(ramp(7.5)))?;
    assert_eq!(both.iter().map(|point| point.value).collect::<Vec<_>>(), [7.5, 12.5]);
    // The other lines have no hysteresis. What remains open is part of the error.
    let disagree = [(1.0, NoRoll), (2.0, NoRoll), (2.0, OneRoll), (3.0, OneRoll)];
    let found = transitions(disagree)?;
    assert_eq!((found.len(), found[0].value, found[0].error), (1, 2.0, 1.0));
    assert!(transitions([])?.is_empty() && transitions([(f64::NAN, OneRoll)]).is_err());
    Ok(())
}
