//! Clusters of points in a plane, found by k-means.

use granular_edmd::ParameterError;
use granular_edmd::glam::DVec2;
use granular_edmd::quantity::{accept, non_negative};
use granular_edmd::random::{Stream, Xoshiro256PlusPlus, generator, uniform};

/// Number of restarts. With four clusters or fewer, most restarts find the same best result.
const RESTARTS: usize = 16;

/// Largest number of iterations from one start, far above the usual number.
const ROUNDS: usize = 1000;

/// Largest allowed coordinate. The sum of the squares over all points stays finite.
const LARGEST: f64 = 1e100;

/// Largest number of clusters to look for: one roll of either sense, and two rolls of either sense.
const MOST: usize = 4;

/// Separation above which two clusters are distinct.
const DISTINCT: f64 = 4.0;

/// A cluster of points: its center, its size and its spread.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Cluster {
    center: DVec2,
    count: usize,
    weight: f64,
    /// Variances along x and y, and the covariance.
    covariance: (f64, f64, f64),
}

impl Cluster {
    fn new(points: &[DVec2], of: usize) -> Self {
        let count = points.len() as f64;
        let center = points.iter().sum::<DVec2>() / count;
        let moment = |product: fn(DVec2) -> f64| {
            points.iter().map(|&point| product(point - center)).sum::<f64>() / count
        };
        let covariance = (moment(|d| d.x * d.x), moment(|d| d.y * d.y), moment(|d| d.x * d.y));
        Self { center, count: points.len(), weight: count / of as f64, covariance }
    }

    /// Returns the mean of the cluster's points.
    pub const fn center(&self) -> DVec2 {
        self.center
    }

    /// Returns the number of the cluster's points.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Returns the cluster's share of all points.
    pub const fn weight(&self) -> f64 {
        self.weight
    }

    /// Returns the standard deviation of the cluster's points along this direction, a unit vector.
    pub fn spread(&self, direction: DVec2) -> f64 {
        self.variance(direction).sqrt()
    }

    fn variance(&self, direction: DVec2) -> f64 {
        let (xx, yy, xy) = self.covariance;
        let DVec2 { x, y } = direction;
        // For points on a line, the variance across the line is zero, and rounding can make it negative.
        (xx * x * x + 2.0 * xy * x * y + yy * y * y).max(0.0)
    }

    /// Returns the distance of two clusters' centers, in units of the clusters' spread along the line between
    /// the centers.
    fn separation(&self, other: &Self, noise: f64) -> f64 {
        let between = other.center - self.center;
        let direction = between.normalize_or_zero();
        let weighted = self.weight * self.variance(direction) + other.weight * other.variance(direction);
        between.length() / (weighted / (self.weight + other.weight)).sqrt().max(noise)
    }
}

/// Clusters of points in a plane, in ascending order of their centers (by x, then y).
///
/// Made by [`StateCriteria::classify`](super::StateCriteria::classify).
#[derive(Debug, Clone, PartialEq)]
pub struct Clusters {
    clusters: Vec<Cluster>,
    labels: Vec<usize>,
}

impl Clusters {
    /// Creates clusters from each sorted point's label and its index in the given order.
    pub(super) fn new(sorted: &[DVec2], labels: &[usize], order: &[usize]) -> Self {
        let most = labels.iter().max().map_or(0, |&label| label + 1);
        let members = |label: usize| -> Vec<DVec2> {
            sorted.iter().zip(labels).filter(|&(_, &of)| of == label).map(|(&point, _)| point).collect()
        };
        let mut found: Vec<(usize, Cluster)> = (0..most)
            .map(|label| (label, members(label)))
            .filter(|(_, members)| !members.is_empty())
            .map(|(label, members)| (label, Cluster::new(&members, sorted.len())))
            .collect();
        // The search numbers its clusters in a random order. Once the clusters are sorted by center, each has
        // the same number for any seed.
        found.sort_by(|(_, a), (_, b)| {
            a.center.x.total_cmp(&b.center.x).then(a.center.y.total_cmp(&b.center.y))
        });
        let mut renamed = vec![0; most];
        found.iter().enumerate().for_each(|(new, &(old, _))| renamed[old] = new);
        let mut places = vec![0; sorted.len()];
        order.iter().zip(labels).for_each(|(&place, &label)| places[place] = renamed[label]);
        Self { clusters: found.into_iter().map(|(_, cluster)| cluster).collect(), labels: places }
    }

    /// Returns the number of clusters, which is at least one.
    #[expect(clippy::len_without_is_empty, reason = "there is always a cluster")]
    pub const fn len(&self) -> usize {
        self.clusters.len()
    }

    /// Iterates over the clusters in their order.
    pub fn iter(&self) -> impl Iterator<Item = &Cluster> {
        self.clusters.iter()
    }

