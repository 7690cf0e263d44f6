//! Clusters, states, transitions and block averages, on data whose answer is known.

use granular_edmd::ParameterError;
use granular_edmd::analysis::ConvectiveRegime::{Coexistence, Collapsed, Conductive, OneRoll, TwoRolls};
use granular_edmd::analysis::{
    ConvectiveRegime, ConvectiveState, KMeans, StateCriteria, TransitionLine, block_average,
    distinct_clusters, line_average, thermal_noise, transitions,
};
use granular_edmd::collision::Frictional;
use granular_edmd::glam::DVec2;
use granular_edmd::kinetic::{IsoLine, Maxwellian};
use granular_edmd::observable::{ConvectionOrder, DenseLayer, RunningMean};
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

    /// Normal, by Box and Muller.
    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }

    fn cloud(&mut self, (x, y): (f64, f64), spread: f64, count: usize) -> Vec<DVec2> {
        (0..count).map(|_| DVec2::new(x + spread * self.normal(), y + spread * self.normal())).collect()
    }
}

fn orders(points: &[DVec2]) -> Vec<ConvectionOrder> {
    points.iter().map(|point| ConvectionOrder { one_roll: point.x, two_rolls: point.y }).collect()
}

fn figure_4(seed: u64, counts: [usize; 3]) -> Vec<DVec2> {
    let mut random = Random::new(seed);
    FIGURE_4.into_iter().zip(counts).flat_map(|(at, count)| random.cloud(at, 1.4 * NOISE, count)).collect()
}

#[test]
fn clusters_of_figure_4_are_found_and_named() -> Outcome {
    for seed in 0..5 {
        let points = figure_4(seed, [100, 150, 250]);
        let found = StateCriteria::default().classify(&orders(&points), NOISE, None)?;
        assert_eq!(found.clusters().len(), 3);
        // A point of one cloud nearer to another's centre is 4.9 spreads out.
        for (state, weight) in [
            (ConvectiveState::ClockwiseRoll, 0.2),
            (ConvectiveState::CounterclockwiseRoll, 0.3),
            (ConvectiveState::TwoRollsUp, 0.5),
        ] {
            assert!((found.weight(state) - weight).abs() < 0.005, "{state} {}", found.weight(state));
        }
        // Five standard errors of a mean of a hundred.
        for (cluster, (x, y)) in found.clusters().iter().zip([FIGURE_4[1], FIGURE_4[2], FIGURE_4[0]]) {
            assert!((cluster.center() - DVec2::new(x, y)).length() < 5.0 * 1.4 * NOISE / 10.0);
        }
        assert_eq!(found.state(), ConvectiveState::TwoRollsUp);
        assert_eq!(found.regime(), Coexistence);
    }
    Ok(())
}

#[test]
fn a_rare_visit_is_a_cluster_but_no_coexistence() -> Outcome {
    let found = StateCriteria::default().classify(&orders(&figure_4(3, [0, 490, 10])), NOISE, None)?;
    assert_eq!((found.clusters().len(), found.regime()), (2, OneRoll));
    let strict = StateCriteria::default().with_least_weight(0.01)?;
    assert_eq!(strict.classify(&orders(&figure_4(3, [0, 490, 10])), NOISE, None)?.regime(), Coexistence);
    Ok(())
}

#[test]
fn one_cloud_of_any_width_is_one_cluster() -> Outcome {
    for seed in 0..4 {
        for spread in [0.1, 1.0, 2.5, 10.0] {
            let cloud = Random::new(seed).cloud((0.0, 0.0), spread * NOISE, 500);
            assert_eq!(distinct_clusters(&cloud, NOISE, seed)?.len(), 1, "seed {seed} spread {spread}");
        }
    }
    Ok(())
}

#[test]
fn uniform_density_cut_in_two_has_the_separation_of_the_proof() -> Outcome {
    let line: Vec<DVec2> = (0..2000).map(|k| DVec2::new(f64::from(k), 0.0)).collect();
    let separation = KMeans::new(2, 1)?.fit(&line)?.separation(0.0);
    assert!((separation - 2.0 * 3.0_f64.sqrt()).abs() < 1e-3, "{separation}");
    Ok(())
}

#[test]
fn correlated_noise_of_a_gas_at_rest_is_conductive() -> Outcome {
    for seed in 0..5 {
        let mut random = Random::new(seed);
        // Twenty samples tell as much as one: 25 independent ones in all.
        let (memory, mut state) = (0.905_f64, DVec2::ZERO);
        let points: Vec<DVec2> = (0..500)
            .map(|_| {
                let kick = DVec2::new(random.normal(), random.normal());
                state = memory * state + (1.0 - memory * memory).sqrt() * NOISE * kick;
                state
            })
            .collect();
        let found = StateCriteria::default().classify(&orders(&points), NOISE, None)?;
        assert_eq!((found.regime(), found.clusters().len()), (Conductive, 1), "seed {seed}");
    }
    Ok(())
}

