//! Clusters of points, found by k-means.

use granular_edmd::ParameterError;
use granular_edmd::quantity::{accept, non_negative};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::clusters::Clusters;
use granular_edmd::glam::DVec2;

/// Number of restarts. With four clusters or fewer, most of them find the same best result.
const RESTARTS: usize = 16;

/// Largest number of iterations from one start, far above the usual number.
const ROUNDS: usize = 1000;

/// Largest coordinate. Its square, summed over all points, stays finite.
const LARGEST: f64 = 1e100;

/// Largest number of clusters to look for: one roll of either sense, and two rolls of either sense.
const MOST: usize = 4;

/// Separation above which two clusters are distinct.
const DISTINCT: f64 = 4.0;

/// Finds the distinct clusters of these points.
///
/// The result has the largest number of clusters, from 1 to 4, whose pairs are all separated by $`D > 4`$
/// ([`Clusters::separation`]).
///
/// A k-means search finds as many clusters as requested, so the number must follow from the result itself.
/// Suppose that it cuts a single cloud, of symmetric density with one maximum, in two. In each half the
/// density falls away from the cut. The mean of the half is therefore at most $`\sqrt3`$ of its standard
/// deviations away from the cut, with equality for the uniform density. A single cloud has
/// $`D \le 2\sqrt3 = 3.46`$ (a Gaussian one 2.65), so above 4 there are two clouds. Neither the width of a
/// cloud nor the correlation of its samples enters, as long as the series fills the cloud. A series of only a
/// few correlation times can look like several clouds.
///
/// `noise` is the least standard deviation of a single state, such as
/// [`thermal_noise`](super::thermal_noise). Clusters closer than four times this noise are never distinct,
/// however sharp they are.
///
/// # Errors
/// If there is no point, a coordinate is not finite or above 1e100 in magnitude, or the noise is negative or
/// not finite.
pub(crate) fn distinct_clusters(points: &[DVec2], noise: f64, seed: u64) -> Result<Clusters, ParameterError> {
    non_negative("noise", noise)?;
    let mut distinct = k_means(points, 1, RESTARTS, seed)?;
    // The search continues after the first number that fails. Three clouds in a row, cut in two, make a wide
    // cluster that is not separated from the other; cut in three, they are.
    for clusters in 2..=MOST.min(points.len()) {
        let found = k_means(points, clusters, RESTARTS, seed)?;
        if found.separation(noise) > DISTINCT {
            distinct = found;
        }
    }
    Ok(distinct)
}

/// Finds this number of clusters in a plane by k-means, the best of several restarts.
///
/// The search looks for the centers $`c_j`$ that minimize the scatter $`\sum_i \min_j |r_i - c_j|^2`$
/// (MacQueen 1967, the paper's reference 14). It starts from points far from each other, and from centers
/// that k-means++ chooses (Arthur & Vassilvitskii 2007). The result depends on the points and the seed, but
/// not on the order of the points, which are sorted first. If there are fewer distinct points than requested
/// clusters, there are fewer clusters.
///
/// # Errors
/// If there are fewer points than clusters, or a coordinate is not finite or above 1e100 in magnitude.
pub(crate) fn k_means(
    points: &[DVec2],
    clusters: usize,
    restarts: usize,
    seed: u64,
) -> Result<Clusters, ParameterError> {
    check(points, clusters)?;
    // Sums of sorted points round alike, so the bits do not depend on the order in which points are
    // given.
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].x.total_cmp(&points[b].x).then(points[a].y.total_cmp(&points[b].y)));
    let sorted: Vec<DVec2> = order.iter().map(|&point| points[point]).collect();
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut best = descend(&sorted, plus_plus(&sorted, clusters, &mut generator));
    for restart in 1..restarts {
        let next = match restart {
            1 => descend(&sorted, farthest(&sorted, clusters)),
            _ => descend(&sorted, plus_plus(&sorted, clusters, &mut generator)),
        };
        if next.scatter < best.scatter {
            best = next;
        }
    }
    Ok(Clusters::new(&sorted, &best.labels, &order))
}

fn check(points: &[DVec2], clusters: usize) -> Result<(), ParameterError> {
    let enough = points.len() >= clusters;
    accept(enough, "number of points", "at least the number of clusters", points.len() as f64)?;
    points.iter().flat_map(DVec2::to_array).try_for_each(|coordinate| {
        let valid = coordinate.abs() <= LARGEST;
        accept(valid, "coordinate of a point", "finite and at most 1e100 in size", coordinate).map(|_| ())
    })
}

