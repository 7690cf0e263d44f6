//! Clusters of points whose partition is known.

use granular_edmd::ParameterError;
use granular_edmd::glam::DVec2;
use granular_edmd_study::analysis::StateCriteria;
use support::cases::few;

use crate::parts::clusters::{Cluster, Clusters, distinct_clusters, k_means};
use crate::{NOISE, Outcome, Random, figure_4};

/// Returns the best of sixteen searches.
fn fit(clusters: usize, seed: u64, points: &[DVec2]) -> Result<Clusters, ParameterError> {
    k_means(points, clusters, 16, seed)
}

#[test]
fn one_cloud_of_any_width_is_one_cluster() -> Outcome {
    for seed in few(0..4, 3) {
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
    let separation = fit(2, 1, &line)?.separation(0.0);
    assert!((separation - 2.0 * 3.0_f64.sqrt()).abs() < 1e-3, "{separation}");
    Ok(())
}

#[test]
fn clusters_know_their_places_sizes_and_spreads() -> Outcome {
    // A cross around (0, 0) and a diagonal through (10, 0), one point more.
    let at = |x: f64, y: f64| DVec2::new(x, y);
    let cross = [at(2.0, 0.0), at(-2.0, 0.0), at(0.0, 1.0), at(0.0, -1.0)];
    let diagonal = [at(10.0, 0.0), at(11.0, 1.0), at(9.0, -1.0), at(12.0, 2.0), at(8.0, -2.0)];
    let found = fit(2, 1, &[cross.as_slice(), &diagonal].concat())?;
    let [first, second] = found.iter().collect::<Vec<_>>()[..] else { panic!("{found:?}") };
    assert_eq!(
        (first.center(), first.count(), second.center(), second.count()),
        (at(0.0, 0.0), 4, at(10.0, 0.0), 5)
    );
    assert_eq!((first.weight(), second.weight()), (4.0 / 9.0, 5.0 / 9.0));
    let near = |value: f64, expected: f64| (value - expected).abs() < 1e-12;
    let slant = DVec2::new(1.0, 1.0).normalize();
    assert!(near(first.spread(DVec2::X), 2_f64.sqrt()) && near(first.spread(DVec2::Y), 0.5_f64.sqrt()));
    assert!(near(second.spread(slant), 2.0) && near(second.spread(slant.perp()), 0.0));
    assert!(near(second.spread(DVec2::new(0.6, 0.8)), 1.4 * 2_f64.sqrt()));
    // Along the line of the centers: variances 2 of four points and 2 of five.
    assert!(near(found.separation(0.0), 10.0 / 2_f64.sqrt()) && near(found.separation(4.0), 2.5));
    assert_eq!(fit(1, 1, &cross)?.separation(0.0), f64::INFINITY);
    let pairs = [-1.0, 1.0, 9.0, 11.0, 29.0, 31.0].map(|x| at(x, 0.0));
    assert!(near(fit(3, 1, &pairs)?.separation(0.0), 10.0), "the nearest two of three");
    let four = [-1.0, 1.0, 3.0, 5.0].map(|x| at(x, 0.0));
    assert_eq!(distinct_clusters(&four, 1.0, 1)?.len(), 1, "four spreads apart are not distinct");
    let mirrored = fit(2, 1, &[at(0.0, 5.0), at(0.0, -5.0)])?;
    assert_eq!(mirrored.labels(), [1, 0], "by height, if one above the other");
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
        let (a, b) = (fit(clusters, 3, &points)?, fit(clusters, 3, &shuffled)?);
        assert!(a.iter().eq(b.iter()), "the same bits");
        assert!(order.iter().zip(b.labels()).all(|(&place, label)| a.labels()[place] == *label));
        assert_eq!(fit(clusters, 3, &points)?, a);
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
        let found = k_means(&points, 2, 50, seed)?;
        assert!((scatter(&points, found.labels()) - best).abs() < 1e-12, "seed {seed}");
    }
    Ok(())
}