    /// Returns the number of each point's cluster, in the order in which the points were given.
    pub fn labels(&self) -> &[usize] {
        &self.labels
    }

    /// Returns the least separation of two clusters, or infinity for a single cluster.
    ///
    /// The separation of two clusters $`a`$ and $`b`$ is the fraction in
    ///
    /// ```math
    /// D = \min_{a\ne b}\frac{|c_a - c_b|}{\max(s_{ab}, \sigma)},\qquad
    /// s_{ab}^2 = \frac{n_a s_a^2 + n_b s_b^2}{n_a + n_b},
    /// ```
    ///
    /// with the standard deviations $`s_a`$, $`s_b`$ along the line of the centers. The `noise` $`\sigma`$ is
    /// the least spread that counts.
    pub fn separation(&self, noise: f64) -> f64 {
        let pairs = self.clusters.iter().enumerate();
        pairs
            .flat_map(|(first, a)| self.clusters[first + 1..].iter().map(move |b| a.separation(b, noise)))
            .fold(f64::INFINITY, f64::min)
    }
}

/// Finds the distinct clusters of these points.
///
/// The result has the largest number of clusters, from 1 to 4, whose pairs are all separated by $`D > 4`$
/// ([`Clusters::separation`]).
///
/// A k-means search finds the requested number of clusters, so the number must follow from the result itself.
/// Suppose that it cuts a single cloud, of symmetric density with one maximum, in two. In each half the
/// density falls away from the cut. The mean of a half is therefore at most $`\sqrt3`$ standard deviations of
/// this half away from the cut, with equality for the uniform density. A single cloud thus has
/// $`D \le 2\sqrt3 = 3.46`$ (2.65 if it is Gaussian), so $`D > 4`$ means two clouds. This bound depends
/// neither on the width of the cloud nor on the correlation of its samples, as long as the series fills the
/// cloud. A series of only a few correlation times can look like several clouds.
///
/// `noise` is the least standard deviation of a single state, such as
/// [`thermal_noise`](super::thermal_noise). Clusters whose centers are closer than four times this noise are
/// never distinct, however narrow the clusters are.
///
/// # Errors
/// If there is no point, a coordinate is not finite or above 1e100 in magnitude, or the noise is negative or
/// not finite.
pub(crate) fn distinct_clusters(points: &[DVec2], noise: f64, seed: u64) -> Result<Clusters, ParameterError> {
    non_negative("noise", noise)?;
    let mut distinct = k_means(points, 1, RESTARTS, seed)?;
    // The search continues after the first number that fails. If three clouds in a row are cut in two, one of
    // the clusters is wide, and is not separated from the other. Cut in three, they are separated.
    for clusters in 2..=MOST.min(points.len()) {
        let found = k_means(points, clusters, RESTARTS, seed)?;
        if found.separation(noise) > DISTINCT {
            distinct = found;
        }
    }
    Ok(distinct)
}

/// Finds the given number of clusters in a plane by k-means, and keeps the best result of several restarts.
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
    let mut generator = generator(seed, Stream::Studies, 0);
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
        accept(valid, "coordinate of a point", "finite and at most 1e100 in magnitude", coordinate)
            .map(|_| ())
    })
}

/// Returns the first centers: each is the point farthest from the previous centers. A small cloud that is far
/// from all others thus gets a center, which a random draw could miss.
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

/// Draws the first centers among the points. The probability that a point becomes the next center is
/// proportional to its squared distance from the nearest center so far.
fn plus_plus(points: &[DVec2], clusters: usize, generator: &mut Xoshiro256PlusPlus) -> Vec<DVec2> {
    // Centers drawn evenly often begin in the same cloud, and a descent cannot carry one of them across the
    // gap to another cloud. Centers drawn by squared distance begin in different clouds in most restarts.
    let first = (uniform(generator) * points.len() as f64) as usize;
    let mut centers = vec![points[first.min(points.len() - 1)]];
    while centers.len() < clusters {
        let distances: Vec<f64> = points.iter().map(|&point| nearest(point, &centers).1).collect();
        let mut left = uniform(generator) * distances.iter().sum::<f64>();
        let passed = |&(_, &distance): &(usize, &f64)| {
            left -= distance;
            distance > 0.0 && left <= 0.0
        };
        // Rounding of the sum may leave a remainder after all points. Then the next center is the last point
        // that is not yet a center.
        let last = distances.iter().rposition(|&distance| distance > 0.0);
        let Some(next) = distances.iter().enumerate().find(passed).map(|(point, _)| point).or(last) else {
            // All points lie on centers: no further distinct point exists.
            break;
        };
        centers.push(points[next]);
    }
    centers
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
