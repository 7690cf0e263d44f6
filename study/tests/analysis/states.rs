//! The names of states, from clusters and layers.

use granular_edmd::ParameterError;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{ConvectionOrder, DenseLayer};
use granular_edmd_study::analysis::ConvectiveRegime::{Coexistence, Collapsed, NoRoll, OneRoll, TwoRolls};
use granular_edmd_study::analysis::{
    ConvectiveRegime, ConvectiveState, StateCriteria, TransitionLine, thermal_noise,
};

use crate::{FIGURE_4, NOISE, Outcome, Random, figure_4};

fn orders(points: &[DVec2]) -> Vec<ConvectionOrder> {
    points.iter().map(|point| ConvectionOrder::new(point.x, point.y)).collect()
}

#[test]
fn clusters_of_figure_4_are_found_and_named() -> Outcome {
    for seed in 0..5 {
        let points = figure_4(seed, [100, 150, 250]);
        let found = StateCriteria::default().classify(&orders(&points), NOISE, None)?;
        assert_eq!(found.clusters().len(), 3);
        // A point of one cloud nearer to another's center is 4.9 spreads out.
        for (state, weight) in [
            (ConvectiveState::ClockwiseRoll, 0.2),
            (ConvectiveState::CounterclockwiseRoll, 0.3),
            (ConvectiveState::TwoRollsUp, 0.5),
        ] {
            assert!((found.weight(state) - weight).abs() < 0.005, "{state} {}", found.weight(state));
        }
        // The tolerance is five standard errors of a mean of a hundred.
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
    let often = StateCriteria::default().classify(&orders(&figure_4(3, [0, 470, 30])), NOISE, None)?;
    assert_eq!((often.clusters().len(), often.regime()), (2, Coexistence));
    Ok(())
}

#[test]
fn a_lean_on_the_way_to_the_collapse_is_no_coexistence() -> Outcome {
    let states = |rolls: [usize; 3]| -> Vec<ConvectionOrder> {
        let at = [(0.0, 0.0), (0.05, 0.04), (0.0, 0.1)];
        let points = rolls.iter().zip(at).flat_map(|(&count, (x, y))| vec![DVec2::new(x, y); count]);
        orders(&points.collect::<Vec<_>>())
    };
    let regime = |rolls| Ok(StateCriteria::default().classify(&states(rolls), 0.004, None)?.regime());
    let found: Result<Vec<_>, ParameterError> =
        [[30, 10, 60], [3, 10, 87], [0, 40, 60], [20, 60, 20]].into_iter().map(regime).collect();
    assert_eq!(found?, [TwoRolls, Coexistence, Coexistence, OneRoll]);
    Ok(())
}

#[test]
fn correlated_noise_of_a_gas_at_rest_is_no_roll() -> Outcome {
    for seed in 0..5 {
        let mut random = Random::new(seed);
        // Twenty samples tell as much as one, so there are 25 independent ones in all.
        let (memory, mut state) = (0.905_f64, DVec2::ZERO);
        let points: Vec<DVec2> = (0..500)
            .map(|_| {
                let kick = DVec2::new(random.normal(), random.normal());
                state = memory * state + (1.0 - memory * memory).sqrt() * NOISE * kick;
                state
            })
            .collect();
        let found = StateCriteria::default().classify(&orders(&points), NOISE, None)?;
        assert_eq!((found.regime(), found.clusters().len()), (NoRoll, 1), "seed {seed}");
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
    assert_eq!(name(2.9 * NOISE, 0.0)?, ConvectiveState::NoRoll);
    assert_eq!(name(3.1 * NOISE, 0.0)?, ConvectiveState::ClockwiseRoll);
    assert_eq!(name(0.1, -0.19)?, ConvectiveState::ClockwiseRoll, "one roll leans to a side");
    assert_eq!(name(0.1, -0.21)?, ConvectiveState::TwoRollsDown);
    Ok(())
}

#[test]
fn states_regimes_and_lines_have_the_names_of_the_paper() {
    assert_eq!(ConvectiveState::TwoRollsUp.to_string(), "two rolls, up in the middle");
    assert_eq!(Coexistence.to_string(), "coexistence of one roll and two");
    assert_eq!(TransitionLine::OneTwoBeginning.to_string(), "1-2(a)");
    let rolls = [ConvectiveState::NoRoll, ConvectiveState::TwoRollsDown, ConvectiveState::Collapsed];
    assert_eq!(rolls.map(ConvectiveState::rolls), [Some(0), Some(2), None]);
}

#[test]
fn collapse_needs_a_compact_layer_on_a_gas_without_rolls() -> Outcome {
    let layer = |packing_fraction, least_below| DenseLayer::new(19.0, packing_fraction, least_below);
    let regime = |two_rolls: f64, layer| -> Result<ConvectiveRegime, ParameterError> {
        let samples = [ConvectionOrder::new(0.0, two_rolls)];
        Ok(StateCriteria::default().classify(&samples, 0.0067, layer)?.regime())
    };
    assert_eq!(regime(0.02, Some(layer(0.67, 0.13)))?, Collapsed);
    assert_eq!(regime(0.02, None)?, NoRoll);
    assert_eq!(regime(0.105, Some(layer(0.67, 0.13)))?, TwoRolls, "rolls are alive");
    assert_eq!(regime(0.02, Some(layer(0.45, 0.13)))?, NoRoll, "not compact");
    assert_eq!(regime(0.0, Some(layer(0.84, 0.84)))?, NoRoll, "a sediment on the floor");
    assert_eq!(regime(0.0, Some(layer(0.8, 0.4)))?, NoRoll, "on no less than half of its density");
    assert_eq!(regime(0.0, Some(layer(0.60, 0.13)))?, NoRoll, "no more than compact");
    assert_eq!(regime(0.03, Some(layer(0.67, 0.13)))?, TwoRolls, "rolls no less than dead");
    // Near the transition: in most samples there is no flow, in some there are two rolls.
    let turns = [0.0, 0.0, 0.0, 0.14].map(|two_rolls| ConvectionOrder::new(0.0, two_rolls));
    let found = StateCriteria::default().classify(&turns, 0.0067, Some(layer(0.71, 0.09)))?;
    assert_eq!((found.regime(), found.weight_of_rolls(0), found.weight_of_rolls(2)), (Collapsed, 0.0, 0.25));
    let criteria = StateCriteria::default().with_collapse(0.4, 0.01)?;
    let sample = [ConvectionOrder::default()];
    assert_eq!(criteria.classify(&sample, 0.01, Some(layer(0.45, 0.13)))?.regime(), Collapsed);
    // The same flow over a base that is a hundred times as fast.
    let fast = StateCriteria::default().with_base_speed(100.0)?;
    let regime = |two_rolls: f64| -> Result<ConvectiveRegime, ParameterError> {
        let sample = [ConvectionOrder::new(0.0, two_rolls)];
        Ok(fast.classify(&sample, 0.67, Some(layer(0.67, 0.13)))?.regime())
    };
    assert_eq!([regime(2.0)?, regime(10.5)?], [Collapsed, TwoRolls]);
    assert!(fast.with_base_speed(0.0).is_err());
    Ok(())
}

#[test]
fn equal_weights_have_a_name_all_the_same() -> Outcome {
    let [none, one, back, two] = [(0.0, 0.0), (0.1, 0.0), (-0.1, 0.0), (0.0, 0.1)];
    let criteria = StateCriteria::default();
    let found = |at: &[(f64, f64)]| {
        let points: Vec<DVec2> = at.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
        criteria.classify(&orders(&points), 0.0, None)
    };
    assert_eq!(found(&[one, back])?.state(), ConvectiveState::CounterclockwiseRoll, "the first cluster");
    assert_eq!(found(&[none, one])?.regime(), NoRoll);
    assert_eq!(found(&[one, two])?.regime(), Coexistence);
    assert_eq!(
        found(&[one, one, two, two, none])?.regime(),
        TwoRolls,
        "no roll has more than the least weight"
    );
    assert_eq!(found(&[one, one, two, two])?.regime(), Coexistence);
    Ok(())
}

#[test]
fn criteria_and_noise_are_those_asked_for() {
    assert_eq!((thermal_noise(2.0, 4.0, 25), thermal_noise(0.0, 1.0, 1)), (Ok(0.1), Ok(0.0)));
}

#[test]
fn criteria_and_noise_refuse_what_has_no_meaning() {
    let criteria = StateCriteria::default();
    assert!(criteria.with_noise_multiple(-1.0).is_err() && criteria.with_two_rolls(0.0).is_err());
    assert!(criteria.with_collapse(f64::NAN, 0.0).is_err() && criteria.with_collapse(0.6, -0.1).is_err());
    assert!(thermal_noise(-1.0, 1.0, 1).is_err() && thermal_noise(1.0, 0.0, 1).is_err());
    assert!(thermal_noise(1.0, 1.0, 0).is_err() && thermal_noise(f64::NAN, 1.0, 1).is_err());
}

/// Clouds of few points beside a large one, each a Gaussian by its quantiles: three clusters, however the
/// sizes are.
#[test]
fn a_small_cloud_is_found_beside_a_large_one() -> Outcome {
    let cloud = |x: f64, y: f64, count: usize| {
        (0..count).map(move |k| {
            let radius = (-2.0 * ((k as f64 + 0.5) / count as f64).ln()).sqrt();
            let angle = std::f64::consts::TAU * (0.618_033_988_75 * k as f64).fract();
            DVec2::new(x, y) + 0.012 * radius * DVec2::from_angle(angle)
        })
    };
    for (large, small, least) in [(160, 7, 3), (250, 3, 3), (90, 12, 4)] {
        let points =
            cloud(-0.12, 0.04, large).chain(cloud(0.0, 0.122, small)).chain(cloud(0.12, 0.04, least));
        let found = StateCriteria::default().classify(&orders(&points.collect::<Vec<_>>()), 0.012, None)?;
        assert_eq!(found.clusters().len(), 3, "{large}, {small}, {least}");
    }
    Ok(())
}
