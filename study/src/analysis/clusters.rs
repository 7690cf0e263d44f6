//! The result of a clustering.

use granular_edmd::glam::DVec2;

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
        // The variance is zero across a line of points, and rounding can make it negative.
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
    /// Creates clusters from the label of each sorted point, and the point's index in the given order.
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
        // The search numbers its clusters in a random order. Sorted by center, a cluster has the same number
        // for any seed.
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