/// Returns the first centers, each the farthest point from the ones before. A cloud of few points that is far
/// from all others has one of them, though a draw may miss it.
fn farthest(points: &[DVec2], clusters: usize) -> Vec<DVec2> {
    let mean = points.iter().sum::<DVec2>() / points.len() as f64;
    let mut centers = vec![points[most_distant(points, |point| point.distance_squared(mean))]];
    while centers.len() < clusters {
        let next = points[most_distant(points, |point| nearest(point, &centers).1)];
        if centers.contains(&next) {
            break;
        }
        centers.push(next);
    }
    centers
}

/// Returns the index of the first point at the largest distance.
fn most_distant(points: &[DVec2], distance: impl Fn(DVec2) -> f64) -> usize {
    let distances = points.iter().map(|&point| distance(point)).enumerate();
    distances.fold((0, -1.0), |most, next| if next.1 > most.1 { next } else { most }).0
}

/// Draws the first centers among the points. The probability of each next one is proportional to its squared
/// distance from the nearest center so far.
fn plus_plus(points: &[DVec2], clusters: usize, generator: &mut Xoshiro256PlusPlus) -> Vec<DVec2> {
    // Centers drawn evenly often begin in the same cloud, and a descent cannot carry one of them across the
    // gap to another cloud. Drawn by squared distance, they begin in different clouds in most restarts.
    let first = (uniform(generator) * points.len() as f64) as usize;
    let mut centers = vec![points[first.min(points.len() - 1)]];
    while centers.len() < clusters {
        let distances: Vec<f64> = points.iter().map(|&point| nearest(point, &centers).1).collect();
        let mut left = uniform(generator) * distances.iter().sum::<f64>();
        let passed = |&(_, &distance): &(usize, &f64)| {
            left -= distance;
            distance > 0.0 && left <= 0.0
        };
        // Rounding of the sum may leave a remainder after all points. Then the last point that is not a
        // center yet is the next one.
        let last = distances.iter().rposition(|&distance| distance > 0.0);
        let Some(next) = distances.iter().enumerate().find(passed).map(|(point, _)| point).or(last) else {
            // All points lie on centers: there are no other distinct points.
            break;
        };
        centers.push(points[next]);
    }
    centers
}

/// Draws a number uniformly from the open interval (0, 1): the middle of one of 2⁵² equal intervals.
fn uniform(generator: &mut Xoshiro256PlusPlus) -> f64 {
    const SCALE: f64 = 1.0 / (1u64 << 52) as f64;
    ((generator.next_u64() >> 12) as f64 + 0.5) * SCALE
}

/// Returns the center nearest to a point, and its squared distance. If several centers are equally near, the
/// first one counts.
fn nearest(point: DVec2, centers: &[DVec2]) -> (usize, f64) {
    let distances = centers.iter().map(|&center| point.distance_squared(center)).enumerate();
    distances.fold((0, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best })
}

struct Fit {
    labels: Vec<usize>,
    scatter: f64,
}

/// Assigns the points to their nearest centers and moves the centers to the means of their points, until
/// nothing changes.
fn descend(points: &[DVec2], mut centers: Vec<DVec2>) -> Fit {
    let mut fit = assign(points, &centers);
    for _ in 0..ROUNDS {
        move_to_means(points, &fit.labels, &mut centers);
        let next = assign(points, &centers);
        // Labels settle after finitely many rounds. The scatter may continue to change by rounding.
        let settled = next.labels == fit.labels;
        fit = next;
        if settled {
            break;
        }
    }
    fit
}

fn assign(points: &[DVec2], centers: &[DVec2]) -> Fit {
    let (labels, distances): (Vec<usize>, Vec<f64>) =
        points.iter().map(|&point| nearest(point, centers)).unzip();
    Fit { labels, scatter: distances.iter().sum() }
}

/// Moves each center to the mean of its points. A center that has lost all points stays where it is.
fn move_to_means(points: &[DVec2], labels: &[usize], centers: &mut [DVec2]) {
    for (label, center) in centers.iter_mut().enumerate() {
        let own = || points.iter().zip(labels).filter(|&(_, &of)| of == label).map(|(&point, _)| point);
        let count = own().count();
        if count > 0 {
            *center = own().sum::<DVec2>() / count as f64;
        }
    }
}