/// One descent ends where every point is nearest to the center of its own cluster. More descents end no
/// worse.
#[test]
fn one_descent_ends_at_rest_and_more_end_no_worse() -> Outcome {
    let points = Random::new(1).cloud((0.0, 0.0), 1.0, 100);
    let mut better = 0;
    for seed in 0..20 {
        let scatter = |restarts| -> Result<f64, ParameterError> {
            let found = k_means(&points, 4, restarts, seed)?;
            let centers: Vec<DVec2> = found.iter().map(Cluster::center).collect();
            let own = |label: usize, point: &DVec2| centers[label].distance_squared(*point);
            for (&label, point) in found.labels().iter().zip(&points) {
                assert!((0..4).all(|other| own(label, point) <= own(other, point)), "seed {seed}");
            }
            Ok(found.labels().iter().zip(&points).map(|(&label, point)| own(label, point)).sum())
        };
        let gain = scatter(1)? - scatter(8)?;
        assert!(gain > -1e-9, "seed {seed}");
        better += usize::from(gain > 1e-9);
    }
    assert!(better > 0);
    Ok(())
}

/// The first centers are far from each other, so that each of four distant groups gets one.
#[test]
fn one_descent_finds_groups_that_are_far_apart() -> Outcome {
    let corners = [(0.0, 0.0), (1e6, 0.0), (0.0, 1e6), (1e6, 1e6)];
    let points: Vec<DVec2> = corners.into_iter().flat_map(|at| Random::new(2).cloud(at, 1.0, 5)).collect();
    for seed in 0..50 {
        let found = k_means(&points, 4, 1, seed)?;
        assert!(found.len() == 4 && found.iter().all(|cluster| cluster.count() == 5), "seed {seed}");
        // Two points whose squared distance is the smallest number there is.
        let close = [DVec2::ZERO, DVec2::new(2e-162, 0.0)];
        assert_eq!(k_means(&close, 2, 1, seed)?.len(), 2, "seed {seed}");
    }
    Ok(())
}

#[test]
fn degenerate_points_are_clustered_and_bad_ones_refused() -> Outcome {
    let equal = [DVec2::new(0.1, -0.2); 7];
    let found = fit(4, 1, &equal)?;
    assert_eq!((found.len(), found.labels()), (1, [0; 7].as_slice()));
    assert!(found.iter().all(|cluster| cluster.spread(DVec2::X) < 1e-16 && cluster.weight() == 1.0));
    assert_eq!(distinct_clusters(&equal, 0.0, 1)?.len(), 1);
    assert_eq!(distinct_clusters(&[DVec2::ZERO, DVec2::X], 0.0, 1)?.len(), 2);
    assert_eq!(distinct_clusters(&[DVec2::ZERO, DVec2::splat(1e100)], 0.0, 1)?.len(), 2);

    let message = |result: Result<_, ParameterError>| result.map(|_: usize| ()).unwrap_err().to_string();
    let fit = |clusters, points: &[DVec2]| fit(clusters, 1, points).map(|found| found.len());
    assert_eq!(
        message(fit(3, &equal[..2])),
        "number of points must be at least the number of clusters, but is 2"
    );
    let coordinate = "coordinate of a point must be finite and at most 1e100 in magnitude, but is";
    assert_eq!(message(fit(1, &[DVec2::new(0.0, f64::NAN)])), format!("{coordinate} NaN"));
    assert_eq!(message(fit(1, &[DVec2::new(f64::INFINITY, 0.0)])), format!("{coordinate} inf"));
    assert!(fit(8, &equal).is_err());
    assert!(distinct_clusters(&[], 0.1, 1).is_err() && distinct_clusters(&equal, f64::NAN, 1).is_err());
    let nobody = StateCriteria::default().classify(&[], 0.1, None);
    assert!(nobody.is_err());
    Ok(())
}