#[test]
fn names_follow_the_mirror() -> Outcome {
    let name = |x: f64, y: f64| -> Result<ConvectiveState, ParameterError> {
        Ok(StateCriteria::default().classify(&orders(&[DVec2::new(x, y)]), NOISE, None)?.state())
    };
    assert_eq!(name(0.118, 0.045)?, ConvectiveState::ClockwiseRoll);
    assert_eq!(name(-0.118, 0.045)?, ConvectiveState::CounterclockwiseRoll);
    assert_eq!(name(0.01, 0.122)?, ConvectiveState::TwoRollsUp);
    assert_eq!(name(0.01, -0.122)?, ConvectiveState::TwoRollsDown);
    assert_eq!(name(2.9 * NOISE, 0.0)?, ConvectiveState::Conductive);
    assert_eq!(name(3.1 * NOISE, 0.0)?, ConvectiveState::ClockwiseRoll);
    Ok(())
}

#[test]
fn collapse_needs_a_compact_layer_on_a_gas_without_rolls() -> Outcome {
    let layer = |packing_fraction, least_below| DenseLayer { height: 19.0, packing_fraction, least_below };
    let regime = |two_rolls: f64, layer| -> Result<ConvectiveRegime, ParameterError> {
        let samples = [ConvectionOrder { one_roll: 0.0, two_rolls }];
        Ok(StateCriteria::default().classify(&samples, 0.0067, layer)?.regime())
    };
    assert_eq!(regime(0.02, Some(layer(0.67, 0.13)))?, Collapsed);
    assert_eq!(regime(0.02, None)?, Conductive);
    assert_eq!(regime(0.105, Some(layer(0.67, 0.13)))?, TwoRolls, "rolls are alive");
    assert_eq!(regime(0.02, Some(layer(0.45, 0.13)))?, Conductive, "not compact");
    assert_eq!(regime(0.0, Some(layer(0.84, 0.84)))?, Conductive, "a sediment on the floor");
    let criteria = StateCriteria::default().with_collapse(0.4, 0.01)?;
    let sample = [ConvectionOrder::default()];
    assert_eq!(criteria.classify(&sample, 0.01, Some(layer(0.45, 0.13)))?.regime(), Collapsed);
    Ok(())
}

#[test]
fn clusters_do_not_depend_on_the_order_of_points() -> Outcome {
    let points = figure_4(11, [100, 150, 250]);
    let mut order: Vec<usize> = (0..points.len()).collect();
    let mut random = Random::new(5);
    for last in (1..order.len()).rev() {
        order.swap(last, (random.uniform() * (last + 1) as f64) as usize);
    }
    let shuffled: Vec<DVec2> = order.iter().map(|&place| points[place]).collect();
    for clusters in 1..5 {
        let search = KMeans::new(clusters, 3)?;
        let (a, b) = (search.fit(&points)?, search.fit(&shuffled)?);
        assert!(a.iter().eq(b.iter()), "the same bits");
        assert!(order.iter().zip(b.labels()).all(|(&place, label)| a.labels()[place] == *label));
        assert_eq!(search.fit(&points)?, a);
    }
    Ok(())
}

#[test]
fn k_means_reaches_the_best_partition_of_few_points() -> Outcome {
    let scatter = |points: &[DVec2], labels: &[usize]| -> f64 {
        (0..2)
            .map(|label| {
                let own: Vec<DVec2> = points
                    .iter()
                    .zip(labels)
                    .filter(|&(_, &of)| of == label)
                    .map(|(&point, _)| point)
                    .collect();
                let center = own.iter().sum::<DVec2>() / own.len().max(1) as f64;
                own.iter().map(|point| point.distance_squared(center)).sum::<f64>()
            })
            .sum()
    };
    for seed in 0..30 {
        let points = Random::new(seed).cloud((0.0, 0.0), 1.0, 9);
        let split = |mask: usize| -> Vec<usize> { (0..9).map(|point| mask >> point & 1).collect() };
        let best = (0..512).map(|mask| scatter(&points, &split(mask))).fold(f64::INFINITY, f64::min);
        let found = KMeans::new(2, seed)?.with_restarts(50)?.fit(&points)?;
        assert!((scatter(&points, found.labels()) - best).abs() < 1e-12, "seed {seed}");
    }
    Ok(())
}

