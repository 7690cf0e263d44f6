//! A given number of clusters, found by k-means.

use granular_edmd::ParameterError;
use granular_edmd::quantity::accept;
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::clusters::Clusters;
use granular_edmd::glam::DVec2;

/// Default number of restarts. With four clusters or fewer, most of them find the same best result.
const RESTARTS: usize = 16;

/// Largest number of iterations from one start, far above the usual number.
const ROUNDS: usize = 1000;

/// Largest coordinate. Its square, summed over all points, stays finite.
const LARGEST: f64 = 1e100;

/// k-means clustering in a plane, the best of several restarts.
///
/// The search looks for the centers $`c_j`$ that minimize the scatter $`\sum_i \min_j |r_i - c_j|^2`$
/// (MacQueen 1967, the paper's reference 14). It starts from centers that k-means++ chooses (Arthur &
/// Vassilvitskii 2007). The result depends on the points and the seed, but not on the order of the points,
/// which are sorted first.
///
/// ```
/// use granular_edmd_study::analysis::KMeans;
/// use granular_edmd::glam::DVec2;
/// let points = [(0.0, 0.1), (5.0, 0.1), (0.0, -0.1), (5.0, -0.1), (5.0, 0.0)];
/// let points = points.map(|(x, y)| DVec2::new(x, y));
/// let clusters = KMeans::new(2, 1)?.fit(&points)?;
/// assert_eq!(clusters.labels(), [0, 1, 0, 1, 1]);
/// assert_eq!(clusters.iter().nth(1).map(|cluster| cluster.center()), Some(DVec2::new(5.0, 0.0)));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KMeans {
    clusters: usize,
    restarts: usize,
    seed: u64,
}

impl KMeans {
    /// Creates a search for this number of clusters.
    ///
    /// # Errors
    /// If the number of clusters is zero.
    pub fn new(clusters: usize, seed: u64) -> Result<Self, ParameterError> {
        accept(clusters > 0, "number of clusters", "at least 1", 0.0)?;
        Ok(Self { clusters, restarts: RESTARTS, seed })
    }

    /// Returns the same search with this number of restarts; 16 unless given.
    ///
    /// # Errors
    /// If it is zero.
    pub fn with_restarts(self, restarts: usize) -> Result<Self, ParameterError> {
        accept(restarts > 0, "number of restarts", "at least 1", 0.0)?;
        Ok(Self { restarts, ..self })
    }

    /// Finds the clusters of these points.
    ///
    /// If there are fewer distinct points than requested clusters, there are fewer clusters.
    ///
    /// # Errors
    /// If there are fewer points than clusters, or a coordinate is not finite or above 1e100 in magnitude.
    pub fn fit(&self, points: &[DVec2]) -> Result<Clusters, ParameterError> {
        check(points, self.clusters)?;
        // Sums of sorted points round alike, so the bits do not depend on the order in which points are
        // given.
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by(|&a, &b| points[a].x.total_cmp(&points[b].x).then(points[a].y.total_cmp(&points[b].y)));
        let sorted: Vec<DVec2> = order.iter().map(|&point| points[point]).collect();
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(self.seed);
        let mut best = descend(&sorted, plus_plus(&sorted, self.clusters, &mut generator));
        for _ in 1..self.restarts {
            let next = descend(&sorted, plus_plus(&sorted, self.clusters, &mut generator));
            if next.scatter < best.scatter {
                best = next;
            }
        }
        Ok(Clusters::new(&sorted, &best.labels, &order))
    }
}

fn check(points: &[DVec2], clusters: usize) -> Result<(), ParameterError> {
    let enough = points.len() >= clusters;
    accept(enough, "number of points", "at least the number of clusters", points.len() as f64)?;
    points.iter().flat_map(DVec2::to_array).try_for_each(|coordinate| {
        let valid = coordinate.abs() <= LARGEST;
        accept(valid, "coordinate of a point", "finite and at most 1e100 in size", coordinate).map(|_| ())
    })
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