#[test]
fn degenerate_points_are_clustered_and_bad_ones_refused() -> Outcome {
    let equal = [DVec2::new(0.1, -0.2); 7];
    let found = KMeans::new(4, 1)?.fit(&equal)?;
    assert_eq!((found.len(), found.labels()), (1, [0; 7].as_slice()));
    assert!(found.get(0).is_some_and(|cluster| cluster.spread(DVec2::X) < 1e-16 && cluster.weight() == 1.0));
    assert_eq!(distinct_clusters(&equal, 0.0, 1)?.len(), 1);
    assert_eq!(distinct_clusters(&[DVec2::ZERO, DVec2::X], 0.0, 1)?.len(), 2);
    assert_eq!(distinct_clusters(&[DVec2::ZERO, DVec2::splat(1e100)], 0.0, 1)?.len(), 2);

    let message = |result: Result<_, ParameterError>| result.map(|_: usize| ()).unwrap_err().to_string();
    let fit = |clusters, points: &[DVec2]| KMeans::new(clusters, 1)?.fit(points).map(|found| found.len());
    assert_eq!(message(fit(0, &equal)), "number of clusters must be at least 1, but is 0");
    assert_eq!(
        message(fit(3, &equal[..2])),
        "number of points must be at least the number of clusters, but is 2"
    );
    let coordinate = "coordinate of a point must be finite and at most 1e100 in size, but is";
    assert_eq!(message(fit(1, &[DVec2::new(0.0, f64::NAN)])), format!("{coordinate} NaN"));
    assert_eq!(message(fit(1, &[DVec2::new(f64::INFINITY, 0.0)])), format!("{coordinate} inf"));
    assert!(KMeans::new(1, 1)?.with_restarts(0).is_err());
    assert!(distinct_clusters(&[], 0.1, 1).is_err() && distinct_clusters(&equal, f64::NAN, 1).is_err());
    let nobody = StateCriteria::default().classify(&[], 0.1, None);
    assert!(nobody.is_err());
    Ok(())
}

#[test]
fn criteria_and_noise_refuse_what_has_no_meaning() {
    let criteria = StateCriteria::default();
    assert!(criteria.with_noise_multiple(-1.0).is_err() && criteria.with_least_weight(0.6).is_err());
    assert!(criteria.with_collapse(f64::NAN, 0.0).is_err() && criteria.with_collapse(0.6, -0.1).is_err());
    assert!(thermal_noise(-1.0, 1.0, 1).is_err() && thermal_noise(1.0, 0.0, 1).is_err());
    assert!(thermal_noise(1.0, 1.0, 0).is_err() && thermal_noise(f64::NAN, 1.0, 1).is_err());
}

#[test]
fn block_error_is_that_of_an_autoregressive_series() -> Outcome {
    // Exact: the error of the mean is sqrt((1 + rho)/(1 - rho)/n).
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
            assert!((average.standard_error() / exact - 1.0).abs() < 0.35, "{rho}: {average:?}");
            // The naive error is known far better, so that their ratio is as uncertain.
            let growth = average.correlated_samples() * (1.0 - rho) / (1.0 + rho);
            assert!((growth.sqrt() - 1.0).abs() < 0.35, "{rho}: {average:?}");
            squares += (average.mean() / average.standard_error()).powi(2);
        }
        // Mean of 40 squared normals: standard error 0.22, and 1/error^2 is biased up by a few per cent.
        let chi = squares / runs as f64;
        assert!((0.35..1.9).contains(&chi), "{rho}: {chi}");
    }
    Ok(())
}

#[test]
fn the_block_taken_is_the_smallest_that_is_long_enough() -> Outcome {
    // Of 300 independent samples: blocks of 8 are too short, 512 < 600, and blocks of 16 are not.
    let mut random = Random::new(3);
    let samples: Vec<f64> = (0..300).map(|_| random.normal()).collect();
    let error = |block| {
        let means = samples.chunks_exact(block).map(|chunk| chunk.iter().sum::<f64>() / block as f64);
        means.collect::<RunningMean>().standard_error()
    };
    assert!((0.97..1.13).contains(&(error(8) / error(1))) && error(8) != error(16));
    assert!((block_average(&samples)?.standard_error() / error(16) - 1.0).abs() < 1e-12);
    Ok(())
}

#[test]
fn short_constant_and_bad_series() -> Outcome {
    let constant = block_average(&[2.5; 100])?;
    assert_eq!((constant.mean(), constant.standard_error(), constant.correlated_samples()), (2.5, 0.0, 1.0));
    assert!(constant.is_converged());
    // A single jump: nobody can tell how often there will be one.
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
        (0.01, Conductive),
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
    // The other lines have no hysteresis: what is open is error.
    let disagree = [(1.0, Conductive), (2.0, Conductive), (2.0, OneRoll), (3.0, OneRoll)];
    let found = transitions(disagree)?;
    assert_eq!((found.len(), found[0].value, found[0].error), (1, 2.0, 1.0));
    assert!(transitions([])?.is_empty() && transitions([(f64::NAN, OneRoll)]).is_err());
    Ok(())
}

#[test]
fn line_of_equal_loss_has_no_scatter() -> Outcome {
    let gas = Maxwellian::new(2.0)?;
    let line = IsoLine::new(-0.2, &gas)?;
    let mut points = Vec::new();
    for friction in [0.0, 0.01, 0.02, 1.5, 3.0] {
        for inelasticity in line.inelasticities(friction)? {
            points.push(Frictional::new(inelasticity, friction)?);
        }
    }
    let average = line_average(&points, &gas)?;
    assert!((average.energy_change().mean() + 0.2).abs() < 1e-12);
    assert!(average.energy_change().standard_deviation() < 1e-12);
    let effective = average.effective_inelasticity();
    assert!((effective.mean() - 0.5 * (1.0 - 0.9_f64.sqrt())).abs() < 1e-12);
    assert!(line_average(&[], &gas).is_err());
    assert!(line_average(&[Frictional::new(0.2, 0.47)?], &gas).is_err(), "more than smooth disks can lose");
    Ok(())
}
